// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "run_node.hpp"

#include <utility>

#include "petal/error.hpp"

namespace petal {

namespace {

std::size_t index_of(const std::vector<PortSpec>& ports, const std::string& name) {
    for (std::size_t i = 0; i < ports.size(); ++i)
        if (ports[i].name == name) return i;
    throw Error("no port '" + name + "': a fault of the pipeline check");
}

}  // namespace

RunNode::RunNode(const StageNode& definition, std::size_t index)
    : definition_(definition),
      index_(index),
      stage_(definition.spec->make_stage(definition.params.get())),
      ports_(definition.spec->inputs.size()),
      consumers_(definition.spec->outputs.size()),
      gathers_(definition.spec->gathers()) {
    for (const auto& [port, wires] : definition.inputs)
        ports_[index_of(spec().inputs, port)].resize(wires.size());
    if (!definition.inputs.empty())
        first_port_ = index_of(spec().inputs, definition.inputs.begin()->first);
}

void RunNode::connect(const std::string& port, RunNode& reader, const std::string& reader_port,
                      std::size_t wire) {
    consumers_[index_of(spec().outputs, port)].push_back(
        {&reader, index_of(reader.spec().inputs, reader_port), wire});
}

bool RunNode::gathered_all() const {
    for (const PortWires& wires : ports_)
        for (const WireState& wire : wires)
            if (!wire.ended) return false;
    return true;
}

RunNode::Work RunNode::next_work() const {
    if (busy || finished_) return Work::none;
    if (is_source()) return source_ended_ ? Work::finish : Work::run;
    if (gathers_) return gathered_all() ? Work::finish : Work::none;

    bool ready = true;
    bool some_ended = false;
    bool all_ended = true;
    for (const PortWires& wires : ports_) {
        if (wires.empty()) continue;
        const WireState& wire = wires.front();
        if (wire.waiting.empty()) ready = false;
        if (wire.ended) some_ended = true;
        if (!wire.ended || *wire.ended != fired_) all_ended = false;
    }
    if (some_ended) check_lengths();
    if (ready) return Work::run;
    return all_ended ? Work::finish : Work::none;
}

void RunNode::check_lengths() const {
    const auto source_of = [this](std::size_t port) {
        const Wire& wire = definition_.inputs.at(spec().inputs[port].name).front();
        return wire.stage + "." + wire.port;
    };
    for (std::size_t i = 0; i < ports_.size(); ++i) {
        if (ports_[i].empty() || !ports_[i].front().ended) continue;
        const std::uint64_t ended = *ports_[i].front().ended;
        for (std::size_t k = 0; k < ports_.size(); ++k) {
            if (ports_[k].empty()) continue;
            const WireState& other = ports_[k].front();
            const bool goes_on =
                fired_ + other.waiting.size() > ended || other.ended.value_or(0) > ended;
            if (!goes_on) continue;
            throw Error("wires that meet here have different numbers of frames: " + source_of(i) +
                        " ended after " + std::to_string(ended) + ", " + source_of(k) +
                        " goes on; frames meet by number, so the sources must emit equally many");
        }
    }
}

PortPackets RunNode::take_inputs(Work work) {
    PortPackets inputs(ports_.size());
    if (work == Work::finish && !gathers_) return inputs;
    for (std::size_t i = 0; i < ports_.size(); ++i) {
        inputs[i].wired = !ports_[i].empty();
        std::vector<AnyPacket>& list = inputs[i].packets;
        for (WireState& wire : ports_[i]) {
            if (gathers_) {
                for (AnyPacket& packet : wire.waiting) list.push_back(std::move(packet));
                wire.waiting.clear();
            } else {
                list.push_back(std::move(wire.waiting.front()));
                wire.waiting.pop_front();
            }
        }
    }
    return inputs;
}

std::shared_ptr<const FrameInfo> RunNode::frame_of(const PortPackets& inputs) const {
    if (definition_.once || inputs.empty() || inputs[first_port_].packets.empty()) return nullptr;
    return inputs[first_port_].packets.front().frame;
}

void RunNode::deliver(const Consumer& to, AnyPacket packet) {
    ports_[to.port][to.wire].waiting.push_back(std::move(packet));
}

void RunNode::wire_ended(const Consumer& to, std::uint64_t frames) {
    ports_[to.port][to.wire].ended = frames;
}

}  // namespace petal
