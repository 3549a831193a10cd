// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
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
        std::string port;
        std::size_t wire = 0;  ///< index among the port's wires
    };

    explicit RunNode(const StageNode& definition);

    const StageNode& definition() const { return definition_; }
    const StageSpec& spec() const { return *definition_.spec; }
    Stage& stage() { return *stage_; }
    StageStatistics& statistics() { return statistics_; }
    std::map<std::string, std::vector<Consumer>>& consumers() { return consumers_; }

    /// What the node can do next.
    enum class Work { none, run, finish };
    /// \throws Error when wires that meet here have different numbers of frames.
    Work next_work() const;
    /// The packets of the next firing, taken out of what waits.
    PortPackets take_inputs(Work work);
    FrameInfo next_frame(const PortPackets& inputs) const;

    void deliver(const std::string& port, std::size_t wire, AnyPacket packet);
    void wire_ended(const std::string& port, std::size_t wire, std::uint64_t frames);
    void ran() { ++fired_; }
    void source_ended() { source_ended_ = true; }
    void finished() { finished_ = true; }

    std::uint64_t fired() const { return fired_; }
    bool has_finished() const { return finished_; }
    bool is_source() const { return spec().is_source(); }
    bool gathers() const { return gathers_; }

    bool busy = false;  ///< a task holds the node

   private:
    /// What has come over one wire and was not used yet.
    struct WireState {
        std::map<std::uint64_t, AnyPacket> waiting;  ///< by frame
        std::optional<std::uint64_t> ended;          ///< after so many frames
    };

    bool gathered_all() const;
    /// \throws Error when one wire ended and another holds, or ended after, more frames. As early
    /// as that is known: a longer source would wait for ever for the frames of the shorter one.
    void check_lengths() const;

    const StageNode& definition_;
    std::unique_ptr<Stage> stage_;
    std::map<std::string, std::vector<WireState>> wires_;
    std::map<std::string, std::vector<Consumer>> consumers_;
    StageStatistics statistics_;
    std::uint64_t fired_ = 0;
    bool gathers_ = false;
    bool source_ended_ = false;
    bool finished_ = false;
};

}  // namespace petal
