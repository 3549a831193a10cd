// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/extrinsics_estimate.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/se3.hpp"
#include "petal/error.hpp"
#include "petal/printed.hpp"
#include "solvers/detail/reprojection_cost.hpp"

namespace petal {
namespace {

/// Directions that the pairs do not observe get this 1-sigma (m or rad) instead of infinity.
constexpr double kUnobservedSigma = 1e3;

/// s^2 times the inverse, with the eigenvalues kept away from zero.
Matrix6d bounded_inverse(const Matrix6d& information, double variance) {
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(information);
    const double least = variance / (kUnobservedSigma * kUnobservedSigma);
    const Vector6d values = eigen.eigenvalues().cwiseMax(least);
    const Matrix6d inverse = eigen.eigenvectors() *
                             (variance * values.cwiseInverse()).asDiagonal() *
                             eigen.eigenvectors().transpose();
    return 0.5 * (inverse + inverse.transpose());
}

/// s0^2 from the squared 2-D residuals: their median is 2 ln 2 s0^2 for Gaussian noise. Unlike the
/// mean it does not grow with one wrong corner. Corrected for the six numbers that the pose took.
double unit_weight_variance(std::vector<double> squares) {
    std::sort(squares.begin(), squares.end());
    const std::size_t half = squares.size() / 2;
    const double median =
        squares.size() % 2 == 1 ? squares[half] : 0.5 * (squares[half - 1] + squares[half]);
    const double numbers = 2.0 * static_cast<double>(squares.size());
    const double freedom = std::max(1.0, numbers - 6.0);
    return median / (2.0 * std::log(2.0)) * numbers / freedom;
}

std::string length_text(double metres) {
    return metres < 0.1 ? printed("%.1f mm", metres * 1e3) : printed("%.2f m", metres);
}

std::string angle_text(double radians) {
    const double degrees = radians * kDegrees;
    return degrees < 0.1 ? printed("%.3f deg", degrees) : printed("%.2f deg", degrees);
}

/// "x axis", or "x and z axes" where no single one holds nearly all of the vector.
std::string axes_text(const Eigen::Vector3d& v) {
    const char* const names[] = {"x", "y", "z"};
    std::string text;
    int count = 0;
    for (int i = 0; i < 3; ++i) {
        if (std::abs(v[i]) < 0.4 * v.norm()) continue;
        text += (count++ == 0 ? "" : " and ") + std::string(names[i]);
    }
    return text + (count > 1 ? " axes" : " axis");
}

std::string turn_text(const Eigen::Vector3d& v) {
    const Eigen::Vector3d size = v.cwiseAbs();
    if (size.x() > 0.9 * v.norm()) return "tilting";
    if (size.z() > 0.9 * v.norm()) return "rolling";
    return "turning";
}

}  // namespace

CameraExtrinsics estimate(const SolveInput& input, const ReprojectionProblem& problem,
                          const Eigen::Isometry3d& pose, const UncertaintyParams& params) {
    const auto errors = problem.errors(pose);
    if (!errors)
        throw Error(
            "camera '" + input.camera +
            "': a pair does not project into the image at the pose that was found; check the "
            "pairs and the intrinsics");
    CameraExtrinsics camera;
    camera.camera = input.camera;
    camera.lidar = input.lidar;
    camera.model = problem.model().camera();
    camera.T_camera_lidar = pose;
    camera.order = input.order;

    Matrix6d information = Matrix6d::Zero();
    std::vector<double> squares;
    const double unit = params.sigma_px * params.sigma_px;
    for (std::size_t i = 0; i < errors->size(); ++i) {
        const PointPair& pair = problem.pairs()[i];
        const Eigen::Vector2d& error = (*errors)[i];
        const Eigen::Vector3d p = pose * pair.lidar;
        Eigen::Matrix<double, 2, 3> by_point;
        problem.model().project(p, &by_point);
        const Eigen::Matrix2d& root = problem.sqrt_weight(i);
        const Eigen::Vector2d weighted = root * error;
        const double redundancy = pair.board >= 0 ? 1.0 / params.board_redundancy : 1.0;
        const double trusted = redundancy * problem.loss().weight(weighted.squaredNorm());
        const Eigen::Matrix<double, 2, 6> jacobian = root * projection_jacobian(by_point, p);
        information += trusted * jacobian.transpose() * jacobian;
        squares.push_back(weighted.squaredNorm());
        camera.chi2 += redundancy * error.dot(pair.covariance.llt().solve(error)) / unit;
        camera.residuals.push_back({input.origins[i].scene, input.origins[i].board,
                                    input.origins[i].corner, pair.image, error});
    }
    double independent = 0.0;
    for (const PointPair& pair : problem.pairs())
        independent += pair.board >= 0 ? 2.0 / params.board_redundancy : 2.0;
    camera.degrees_of_freedom = std::max(0, static_cast<int>(std::lround(independent)) - 6);

    const double variance =
        std::max(unit_weight_variance(squares), params.min_sigma_px * params.min_sigma_px);
    camera.covariance = bounded_inverse(information, variance);

    const Matrix6d column = column_covariance(camera);
    camera.sigma_translation = column.diagonal().head<3>().cwiseMax(0.0).cwiseSqrt();
    camera.sigma_rotation = column.diagonal().tail<3>().cwiseMax(0.0).cwiseSqrt();
    return camera;
}

std::string describe_weakest(const Matrix6d& covariance, double rotation_per_m) {
    Vector6d scale = Vector6d::Ones();
    scale.tail<3>().setConstant(1.0 / rotation_per_m);
    const Matrix6d scaled = scale.asDiagonal() * covariance * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(scaled);
    const Vector6d one_sigma = std::sqrt(std::max(0.0, eigen.eigenvalues()[5])) *
                               scale.cwiseInverse().asDiagonal() * eigen.eigenvectors().col(5);
    const Eigen::Vector3d shift = one_sigma.head<3>(), turn = one_sigma.tail<3>();
    const std::string shifting =
        "a shift along the camera's " + axes_text(shift) + " (" + length_text(shift.norm()) + ")";
    const std::string turning = turn_text(turn) + " about the camera's " + axes_text(turn) + " (" +
                                angle_text(turn.norm()) + ")";
    const double shift_part = shift.norm() * rotation_per_m, turn_part = turn.norm();
    if (turn_part < 0.1 * shift_part) return shifting + ", 1 sigma";
    if (shift_part < 0.1 * turn_part) return turning + ", 1 sigma";
    return turning + " together with " + shifting + ", 1 sigma";
}

}  // namespace petal
