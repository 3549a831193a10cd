// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/board_errors.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "petal/calibration/angles.hpp"

namespace petal {
namespace {

constexpr double kSameCorner = 1e-3;  ///< m: truth.json may have been written with few digits
constexpr double kSmallest = 1e-10;   ///< of the largest variance: rounding leaves 1e-15

double mean_square(const std::vector<Eigen::Vector2d>& errors) {
    double squares = 0.0;
    for (const Eigen::Vector2d& error : errors) squares += error.squaredNorm();
    return squares / static_cast<double>(errors.size());
}

Eigen::Vector2d mean_of_points(const std::vector<Eigen::Vector2d>& points) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& point : points) sum += point;
    return sum / static_cast<double>(points.size());
}

}  // namespace

std::optional<ErrorInSigmas> error_in_sigmas(const Eigen::VectorXd& error,
                                             const Eigen::MatrixXd& covariance) {
    if (covariance.rows() != error.size() || covariance.cols() != error.size()) return std::nullopt;
    if (!covariance.allFinite() || !error.allFinite()) return std::nullopt;
    const Eigen::VectorXd variances = covariance.diagonal();
    if (!(variances.minCoeff() > 0.0)) return std::nullopt;
    // Metres and radians differ by orders of magnitude: judged in units of the sigmas.
    const Eigen::VectorXd per_sigma = variances.cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd correlation =
        per_sigma.asDiagonal() * covariance * per_sigma.asDiagonal();
    if (!((correlation - correlation.transpose()).cwiseAbs().maxCoeff() < 1e-6))
        return std::nullopt;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(correlation);
    const double limit = kSmallest * eigen.eigenvalues().maxCoeff();
    if (eigen.eigenvalues().minCoeff() < -limit) return std::nullopt;
    const Eigen::VectorXd principal =
        eigen.eigenvectors().transpose() * error.cwiseProduct(per_sigma);
    ErrorInSigmas result;
    for (Eigen::Index i = 0; i < principal.size(); ++i) {
        if (eigen.eigenvalues()(i) <= limit) continue;
        result.squared += principal(i) * principal(i) / eigen.eigenvalues()(i);
        ++result.freedoms;
    }
    return result;
}

TrueBoard::TrueBoard(const Truth::Board& board) : board_(&board) {
    const Eigen::Isometry3d to_board = board.T_lidar_board.inverse();
    std::vector<Eigen::Vector3d> corners;
    for (const Eigen::Vector3d& corner : board.corners_lidar) corners.push_back(to_board * corner);
    if (corners.empty()) return;
    for (const Eigen::Vector3d& corner : corners)
        middle_ += corner / static_cast<double>(corners.size());
    for (const Eigen::Vector3d& corner : corners)
        radius_ += (corner - middle_).squaredNorm() / static_cast<double>(corners.size());
    radius_ = std::sqrt(radius_);
    for (int quarter = 0; quarter < 4; ++quarter) {
        Turn turn;
        turn.motion = Eigen::Translation3d(middle_) *
                      Eigen::AngleAxisd(quarter * kPi / 2.0, Eigen::Vector3d::UnitZ()) *
                      Eigen::Translation3d(-middle_);
        for (const Eigen::Vector3d& corner : corners) {
            const Eigen::Vector3d turned = turn.motion * corner;
            for (std::size_t i = 0; i < corners.size(); ++i)
                if ((corners[i] - turned).norm() < kSameCorner) {
                    turn.order.push_back(i);
                    break;
                }
        }
        if (turn.order.size() == corners.size()) turns_.push_back(std::move(turn));
    }
}

Eigen::Vector2d TrueBoard::middle_image() const {
    return mean_of_points(board_->corners_image);
}

double TrueBoard::radius_image() const {
    const Eigen::Vector2d middle = middle_image();
    std::vector<Eigen::Vector2d> arms;
    for (const Eigen::Vector2d& corner : board_->corners_image) arms.push_back(corner - middle);
    return std::sqrt(mean_square(arms));
}

LidarBoardError lidar_board_error(const LidarBoard& found, const TrueBoard& truth,
                                  double range_sigma) {
    const Eigen::Isometry3d& T_true = truth.board().T_lidar_board;
    Eigen::Isometry3d nearest = found.T_lidar_board;
    double least = -1.0;
    for (const TrueBoard::Turn& turn : truth.turns()) {
        const Eigen::Isometry3d turned = found.T_lidar_board * turn.motion;
        const double angle = rotation_angle(turned.linear() * T_true.linear().transpose());
        if (least >= 0.0 && angle >= least) continue;
        least = angle;
        nearest = turned;
    }
    // To the board's own axes, at its middle.
    Eigen::Isometry3d frame = nearest;
    frame.translation() = nearest * truth.middle();
    const Matrix6d to_board = adjoint(frame.inverse());
    LidarBoardError result;
    result.error = -(to_board * se3_log(T_true * nearest.inverse()));
    if (!found.covariance) return result;
    Matrix6d covariance = *found.covariance;
    const Eigen::Vector3d ray = frame.translation().normalized();
    covariance.topLeftCorner<3, 3>() += range_sigma * range_sigma * ray * ray.transpose();
    const Matrix6d own = to_board * covariance * to_board.transpose();
    const auto whole = error_in_sigmas(result.error, 0.5 * (own + own.transpose()));
    if (!whole || whole->freedoms < 6) return result;
    result.whole = whole;
    result.in_sigmas = result.error.cwiseQuotient(own.diagonal().cwiseSqrt());
    return result;
}

ImageBoardError image_board_error(const ImageBoard& found, const TrueBoard& truth) {
    const std::vector<Eigen::Vector2d>& expected = truth.board().corners_image;
    std::vector<Eigen::Vector2d> errors;
    for (const TrueBoard::Turn& turn : truth.turns()) {
        std::vector<Eigen::Vector2d> these;
        for (std::size_t i = 0; i < expected.size(); ++i)
            these.push_back(found.corners[i] - expected[turn.order[i]]);
        if (errors.empty() || mean_square(these) < mean_square(errors)) errors = std::move(these);
    }
    ImageBoardError result;
    result.rms_px = std::sqrt(mean_square(errors));
    result.shift_px = mean_of_points(errors);
    const auto size = static_cast<Eigen::Index>(2 * errors.size());
    if (found.joint_covariance.rows() != size || found.joint_covariance.cols() != size)
        return result;
    Eigen::VectorXd all(size);
    Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(2, size);
    for (std::size_t i = 0; i < errors.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(2 * i);
        all.segment<2>(at) = errors[i];
        mean.block<2, 2>(0, at) = Eigen::Matrix2d::Identity() / static_cast<double>(errors.size());
    }
    result.whole = error_in_sigmas(all, found.joint_covariance);
    const Eigen::Matrix2d shift = mean * found.joint_covariance * mean.transpose();
    if (result.whole && shift.diagonal().minCoeff() > 0.0)
        result.shift_in_sigmas = result.shift_px.cwiseQuotient(shift.diagonal().cwiseSqrt());
    return result;
}

}  // namespace petal
