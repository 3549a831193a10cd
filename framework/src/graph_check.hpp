// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <vector>

#include "draft.hpp"

namespace petal {

/// What is known of a graph without faults.
struct CheckedGraph {
    std::vector<std::size_t> order;  ///< stage numbers, every wire leading forward; ties by id
    std::vector<bool> once;          ///< by stage number: fires once, after the last frame
};

/// Checks the wired stages as a graph: a source, no cycle, no two rates on one stage's inputs. Both
/// are complete only where no problem was added. \param draft after check_wires().
CheckedGraph check_graph(const Draft& draft, ProblemList& problems);

/// Each cycle's wires in the direction of the data; a graph of overlapping cycles gives one cycle
/// for each wire that closes one, as a walk by id meets them.
std::vector<std::vector<const DraftWire*>> find_cycles(const Draft& draft);

/// Stage numbers so that every wire leads forward, ties by number; those behind a cycle are left
/// out.
std::vector<std::size_t> topological_order(const Draft& draft);

/// Rates (see petal/stage.hpp): whether each stage fires once, after the last frame. Stages whose
/// rate cannot be known, for faults told already, count as frame stages and give no problems.
std::vector<bool> check_rates(const Draft& draft, const std::vector<std::size_t>& order,
                              ProblemList& problems);

}  // namespace petal
