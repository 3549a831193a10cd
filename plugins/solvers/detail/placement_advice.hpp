// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>

#include "petal/calibration/diagnosis.hpp"
#include "solvers/detail/joint_solve.hpp"

namespace petal {

struct AdviceParams {
    double min_range = 2.0, max_range = 6.0;         ///< m, of the camera to the board's centre
    double range_offset_sigma = 0.005;               ///< m: how well it is known
    double allowed_range_offset = 0.01;              ///< m: 1 sigma of it, in the weights
    double variance_scale = 1.0;                     ///< of what noise does
    double usable_sigma = 0.005;                     ///< m; what a sigma is counted in
    double usable_sigma_rotation = 0.06 / 57.29578;  ///< rad
};

/// One more placement of the board, seen by one camera, that makes the largest principal sigma of
/// that camera's pose (each in units of its usable limit) smallest. Tried are nine places in the
/// image, ranges a metre apart, and pitch and yaw of -30, 0 and 30 deg each, wherever the board
/// lies wholly in the image. The noise is that of the boards at hand: the mean covariance of their
/// LiDAR poses about their centres, per range squared, and the corner noise that, were it
/// independent, would carry what their images carry. None where no board was seen or none helps.
/// `known` is what the data say of the camera's pose and the range offset.
std::optional<Diagnosis::Advice> advise_placement(const JointModel& model,
                                                  const JointSolution& solution, std::size_t camera,
                                                  const Eigen::Matrix<double, 7, 7>& known,
                                                  const AdviceParams& params);

}  // namespace petal
