// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/truth.hpp"
#include "petal/run.hpp"

namespace petal {

class BoardEdges;

/// How many points there are of each kind.
struct KindCounts {
    std::size_t all = 0;
    std::array<std::size_t, 4> label{};  ///< by the values of Truth::labels
    std::size_t edge = 0;                ///< board points near an edge; they count as board too
};

/// The points before a filter, after it, and those before it that stayed.
struct LabelCounts {
    KindCounts before, after, kept;
    bool edges_known = true;  ///< false: there are board points, but the boards are not known

    void add(const LabelCounts& other);
};

/// Counts the points of one scene (`name`, for messages).
/// \throws Error where a cloud's points cannot be told apart by the labels: naming the port, what
/// was expected, and what to do.
LabelCounts count_labels(const Truth& truth, const Cloud& before, const Cloud& after,
                         const BoardEdges& edges, double edge_distance, const std::string& name,
                         Run& run);

/// The figures of `metric.labels`, for one scene or (empty name) in total. Shares of nothing are
/// left out.
std::vector<Metric> label_figures(const LabelCounts& counts, const std::string& scene);

}  // namespace petal
