// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/joint_scenes.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "solvers/detail/verdict.hpp"

namespace petal {
namespace {

constexpr double kOutlierZ = 3.0902;  // one-sided 99.9 %
/// Below this share of the reference a direction did not gain from the scene at all.
constexpr double kNoGain = 1e-6;
/// A pose that is known no better than this (m, rad) is not determined.
constexpr double kUndetermined = 10.0;

bool any_weighted(const JointState& state) {
    const auto below = [](double weight) { return weight < 1.0; };
    return std::any_of(state.board_weights.begin(), state.board_weights.end(), below) ||
           std::any_of(state.point_weights.begin(), state.point_weights.end(), below);
}

}  // namespace

double mahalanobis(const Vector6d& d, const Matrix6d& covariance, const Matrix6d& reference) {
    const Eigen::LLT<Matrix6d> root(reference);
    if (root.info() != Eigen::Success) return 0.0;
    const Matrix6d half = root.matrixL().solve(covariance);
    const Matrix6d unit = root.matrixL().solve(half.transpose());
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(0.5 * (unit + unit.transpose()));
    const Vector6d seen = eigen.eigenvectors().transpose() * root.matrixL().solve(d);
    double squared = 0.0;
    for (int i = 0; i < 6; ++i)
        if (eigen.eigenvalues()[i] > kNoGain) squared += seen[i] * seen[i] / eigen.eigenvalues()[i];
    return std::sqrt(squared);
}

SceneInfluence::SceneInfluence(const JointModel& model, const JointOptions& options,
                               const JointSolution& solution, const JointUncertainty& uncertainty)
    : model_(model),
      options_(options),
      solution_(solution),
      uncertainty_(uncertainty),
      plain_chi2_(solution.chi2),
      scene_chi2_(model.scenes.size(), 0.0),
      scene_numbers_(model.scenes.size(), 0.0) {
    for (std::size_t b = 0; b < model.boards.size(); ++b) {
        scene_chi2_[model.boards[b].scene] += solution.board_chi2[b];
        scene_numbers_[model.boards[b].scene] +=
            6.0 * static_cast<double>(model.boards[b].views.size());
    }
    for (std::size_t i = 0; i < model.points.size(); ++i) {
        scene_chi2_[model.points[i].scene] += solution.point_chi2[i];
        scene_numbers_[model.points[i].scene] += 2.0 / model.points[i].redundancy;
    }
    if (any_weighted(solution.state)) {
        JointOptions plain = options;
        plain.robust_loss = "none";
        JointState start = solution.state;
        std::fill(start.board_weights.begin(), start.board_weights.end(), 1.0);
        std::fill(start.point_weights.begin(), start.point_weights.end(), 1.0);
        if (const auto solved = solve_joint(model, plain, start)) plain_chi2_ = solved->chi2;
    }
    for (std::size_t s = 0; s < model.scenes.size(); ++s) without_.push_back(without(s));
}

SceneInfluence::Without SceneInfluence::without(std::size_t scene) const {
    Without result;
    const std::size_t cameras = model_.cameras.size();
    result.shift.assign(cameras, Vector6d::Zero());
    result.covariance.assign(cameras, Matrix6d::Zero());
    JointOptions options = options_;
    options.without_scene = scene;
    const auto solved = solve_joint(model_, options, solution_.state);
    if (!solved || solved->numbers <= 0.0) return result;
    const JointUncertainty left(model_, options, *solved);
    result.variance_scale = left.variance_scale();
    result.solvable = true;
    for (std::size_t c = 0; c < cameras; ++c) {
        result.covariance[c] = left.covariance_with_offset(c) / left.variance_scale();
        const double largest = std::sqrt(result.covariance[c].diagonal().maxCoeff());
        result.solvable = result.solvable && largest < kUndetermined;
        result.shift[c] =
            se3_log(solved->state.T_camera_lidar[c] * solution_.state.T_camera_lidar[c].inverse());
    }
    if (!result.solvable) {
        std::fill(result.shift.begin(), result.shift.end(), Vector6d::Zero());
        return result;
    }
    // What the scene adds to chi-square: that of its disagreement with all others.
    const double added = (plain_chi2_ - solved->chi2) / left.variance_scale();
    const int numbers = std::max(1, static_cast<int>(std::lround(scene_numbers_[scene])));
    result.outlier = added > chi2_quantile(numbers, kOutlierZ);
    return result;
}

std::vector<Diagnosis::Scene> SceneInfluence::of(std::size_t camera) const {
    const auto influences = uncertainty_.influences();
    const Matrix6d covariance =
        uncertainty_.covariance_with_offset(camera) / uncertainty_.variance_scale();
    std::vector<Diagnosis::Scene> scenes;
    for (std::size_t s = 0; s < model_.scenes.size(); ++s) {
        const Without& left = without_[s];
        Diagnosis::Scene scene;
        scene.scene = model_.scenes[s].number;
        scene.name = model_.scenes[s].name;
        scene.chi2 = scene_chi2_[s];
        scene.degrees_of_freedom = static_cast<int>(std::lround(scene_numbers_[s]));
        scene.influence = influences[s];
        scene.solvable_without = left.solvable;
        scene.outlier = left.outlier;
        if (left.solvable) {
            scene.shift = left.shift[camera];
            // The estimates with and without are correlated: for least squares the covariance of
            // their difference is the difference of their covariances.
            scene.shift_sigmas = mahalanobis(scene.shift, left.covariance[camera] - covariance,
                                             left.covariance[camera]) /
                                 std::sqrt(left.variance_scale);
        }
        scenes.push_back(scene);
    }
    return scenes;
}

}  // namespace petal
