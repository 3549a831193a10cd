// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "graph_check.hpp"

#include <algorithm>
#include <functional>
#include <queue>
#include <string>
#include <utility>

namespace petal {
namespace {

/// A wire, from the stage that writes to the one that reads.
struct Edge {
    std::size_t to;
    const DraftWire* wire;
};

std::vector<std::vector<Edge>> edges_by_writer(const Draft& draft) {
    std::vector<std::vector<Edge>> edges(draft.stages.size());
    for (std::size_t to = 0; to < draft.stages.size(); ++to)
        for (const DraftInput& input : draft.stages[to].inputs)
            for (const DraftWire& wire : input.wires) edges[wire.from].push_back({to, &wire});
    return edges;
}

void tell_cycles(const Draft& draft, ProblemList& problems) {
    for (const auto& cycle : find_cycles(draft)) {
        std::string text;
        for (const DraftWire* wire : cycle) text += printable(draft.stages[wire->from].id) + " -> ";
        text += printable(draft.stages[cycle.front()->from].id);
        const DraftWire& closing = *cycle.back();
        problems.add(closing.origin, closing.path,
                     "cycle: " + text + "; expected wires that lead from sources to sinks only");
    }
}

bool has_source(const Draft& draft) {
    return std::any_of(draft.stages.begin(), draft.stages.end(), [](const DraftStage& stage) {
        return stage.spec && stage.spec->is_source();
    });
}

/// A stage of optional inputs only, none of them wired, would never fire.
void tell_idle_stages(const Draft& draft, ProblemList& problems) {
    for (const DraftStage& stage : draft.stages) {
        if (!stage.spec || stage.spec->is_source() || !stage.inputs_known || !stage.inputs.empty())
            continue;
        std::vector<std::string> names;
        for (const PortSpec& port : stage.spec->inputs) names.push_back(port.name);
        problems.add(stage.origin, path_join(path_join("stages", stage.id), "in"),
                     "no input of '" + printable(stage.id) + "' is wired, so it would never fire" +
                         expected_one_of("", names));
    }
}

}  // namespace

std::vector<std::vector<const DraftWire*>> find_cycles(const Draft& draft) {
    enum class Mark { fresh, open, done };
    const auto edges = edges_by_writer(draft);
    std::vector<Mark> marks(draft.stages.size(), Mark::fresh);
    std::vector<std::vector<const DraftWire*>> cycles;
    struct Step {
        std::size_t stage;
        std::size_t next_edge;
    };
    // Depth first, without recursion: a pipeline may be a chain of any length.
    for (std::size_t start = 0; start < draft.stages.size(); ++start) {
        if (marks[start] != Mark::fresh) continue;
        std::vector<Step> walk{{start, 0}};
        std::vector<const DraftWire*> wires;  // wires[i] leads from walk[i] to walk[i + 1]
        marks[start] = Mark::open;
        while (!walk.empty()) {
            Step& step = walk.back();
            if (step.next_edge == edges[step.stage].size()) {
                marks[step.stage] = Mark::done;
                walk.pop_back();
                if (!wires.empty()) wires.pop_back();
                continue;
            }
            const Edge& edge = edges[step.stage][step.next_edge++];
            if (marks[edge.to] == Mark::fresh) {
                marks[edge.to] = Mark::open;
                wires.push_back(edge.wire);
                walk.push_back({edge.to, 0});
            } else if (marks[edge.to] == Mark::open) {
                std::size_t at = 0;
                while (walk[at].stage != edge.to) ++at;
                const auto offset = static_cast<std::ptrdiff_t>(at);
                std::vector<const DraftWire*> cycle(wires.begin() + offset, wires.end());
                cycle.push_back(edge.wire);
                // The same cycle again over a second wire between the same stages tells nothing
                // new.
                const auto same = [&](const std::vector<const DraftWire*>& other) {
                    return std::equal(
                        other.begin(), other.end(), cycle.begin(), cycle.end(),
                        [](const DraftWire* a, const DraftWire* b) { return a->from == b->from; });
                };
                if (std::none_of(cycles.begin(), cycles.end(), same)) cycles.push_back(cycle);
            }
        }
    }
    return cycles;
}

std::vector<std::size_t> topological_order(const Draft& draft) {
    const auto edges = edges_by_writer(draft);
    std::vector<std::size_t> waiting_for(draft.stages.size(), 0);
    for (const auto& outgoing : edges)
        for (const Edge& edge : outgoing) ++waiting_for[edge.to];
    std::priority_queue<std::size_t, std::vector<std::size_t>, std::greater<>> ready;
    for (std::size_t i = 0; i < waiting_for.size(); ++i)
        if (waiting_for[i] == 0) ready.push(i);
    std::vector<std::size_t> order;
    while (!ready.empty()) {
        const std::size_t stage = ready.top();
        ready.pop();
        order.push_back(stage);
        for (const Edge& edge : edges[stage])
            if (--waiting_for[edge.to] == 0) ready.push(edge.to);
    }
    return order;
}

CheckedGraph check_graph(const Draft& draft, ProblemList& problems) {
    const std::size_t before = problems.size();
    CheckedGraph graph;
    graph.order = topological_order(draft);
    tell_cycles(draft, problems);
    tell_idle_stages(draft, problems);
    graph.once = check_rates(draft, graph.order, problems);
    const bool all_known =
        std::all_of(draft.stages.begin(), draft.stages.end(),
                    [](const DraftStage& stage) { return stage.spec && stage.inputs_known; });
    // Where a wire or a type is wrong, the source may be what is missing there: told already.
    if (all_known && problems.size() == before && !draft.stages.empty() && !has_source(draft))
        problems.add(draft.stages.front().origin, "stages",
                     "no source; expected a stage without inputs that emits the frames");
    return graph;
}

}  // namespace petal
