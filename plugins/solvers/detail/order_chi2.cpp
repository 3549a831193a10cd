// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/order_chi2.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "petal/calibration/se3.hpp"
#include "solvers/detail/corner_covariance.hpp"
#include "solvers/detail/reprojection_cost.hpp"

namespace petal {
namespace {

constexpr double kSmallestSigma = 0.05;  // px: a covariance of lines alone has no full rank

/// Whitened: what a small motion of the board in the camera's frame does to its pixels.
struct BoardInImage {
    Eigen::MatrixXd root;               ///< inverse of the covariance's lower Cholesky factor
    Matrix6d lidar = Matrix6d::Zero();  ///< covariance of its pose in the LiDAR frame
};

/// The covariance of the pose of a board whose corners have `sigma` each; as if from the corners
/// left when those that follow from others are taken away.
Matrix6d pose_covariance_of(const std::vector<Eigen::Vector3d>& corners, double sigma) {
    Matrix6d information = Matrix6d::Zero();
    for (const auto& corner : corners) {
        Eigen::Matrix<double, 3, 6> by_pose;
        by_pose << Eigen::Matrix3d::Identity(), -skew(corner);
        information += by_pose.transpose() * by_pose;
    }
    return kBoardRedundancy * sigma * sigma * information.ldlt().solve(Matrix6d::Identity());
}

/// None where a covariance is none.
std::optional<BoardInImage> board_in_image(const BoardSet& boards, const BoardMatch& match,
                                           double lidar_sigma) {
    const LidarBoard& lidar = *boards.lidar(match).board;
    const ImageBoard& image = *boards.image(match).board;
    Eigen::MatrixXd covariance =
        corner_covariance(image.joint_covariance, image.covariance, image.corners.size());
    covariance.diagonal().array() += kSmallestSigma * kSmallestSigma;
    BoardInImage result;
    const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
    if (!covariance.allFinite() || factor.info() != Eigen::Success) return std::nullopt;
    result.root =
        factor.matrixL().solve(Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()));
    result.lidar =
        lidar.covariance ? *lidar.covariance : pose_covariance_of(lidar.corners, lidar_sigma);
    if (!result.lidar.allFinite()) return std::nullopt;
    return result;
}

/// The board's motion that explains its pixels best, and the inverse of its covariance, the noise
/// of both sensors together. None where a corner does not project, or the two together are no
/// covariance.
struct Motion {
    Vector6d motion;
    Matrix6d information;
};
std::optional<Motion> motion_of(const BoardSet& boards, const BoardMatch& match,
                                const BoardInImage& noise, const Eigen::Isometry3d& pose) {
    const auto pairs = boards.pairs({match});
    const auto rows = 2 * static_cast<Eigen::Index>(pairs.size());
    Eigen::Matrix<double, Eigen::Dynamic, 6> jacobian(rows, 6);
    Eigen::VectorXd error(rows);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Eigen::Vector3d p = pose * pairs[i].lidar;
        Eigen::Matrix<double, 2, 3> by_point;
        const auto pixel = boards.model().project(p, &by_point);
        if (!pixel) return std::nullopt;
        const auto row = 2 * static_cast<Eigen::Index>(i);
        error.segment<2>(row) = pairs[i].image - *pixel;
        jacobian.middleRows<2>(row) = projection_jacobian(by_point, p);
    }
    const Eigen::MatrixXd whitened = noise.root * jacobian;
    const Matrix6d by_image = whitened.transpose() * whitened;
    const Matrix6d Ad = adjoint(pose);
    const Matrix6d by_lidar = Ad * noise.lidar * Ad.transpose();
    const Eigen::LDLT<Matrix6d> solver(by_image);
    Motion result;
    result.motion = solver.solve(whitened.transpose() * (noise.root * error));
    const Matrix6d covariance = solver.solve(Matrix6d::Identity()) + by_lidar;
    const Eigen::LLT<Matrix6d> factor(0.5 * (covariance + covariance.transpose()));
    if (factor.info() != Eigen::Success) return std::nullopt;
    result.information = factor.solve(Matrix6d::Identity());
    if (!result.motion.allFinite() || !result.information.allFinite()) return std::nullopt;
    return result;
}

}  // namespace

std::optional<OrderChi2> order_chi2(const BoardSet& boards, const std::vector<BoardMatch>& matches,
                                    const Eigen::Isometry3d& pose, double lidar_sigma) {
    constexpr int kSteps = 5;
    OrderChi2 result;
    result.degrees_of_freedom = 6 * static_cast<int>(matches.size()) - 6;
    std::vector<BoardInImage> noise;
    for (const BoardMatch& match : matches) {
        auto board = board_in_image(boards, match, lidar_sigma);
        if (!board) return std::nullopt;
        noise.push_back(*std::move(board));
    }
    Eigen::Isometry3d at = pose;
    for (int step = 0; step < kSteps; ++step) {
        Matrix6d information = Matrix6d::Zero();
        Vector6d weighted = Vector6d::Zero();
        double chi2 = 0.0;
        for (std::size_t m = 0; m < matches.size(); ++m) {
            const auto motion = motion_of(boards, matches[m], noise[m], at);
            if (!motion) {
                if (step == 0) return std::nullopt;
                return result;
            }
            information += motion->information;
            weighted += motion->information * motion->motion;
            chi2 += motion->motion.dot(motion->information * motion->motion);
        }
        // Far from the minimum a step can lead away: what was reached so far holds.
        if (step > 0 && chi2 >= result.chi2) break;
        result.chi2 = chi2;
        at = se3_exp(information.ldlt().solve(weighted)) * at;
    }
    return result;
}

}  // namespace petal
