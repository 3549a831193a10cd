// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/pose_agreement.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace petal {
namespace {

constexpr double kLeastPx = 0.05;  // 1 sigma: no corner is surer than this
// What a drift may be at all, 1 sigma: keeps what the boards do not tell at zero.
constexpr double kDriftMetres = 0.5;
constexpr double kDriftRadians = 0.2;

template <class Point>
Point mean_of(const std::vector<Point>& points) {
    Point sum = Point::Zero();
    for (const Point& p : points) sum += p;
    return sum / static_cast<double>(points.size());
}

/// RMS distance of the corners from their middle, px.
double radius_of(const std::vector<Eigen::Vector2d>& corners) {
    const Eigen::Vector2d middle = mean_of(corners);
    double sum = 0.0;
    for (const auto& corner : corners) sum += (corner - middle).squaredNorm();
    return std::sqrt(sum / static_cast<double>(corners.size()));
}

/// For each image corner the projected corner nearest to it once the middles lie on each other;
/// empty where that is not one to one.
std::vector<std::size_t> nearest_order(const std::vector<Eigen::Vector2d>& projected,
                                       const std::vector<Eigen::Vector2d>& image) {
    const Eigen::Vector2d shift = mean_of(image) - mean_of(projected);
    std::vector<std::size_t> order;
    std::vector<bool> used(projected.size(), false);
    for (const Eigen::Vector2d& corner : image) {
        std::size_t nearest = 0;
        for (std::size_t i = 1; i < projected.size(); ++i)
            if ((projected[i] + shift - corner).squaredNorm() <
                (projected[nearest] + shift - corner).squaredNorm())
                nearest = i;
        if (used[nearest]) return {};
        used[nearest] = true;
        order.push_back(nearest);
    }
    return order;
}

bool finite(const ImageBoard& board) {
    return std::all_of(board.corners.begin(), board.corners.end(),
                       [](const Eigen::Vector2d& p) { return p.allFinite(); });
}

}  // namespace

std::vector<PosedMatch> match_by_pose(const CameraModel& model,
                                      const Eigen::Isometry3d& T_camera_lidar,
                                      const LidarBoards& lidar, const ImageBoards& image,
                                      const std::string& camera, double reach) {
    struct Candidate {
        double distance;
        PosedMatch match;
    };
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < lidar.boards.size(); ++i) {
        const LidarBoard& board = lidar.boards[i];
        std::vector<Eigen::Vector2d> projected;
        for (const Eigen::Vector3d& corner : board.corners)
            if (const auto pixel = model.project(T_camera_lidar * corner))
                projected.push_back(*pixel);
        if (projected.size() != board.corners.size() || projected.size() < 4) continue;
        for (std::size_t j = 0; j < image.boards.size(); ++j) {
            const ImageBoard& seen = image.boards[j];
            if (seen.camera != camera || seen.target != board.target ||
                seen.corners.size() != projected.size() || !finite(seen))
                continue;
            const double distance = (mean_of(projected) - mean_of(seen.corners)).norm();
            if (!(distance <= reach * radius_of(seen.corners))) continue;
            auto order = nearest_order(projected, seen.corners);
            if (order.empty()) continue;
            PosedMatch match{i, j, {}, std::move(order)};
            for (const std::size_t k : match.order) match.lidar_corners.push_back(board.corners[k]);
            candidates.push_back({distance, std::move(match)});
        }
    }
    std::stable_sort(
        candidates.begin(), candidates.end(),
        [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
    std::vector<PosedMatch> matches;
    for (Candidate& candidate : candidates) {
        const bool free = std::none_of(matches.begin(), matches.end(), [&](const PosedMatch& m) {
            return m.lidar == candidate.match.lidar || m.image == candidate.match.image;
        });
        if (free) matches.push_back(std::move(candidate.match));
    }
    return matches;
}

bool DriftSum::add(const PosedMatch& match, const LidarBoard& lidar, const ImageBoard& image) {
    const auto n = 2 * static_cast<Eigen::Index>(match.lidar_corners.size());
    Eigen::VectorXd error(n);
    Eigen::MatrixXd by_drift(n, 6), by_board(n, 6);
    for (std::size_t i = 0; i < match.lidar_corners.size(); ++i) {
        const Eigen::Vector3d& p = match.lidar_corners[i];
        const Eigen::Vector3d in_camera = T_ * p;
        Eigen::Matrix<double, 2, 3> by_point;
        const auto pixel = model_.project(in_camera, &by_point);
        if (!pixel) return false;
        const auto row = 2 * static_cast<Eigen::Index>(i);
        error.segment<2>(row) = image.corners[i] - *pixel;
        Eigen::Matrix<double, 3, 6> motion;
        motion << Eigen::Matrix3d::Identity(), -skew(in_camera);
        by_drift.middleRows<2>(row) = by_point * motion;
        motion << Eigen::Matrix3d::Identity(), -skew(p);
        by_board.middleRows<2>(row) = by_point * T_.linear() * motion;
    }
    const bool joint = image.joint_covariance.rows() == n && image.joint_covariance.cols() == n &&
                       image.joint_covariance.allFinite();
    Eigen::MatrixXd noise = Eigen::MatrixXd::Zero(n, n);
    if (joint) {
        noise = image.joint_covariance;
    } else {
        for (std::size_t i = 0; i < match.lidar_corners.size(); ++i) {
            const auto row = 2 * static_cast<Eigen::Index>(i);
            noise.block<2, 2>(row, row) =
                noise_.board_redundancy * (i < image.covariance.size()
                                               ? image.covariance[i]
                                               : Eigen::Matrix2d::Identity().eval());
        }
    }
    noise.diagonal().array() += kLeastPx * kLeastPx;
    Matrix6d of_board = Matrix6d::Zero();
    of_board.topLeftCorner<3, 3>().diagonal().setConstant(noise_.lidar_sigma * noise_.lidar_sigma);
    if (lidar.covariance && lidar.covariance->allFinite()) of_board = *lidar.covariance;
    noise += by_board * of_board * by_board.transpose();
    const Eigen::LDLT<Eigen::MatrixXd> ldlt(noise);
    const Eigen::VectorXd weighed = ldlt.solve(error);
    if (!weighed.allFinite()) return false;
    information_ += by_drift.transpose() * ldlt.solve(by_drift);
    right_ += by_drift.transpose() * weighed;
    // What a motion of the board makes of the misses: 6 numbers, however many corners it has.
    const Matrix6d of_motion = by_board.transpose() * ldlt.solve(by_board);
    const Vector6d pull = by_board.transpose() * weighed;
    const Vector6d unit = of_motion.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Matrix6d in_units = unit.asDiagonal() * of_motion * unit.asDiagonal();
    const Vector6d pull_in_units = unit.cwiseProduct(pull);
    chi2_ += std::max(0.0, pull_in_units.dot(in_units.ldlt().solve(pull_in_units)));
    ++boards_;
    for (Eigen::Index i = 0; i < n; i += 2) errors_.emplace_back(error.segment<2>(i));
    return true;
}

DriftSum::Result DriftSum::result(const Matrix6d& covariance) const {
    Result result;
    Vector6d prior;
    prior.head<3>().setConstant(1.0 / (kDriftMetres * kDriftMetres));
    prior.tail<3>().setConstant(1.0 / (kDriftRadians * kDriftRadians));
    Matrix6d information = information_;
    information.diagonal() += prior;
    result.drift = information.ldlt().solve(right_);
    result.left_chi2 = std::max(0.0, chi2_ - right_.dot(result.drift));
    result.left_freedoms = 6 * (boards_ - 1);
    if (result.left_freedoms > 0) {
        result.variance_scale = std::max(1.0, result.left_chi2 / result.left_freedoms);
        result.left_sigmas = deviate_of_chi2(result.left_chi2, result.left_freedoms);
    }
    // xi' (C + A^-1)^-1 xi with xi = A^-1 b, without inverting A.
    const Matrix6d a = information_ / result.variance_scale;
    const Vector6d b = right_ / result.variance_scale;
    Matrix6d whole = a * covariance * a + a;
    whole.diagonal() += 1e-12 * whole.diagonal().cwiseAbs() + Vector6d::Constant(1e-12);
    // Metres and radians differ by orders: scaled, so that no digits are lost.
    const Vector6d scale = whole.diagonal().cwiseSqrt().cwiseInverse();
    const Matrix6d scaled = scale.asDiagonal() * whole * scale.asDiagonal();
    const Vector6d scaled_b = scale.cwiseProduct(b);
    result.chi2 = std::max(0.0, scaled_b.dot(scaled.ldlt().solve(scaled_b)));
    result.sigmas = deviate_of_chi2(result.chi2, 6);
    return result;
}

double deviate_of_chi2(double chi2, int degrees_of_freedom) {
    const double k = degrees_of_freedom;
    const double spread = 2.0 / (9.0 * k);
    return (std::cbrt(chi2 / k) - (1.0 - spread)) / std::sqrt(spread);
}

}  // namespace petal
