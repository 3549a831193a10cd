// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "petal/calibration/boards.hpp"

namespace petal {

/// What a solver knows of the trust that one camera's extrinsics deserve, beside their covariance,
/// which takes the intrinsics as exact.
struct Diagnosis {
    using Vector6d = Eigen::Matrix<double, 6, 1>;

    /// The same covariance, were the intrinsics known only so well.
    Matrix6d covariance_considered = Matrix6d::Zero();
    double variance_scale = 1.0;  ///< of noise, max(1, chi2 / dof); the covariances hold it

    /// What one scene does to the result.
    struct Scene {
        std::uint64_t scene = 0;  ///< frame number
        std::string name;
        double chi2 = 0.0;           ///< of its boards
        int degrees_of_freedom = 0;  ///< 6 a board
        double influence = 0.0;      ///< its share of the information, 0 to 1; they sum up to 1
        Vector6d shift = Vector6d::Zero();  ///< (rho, phi) of the result without it; m, rad
        double shift_sigmas = 0.0;          ///< length of `shift` in units of its own sigma
        bool solvable_without = true;       ///< the others alone determine a pose
        bool outlier = false;
    };
    std::vector<Scene> scenes;

    /// The largest 1 sigma of a pixel, from the whole covariance.
    struct Drift {
        double range = 0.0;  ///< m, straight ahead of the camera
        double px = 0.0;
        double considered_px = 0.0;  ///< with covariance_considered
    };
    std::vector<Drift> drifts;

    /// A placement that would help most, in words and numbers.
    struct Advice {
        std::string sentence;
        double range = 0.0;       ///< m
        double u = 0.0, v = 0.0;  ///< px, where its centre should be seen
        double pitch = 0.0;       ///< rad, about the camera's x axis
        double yaw = 0.0;         ///< rad, about the camera's y axis
        double sigma_translation_before = 0.0, sigma_translation_after = 0.0;  ///< m, largest
        double sigma_rotation_before = 0.0, sigma_rotation_after = 0.0;        ///< rad, largest
    };
    std::optional<Advice> advice;

    /// The focal length as a factor of the given one, were it free.
    struct FocalScale {
        double scale = 1.0;
        double sigma = 0.0;
        bool estimated = false;  ///< the extrinsics are those with it
    };
    std::optional<FocalScale> focal;

    /// How far the result lies from a prior on the translation, in its sigmas; the covariance holds
    /// the prior, `covariance_without_prior` does not.
    struct Prior {
        double distance = 0.0;  ///< m
        double sigmas = 0.0;
        Matrix6d covariance_without_prior = Matrix6d::Zero();
    };
    std::optional<Prior> prior;
};

}  // namespace petal
