// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/plane_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace petal {

void PlaneFitter::add(const Eigen::Vector3d& p) {
    if (size_ == 0) origin_ = p;
    const Eigen::Vector3d q = p - origin_;
    sum_ += q;
    products_ += q * q.transpose();
    ++size_;
}

std::optional<PlaneFit> PlaneFitter::fit() const {
    if (size_ < 3) return std::nullopt;
    const double n = static_cast<double>(size_);
    const Eigen::Vector3d mean = sum_ / n;
    const Eigen::Matrix3d scatter = products_ / n - mean * mean.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
    if (solver.info() != Eigen::Success) return std::nullopt;
    const Eigen::Vector3d variance = solver.eigenvalues().cwiseMax(0.0);  // ascending
    constexpr double kMinExtent = 1e-6;                                   // m
    constexpr double kMinRatio = 1e-3;
    const double second = std::sqrt(variance(1));
    if (!(second > kMinExtent) || second < kMinRatio * std::sqrt(variance(2))) return std::nullopt;

    PlaneFit fit;
    fit.centroid = origin_ + mean;
    fit.normal = solver.eigenvectors().col(0);
    fit.offset = -fit.normal.dot(fit.centroid);
    if (fit.offset < 0.0) {
        fit.normal = -fit.normal;
        fit.offset = -fit.offset;
    }
    fit.rms = std::sqrt(variance(0));
    if (size_ > 3) {
        // The plane turns about its two principal axes by a1, a2 and shifts at the centroid by s:
        // three independent errors. n' = n + a1 e1 + a2 e2, d' = d - (a1 e1 + a2 e2) . c + s.
        const double point_variance = variance(0) * n / (n - 3.0);
        for (int axis = 1; axis < 3; ++axis) {
            Eigen::Vector4d g;
            g.head<3>() = solver.eigenvectors().col(axis);
            g(3) = -g.head<3>().dot(fit.centroid);
            fit.covariance += g * g.transpose() * (point_variance / (n * variance(axis)));
        }
        fit.covariance(3, 3) += point_variance / n;
    }
    return fit;
}

Eigen::Isometry3d plane_frame(const Eigen::Vector3d& normal, const Eigen::Vector3d& origin) {
    constexpr double kMinSine = 0.1;  // 6 deg
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    if (up.cross(normal).norm() < kMinSine) up = Eigen::Vector3d::UnitX();
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    const Eigen::Vector3d z = -normal;
    const Eigen::Vector3d y = -(up - normal * normal.dot(up)).normalized();
    frame.linear().col(0) = y.cross(z);
    frame.linear().col(1) = y;
    frame.linear().col(2) = z;
    frame.translation() = origin;
    return frame;
}

}  // namespace petal
