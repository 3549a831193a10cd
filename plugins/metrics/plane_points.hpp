// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "metrics/detail/board_edges.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/planes.hpp"
#include "petal/calibration/truth.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct PlanePointsMetricParams {
    double edge_angle_deg = 0.255;
    double surroundings = 0.05;
    std::vector<std::filesystem::path> targets;
};

/// `metric.plane_points`: what the filters and the plane stage leave for the board detector.
class PlanePointsMetric final : public Stage {
   public:
    using Params = PlanePointsMetricParams;
    static void describe(Spec<Params>& s);
    explicit PlanePointsMetric(Params params) : p_(params), targets_(std::move(p_.targets)) {}
    void run(Run& run) override;
    void finish(Run& run) override;

   private:
    struct Counts {
        std::size_t near_boards = 0;         ///< points of planes on and around boards
        std::array<std::size_t, 4> label{};  ///< of these, by the values of Truth::labels
        std::size_t edge = 0;                ///< board points near an edge
        std::size_t boards = 0, boards_without = 0;
        std::optional<std::size_t> least_side;  ///< board points at the poorest side of a hole
    };
    Counts count(const Truth& truth, const Planes& planes, const std::string& scene, Run& run);
    static void add_figures(const Counts& counts, const std::string& scene, Metrics& metrics);

    Params p_;
    TargetsByName targets_;
    Counts total_;
    std::vector<std::string> without_truth_;  ///< names of scenes
};

}  // namespace petal
