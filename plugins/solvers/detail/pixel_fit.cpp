// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/pixel_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "petal/calibration/se3.hpp"
#include "solvers/detail/reprojection_cost.hpp"

namespace petal {
namespace {

constexpr int kPixelSteps = 60;
constexpr double kSmallestGain = 1e-12;  // of the cost

struct PixelEquations {
    Matrix6d information = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    double squares = 0.0;
};

/// None where a pair does not project.
std::optional<PixelEquations> linearise_pixels(const CameraModel& model,
                                               const std::vector<PointPair>& pairs,
                                               const Eigen::Isometry3d& pose) {
    PixelEquations equations;
    for (const PointPair& pair : pairs) {
        const Eigen::Vector3d p = pose * pair.lidar;
        Eigen::Matrix<double, 2, 3> by_point;
        const auto pixel = model.project(p, &by_point);
        if (!pixel) return std::nullopt;
        const Eigen::Vector2d error = pair.image - *pixel;
        const Eigen::Matrix<double, 2, 6> jacobian = projection_jacobian(by_point, p);
        equations.information.noalias() += jacobian.transpose() * jacobian;
        equations.gradient.noalias() += jacobian.transpose() * error;
        equations.squares += error.squaredNorm();
    }
    if (!std::isfinite(equations.squares)) return std::nullopt;
    return equations;
}

}  // namespace

std::optional<PixelFit> fit_pixels(const CameraModel& model, const std::vector<PointPair>& pairs,
                                   const Eigen::Isometry3d& start) {
    if (pairs.empty() || !start.matrix().allFinite()) return std::nullopt;
    Eigen::Isometry3d pose = start;
    auto now = linearise_pixels(model, pairs, pose);
    if (!now) return std::nullopt;
    double damping = 1e-4;
    for (int step = 0; step < kPixelSteps; ++step) {
        Matrix6d damped = now->information;
        damped.diagonal() *= 1.0 + damping;
        damped.diagonal().array() += 1e-12;
        const Vector6d delta = damped.ldlt().solve(now->gradient);
        if (!delta.allFinite()) break;
        const Eigen::Isometry3d next = se3_exp(delta) * pose;
        const auto then = linearise_pixels(model, pairs, next);
        if (!then || then->squares > now->squares) {
            damping *= 10.0;
            if (damping > 1e8) break;
            continue;
        }
        const double gain = now->squares - then->squares;
        pose = next;
        now = then;
        damping = std::max(0.1 * damping, 1e-12);
        if (gain <= kSmallestGain * now->squares || delta.squaredNorm() < 1e-24) break;
    }
    // Products of many rotations drift off SO(3) by rounding.
    pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
    PixelFit fit;
    fit.pose.T_camera_lidar = pose;
    fit.pose.cost = 0.5 * now->squares;
    fit.pose.rms_px = std::sqrt(now->squares / static_cast<double>(pairs.size()));
    fit.information = now->information;
    return fit;
}

}  // namespace petal
