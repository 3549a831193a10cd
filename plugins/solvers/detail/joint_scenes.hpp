// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

#include "petal/calibration/diagnosis.hpp"
#include "solvers/detail/joint_uncertainty.hpp"

namespace petal {

/// What every scene does to the result: the problem solved again without it.
class SceneInfluence {
   public:
    SceneInfluence(const JointModel& model, const JointOptions& options,
                   const JointSolution& solution, const JointUncertainty& uncertainty);

    /// Told for one camera: its shifts. Scenes in the model's order.
    std::vector<Diagnosis::Scene> of(std::size_t camera) const;

   private:
    /// The solution without one scene.
    struct Without {
        bool solvable = false;
        std::vector<Vector6d> shift;       ///< of each camera
        std::vector<Matrix6d> covariance;  ///< of each camera, unscaled
        double variance_scale = 1.0;
        bool outlier = false;
    };
    Without without(std::size_t scene) const;

    const JointModel& model_;
    const JointOptions& options_;
    const JointSolution& solution_;
    const JointUncertainty& uncertainty_;
    double plain_chi2_ = 0.0;  ///< of all scenes, without a robust loss
    std::vector<double> scene_chi2_, scene_numbers_;
    std::vector<Without> without_;
};

/// sqrt(d' C^-1 d) over the directions in which `covariance` is not zero, seen in units of
/// `reference` (a covariance not below it).
double mahalanobis(const Vector6d& d, const Matrix6d& covariance, const Matrix6d& reference);

}  // namespace petal
