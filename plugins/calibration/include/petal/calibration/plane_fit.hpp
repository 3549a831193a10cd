// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>

namespace petal {

/// A least-squares plane n . p + d = 0 (equation (2) of the letter).
struct PlaneFit {
    Eigen::Vector3d normal =
        Eigen::Vector3d::UnitX();  ///< unit length, towards the origin (d >= 0)
    double offset = 0.0;           ///< d, m
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();    ///< of the points, m; lies in the plane
    Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< of (normal, offset); rank 3
    double rms = 0.0;                                      ///< of the points' distances, m

    double distance(const Eigen::Vector3d& p) const { return normal.dot(p) + offset; }
};

/// Fits a plane by orthogonal least squares: the normal is the eigenvector of the smallest
/// eigenvalue of the points' scatter. It keeps sums only, so points are added one by one and never
/// copied.
class PlaneFitter {
   public:
    void add(const Eigen::Vector3d& p);
    std::size_t size() const { return size_; }

    /// None for fewer than three points, or where they lie on a line (second extent below 1e-3 of
    /// the first, or below 1 um). The covariance takes the points' errors as independent, along the
    /// normal and of the size that the residuals show, rms^2 n / (n - 3); it is zero for three
    /// points, where they show nothing.
    std::optional<PlaneFit> fit() const;

   private:
    std::size_t size_ = 0;
    Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  ///< the first point: keeps the sums small
    Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
    Eigen::Matrix3d products_ = Eigen::Matrix3d::Zero();
};

/// A frame in a plane as an observer at the LiDAR sees it, T_lidar_plane: origin `origin`, z away
/// from the observer (-normal), y down, x right. Up is the LiDAR's +z; its +x where +z is along the
/// normal (within 6 deg). `normal` is of unit length and points to the observer.
Eigen::Isometry3d plane_frame(const Eigen::Vector3d& normal, const Eigen::Vector3d& origin);

}  // namespace petal
