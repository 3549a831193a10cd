// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <tbb/task_arena.h>

#include <chrono>
#include <optional>
#include <utility>

#include "plain_message.hpp"
#include "scheduler.hpp"

namespace petal {

namespace {

std::string frame_text(const FrameInfo& frame) {
    return "frame " + std::to_string(frame.number) +
           (frame.name.empty() ? "" : " '" + frame.name + "'");
}

}  // namespace

Scheduler::Outcome Scheduler::fire(Job& job) {
    RunNode& node = *job.node;
    Taping& taping = tapings_[node.index()];
    if (taping.play != nullptr) return play(taping);
    const bool once = node.definition().once;
    Outcome outcome;
    auto frame = node.frame_of(job.inputs);
    std::optional<TapingServices> taped;
    if (taping.fill != nullptr) taped.emplace(recorder_, *taping.fill);
    RunServices& services = taped ? static_cast<RunServices&>(*taped) : recorder_;
    Firing firing(node.spec(), node.definition().id, std::move(frame), once ? 0 : node.fired(),
                  std::move(job.inputs), services);
    const auto start = std::chrono::steady_clock::now();
    fire_stage(job, firing, outcome);
    outcome.wall_s = seconds_since(start);
    outcome.source_ended = firing.ended();
    if (!outcome.failure.empty() && job.work == RunNode::Work::run && !once)
        outcome.where = frame_text(firing.frame());
    if (taped && outcome.failure.empty() && !outcome.cancelled) {
        taped->add_entry(outcome.outputs, outcome.source_ended);
        taping.fill->whole = job.work == RunNode::Work::finish;
    }
    return outcome;
}

void Scheduler::fire_stage(Job& job, Firing& firing, Outcome& outcome) const {
    RunNode& node = *job.node;
    try {
        // A stage that waits for tasks of its own must not be given another stage meanwhile.
        tbb::this_task_arena::isolate([&] {
            if (job.work == RunNode::Work::run) {
                node.stage().run(firing);
            } else {
                node.stage().finish(firing);
            }
        });
        if (job.work == RunNode::Work::run || node.gathers()) {
            outcome.outputs = firing.take_outputs();
        } else {
            firing.expect_no_outputs();
        }
    } catch (const Cancelled&) {
        outcome.cancelled = true;
    } catch (const WriteError& thrown) {
        outcome.failure = plain_message(thrown.what());
        outcome.write_failed = true;
    } catch (const std::exception& thrown) {
        outcome.failure = plain_message(thrown.what());
    } catch (...) {
        outcome.failure = "threw something that is no std::exception";
    }
}

Scheduler::Outcome Scheduler::play(Taping& taping) {
    Outcome outcome;
    if (taping.next >= taping.play->firings.size()) {
        outcome.failure = "has more to do than its tape: a fault of the runner";
        return outcome;
    }
    const FiringTape::Entry& entry = taping.play->firings[taping.next++];
    for (const auto& tell : entry.told) tell(recorder_);
    outcome.outputs = entry.outputs;
    outcome.source_ended = entry.source_ended;
    return outcome;
}

}  // namespace petal
