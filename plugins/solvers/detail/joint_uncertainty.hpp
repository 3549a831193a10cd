// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "petal/calibration/diagnosis.hpp"
#include "solvers/detail/joint_information.hpp"

namespace petal {

/// How well is known what is not estimated (1 sigma).
struct ConsiderParams {
    double range_offset_sigma = 0.005;      ///< m, of the LiDAR, along each ray
    double focal_sigma = 0.001;             ///< of 1, of the focal length
    double principal_point_sigma_px = 1.0;  ///< of cx and of cy
};

/// Covariances at a solution, from the information of its scenes.
class JointUncertainty {
   public:
    JointUncertainty(const JointModel& model, const JointOptions& options,
                     const JointSolution& solution);

    /// Numbers less parameters, at least 0.
    int degrees_of_freedom() const { return freedom_; }
    double chi2() const { return chi2_; }
    /// max(1, chi2 / degrees of freedom): every covariance below holds it.
    double variance_scale() const { return scale_; }

    /// Of the pose of a camera, (rho, phi), intrinsics exact, where the LiDAR's range offset errs
    /// by `range_offset_sigma` (m; 0: ranges exact, which leaves the noise alone).
    Matrix6d covariance(std::size_t camera, double range_offset_sigma) const;
    Matrix6d covariance_without_prior(std::size_t camera, double range_offset_sigma) const;
    /// As the weights see it: with the sigma of the range offset that they allow for, scaled too.
    Matrix6d covariance_with_offset(std::size_t camera) const;
    /// `covariance` with what `params` says of the range offset, and, as independent errors, of
    /// each camera's focal length (where it is not estimated) and principal point.
    Matrix6d covariance_considered(std::size_t camera, const ConsiderParams& params) const;

    /// The focal length as it is estimated, or as one step from the solution would make it.
    Diagnosis::FocalScale focal(std::size_t camera) const;

    /// What the data say of a camera's pose and the range offset, 7 x 7, all else eliminated;
    /// neither the prior of the offset nor the variance scale is in it.
    Eigen::Matrix<double, 7, 7> information(std::size_t camera) const;

    /// Each scene's share of the information on what is estimated; they sum up to 1.
    std::vector<double> influences() const;

    const std::vector<JointInformation>& scenes() const { return scenes_; }

   private:
    Eigen::MatrixXd estimated_part(const Eigen::MatrixXd& normal) const;
    Eigen::VectorXd offset_answer(const Eigen::MatrixXd& inverse) const;
    Eigen::MatrixXd with_offset(const Eigen::MatrixXd& inverse, double range_offset_sigma) const;

    JointLayout layout_;
    std::vector<bool> free_focal_;
    std::vector<double> focal_;
    std::vector<JointInformation> scenes_;
    JointInformation prior_, total_;  ///< total_ holds the prior, and that of the range offset
    /// Where they stand in the layout: poses, the range offset, free focal lengths.
    std::vector<Eigen::Index> estimated_;
    double range_offset_sigma_ = 0.0;
    Eigen::MatrixXd inverse_;  ///< of what is estimated, unscaled
    double chi2_ = 0.0, scale_ = 1.0;
    int freedom_ = 0;
};

}  // namespace petal
