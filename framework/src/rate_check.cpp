// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <string>

#include "graph_check.hpp"

namespace petal {
namespace {

enum class Rate { unknown, frame, once };

class RateCheck {
   public:
    RateCheck(const Draft& draft, ProblemList& problems)
        : draft_(draft), problems_(problems), rates_(draft.stages.size(), Rate::unknown) {}

    void check(std::size_t number) {
        const DraftStage& stage = draft_.stages[number];
        if (!stage.spec) return;
        if (stage.spec->is_source()) {
            rates_[number] = Rate::frame;
        } else if (stage.spec->gathers()) {
            rates_[number] = Rate::once;
            check_gatherer(stage);
        } else {
            rates_[number] = common_rate(stage);
        }
    }

    std::vector<bool> fire_once() const {
        std::vector<bool> once;
        for (const Rate rate : rates_) once.push_back(rate == Rate::once);
        return once;
    }

   private:
    /// Beside its gathering ports such a stage can read only what is there once, at the end.
    void check_gatherer(const DraftStage& stage) {
        for (const DraftInput& input : stage.inputs) {
            if (!input.port || input.port->gathers) continue;
            for (const DraftWire& wire : input.wires) {
                if (rates_[wire.from] != Rate::frame) continue;
                problems_.add(wire.origin, wire.path,
                              "two rates: '" + printable(stage.id) +
                                  "' gathers and fires once, after the " + "last frame, but '" +
                                  printable(wire.stage) + "." + wire.port +
                                  "' brings a packet for each frame; expected a once wire on '" +
                                  input.name + "'");
            }
        }
    }

    Rate common_rate(const DraftStage& stage) {
        const DraftWire* frame = nullptr;
        const DraftWire* once = nullptr;
        bool known = stage.inputs_known;
        for (const DraftInput& input : stage.inputs) {
            for (const DraftWire& wire : input.wires) {
                const Rate rate = rates_[wire.from];
                known = known && rate != Rate::unknown;
                if (rate == Rate::frame && !frame) frame = &wire;
                if (rate == Rate::once && !once) once = &wire;
            }
        }
        if (frame && once) {
            problems_.add(once->origin, once->path,
                          "two rates: '" + printable(once->stage) + "." + once->port +
                              "' fires once, after the last frame, but '" +
                              printable(frame->stage) + "." + frame->port + "' (" + frame->path +
                              ") brings a packet for each frame; expected one rate on the inputs " +
                              "of '" + printable(stage.id) + "'");
            return Rate::unknown;
        }
        if (!known) return Rate::unknown;
        return once ? Rate::once : Rate::frame;
    }

    const Draft& draft_;
    ProblemList& problems_;
    std::vector<Rate> rates_;
};

}  // namespace

std::vector<bool> check_rates(const Draft& draft, const std::vector<std::size_t>& order,
                              ProblemList& problems) {
    RateCheck check(draft, problems);
    for (const std::size_t number : order) check.check(number);
    return check.fire_once();
}

}  // namespace petal
