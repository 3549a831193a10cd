// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// Stages that take their time and write what they are told to: to cancel runs, and to fill disks.

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "petal/output.hpp"
#include "petal/plugin.hpp"

namespace slow {

struct Tick {
    int number = 0;
};

}  // namespace slow

template <>
struct petal::PacketTraits<slow::Tick> {
    static constexpr const char* name = "Tick";
    static void seal(slow::Tick&) {}
    static std::size_t bytes(const slow::Tick&) { return sizeof(slow::Tick); }
};

namespace slow {
namespace {

void take_time(petal::Run& run, int milliseconds, bool polls) {
    for (int i = 0; i < milliseconds; ++i) {
        if (polls) run.check_cancelled();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

/// `bytes` in blocks, slowly.
template <class Write>
void write_slowly(petal::Run& run, int bytes, int pause_ms, Write write) {
    constexpr int kBlock = 1000;
    for (int done = 0; done < bytes; done += kBlock) {
        run.check_cancelled();
        write(std::string(static_cast<std::size_t>(std::min(kBlock, bytes - done)), 'x'));
        std::this_thread::sleep_for(std::chrono::milliseconds(pause_ms));
    }
}

struct SourceParams {
    int frames = 1;
    int pause_ms = 0;
    bool polls = true;
};
class Source final : public petal::Stage {
   public:
    using Params = SourceParams;
    static void describe(petal::Spec<Params>& s) {
        s.summary("Emits ticks.");
        s.writes<Tick>("tick", "a tick");
        s.param("frames", &Params::frames).within(0, 1000000).doc("how many");
        s.param("pause_ms", &Params::pause_ms).within(0, 1000000).doc("before each");
        s.param("polls", &Params::polls).doc("stops when cancelled");
    }
    explicit Source(Params params) : params_(params) {}
    void run(petal::Run& run) override {
        take_time(run, params_.pause_ms, params_.polls);
        if (next_ == params_.frames) return run.end_of_data();
        if (next_ % 5 == 0) run.log(petal::LogLevel::info, "tick " + std::to_string(next_));
        run.write("tick", Tick{next_++});
        run.progress(next_, params_.frames, "ticks");
    }

   private:
    Params params_;
    int next_ = 0;
};

struct WorkParams {
    std::string in = "run";
    int work_ms = 0;
    bool polls = true;
};
class Work final : public petal::Stage {
   public:
    using Params = WorkParams;
    static void describe(petal::Spec<Params>& s) {
        s.summary("Takes its time.");
        s.reads<Tick>("tick", "a tick");
        s.writes<Tick>("tick", "the tick");
        s.param("in", &Params::in).choices({"run", "finish"}).doc("the call that is slow");
        s.param("work_ms", &Params::work_ms).within(0, 1000000).doc("how long");
        s.param("polls", &Params::polls).doc("stops when cancelled");
    }
    explicit Work(Params params) : params_(std::move(params)) {}
    void run(petal::Run& run) override {
        if (params_.in == "run") take_time(run, params_.work_ms, params_.polls);
        run.write("tick", run.in<Tick>("tick"));
    }
    void finish(petal::Run& run) override {
        if (params_.in == "finish") take_time(run, params_.work_ms, params_.polls);
    }

   private:
    Params params_;
};

struct WriterParams {
    std::string way = "output";
    std::string name = "result.json";
    int bytes = 1000;
    int pause_ms = 0;
};
class Writer final : public petal::Stage {
   public:
    using Params = WriterParams;
    static void describe(petal::Spec<Params>& s) {
        s.summary("Writes a file after the last tick.");
        s.gathers<Tick>("tick", "ticks");
        s.param("way", &Params::way).choices({"output", "save", "stream"}).doc("how");
        s.param("name", &Params::name).doc("the file");
        s.param("bytes", &Params::bytes).within(0, 1000000000).doc("its size");
        s.param("pause_ms", &Params::pause_ms).within(0, 1000000).doc("after each 1000 bytes");
    }
    explicit Writer(Params params) : params_(std::move(params)) {}
    void finish(petal::Run& run) override {
        const auto fill = [&](const std::filesystem::path& path) {
            std::string all;
            write_slowly(run, params_.bytes, params_.pause_ms, [&](const std::string& block) {
                all += block;
                petal::write_file(path, all);
            });
        };
        if (params_.way == "output") return run.output(params_.name, fill);
        if (params_.way == "save") return run.save(params_.name, fill);
        petal::PendingFile file(run.output_path(params_.name));
        fill(file.path());
        file.commit();
    }

   private:
    Params params_;
};

}  // namespace
}  // namespace slow

PETAL_PLUGIN("slow", "0.1.0", [](petal::Registrar& r) {
    std::this_thread::sleep_for(std::chrono::seconds(PETAL_TEST_LOADING_S));
    r.add<slow::Source>("slow.source");
    r.add<slow::Work>("slow.work");
    r.add<slow::Writer>("slow.writer");
});
