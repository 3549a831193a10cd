// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/joint_solve.hpp"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>

#include "solvers/detail/joint_cost.hpp"
#include "solvers/detail/se3_manifold.hpp"
#include "solvers/detail/verdict.hpp"

namespace petal {
namespace {

constexpr double kLossZ = 2.3263;  // one-sided 99 %: of clean boards one in a hundred
constexpr int kMostRounds = 30;    // of solving and weighting
constexpr double kSameWeights = 1e-4;

bool taken(const JointOptions& options, std::size_t scene) {
    return !options.without_scene || *options.without_scene != scene;
}

/// Ceres without a say in who deletes the manifold, on one thread, silent.
struct QuietProblem {
    Se3Manifold manifold;
    ceres::Problem problem{[] {
        ceres::Problem::Options owned_here;
        owned_here.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
        return owned_here;
    }()};

    bool solve(ceres::LinearSolverType type) {
        ceres::Solver::Options options;
        options.linear_solver_type = type;
        options.max_num_iterations = 100;
        options.function_tolerance = 1e-12;
        options.gradient_tolerance = 1e-12;
        options.parameter_tolerance = 1e-12;
        options.num_threads = 1;  // sums in one order: the same bytes on any number of threads
        options.logging_type = ceres::SILENT;
        ceres::Solver::Summary summary;
        ceres::Solve(options, &problem, &summary);
        return summary.IsSolutionUsable();
    }
};

/// The whitened square of a view at the pose of the board that fits it alone, near the joint one.
/// With the board held, the perturbation of the camera's pose moves the board in the image freely.
double least_alone(const CameraModel& model, const JointBoard::View& view,
                   const Eigen::Isometry3d& T_camera_lidar, const Eigen::Isometry3d& T_lidar_board,
                   double focal) {
    QuietProblem alone;
    PoseBlock camera = to_block(T_camera_lidar), board = to_block(T_lidar_board);
    alone.problem.AddParameterBlock(camera.data(), 7, &alone.manifold);
    alone.problem.AddResidualBlock(new BoardViewCost(model, view, 1.0), nullptr, camera.data(),
                                   board.data(), &focal);
    alone.problem.SetParameterBlockConstant(board.data());
    alone.problem.SetParameterBlockConstant(&focal);
    alone.solve(ceres::DENSE_QR);
    ViewLinear linear;
    linearise(model, view, to_pose(camera.data()), T_lidar_board, focal, linear);
    return linear.error.squaredNorm();
}

double loss_weight(const std::string& loss, double chi2, double numbers) {
    if (loss == "none") return 1.0;
    const double limit = chi2_quantile(std::max(1, static_cast<int>(std::lround(numbers))), kLossZ);
    if (loss == "cauchy") return 1.0 / (1.0 + chi2 / limit);
    return chi2 <= limit ? 1.0 : std::sqrt(limit / chi2);
}

class JointSolver {
   public:
    JointSolver(const JointModel& model, const JointOptions& options)
        : model_(model), options_(options) {}

    std::optional<JointSolution> from(JointState state) {
        for (int round = 0; round < kMostRounds; ++round) {
            if (options_.poll) options_.poll();
            if (!whiten_points(state) || !projects(state) || !refine(state)) return std::nullopt;
            JointSolution solution = figures(state);
            const JointState before = state;
            weigh(solution, state);
            if (round + 1 == kMostRounds || unchanged(before, state)) return solution;
        }
        return std::nullopt;
    }

   private:
    bool whiten_points(const JointState& state) {
        point_whitening_.assign(model_.points.size(), Eigen::Matrix2d::Identity());
        for (std::size_t i = 0; i < model_.points.size(); ++i) {
            const JointPoint& point = model_.points[i];
            PointLinear linear;
            if (!linearise(model_.cameras[point.camera], point, model_.point_sigma,
                           state.T_camera_lidar[point.camera], state.focal[point.camera],
                           state.range_offset, linear))
                return false;
            point_whitening_[i] = linear.whitening;
        }
        return true;
    }

    /// Asked before Ceres is, which would write its complaint to the terminal.
    bool projects(const JointState& state) const {
        for (std::size_t b = 0; b < model_.boards.size(); ++b)
            for (const auto& view : model_.boards[b].views) {
                ViewLinear linear;
                if (!linearise(model_.cameras[view.camera], view, state.T_camera_lidar[view.camera],
                               state.T_lidar_board[b], state.focal[view.camera], linear) ||
                    !linear.error.allFinite())
                    return false;
            }
        return true;
    }

    bool refine(JointState& state) const {
        std::vector<PoseBlock> cameras, boards;
        for (const auto& pose : state.T_camera_lidar) cameras.push_back(to_block(pose));
        for (const auto& pose : state.T_lidar_board) boards.push_back(to_block(pose));
        QuietProblem joint;
        ceres::Problem& problem = joint.problem;
        for (std::size_t c = 0; c < cameras.size(); ++c) {
            problem.AddParameterBlock(cameras[c].data(), 7, &joint.manifold);
            problem.AddParameterBlock(&state.focal[c], 1);
            if (c >= options_.free_focal.size() || !options_.free_focal[c])
                problem.SetParameterBlockConstant(&state.focal[c]);
        }
        problem.AddResidualBlock(new ZeroPriorCost(options_.range_offset_sigma), nullptr,
                                 &state.range_offset);
        for (std::size_t b = 0; b < boards.size(); ++b) {
            const JointBoard& board = model_.boards[b];
            if (!taken(options_, board.scene)) continue;
            problem.AddParameterBlock(boards[b].data(), 7, &joint.manifold);
            problem.AddResidualBlock(new BoardPoseCost(board, state.board_weights[b]), nullptr,
                                     boards[b].data(), &state.range_offset);
            for (const auto& view : board.views)
                problem.AddResidualBlock(
                    new BoardViewCost(model_.cameras[view.camera], view, state.board_weights[b]),
                    nullptr, cameras[view.camera].data(), boards[b].data(),
                    &state.focal[view.camera]);
        }
        for (std::size_t i = 0; i < model_.points.size(); ++i) {
            const JointPoint& point = model_.points[i];
            if (!taken(options_, point.scene)) continue;
            problem.AddResidualBlock(
                new JointPointCost(model_.cameras[point.camera], point, point_whitening_[i],
                                   state.point_weights[i]),
                nullptr, cameras[point.camera].data(), &state.focal[point.camera],
                &state.range_offset);
        }
        if (options_.prior)
            problem.AddResidualBlock(
                new TranslationPriorCost(options_.prior->translation, options_.prior->sigma),
                nullptr, cameras[options_.prior->camera].data());
        if (!joint.solve(ceres::DENSE_SCHUR)) return false;
        for (std::size_t c = 0; c < cameras.size(); ++c)
            state.T_camera_lidar[c] = to_pose(cameras[c].data());
        for (std::size_t b = 0; b < boards.size(); ++b)
            state.T_lidar_board[b] = to_pose(boards[b].data());
        return true;
    }

    JointSolution figures(const JointState& state) const {
        JointSolution solution;
        solution.state = state;
        const double offset = state.range_offset / options_.range_offset_sigma;
        solution.chi2 = solution.squares = offset * offset;
        solution.board_chi2.assign(model_.boards.size(), 0.0);
        solution.point_chi2.assign(model_.points.size(), 0.0);
        for (std::size_t b = 0; b < model_.boards.size(); ++b) {
            const JointBoard& board = model_.boards[b];
            if (!taken(options_, board.scene)) continue;
            const Eigen::Isometry3d& pose = state.T_lidar_board[b];
            double& chi2 = solution.board_chi2[b];
            chi2 = linearise(board, pose, state.range_offset).error.squaredNorm();
            solution.squares += chi2;
            for (const auto& view : board.views) {
                const CameraModel& model = model_.cameras[view.camera];
                const Eigen::Isometry3d& camera = state.T_camera_lidar[view.camera];
                const double focal = state.focal[view.camera];
                ViewLinear linear;
                linearise(model, view, camera, pose, focal, linear);
                solution.squares += linear.error.squaredNorm();
                chi2 += std::max(0.0, linear.error.squaredNorm() -
                                          least_alone(model, view, camera, pose, focal));
            }
            solution.chi2 += chi2;
            solution.numbers += 6.0 * static_cast<double>(board.views.size());
        }
        for (std::size_t i = 0; i < model_.points.size(); ++i) {
            const JointPoint& point = model_.points[i];
            if (!taken(options_, point.scene)) continue;
            PointLinear linear;
            linearise(model_.cameras[point.camera], point, model_.point_sigma,
                      state.T_camera_lidar[point.camera], state.focal[point.camera],
                      state.range_offset, linear, &point_whitening_[i]);
            solution.point_chi2[i] = state.point_weights[i] * linear.error.squaredNorm();
            solution.chi2 += solution.point_chi2[i];
            solution.squares += solution.point_chi2[i];
            solution.numbers += 2.0 / point.redundancy;
        }
        return solution;
    }

    void weigh(const JointSolution& solution, JointState& state) const {
        for (std::size_t b = 0; b < model_.boards.size(); ++b)
            state.board_weights[b] =
                loss_weight(options_.robust_loss, solution.board_chi2[b],
                            6.0 * static_cast<double>(model_.boards[b].views.size()));
        for (std::size_t i = 0; i < model_.points.size(); ++i)
            state.point_weights[i] =
                loss_weight(options_.robust_loss,
                            solution.point_chi2[i] * model_.points[i].redundancy /
                                solution.state.point_weights[i],
                            2.0);
    }

    static bool unchanged(const JointState& a, const JointState& b) {
        const auto near = [](double x, double y) { return std::abs(x - y) < kSameWeights; };
        return std::equal(a.board_weights.begin(), a.board_weights.end(), b.board_weights.begin(),
                          near) &&
               std::equal(a.point_weights.begin(), a.point_weights.end(), b.point_weights.begin(),
                          near);
    }

    const JointModel& model_;
    const JointOptions& options_;
    std::vector<Eigen::Matrix2d> point_whitening_;
};

}  // namespace

std::optional<JointSolution> solve_joint(const JointModel& model, const JointOptions& options,
                                         const JointState& start) {
    return JointSolver(model, options).from(start);
}

std::optional<JointSolution> solve_joint(const JointModel& model, const JointOptions& options,
                                         const std::vector<Eigen::Isometry3d>& T_camera_lidar) {
    JointState start;
    start.T_camera_lidar = T_camera_lidar;
    for (const JointBoard& board : model.boards) start.T_lidar_board.push_back(board.T_lidar_board);
    start.focal.assign(model.cameras.size(), 1.0);
    start.board_weights.assign(model.boards.size(), 1.0);
    start.point_weights.assign(model.points.size(), 1.0);
    return solve_joint(model, options, start);
}

}  // namespace petal
