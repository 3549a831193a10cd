// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/joint_search.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <iterator>
#include <set>
#include <vector>

#include "solvers/detail/pose_starts.hpp"
#include "solvers/detail/reprojection_problem.hpp"

namespace petal {
namespace {

/// Corners alone weigh the LiDAR's noise wrongly: a minimum this many times worse on them may still
/// be the better one of the joint problem.
constexpr double kSimilarRms = 3.0;
constexpr std::size_t kMostMinima = 3;
/// Nearer than this (m, rad) two solutions are one: far above what is left after convergence.
constexpr double kSamePose = 1e-3;

double angle_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    return rotation_angle(a.linear().transpose() * b.linear());
}

/// Where one camera's pose may lie, the best first.
std::vector<Eigen::Isometry3d> camera_minima(const CameraModel& model, const SolveInput& input) {
    const ReprojectionProblem problem(model, input.pairs);
    std::set<int> boards;
    bool single_points = false;
    for (const PointPair& pair : input.pairs) {
        if (pair.board >= 0) boards.insert(pair.board);
        single_points = single_points || pair.board < 0;
    }
    auto starts = input.initial;
    if (starts.empty() || (boards.size() < 2 && !single_points)) {
        const auto own = pose_starts(model, input.pairs);
        starts.insert(starts.end(), own.begin(), own.end());
    }
    auto refined = problem.refine_all(starts);
    if (refined.empty()) return {};
    const double most = kSimilarRms * refined.front().rms_px + 1e-6;
    if (input.order.by == DecidedBy::prior && !input.initial.empty()) {
        const auto nearest =
            std::min_element(refined.begin(), refined.end(), [&](const auto& a, const auto& b) {
                return angle_between(a.T_camera_lidar, input.initial.front()) <
                       angle_between(b.T_camera_lidar, input.initial.front());
            });
        std::rotate(refined.begin(), nearest, std::next(nearest));
    }
    std::vector<Eigen::Isometry3d> minima;
    for (const RefinedPose& pose : refined)
        if (minima.empty() || (pose.rms_px < most && minima.size() < kMostMinima))
            minima.push_back(pose.T_camera_lidar);
    return minima;
}

}  // namespace

std::optional<JointMinima> search_joint(const JointInput& input, const JointOptions& options) {
    std::vector<std::vector<Eigen::Isometry3d>> minima;
    std::vector<Eigen::Isometry3d> start;
    for (std::size_t c = 0; c < input.cameras.size(); ++c) {
        minima.push_back(camera_minima(input.model.cameras[c], input.cameras[c]));
        if (minima.back().empty()) return std::nullopt;
        start.push_back(minima.back().front());
    }
    std::optional<JointMinima> found;
    if (auto solution = solve_joint(input.model, options, start))
        found = JointMinima{*std::move(solution), std::nullopt};
    for (std::size_t c = 0; c < minima.size(); ++c)
        for (std::size_t i = 1; i < minima[c].size(); ++i) {
            auto other_start = found ? found->best.state.T_camera_lidar : start;
            other_start[c] = minima[c][i];
            auto other = solve_joint(input.model, options, other_start);
            if (!other) continue;
            if (!found) {
                found = JointMinima{*std::move(other), std::nullopt};
                continue;
            }
            const Eigen::Isometry3d a = found->best.state.T_camera_lidar[c];
            const Eigen::Isometry3d b = other->state.T_camera_lidar[c];
            JointMinima::Other told{c, angle_between(a, b),
                                    (a.translation() - b.translation()).norm(),
                                    other->squares - found->best.squares};
            if (told.angle < kSamePose && told.distance < kSamePose) continue;
            if (told.squares < 0.0 && input.cameras[c].order.by != DecidedBy::prior) {
                found->best = *std::move(other);
                told.squares = -told.squares;
            }
            if (!found->other || told.squares < found->other->squares) found->other = told;
        }
    return found;
}

}  // namespace petal
