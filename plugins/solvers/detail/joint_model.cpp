// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/joint_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "petal/error.hpp"
#include "solvers/detail/corner_covariance.hpp"

namespace petal {
namespace {

/// Of a variance, against the largest: rounding of a covariance that is singular by nature leaves
/// some 1e-15, and no detector tells one direction a thousand times better than another.
constexpr double kSingular = 1e-6;

/// The inverse of the left Jacobian of SE(3) at a small (rho, phi), to second order.
Matrix6d inverse_left_jacobian(const Vector6d& xi) {
    Matrix6d ad = Matrix6d::Zero();
    ad.topLeftCorner<3, 3>() = skew(xi.tail<3>());
    ad.bottomRightCorner<3, 3>() = skew(xi.tail<3>());
    ad.topRightCorner<3, 3>() = skew(xi.head<3>());
    return Matrix6d::Identity() - 0.5 * ad + ad * ad / 12.0;
}

Eigen::Matrix<double, 3, 6> point_jacobian(const Eigen::Vector3d& p) {
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian << Eigen::Matrix3d::Identity(), -skew(p);
    return jacobian;
}

}  // namespace

bool linearise(const CameraModel& model, const JointBoard::View& view,
               const Eigen::Isometry3d& T_camera_lidar, const Eigen::Isometry3d& T_lidar_board,
               double focal, ViewLinear& out) {
    const auto rows = static_cast<Eigen::Index>(2 * view.corners.size());
    Eigen::VectorXd error(rows), by_focal(rows);
    Eigen::Matrix<double, Eigen::Dynamic, 6> by_camera(rows, 6), by_board(rows, 6);
    Eigen::Matrix<double, Eigen::Dynamic, 2> by_centre(rows, 2);
    const Eigen::Vector2d centre(model.cx(), model.cy());
    for (std::size_t i = 0; i < view.corners.size(); ++i) {
        const Eigen::Vector3d p_lidar = T_lidar_board * view.corners[i];
        const Eigen::Vector3d p_camera = T_camera_lidar * p_lidar;
        Eigen::Matrix<double, 2, 3> by_point;
        const auto pixel = model.project(p_camera, &by_point);
        if (!pixel) return false;
        const auto row = static_cast<Eigen::Index>(2 * i);
        // Distortion acts before K, so the focal length scales about the principal point.
        const Eigen::Vector2d off_centre = *pixel - centre;
        error.segment<2>(row) = view.image[i] - centre - focal * off_centre;
        by_focal.segment<2>(row) = -off_centre;
        by_centre.middleRows<2>(row) = -Eigen::Matrix2d::Identity();
        by_camera.middleRows<2>(row) = -focal * by_point * point_jacobian(p_camera);
        by_board.middleRows<2>(row) =
            -focal * by_point * T_camera_lidar.linear() * point_jacobian(p_lidar);
    }
    out.error = view.whitening * error;
    out.by_camera = view.whitening * by_camera;
    out.by_board = view.whitening * by_board;
    out.by_focal = view.whitening * by_focal;
    out.by_centre = view.whitening * by_centre;
    return true;
}

BoardLinear linearise(const JointBoard& board, const Eigen::Isometry3d& T_lidar_board,
                      double range_offset) {
    const Vector6d xi = se3_log(T_lidar_board * board.T_lidar_board.inverse());
    // The measurement lies too far by the offset, so the error grows with it towards the sensor.
    Vector6d offset = Vector6d::Zero();
    offset.head<3>() = board.centre.normalized();
    return {board.whitening * (xi + range_offset * offset),
            board.whitening * inverse_left_jacobian(xi), board.whitening * offset};
}

bool linearise(const CameraModel& model, const JointPoint& point, double point_sigma,
               const Eigen::Isometry3d& T_camera_lidar, double focal, double range_offset,
               PointLinear& out, const Eigen::Matrix2d* whitening) {
    const Eigen::Vector3d p_camera = T_camera_lidar * point.lidar;
    Eigen::Matrix<double, 2, 3> by_point;
    const auto pixel = model.project(p_camera, &by_point);
    if (!pixel) return false;
    by_point *= focal;
    const Eigen::Vector2d centre(model.cx(), model.cy());
    const Eigen::Vector2d off_centre = *pixel - centre;
    if (whitening != nullptr) {
        out.whitening = *whitening;
    } else {
        const Eigen::Matrix2d covariance =
            point.redundancy *
            (point.covariance + point_sigma * point_sigma * by_point * by_point.transpose());
        out.whitening = covariance.llt().matrixL().solve(Eigen::Matrix2d::Identity());
    }
    out.error = out.whitening * (point.image - centre - focal * off_centre);
    out.by_camera = -out.whitening * by_point * point_jacobian(p_camera);
    out.by_focal = -out.whitening * off_centre;
    out.by_centre = -out.whitening;
    // The true point is nearer than the measured one where the offset is positive.
    out.by_range = out.whitening * by_point * T_camera_lidar.linear() * point.lidar.normalized();
    out.error += range_offset * out.by_range;
    return true;
}

Eigen::MatrixXd pixel_whitening(const Eigen::MatrixXd& covariance, double min_sigma_px,
                                const std::string& who) {
    if (const auto fault = covariance_fault(covariance); !fault.empty())
        throw Error(who + ": the covariance of its corners " + fault +
                    "; check what detected it, or leave it empty where it is unknown");
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
    const Eigen::VectorXd& values = eigen.eigenvalues();
    const Eigen::Index size = values.size();
    const double largest = values[size - 1];
    Eigen::Index first = 0;
    while (first < size && !(values[first] > kSingular * largest)) ++first;
    if (!(largest > 0.0) || size - first < 6)
        throw Error(who + ": the covariance of its corners has rank " +
                    std::to_string(largest > 0.0 ? size - first : 0) +
                    ", at least 6 are expected; leave it empty where it is unknown");
    const Eigen::Index rank = size - first;
    const Eigen::VectorXd sigmas = values.tail(rank).cwiseSqrt().cwiseMax(min_sigma_px);
    return sigmas.cwiseInverse().asDiagonal() * eigen.eigenvectors().rightCols(rank).transpose();
}

Matrix6d covariance_about(const Eigen::Vector3d& centre, double sigma, double sigma_rotation) {
    Eigen::Isometry3d there = Eigen::Isometry3d::Identity();
    there.translation() = centre;
    const Matrix6d map = adjoint(there);
    Vector6d variances;
    variances << Eigen::Vector3d::Constant(sigma * sigma),
        Eigen::Vector3d::Constant(sigma_rotation * sigma_rotation);
    return map * variances.asDiagonal() * map.transpose();
}

}  // namespace petal
