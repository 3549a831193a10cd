// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/correspondences.hpp"

namespace petal {

struct RobustLoss {
    enum class Kind { none, huber, cauchy };
    Kind kind = Kind::none;
    double scale_px = 2.0;  ///< weighted residuals above it count less

    /// \throws Error for another word than none, huber, cauchy.
    static Kind kind_of(const std::string& name);
    /// What a pair weighs at the (weighted) squared residual `squared_px`: rho'.
    double weight(double squared_px) const;
};

struct RefinedPose {
    Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
    double cost = 0.0;    ///< half the sum of the weighted, robust squares, px^2
    double rms_px = 0.0;  ///< over pairs, of the plain 2-D distance
};

/// Equation (10) for the pairs of one camera: the sum of squared reprojection errors over
/// T_camera_lidar. Immutable once made; keeps its own copies.
class ReprojectionProblem {
   public:
    /// Weighted by the pairs' covariances when `weigh`: the weights are scaled so that their mean
    /// is 1, so residuals stay pixels, and equal covariances give plain least squares. \throws
    /// Error naming the pair for NaN or infinite points, or a matrix that is no covariance.
    ReprojectionProblem(CameraModel model, std::vector<PointPair> pairs, bool weigh = true,
                        RobustLoss loss = {});

    /// Least squares from `start` by Ceres on one thread. None where a pair does not project at the
    /// start, or Ceres cannot go on.
    std::optional<RefinedPose> refine(const Eigen::Isometry3d& start) const;
    /// Every start refined; poses that ended in one minimum are told once. The lowest cost first;
    /// equal costs keep the order of the starts.
    std::vector<RefinedPose> refine_all(const std::vector<Eigen::Isometry3d>& starts) const;
    /// The figures at a pose, as it is. None where a pair does not project.
    std::optional<RefinedPose> evaluate(const Eigen::Isometry3d& pose) const;

    /// Measured minus projected for each pair, raw pixels. None where one does not project.
    std::optional<std::vector<Eigen::Vector2d>> errors(const Eigen::Isometry3d& pose) const;

    const CameraModel& model() const { return model_; }
    const std::vector<PointPair>& pairs() const { return pairs_; }
    const RobustLoss& loss() const { return loss_; }
    /// S with S'S = the pair's weight (dimensionless, mean 1).
    const Eigen::Matrix2d& sqrt_weight(std::size_t pair) const { return sqrt_weights_[pair]; }
    /// Of unit weight, px^2: the harmonic mean of the covariances (the plain one where not
    /// weighted).
    double unit_variance() const { return unit_variance_; }

   private:
    CameraModel model_;
    std::vector<PointPair> pairs_;
    RobustLoss loss_;
    std::vector<Eigen::Matrix2d> sqrt_weights_;
    double unit_variance_ = 1.0;
};

}  // namespace petal
