// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firing.hpp"
#include "petal/stage.hpp"
#include "pipeline.hpp"
#include "run_report.hpp"

namespace petal {

/// One stage of a run: its instance, the packets that wait for it, and when it may fire. Not
/// thread-safe: the scheduler guards it; only the stage instance itself is used outside the
/// scheduler's lock.
class RunNode {
   public:
    /// Where an output's packets go.
    struct Consumer {
        RunNode* node = nullptr;
        std::size_t port = 0;  ///< index in its declaration
        std::size_t wire = 0;  ///< index among the port's wires
    };

    /// `index`: the node's place among the run's.
    RunNode(const StageNode& definition, std::size_t index);

    const StageNode& definition() const { return definition_; }
    const StageSpec& spec() const { return *definition_.spec; }
    Stage& stage() { return *stage_; }
    StageStatistics& statistics() { return statistics_; }
    std::size_t index() const { return index_; }
    /// By output port, as declared.
    const std::vector<std::vector<Consumer>>& consumers() const { return consumers_; }
    /// Connects an output port of this node with what reads it. \pre both ports are declared.
    void connect(const std::string& port, RunNode& reader, const std::string& reader_port,
                 std::size_t wire);

    /// What the node can do next.
    enum class Work { none, run, finish };
    /// \throws Error when wires that meet here have different numbers of frames.
    Work next_work() const;
    /// The packets of the next firing, taken out of what waits.
    PortPackets take_inputs(Work work);
    /// The frame of these inputs; null for a source, and where the node fires once.
    std::shared_ptr<const FrameInfo> frame_of(const PortPackets& inputs) const;

    void deliver(const Consumer& to, AnyPacket packet);
    void wire_ended(const Consumer& to, std::uint64_t frames);
    void ran() { ++fired_; }
    void source_ended() { source_ended_ = true; }
    void finished() { finished_ = true; }

    std::uint64_t fired() const { return fired_; }
    bool has_finished() const { return finished_; }
    bool is_source() const { return spec().is_source(); }
    bool gathers() const { return gathers_; }

    /// A firing took so long.
    void took(double wall_s) { cost_s_ = std::max(wall_s, 0.75 * cost_s_); }
    /// What the next run() may take: the longest of the last ones, the older the less. At first as
    /// if long.
    double cost_s() const { return cost_s_; }

    bool busy = false;    ///< waits to fire, or fires
    bool firing = false;  ///< fires

   private:
    /// What has come over one wire and was not used yet. Packets come frame by frame, none is left
    /// out: the first that waits is that of frame fired_ (of frame 0 where the node gathers).
    struct WireState {
        std::deque<AnyPacket> waiting;
        std::optional<std::uint64_t> ended;  ///< after so many frames
    };
    /// The wires of one input port; none where it is not wired.
    using PortWires = std::vector<WireState>;

    bool gathered_all() const;
    /// \throws Error when one wire ended and another holds, or ended after, more frames. As early
    /// as that is known: a longer source would wait for ever for the frames of the shorter one.
    void check_lengths() const;

    const StageNode& definition_;
    std::size_t index_;
    std::unique_ptr<Stage> stage_;
    std::vector<PortWires> ports_;  ///< by input port, as declared
    std::size_t first_port_ = 0;    ///< the wired one whose packets name the frame
    std::vector<std::vector<Consumer>> consumers_;
    StageStatistics statistics_;
    double cost_s_ = 1.0;
    std::uint64_t fired_ = 0;
    bool gathers_ = false;
    bool source_ended_ = false;
    bool finished_ = false;
};

}  // namespace petal
