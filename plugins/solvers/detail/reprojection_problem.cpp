// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/reprojection_problem.hpp"

#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "petal/calibration/se3.hpp"
#include "petal/error.hpp"
#include "solvers/detail/reprojection_cost.hpp"
#include "solvers/detail/se3_manifold.hpp"

namespace petal {
namespace {

/// Two refined poses nearer than this are one minimum: far above what is left after convergence,
/// far below what separates planar minima.
constexpr double kSameTranslation = 1e-4;  // m
constexpr double kSameRotation = 1e-4;     // rad

void check_pair(const PointPair& pair, std::size_t index) {
    const std::string who = "pair " + std::to_string(index) + " (board " +
                            std::to_string(pair.board) + ", corner " + std::to_string(pair.corner) +
                            ")";
    if (!pair.lidar.allFinite() || !pair.image.allFinite())
        throw Error(who + " holds NaN or infinity; remove it, or repair what detected it");
    const Eigen::Matrix2d& c = pair.covariance;
    if (!c.allFinite() || !(c(0, 0) > 0.0) || !(c.determinant() > 0.0))
        throw Error(who +
                    " has an image covariance that is not positive definite; give px^2, or "
                    "the identity where it is unknown");
}

std::unique_ptr<ceres::LossFunction> make_loss(const RobustLoss& loss) {
    switch (loss.kind) {
        case RobustLoss::Kind::huber:
            return std::make_unique<ceres::HuberLoss>(loss.scale_px);
        case RobustLoss::Kind::cauchy:
            return std::make_unique<ceres::CauchyLoss>(loss.scale_px);
        case RobustLoss::Kind::none:
            break;
    }
    return nullptr;
}

}  // namespace

RobustLoss::Kind RobustLoss::kind_of(const std::string& name) {
    if (name == "none") return Kind::none;
    if (name == "huber") return Kind::huber;
    if (name == "cauchy") return Kind::cauchy;
    throw Error("robust loss '" + name + "' is unknown; use none, huber or cauchy");
}

double RobustLoss::weight(double squared_px) const {
    double rho[3] = {squared_px, 1.0, 0.0};
    if (const auto loss = make_loss(*this)) loss->Evaluate(squared_px, rho);
    return rho[1];
}

ReprojectionProblem::ReprojectionProblem(CameraModel model, std::vector<PointPair> pairs,
                                         bool weigh, RobustLoss loss)
    : model_(std::move(model)), pairs_(std::move(pairs)), loss_(loss) {
    double information = 0.0, variance = 0.0;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
        check_pair(pairs_[i], i);
        information += 0.5 * pairs_[i].covariance.inverse().trace();
        variance += 0.5 * pairs_[i].covariance.trace();
    }
    const auto count = static_cast<double>(pairs_.size());
    if (!pairs_.empty()) unit_variance_ = weigh ? count / information : variance / count;
    for (const PointPair& pair : pairs_) {
        Eigen::Matrix2d root = Eigen::Matrix2d::Identity();
        if (weigh) {
            const Eigen::Matrix2d weight = unit_variance_ * pair.covariance.inverse();
            root = weight.llt().matrixL().transpose();
        }
        sqrt_weights_.push_back(root);
    }
}

std::optional<std::vector<Eigen::Vector2d>> ReprojectionProblem::errors(
    const Eigen::Isometry3d& pose) const {
    std::vector<Eigen::Vector2d> result;
    result.reserve(pairs_.size());
    for (const PointPair& pair : pairs_) {
        const auto pixel = model_.project(pose * pair.lidar);
        if (!pixel) return std::nullopt;
        result.push_back(pair.image - *pixel);
    }
    return result;
}

std::optional<RefinedPose> ReprojectionProblem::evaluate(const Eigen::Isometry3d& pose) const {
    const auto left = errors(pose);
    if (!left || left->empty()) return std::nullopt;
    RefinedPose result{pose, 0.0, 0.0};
    const auto loss = make_loss(loss_);
    for (std::size_t i = 0; i < left->size(); ++i) {
        const double squared = (sqrt_weights_[i] * (*left)[i]).squaredNorm();
        double rho[3] = {squared, 1.0, 0.0};
        if (loss) loss->Evaluate(squared, rho);
        result.cost += 0.5 * rho[0];
        result.rms_px += (*left)[i].squaredNorm();
    }
    result.rms_px = std::sqrt(result.rms_px / static_cast<double>(left->size()));
    if (!std::isfinite(result.cost)) return std::nullopt;
    return result;
}

std::optional<RefinedPose> ReprojectionProblem::refine(const Eigen::Isometry3d& start) const {
    // Asked before Ceres is, which would write its complaint to the terminal.
    if (!start.matrix().allFinite() || !evaluate(start)) return std::nullopt;

    PoseBlock block = to_block(start);
    Se3Manifold manifold;
    const auto loss = make_loss(loss_);
    ceres::Problem::Options owned_here;
    owned_here.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    owned_here.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(owned_here);
    problem.AddParameterBlock(block.data(), 7, &manifold);
    for (std::size_t i = 0; i < pairs_.size(); ++i)
        problem.AddResidualBlock(
            new ReprojectionCost(model_, pairs_[i].lidar, pairs_[i].image, sqrt_weights_[i]),
            loss.get(), block.data());

    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 200;
    options.function_tolerance = 1e-13;
    options.gradient_tolerance = 1e-12;
    options.parameter_tolerance = 1e-12;
    options.num_threads = 1;  // sums in one order: the same bytes on any number of threads
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable()) return std::nullopt;
    return evaluate(to_pose(block.data()));
}

std::vector<RefinedPose> ReprojectionProblem::refine_all(
    const std::vector<Eigen::Isometry3d>& starts) const {
    std::vector<RefinedPose> minima;
    for (const Eigen::Isometry3d& start : starts)
        if (const auto refined = refine(start)) minima.push_back(*refined);
    std::stable_sort(minima.begin(), minima.end(),
                     [](const RefinedPose& a, const RefinedPose& b) { return a.cost < b.cost; });
    std::vector<RefinedPose> distinct;
    for (const RefinedPose& pose : minima) {
        const bool known =
            std::any_of(distinct.begin(), distinct.end(), [&](const RefinedPose& other) {
                const Eigen::Isometry3d between =
                    pose.T_camera_lidar * other.T_camera_lidar.inverse();
                return between.translation().norm() < kSameTranslation &&
                       rotation_angle(between.linear()) < kSameRotation;
            });
        if (!known) distinct.push_back(pose);
    }
    return distinct;
}

}  // namespace petal
