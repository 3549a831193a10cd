// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/truth_figures.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/se3.hpp"

namespace petal {
namespace {

/// xi^T C^-1 xi. None where C is not positive definite, to the digits that a double holds.
std::optional<double> squared_in_sigmas(const Vector6d& xi, const Matrix6d& covariance) {
    const Vector6d variances = covariance.diagonal();
    if (!covariance.allFinite() || !(variances.minCoeff() > 0.0)) return std::nullopt;
    // Metres and radians differ by orders of magnitude: judged in units of the sigmas.
    const Vector6d per_sigma = variances.cwiseSqrt().cwiseInverse();
    const Matrix6d correlation = per_sigma.asDiagonal() * covariance * per_sigma.asDiagonal();
    constexpr double kSmallest =
        1e-13;  // of an eigenvalue; their mean is 1, rounding errs by 1e-15
    if (!((correlation - correlation.transpose()).cwiseAbs().maxCoeff() < 1e-6))
        return std::nullopt;
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(correlation);
    if (!(eigen.eigenvalues().minCoeff() > kSmallest)) return std::nullopt;
    const Vector6d principal = eigen.eigenvectors().transpose() * xi.cwiseProduct(per_sigma);
    return principal.cwiseAbs2().cwiseQuotient(eigen.eigenvalues()).sum();
}

}  // namespace

PoseError pose_error(const CameraExtrinsics& estimated, const Eigen::Isometry3d& truth) {
    const Eigen::Isometry3d& pose = estimated.T_camera_lidar;
    PoseError error;
    Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
    turn.linear() = pose.linear() * truth.linear().transpose();
    error.rotation = se3_log(turn).tail<3>();
    error.translation = pose.translation() - truth.translation();
    error.nees = squared_in_sigmas(se3_log(truth * pose.inverse()), estimated.covariance);
    return error;
}

void CornerDrift::add(const CornerDrift& other) {
    px.insert(px.end(), other.px.begin(), other.px.end());
    lost += other.lost;
}

CornerDrift corner_drift(const CameraModel& model, const Eigen::Isometry3d& estimated,
                         const Eigen::Isometry3d& truth, const std::vector<Truth::Board>& boards) {
    CornerDrift drift;
    for (const Truth::Board& board : boards)
        for (const Eigen::Vector3d& corner : board.corners_lidar) {
            const auto seen = model.project(estimated * corner);
            const auto true_pixel = model.project(truth * corner);
            if (seen && true_pixel) {
                drift.px.push_back((*seen - *true_pixel).norm());
            } else {
                ++drift.lost;
            }
        }
    return drift;
}

std::vector<Metric> truth_figures(const PoseError& pose, const CornerDrift& drift,
                                  const std::string& scene) {
    std::vector<Metric> figures;
    const auto add = [&](const std::string& name, double value, const char* unit) {
        figures.push_back({"truth." + name, value, unit, scene});
    };
    const Eigen::Vector3d turn_deg = pose.rotation * kDegrees;
    add("rotation_deg", turn_deg.norm(), "deg");
    add("rotation_x_deg", turn_deg.x(), "deg");
    add("rotation_y_deg", turn_deg.y(), "deg");
    add("rotation_z_deg", turn_deg.z(), "deg");
    add("translation_m", pose.translation.norm(), "m");
    add("translation_x_m", pose.translation.x(), "m");
    add("translation_y_m", pose.translation.y(), "m");
    add("translation_z_m", pose.translation.z(), "m");
    if (pose.nees) add("nees", *pose.nees, "1");
    add("drift_count", static_cast<double>(drift.px.size()), "1");
    if (drift.px.empty()) return figures;
    const double sum = std::accumulate(drift.px.begin(), drift.px.end(), 0.0);
    add("drift_px", sum / static_cast<double>(drift.px.size()), "px");
    add("drift_max_px", *std::max_element(drift.px.begin(), drift.px.end()), "px");
    return figures;
}

}  // namespace petal
