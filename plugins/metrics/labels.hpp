// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "metrics/detail/board_edges.hpp"
#include "metrics/detail/label_counts.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct LabelsMetricParams {
    double edge_distance = 0.012;
    std::vector<std::filesystem::path> targets;
};

/// `metric.labels`: what a filter took and left of each kind of point.
class LabelsMetric final : public Stage {
   public:
    using Params = LabelsMetricParams;
    static void describe(Spec<Params>& s);
    explicit LabelsMetric(Params params)
        : edge_distance_(params.edge_distance), targets_(std::move(params.targets)) {}
    void run(Run& run) override;
    void finish(Run& run) override;

   private:
    double edge_distance_;
    TargetsByName targets_;
    LabelCounts total_;
    std::size_t scenes_ = 0;
    std::vector<std::string> without_labels_;  ///< names of scenes
    std::vector<std::string> without_boards_;
};

}  // namespace petal
