// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "metrics/detail/board_edges.hpp"
#include "metrics/detail/board_shape.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct BoardCheckParams {
    double sigmas = 3.0;
    double max_bow = 0.005;
    double max_flatness = 0.003;
    double max_pitch_error = 0.015;
    double max_size_error = 0.015;
    std::vector<std::filesystem::path> targets = {"four_square_holes_500mm"};
};

/// `metric.board_check`: whether the boards are what their target file says.
class BoardCheck final : public Stage {
   public:
    using Params = BoardCheckParams;
    static void describe(Spec<Params>& s);
    explicit BoardCheck(Params params) : p_(std::move(params)), targets_(p_.targets) {}
    void run(Run& run) override;

   private:
    void judge(const BoardShape& shape, const Target& target, const std::string& who,
               Metrics& metrics) const;
    void look_for_others(Run& run, Metrics& metrics) const;
    /// Beyond `limit`, and beyond the sigmas.
    bool beyond(const Measured& measured, double expected, double limit) const;

    Params p_;
    TargetsByName targets_;
};

}  // namespace petal
