// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "run_node.hpp"

#include <utility>

#include "petal/error.hpp"

namespace petal {

RunNode::RunNode(const StageNode& definition)
    : definition_(definition),
      stage_(definition.spec->make_stage(definition.params.get())),
      gathers_(definition.spec->gathers()) {
    for (const auto& [port, wires] : definition.inputs) wires_[port].resize(wires.size());
}

bool RunNode::gathered_all() const {
    for (const auto& [port, wires] : wires_)
        for (const WireState& wire : wires)
            if (!wire.ended) return false;
    return true;
}

RunNode::Work RunNode::next_work() const {
    if (busy || finished_) return Work::none;
    if (is_source()) return source_ended_ ? Work::finish : Work::run;
    if (gathers_) return gathered_all() ? Work::finish : Work::none;

    check_lengths();
    bool ready = true;
    for (const auto& [port, wires] : wires_)
        if (wires.front().waiting.count(fired_) == 0) ready = false;
    if (ready) return Work::run;
    for (const auto& [port, wires] : wires_)
        if (!wires.front().ended || *wires.front().ended != fired_) return Work::none;
    return Work::finish;
}

void RunNode::check_lengths() const {
    const auto source_of = [this](const std::string& port) {
        const Wire& wire = definition_.inputs.at(port).front();
        return wire.stage + "." + wire.port;
    };
    for (const auto& [port, wires] : wires_) {
        const WireState& wire = wires.front();
        if (!wire.ended) continue;
        for (const auto& [other_port, other_wires] : wires_) {
            const WireState& other = other_wires.front();
            const bool goes_on = other.waiting.lower_bound(*wire.ended) != other.waiting.end() ||
                                 other.ended.value_or(0) > *wire.ended;
            if (!goes_on) continue;
            throw Error(
                "wires that meet here have different numbers of frames: " + source_of(port) +
                " ended after " + std::to_string(*wire.ended) + ", " + source_of(other_port) +
                " goes on; frames meet by number, so the sources must emit equally many");
        }
    }
}

PortPackets RunNode::take_inputs(Work work) {
    PortPackets packets;
    if (work == Work::finish && !gathers_) return packets;
    for (auto& [port, wires] : wires_) {
        std::vector<AnyPacket>& list = packets[port];
        for (WireState& wire : wires) {
            if (gathers_) {
                for (auto& [frame, packet] : wire.waiting) list.push_back(std::move(packet));
                wire.waiting.clear();
            } else {
                auto next = wire.waiting.extract(fired_);
                list.push_back(std::move(next.mapped()));
            }
        }
    }
    return packets;
}

FrameInfo RunNode::next_frame(const PortPackets& inputs) const {
    if (definition_.once) return FrameInfo{};
    for (const auto& [port, packets] : inputs)
        if (!packets.empty()) return packets.front().frame;
    FrameInfo frame;
    frame.number = fired_;
    return frame;
}

void RunNode::deliver(const std::string& port, std::size_t wire, AnyPacket packet) {
    const std::uint64_t number = packet.frame.number;
    wires_.at(port).at(wire).waiting.emplace(number, std::move(packet));
}

void RunNode::wire_ended(const std::string& port, std::size_t wire, std::uint64_t frames) {
    wires_.at(port).at(wire).ended = frames;
}

}  // namespace petal
