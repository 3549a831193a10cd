// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scheduler.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <utility>

namespace petal {

namespace {

/// What it costs to wake another thread for a firing, roughly. Shorter ones are not handed over.
constexpr double kHandOver = 5e-6;  // s

}  // namespace

Scheduler::Scheduler(const Pipeline& pipeline, const RunSettings& settings, RunRecorder& recorder)
    : recorder_(recorder),
      threads_(settings.threads),
      frames_in_flight_(static_cast<std::uint64_t>(settings.threads) + 2) {
    for (const StageNode& stage : pipeline.stages) {
        try {
            nodes_.emplace_back(stage, nodes_.size());
        } catch (const std::exception& failure) {
            fail(stage, "while it was made", failure.what());
        } catch (...) {
            fail(stage, "while it was made", "threw something that is no std::exception");
        }
    }
    find_tapes(settings);
    if (failures_.empty()) connect_nodes();
}

void Scheduler::find_tapes(const RunSettings& settings) {
    for (const RunNode& node : nodes_) {
        Taping taping;
        const std::string& id = node.definition().id;
        if (const auto found = settings.played.find(id); found != settings.played.end())
            taping.play = found->second;
        if (const auto found = settings.taped.find(id); found != settings.taped.end())
            taping.fill = found->second;
        tapings_.push_back(taping);
    }
}

void Scheduler::connect_nodes() {
    std::map<std::string, RunNode*> by_id;
    for (RunNode& node : nodes_) by_id[node.definition().id] = &node;
    for (RunNode& node : nodes_)
        for (const auto& [port, wires] : node.definition().inputs)
            for (std::size_t i = 0; i < wires.size(); ++i)
                by_id.at(wires[i].stage)->connect(wires[i].port, node, port, i);
    followers_.resize(nodes_.size());
    for (RunNode& node : nodes_)
        if (node.is_source()) {
            sources_.push_back(&node);
            find_followers(node);
        }
}

void Scheduler::find_followers(RunNode& source) {
    std::vector<const RunNode*>& followers = followers_[source.index()];
    std::vector<const RunNode*> open{&source};
    while (!open.empty()) {
        const RunNode* node = open.back();
        open.pop_back();
        for (const auto& consumers : node->consumers())
            for (const RunNode::Consumer& consumer : consumers) {
                if (consumer.node->gathers() ||
                    std::count(followers.begin(), followers.end(), consumer.node) > 0)
                    continue;
                followers.push_back(consumer.node);
                open.push_back(consumer.node);
            }
    }
}

/// The frames of a source that all its followers have worked on. Stages of other sources do not
/// count: they may have fewer frames.
std::uint64_t Scheduler::frames_done(const RunNode& source) const {
    std::uint64_t slowest = source.fired();
    for (const RunNode* node : followers_[source.index()])
        slowest = std::min(slowest, node->fired());
    return slowest;
}

bool Scheduler::may_emit(const RunNode& source) const {
    return source.fired() - frames_done(source) < frames_in_flight_;
}

void Scheduler::run() {
    if (!failures_.empty()) return;
    tbb::task_arena arena(threads_);
    arena.execute([this] {
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            for (RunNode& node : nodes_) schedule(node);
            workers_ = 1;
        }
        tasks_.run([this] { work(); });
        tasks_.wait();
    });
}

void Scheduler::fail(const StageNode& stage, const std::string& where, const std::string& what) {
    failures_.push_back(stage.id + " (" + stage.spec->type + ")" +
                        (where.empty() ? "" : ", " + where) + ": " + what);
}

/// Puts the node into the list where it has work.
void Scheduler::schedule(RunNode& node) {
    if (node.busy || !failures_.empty() || cancelled_) return;
    if (recorder_.cancelled()) {
        cancelled_ = true;
        return;
    }
    try {
        const RunNode::Work work = node.next_work();
        if (work == RunNode::Work::none) return;
        if (work == RunNode::Work::run && node.is_source() && !may_emit(node)) return;
        node.busy = true;
        ready_.push_back({&node, work});
    } catch (const std::exception& failure) {
        fail(node.definition(), "", failure.what());
    }
}

std::optional<Scheduler::Job> Scheduler::take_job() {
    if (ready_.empty() || !failures_.empty() || cancelled_) return std::nullopt;
    const Ready ready = ready_.back();
    ready_.pop_back();
    RunNode& node = *ready.node;
    node.firing = true;
    const bool short_one = ready.work == RunNode::Work::run && node.cost_s() < kHandOver;
    if (!ready_.empty() && workers_ < threads_ && !short_one) {
        ++workers_;
        tasks_.run([this] { work(); });
    }
    return Job{&node, ready.work, node.take_inputs(ready.work)};
}

void Scheduler::work() {
    Outcome outcome;  // outside the loop: what nobody takes of it is freed outside the lock
    std::unique_lock<std::mutex> lock(mutex_);
    FiringClock clock(nodes_.size());
    while (auto job = take_job()) {
        lock.unlock();
        outcome = fire(*job);
        clock.add(job->node->index(), outcome.wall_s);
        lock.lock();
        settle(*job->node, job->work, outcome);
    }
    --workers_;
    const auto& times = clock.times();
    for (RunNode& node : nodes_) {
        node.statistics().wall_s += times[node.index()].wall_s;
        node.statistics().cpu_s += times[node.index()].cpu_s;
    }
}

/// Hands on what a firing gave, and schedules whoever can work now.
void Scheduler::settle(RunNode& node, RunNode::Work work, Outcome& outcome) {
    node.busy = false;
    node.firing = false;
    node.took(outcome.wall_s);
    if (outcome.cancelled) {
        cancelled_ = true;
        return;
    }
    if (!outcome.failure.empty()) {
        fail(node.definition(), outcome.where, outcome.failure);
        write_failed_ = write_failed_ || outcome.write_failed;
        return;
    }
    if (node.gathers() || (work == RunNode::Work::run && !outcome.source_ended))
        ++node.statistics().firings;
    deliver(node, outcome.outputs);
    if (outcome.source_ended) {
        node.source_ended();
    } else if (work == RunNode::Work::run) {
        node.ran();
    } else {
        node.finished();
        end_wires(node);
    }
    // Sources first, readers last: the list is worked on from its end.
    for (RunNode* source : sources_)
        if (source != &node) schedule(*source);
    schedule(node);
    for (const auto& consumers : node.consumers())
        for (const RunNode::Consumer& consumer : consumers) schedule(*consumer.node);
}

void Scheduler::deliver(RunNode& node, OutputPackets& outputs) {
    for (std::size_t port = 0; port < outputs.size(); ++port) {
        AnyPacket& packet = outputs[port];
        ++node.statistics().packets;
        node.statistics().bytes += packet.bytes;
        const auto& consumers = node.consumers()[port];
        for (std::size_t i = 0; i + 1 < consumers.size(); ++i)
            consumers[i].node->deliver(consumers[i], packet);
        if (!consumers.empty()) consumers.back().node->deliver(consumers.back(), std::move(packet));
    }
}

void Scheduler::end_wires(RunNode& node) {
    // A gathering stage writes its one packet in finish().
    const std::uint64_t frames = node.gathers() ? 1 : node.fired();
    for (const auto& consumers : node.consumers())
        for (const RunNode::Consumer& consumer : consumers)
            consumer.node->wire_ended(consumer, frames);
}

RunProgress Scheduler::progress() {
    const std::lock_guard<std::mutex> lock(mutex_);
    RunProgress progress;
    for (const RunNode& node : nodes_)
        if (node.firing) progress.at_work.push_back(node.definition().id);
    for (const RunNode* source : sources_) {
        if (source->fired() < progress.frames_emitted) continue;
        progress.frames_emitted = source->fired();
        progress.frames_done = frames_done(*source);
        progress.source = recorder_.progress_of(source->definition().id);
    }
    return progress;
}

void Scheduler::fill(RunReport& report) {
    const std::lock_guard<std::mutex> lock(mutex_);
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
    report.write_failed = write_failed_;
}

}  // namespace petal
