// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/testing/stage_harness.hpp"

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <set>
#include <string>
#include <system_error>
#include <thread>

#include "firing.hpp"
#include "nearest.hpp"
#include "param_values.hpp"

namespace petal::testing {

namespace fs = std::filesystem;

struct StageHarness::State : RunServices {
    explicit State(StageSpec its_spec) : spec(std::move(its_spec)) {
        std::string name = (fs::temp_directory_path() / "petal-stage-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw Error("cannot make a temporary folder " + name);
        run_folder = name;
    }
    ~State() override {
        std::error_code ignored;
        fs::remove_all(run_folder, ignored);
    }

    void log(const std::string&, LogLevel, const std::string& message) override {
        const std::lock_guard<std::mutex> lock(mutex);
        logs.push_back(message);
    }
    void note(const std::string&, const FrameInfo&, const Note& told) override {
        const std::lock_guard<std::mutex> lock(mutex);
        notes.push_back(told);
    }
    void verdict(const std::string&, Level level, const std::vector<std::string>& why) override {
        const std::lock_guard<std::mutex> lock(mutex);
        told_level = level;
        reasons = why;
    }
    void progress(const std::string&, double done, double total, std::string_view unit) override {
        const std::lock_guard<std::mutex> lock(mutex);
        told_progress.push_back({done, total, std::string(unit)});
    }
    void used_file(const fs::path& path) override {
        const std::lock_guard<std::mutex> lock(mutex);
        used_files.push_back(path);
    }
    void claim_product(const std::string&, const fs::path& name) override {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!products.insert(name).second)
            throw Error("'" + name.string() + "' was written already");
    }
    bool debug(const std::string&) const override { return debug_on; }
    bool cancelled() const override {
        return is_cancelled || (cancel_at && std::chrono::steady_clock::now() >= *cancel_at);
    }
    int threads() const override { return thread_count; }
    std::uint64_t seed() const override { return run_seed; }
    const fs::path& folder() const override { return run_folder; }

    std::shared_ptr<void> params() const {
        auto made = spec.make_params();
        for (const auto& [name, value] : values) spec.find_param(name)->set(made.get(), value);
        if (spec.check_params)
            for (const std::string& problem : spec.check_params(made.get())) throw Error(problem);
        return made;
    }

    StageSpec spec;
    std::string id = "stage";
    std::map<std::string, Value> values;
    std::map<std::string, std::vector<AnyPacket>> given;
    std::map<std::string, std::vector<AnyPacket>> written;
    fs::path run_folder;
    std::uint64_t run_seed = 1;
    int thread_count = 1;
    bool debug_on = false;
    bool is_cancelled = false;
    bool other_threads = false;
    double cancel_after_s = -1.0;
    std::optional<std::chrono::steady_clock::time_point> cancel_at;

    std::mutex mutex;
    std::vector<Note> notes;
    std::vector<std::string> logs;
    std::vector<std::string> reasons;
    std::vector<fs::path> used_files;
    std::set<fs::path> products;
    std::vector<Progress> told_progress;
    std::optional<Level> told_level;

    void keep(OutputPackets outputs) {
        for (std::size_t i = 0; i < outputs.size(); ++i)
            written[spec.outputs[i].name].push_back(std::move(outputs[i]));
    }
    /// A call of the stage, on a thread of its own where that was asked for.
    template <class Call>
    void call(Call&& stage_call) const {
        if (!other_threads) return stage_call();
        std::exception_ptr thrown;
        std::thread([&] {
            try {
                stage_call();
            } catch (...) {
                thrown = std::current_exception();
            }
        }).join();
        if (thrown) std::rethrow_exception(thrown);
    }
    PortPackets no_packets() const { return PortPackets(spec.inputs.size()); }
    void fire_source(Stage& stage) {
        for (std::uint64_t number = 0;; ++number) {
            Firing firing(spec, id, nullptr, number, no_packets(), *this);
            call([&] { stage.run(firing); });
            keep(firing.take_outputs());
            if (firing.ended()) return;
        }
    }
    void fire_gathering(Stage& stage) {
        PortPackets inputs;
        for (const PortSpec& port : spec.inputs) {
            const auto found = given.find(port.name);
            inputs.push_back({found != given.end(),
                              found == given.end() ? std::vector<AnyPacket>{} : found->second});
        }
        Firing firing(spec, id, nullptr, 0, std::move(inputs), *this);
        call([&] { stage.finish(firing); });
        keep(firing.take_outputs());
    }
    void fire_frames(Stage& stage) {
        std::size_t frames = 0;
        for (const auto& [port, packets] : given) frames = std::max(frames, packets.size());
        for (std::size_t k = 0; k < frames; ++k) {
            PortPackets inputs;
            std::shared_ptr<const FrameInfo> frame;
            for (const PortSpec& port : spec.inputs) {
                PortInput& input = inputs.emplace_back();
                const auto found = given.find(port.name);
                if (found == given.end()) continue;
                if (k >= found->second.size())
                    throw Error("port " + port.name + " was given fewer packets than others");
                const AnyPacket& packet = found->second[k];
                input = {true, {packet}};
                if (packet.frame && (!frame || frame->name.empty())) frame = packet.frame;
            }
            Firing firing(spec, id, std::move(frame), k, std::move(inputs), *this);
            call([&] { stage.run(firing); });
            keep(firing.take_outputs());
        }
    }
};

StageHarness::StageHarness(StageSpec spec) : state_(std::make_unique<State>(std::move(spec))) {}
StageHarness::~StageHarness() = default;
StageHarness::StageHarness(StageHarness&&) noexcept = default;
StageHarness& StageHarness::operator=(StageHarness&&) noexcept = default;

StageHarness& StageHarness::set(const std::string& param, Value value) {
    const ParamSpec* declared = state_->spec.find_param(param);
    if (declared == nullptr) {
        std::vector<std::string> names;
        for (const ParamSpec& known : state_->spec.params) names.push_back(known.name);
        throw Error("unknown parameter '" + param + "'" + did_you_mean(param, names));
    }
    if (const std::string problem = value_problem(*declared, value); !problem.empty())
        throw Error("parameter '" + param + "': " + problem);
    state_->values[param] = std::move(value);
    return *this;
}

StageHarness& StageHarness::seed(std::uint64_t seed) {
    state_->run_seed = seed;
    return *this;
}
StageHarness& StageHarness::threads(int count) {
    state_->thread_count = count;
    return *this;
}
StageHarness& StageHarness::debug(bool on) {
    state_->debug_on = on;
    return *this;
}
StageHarness& StageHarness::cancel() {
    state_->is_cancelled = true;
    return *this;
}

StageHarness& StageHarness::cancel_after(double seconds) {
    state_->cancel_after_s = seconds;
    return *this;
}
StageHarness& StageHarness::change_threads(bool on) {
    state_->other_threads = on;
    return *this;
}

void StageHarness::fire() {
    if (state_->cancel_after_s >= 0.0)
        state_->cancel_at = std::chrono::steady_clock::now() +
                            std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                std::chrono::duration<double>(state_->cancel_after_s));
    state_->written.clear();
    state_->notes.clear();
    state_->logs.clear();
    state_->reasons.clear();
    state_->used_files.clear();
    state_->products.clear();
    state_->told_progress.clear();
    state_->told_level.reset();
    const auto params = state_->params();
    const std::unique_ptr<Stage> stage = state_->spec.make_stage(params.get());
    if (state_->spec.gathers()) {
        state_->fire_gathering(*stage);
        return;
    }
    if (state_->spec.is_source()) {
        state_->fire_source(*stage);
    } else {
        state_->fire_frames(*stage);
    }
    Firing last(state_->spec, state_->id, nullptr, 0, state_->no_packets(), *state_);
    state_->call([&] { stage->finish(last); });
    last.expect_no_outputs();
}

std::uint64_t StageHarness::given(const std::string& port) const {
    const auto found = state_->given.find(port);
    return found == state_->given.end() ? 0 : found->second.size();
}

StageHarness& StageHarness::give_packet(const std::string& port, AnyPacket packet) {
    const PortSpec* declared = state_->spec.find_input(port);
    if (declared == nullptr) throw Error("the stage has no input port '" + port + "'");
    if (!packet.holds(declared->type))
        throw Error("port '" + port + "' takes " + declared->type + ", not " + packet.type);
    state_->given[port].push_back(std::move(packet));
    return *this;
}

const std::vector<AnyPacket>& StageHarness::written(const std::string& port) const {
    static const std::vector<AnyPacket> kNone;
    if (state_->spec.find_output(port) == nullptr)
        throw Error("the stage has no output port '" + port + "'");
    const auto found = state_->written.find(port);
    return found == state_->written.end() ? kNone : found->second;
}

const StageSpec& StageHarness::spec() const {
    return state_->spec;
}
const std::vector<Note>& StageHarness::notes() const {
    return state_->notes;
}
const std::vector<std::string>& StageHarness::logs() const {
    return state_->logs;
}
std::optional<Level> StageHarness::verdict() const {
    return state_->told_level;
}
const std::vector<std::string>& StageHarness::reasons() const {
    return state_->reasons;
}
const std::vector<fs::path>& StageHarness::used_files() const {
    return state_->used_files;
}
const std::vector<StageHarness::Progress>& StageHarness::progress() const {
    return state_->told_progress;
}
const fs::path& StageHarness::folder() const {
    return state_->run_folder;
}

}  // namespace petal::testing
