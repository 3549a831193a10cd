// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "runner.hpp"

#include <sys/resource.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "plain_message.hpp"
#include "run_node.hpp"
#include "run_recorder.hpp"

namespace petal {

namespace {

double thread_cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double process_cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Decides who fires when. Every decision is taken under one lock; stages fire outside it.
class Scheduler {
   public:
    Scheduler(const Pipeline& pipeline, const RunSettings& settings, RunRecorder& recorder)
        : recorder_(recorder), frames_in_flight_(static_cast<std::uint64_t>(settings.threads) + 2) {
        std::map<std::string, RunNode*> by_id;
        for (const StageNode& stage : pipeline.stages) {
            try {
                nodes_.emplace_back(stage);
                by_id[stage.id] = &nodes_.back();
            } catch (const std::exception& failure) {
                fail(stage, "while it was made", failure.what());
            }
        }
        if (!failures_.empty()) return;
        for (RunNode& node : nodes_)
            for (const auto& [port, wires] : node.definition().inputs)
                for (std::size_t i = 0; i < wires.size(); ++i)
                    by_id.at(wires[i].stage)
                        ->consumers()[wires[i].port]
                        .push_back({&node, port, i});
        for (RunNode& node : nodes_)
            if (node.is_source()) find_followers(node);
    }

    void run(int threads) {
        if (!failures_.empty()) return;
        tbb::task_arena arena(threads);
        arena.execute([this] {
            {
                const std::lock_guard<std::mutex> lock(mutex_);
                for (RunNode& node : nodes_) schedule(node);
            }
            tasks_.wait();
        });
    }

    void fill(RunReport& report) {
        for (RunNode& node : nodes_) {
            report.stages[node.definition().id] = node.statistics();
            if (node.is_source()) report.frames = std::max(report.frames, node.fired());
        }
        if (failures_.empty() && !cancelled_)
            for (const RunNode& node : nodes_)
                if (!node.has_finished())
                    fail(node.definition(), "", "did not come to its end: a fault of the runner");
        report.status = !failures_.empty() ? RunStatus::failed
                        : cancelled_       ? RunStatus::cancelled
                                           : RunStatus::done;
        std::sort(failures_.begin(), failures_.end());
        report.errors = failures_;
    }

   private:
    void fail(const StageNode& stage, const std::string& where, const std::string& what) {
        failures_.push_back(stage.id + " (" + stage.spec->type + ")" +
                            (where.empty() ? "" : ", " + where) + ": " + what);
    }

    /// The stages that a source feeds frame by frame, directly or through others.
    void find_followers(RunNode& source) {
        std::vector<RunNode*> open{&source};
        std::set<const RunNode*>& followers = followers_[&source];
        while (!open.empty()) {
            RunNode* node = open.back();
            open.pop_back();
            for (const auto& [port, consumers] : node->consumers())
                for (const RunNode::Consumer& consumer : consumers)
                    if (!consumer.node->gathers() && followers.insert(consumer.node).second)
                        open.push_back(consumer.node);
        }
    }

    /// A source waits while the slowest stage that it feeds is too many frames behind. Stages of
    /// other sources do not count: they may have fewer frames.
    bool may_emit(const RunNode& source) const {
        std::uint64_t slowest = source.fired();
        for (const RunNode* node : followers_.at(&source))
            slowest = std::min(slowest, node->fired());
        return source.fired() - slowest < frames_in_flight_;
    }

    /// Starts a task for the node where it has work. Under the lock.
    void schedule(RunNode& node) {
        if (!failures_.empty() || cancelled_) return;
        if (recorder_.cancelled()) {
            cancelled_ = true;
            return;
        }
        RunNode::Work work = RunNode::Work::none;
        try {
            work = node.next_work();
            if (work == RunNode::Work::none) return;
            if (work == RunNode::Work::run && node.is_source() && !may_emit(node)) return;
        } catch (const std::exception& failure) {
            fail(node.definition(), "", failure.what());
            return;
        }
        node.busy = true;
        tasks_.run([this, &node, work] { fire(node, work); });
    }

    void fire(RunNode& node, RunNode::Work work) {
        std::unique_lock<std::mutex> lock(mutex_);
        PortPackets inputs = node.take_inputs(work);
        const FrameInfo frame = node.next_frame(inputs);
        lock.unlock();

        Firing firing(node.spec(), node.definition().id, frame, std::move(inputs), recorder_);
        std::map<std::string, AnyPacket> outputs;
        std::string failure;
        bool stopped = false;
        const auto start = std::chrono::steady_clock::now();
        const double cpu_start = thread_cpu_seconds();
        try {
            if (work == RunNode::Work::run) {
                node.stage().run(firing);
            } else {
                node.stage().finish(firing);
            }
            if (work == RunNode::Work::run || node.gathers()) {
                outputs = firing.take_outputs();
            } else {
                firing.expect_no_outputs();
            }
        } catch (const Cancelled&) {
            stopped = true;
        } catch (const std::exception& thrown) {
            failure = plain_message(thrown.what());
        } catch (...) {
            failure = "threw something that is no std::exception";
        }
        const double wall = seconds_since(start);
        const double cpu = thread_cpu_seconds() - cpu_start;

        lock.lock();
        node.busy = false;
        StageStatistics& statistics = node.statistics();
        statistics.wall_s += wall;
        statistics.cpu_s += cpu;
        if (stopped) {
            cancelled_ = true;
        } else if (!failure.empty()) {
            fail(node.definition(), where(node, firing, work), failure);
        } else {
            done(node, work, firing.ended(), std::move(outputs));
        }
    }

    static std::string where(const RunNode& node, const Firing& firing, RunNode::Work work) {
        if (work == RunNode::Work::finish || node.definition().once) return "";
        const FrameInfo& frame = firing.frame();
        return "frame " + std::to_string(frame.number) +
               (frame.name.empty() ? "" : " '" + frame.name + "'");
    }

    /// Hands on what a firing gave, and starts whoever can work now. Under the lock.
    void done(RunNode& node, RunNode::Work work, bool source_ended,
              std::map<std::string, AnyPacket> outputs) {
        StageStatistics& statistics = node.statistics();
        if (node.gathers() || (work == RunNode::Work::run && !source_ended)) ++statistics.firings;
        for (auto& [port, packet] : outputs) {
            ++statistics.packets;
            statistics.bytes += packet.bytes;
            for (const RunNode::Consumer& consumer : node.consumers()[port])
                consumer.node->deliver(consumer.port, consumer.wire, packet);
        }
        if (source_ended) {
            node.source_ended();
        } else if (work == RunNode::Work::run) {
            node.ran();
        } else {
            node.finished();
            // A gathering stage writes its one packet in finish().
            const std::uint64_t frames = node.gathers() ? 1 : node.fired();
            for (const auto& [port, consumers] : node.consumers())
                for (const RunNode::Consumer& consumer : consumers)
                    consumer.node->wire_ended(consumer.port, consumer.wire, frames);
        }
        for (const auto& [port, consumers] : node.consumers())
            for (const RunNode::Consumer& consumer : consumers) schedule(*consumer.node);
        schedule(node);
        for (RunNode& other : nodes_)
            if (other.is_source() && &other != &node) schedule(other);
    }

    RunRecorder& recorder_;
    std::uint64_t frames_in_flight_;
    std::deque<RunNode> nodes_;  // in topological order; a deque keeps their addresses
    std::mutex mutex_;
    tbb::task_group tasks_;
    std::map<const RunNode*, std::set<const RunNode*>> followers_;  // of each source
    std::vector<std::string> failures_;
    bool cancelled_ = false;
};

}  // namespace

RunReport run_pipeline(const Pipeline& pipeline, const RunSettings& settings, RunLog& log) {
    const auto start = std::chrono::steady_clock::now();
    const double cpu_start = process_cpu_seconds();
    // Caps whatever uses oneTBB inside a stage too.
    const tbb::global_control cap(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(settings.threads));
    // After the cap: a pool told first would warn about it.
    for (const auto& limit : settings.thread_limits) limit(settings.threads);
    RunRecorder recorder(settings, pipeline.seed, log);
    RunReport report;
    report.threads = settings.threads;
    {
        Scheduler scheduler(pipeline, settings, recorder);
        scheduler.run(settings.threads);
        scheduler.fill(report);
    }
    recorder.fill(report, pipeline);
    report.wall_s = seconds_since(start);
    report.cpu_s = process_cpu_seconds() - cpu_start;
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    report.peak_memory_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    return report;
}

}  // namespace petal
