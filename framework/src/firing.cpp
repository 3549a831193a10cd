// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "firing.hpp"

#include <random>
#include <utility>

#include "petal/output.hpp"

namespace petal {

namespace fs = std::filesystem;

namespace {

/// FNV-1a: std::hash may differ between library versions, and a seed must not.
std::uint64_t stable_hash(std::string_view text) {
    std::uint64_t hash = 14695981039346656037ULL;
    for (const char c : text) {
        hash ^= static_cast<unsigned char>(c);
        hash *= 1099511628211ULL;
    }
    return hash;
}

/// A frame's name as a folder's name: nothing that leads elsewhere.
std::string as_folder(const FrameInfo& frame) {
    std::string name = frame.name;
    for (char& c : name)
        if (c == '/' || c == '\\' || static_cast<unsigned char>(c) < 32) c = '_';
    if (name.empty() || name == "." || name == "..") return {};
    return name;
}

/// `name` relative to the folder; an absolute one (as ${out} gives) must lie below it.
fs::path relative_inside(const fs::path& folder, const fs::path& name) {
    fs::path relative = name.is_absolute() ? name.lexically_normal().lexically_relative(folder)
                                           : name.lexically_normal();
    if (relative.empty() || *relative.begin() == ".." || *relative.begin() == "." ||
        !relative.has_filename())
        throw Error("'" + name.string() +
                    "' leads out of the run folder or names no file; give a name inside it");
    return relative;
}

void write_whole(const fs::path& path, const std::function<void(const fs::path&)>& writer) {
    PendingFile file(path);
    writer(file.path());
    file.commit();
}

}  // namespace

Firing::Firing(const StageSpec& spec, const std::string& id, std::shared_ptr<const FrameInfo> frame,
               std::uint64_t number, PortPackets inputs, RunServices& services)
    : spec_(spec),
      id_(id),
      shared_frame_(std::move(frame)),
      inputs_(std::move(inputs)),
      services_(services),
      outputs_(spec.outputs.size()) {
    own_frame_.number = number;
}

const PortInput* Firing::find_input(std::string_view port) const {
    for (std::size_t i = 0; i < inputs_.size(); ++i)
        if (spec_.inputs[i].name == port) return inputs_[i].wired ? &inputs_[i] : nullptr;
    return nullptr;
}

bool Firing::wired(std::string_view port) const {
    return find_input(port) != nullptr;
}

const AnyPacket& Firing::input(std::string_view port) const {
    const PortInput* found = find_input(port);
    if (found == nullptr || found->packets.empty())
        throw Error("input port '" + std::string(port) +
                    "' is not wired; wire it, or ask wired() first");
    return found->packets.front();
}

const std::vector<AnyPacket>& Firing::inputs(std::string_view port) const {
    static const std::vector<AnyPacket> kNone;
    const PortInput* found = find_input(port);
    return found == nullptr ? kNone : found->packets;
}

void Firing::publish(std::string_view port, AnyPacket packet) {
    std::size_t index = 0;
    while (index < spec_.outputs.size() && spec_.outputs[index].name != port) ++index;
    if (index == spec_.outputs.size())
        throw StageFault("the stage wrote on port '" + std::string(port) +
                         "', which it does not declare as an output");
    const PortSpec& declared = spec_.outputs[index];
    if (!packet.holds(declared.type))
        throw StageFault("the stage wrote " + std::string(packet ? packet.type : "no value") +
                         " on port '" + declared.name + "', which it declares as " + declared.type);
    if (outputs_[index])
        throw StageFault("the stage wrote port '" + declared.name + "' twice for one frame");
    outputs_[index] = std::move(packet);
}

const std::string* Firing::written_port() const {
    for (std::size_t i = 0; i < outputs_.size(); ++i)
        if (outputs_[i]) return &spec_.outputs[i].name;
    return nullptr;
}

OutputPackets Firing::take_outputs() {
    if (ended_) {
        if (const std::string* port = written_port())
            throw StageFault("the stage wrote port '" + *port +
                             "' in the call that ended its data");
        return {};
    }
    for (std::size_t i = 0; i < outputs_.size(); ++i)
        if (!outputs_[i])
            throw StageFault("the stage wrote no packet on port '" + spec_.outputs[i].name +
                             "'; a stage that finds nothing writes an empty " +
                             spec_.outputs[i].type);
    // Last: a source may name its frame before or after it writes.
    if (!shared_frame_) shared_frame_ = std::make_shared<const FrameInfo>(own_frame_);
    for (AnyPacket& packet : outputs_) packet.frame = shared_frame_;
    return std::move(outputs_);
}

void Firing::expect_no_outputs() const {
    if (const std::string* port = written_port())
        throw StageFault(
            "the stage wrote port '" + *port +
            "' in finish(), where nobody can read it; only stages that gather write there");
}

void Firing::set_frame(std::string name, double stamp) {
    if (!spec_.is_source()) throw StageFault("set_frame() is for sources: this stage has inputs");
    own_frame_.name = std::move(name);
    own_frame_.stamp = stamp;
}

void Firing::end_of_data() {
    if (!spec_.is_source()) throw StageFault("end_of_data() is for sources: this stage has inputs");
    ended_ = true;
}

Rng& Firing::rng() {
    if (!rng_) {
        const std::uint64_t parts[] = {services_.seed(), stable_hash(id_), frame().number};
        std::vector<std::uint32_t> words;
        for (const std::uint64_t part : parts) {
            words.push_back(static_cast<std::uint32_t>(part));
            words.push_back(static_cast<std::uint32_t>(part >> 32));
        }
        std::seed_seq sequence(words.begin(), words.end());
        rng_.emplace(sequence);
    }
    return *rng_;
}

void Firing::log(LogLevel level, const std::string& message) {
    services_.log(id_, level, message);
}

void Firing::note(const Note& note) {
    services_.note(id_, frame(), note);
}

void Firing::verdict(Level level, const std::vector<std::string>& reasons) {
    services_.verdict(id_, level, reasons);
}

void Firing::save(const std::string& name, const std::function<void(const fs::path&)>& writer) {
    const fs::path folder = services_.folder() / "stages" / id_ / as_folder(frame());
    write_whole(folder / relative_inside(folder, name), writer);
}

void Firing::output(const std::string& name, const std::function<void(const fs::path&)>& writer) {
    write_whole(output_path(name), writer);
}

fs::path Firing::output_path(const fs::path& name) {
    const fs::path relative = relative_inside(services_.folder(), name);
    services_.claim_product(id_, relative);
    return services_.folder() / relative;
}

const char* to_string(Level level) {
    switch (level) {
        case Level::usable:
            return "usable";
        case Level::weak:
            return "weak";
        case Level::not_usable:
            return "not_usable";
    }
    return "not_usable";
}

}  // namespace petal
