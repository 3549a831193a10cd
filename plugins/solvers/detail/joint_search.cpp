// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/joint_search.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <iterator>
#include <set>
#include <utility>
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
    std::optional<JointSolution> best = solve_joint(input.model, options, start);
    std::vector<JointSolution> others;
    for (std::size_t c = 0; c < minima.size(); ++c)
        for (std::size_t i = 1; i < minima[c].size(); ++i) {
            auto other_start = best ? best->state.T_camera_lidar : start;
            other_start[c] = minima[c][i];
            auto other = solve_joint(input.model, options, other_start);
            if (!other) continue;
            if (!best) {
                best = std::move(other);
                continue;
            }
            if (other->squares < best->squares && input.cameras[c].order.by != DecidedBy::prior)
                std::swap(*best, *other);
            others.push_back(*std::move(other));
        }
    if (!best) return std::nullopt;
    auto told = nearest_other(*best, others);
    return JointMinima{*std::move(best), told};
}

std::optional<JointMinima::Other> nearest_other(const JointSolution& best,
                                                const std::vector<JointSolution>& others) {
    std::optional<JointMinima::Other> nearest;
    for (const JointSolution& other : others) {
        JointMinima::Other told;
        for (std::size_t c = 0; c < best.state.T_camera_lidar.size(); ++c) {
            const Eigen::Isometry3d& a = best.state.T_camera_lidar[c];
            const Eigen::Isometry3d& b = other.state.T_camera_lidar[c];
            const double angle = angle_between(a, b);
            const double distance = (a.translation() - b.translation()).norm();
            if (std::max(angle, distance) <= std::max(told.angle, told.distance)) continue;
            told.camera = c;
            told.angle = angle;
            told.distance = distance;
        }
        if (told.angle < kSamePose && told.distance < kSamePose) continue;
        told.squares = other.squares - best.squares;
        if (!nearest || told.squares < nearest->squares) nearest = told;
    }
    return nearest;
}

std::vector<std::size_t> cameras_without_pose(const JointInput& input) {
    std::vector<std::size_t> lost;
    for (std::size_t c = 0; c < input.cameras.size(); ++c)
        if (camera_minima(input.model.cameras[c], input.cameras[c]).empty()) lost.push_back(c);
    return lost;
}

}  // namespace petal
