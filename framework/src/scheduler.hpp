// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <tbb/task_group.h>

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "firing_clock.hpp"
#include "firing_tape.hpp"
#include "run_node.hpp"
#include "run_progress.hpp"
#include "run_recorder.hpp"
#include "run_report.hpp"
#include "runner.hpp"

namespace petal {

/// Decides who fires when. Every decision is taken under one lock; stages fire outside it.
///
/// What can fire waits in one list, the stages nearest to the end of the graph first, so that
/// packets live short. Workers (at most as many as threads) take from it until it is empty: a chain
/// runs through in one worker without a task for each firing. A worker calls another one when there
/// is more to do and its own next firing may take longer than the handing over.
class Scheduler {
   public:
    /// Makes every stage; one that cannot be made is a failure of the run.
    Scheduler(const Pipeline& pipeline, const RunSettings& settings, RunRecorder& recorder);

    /// Fires all there is to fire. Call it once.
    void run();

    /// From any thread, while run() is at work.
    RunProgress progress();

    /// Status, failures and figures. After run().
    void fill(RunReport& report);

   private:
    /// A firing to come: a node and its inputs.
    struct Job {
        RunNode* node = nullptr;
        RunNode::Work work = RunNode::Work::none;
        PortPackets inputs;
    };
    /// What became of it.
    struct Outcome {
        OutputPackets outputs;
        std::string failure;  ///< empty: none
        std::string where;    ///< the frame, for the message
        bool cancelled = false;
        bool source_ended = false;
        bool write_failed = false;
        double wall_s = 0.0;
    };
    /// Where a stage's tape is, if there is one.
    struct Taping {
        const FiringTape* play = nullptr;
        std::size_t next = 0;  ///< of the firings to play
        FiringTape* fill = nullptr;
    };
    struct Ready {
        RunNode* node = nullptr;
        RunNode::Work work = RunNode::Work::none;
    };

    void connect_nodes();
    void find_tapes(const RunSettings& settings);
    void find_followers(RunNode& source);
    bool may_emit(const RunNode& source) const;

    /// A worker: takes jobs until none is left.
    void work();
    Outcome fire(Job& job);
    /// Fires the stage itself.
    void fire_stage(Job& job, Firing& firing, Outcome& outcome) const;
    /// Gives what a tape has instead.
    Outcome play(Taping& taping);

    // Under the lock:
    void fail(const StageNode& stage, const std::string& where, const std::string& what);
    void schedule(RunNode& node);
    std::optional<Job> take_job();
    void settle(RunNode& node, RunNode::Work work, Outcome& outcome);
    void deliver(RunNode& node, OutputPackets& outputs);
    void end_wires(RunNode& node);
    std::uint64_t frames_done(const RunNode& source) const;

    RunRecorder& recorder_;
    int threads_;
    std::uint64_t frames_in_flight_;
    std::deque<RunNode> nodes_;  // in topological order; a deque keeps their addresses
    /// Of each source, by its index: the stages that it feeds frame by frame, also through others.
    std::vector<std::vector<const RunNode*>> followers_;
    std::vector<RunNode*> sources_;
    std::vector<Taping> tapings_;  ///< by node
    std::mutex mutex_;
    std::vector<Ready> ready_;  // the last one goes first
    int workers_ = 0;
    tbb::task_group tasks_;
    std::vector<std::string> failures_;
    bool cancelled_ = false;
    bool write_failed_ = false;
};

}  // namespace petal
