// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/joint_focal.hpp"

#include <cmath>

#include "petal/printed.hpp"

namespace petal {
namespace {

constexpr double kSeenFocal = 0.02;    // 1 sigma of a focal length that boards tell from distance
constexpr double kSurelyOther = 3.0;   // sigmas from which a focal length is another one
constexpr double kFarFromGiven = 2.0;  // and in units of how well the given one is known

}  // namespace

Diagnosis::FocalScale best_focal(const JointModel& model, const JointOptions& options,
                                 const JointSolution& solution, const JointUncertainty& uncertainty,
                                 std::size_t camera) {
    const Diagnosis::FocalScale step = uncertainty.focal(camera);
    if (step.estimated || !(step.sigma < kSeenFocal)) return step;
    JointOptions freed = options;
    freed.free_focal.resize(model.cameras.size(), false);
    freed.free_focal[camera] = true;
    const auto solved = solve_joint(model, freed, solution.state);
    if (!solved) return step;
    Diagnosis::FocalScale focal = JointUncertainty(model, freed, *solved).focal(camera);
    focal.estimated = false;
    return focal;
}

std::optional<std::string> focal_doubt(const Diagnosis::FocalScale& focal, double given_sigma) {
    const double off = std::abs(focal.scale - 1.0);
    if (!(off > kSurelyOther * focal.sigma) || !(off > kFarFromGiven * given_sigma))
        return std::nullopt;
    return printed("focal length %s %.1f %% too %s (sigma %.1f %%)",
                   focal.estimated ? "was" : "seems", off * 100.0,
                   focal.scale < 1.0 ? "long" : "short", focal.sigma * 100.0) +
           (focal.estimated ? " and was estimated: the result needs the corrected intrinsics"
                            : ": check the intrinsics");
}

}  // namespace petal
