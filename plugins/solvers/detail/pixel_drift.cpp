// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/pixel_drift.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "petal/printed.hpp"
#include "solvers/detail/reprojection_cost.hpp"

namespace petal {
namespace {

constexpr double kDriftRanges[] = {5.0, 20.0, 50.0};  // m

double pixel_sigma(const CameraModel& model, const Matrix6d& covariance, double range) {
    const Eigen::Vector3d ahead(0.0, 0.0, range);
    Eigen::Matrix<double, 2, 3> by_point;
    if (!model.project(ahead, &by_point)) return 0.0;
    const Eigen::Matrix<double, 2, 6> jacobian = projection_jacobian(by_point, ahead);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(
        jacobian * covariance * jacobian.transpose(), Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(0.0, eigen.eigenvalues()[1]));
}

}  // namespace

std::vector<Diagnosis::Drift> pixel_drifts(const CameraModel& model, const Matrix6d& covariance,
                                           const Matrix6d& considered) {
    std::vector<Diagnosis::Drift> drifts;
    for (const double range : kDriftRanges)
        drifts.push_back(
            {range, pixel_sigma(model, covariance, range), pixel_sigma(model, considered, range)});
    return drifts;
}

std::string drift_text(const std::vector<Diagnosis::Drift>& drifts) {
    std::string ranges, exact, considered;
    for (std::size_t i = 0; i < drifts.size(); ++i) {
        const char* comma = i == 0 ? "" : i + 1 == drifts.size() ? " and " : ", ";
        ranges += comma + printed("%g", drifts[i].range);
        exact += comma + printed("%.1f", drifts[i].px);
        considered += comma + printed("%.1f", drifts[i].considered_px);
    }
    return "; straight ahead at " + ranges + " m that is " + exact + " px (" + considered +
           " px with the doubt in the intrinsics)";
}

}  // namespace petal
