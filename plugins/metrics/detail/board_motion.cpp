// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/board_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "metrics/detail/plate_edges.hpp"
#include "metrics/detail/plate_rays.hpp"
#include "metrics/detail/shown_edges.hpp"
#include "petal/calibration/for_pieces.hpp"
#include "petal/printed.hpp"

namespace petal {
namespace {

constexpr double kMotionBorder = 0.03;      // m around the board that is looked at
constexpr double kMotionBand = 0.025;       // m on either side of an edge
constexpr double kMotionFromEdge = 0.015;   // m: nearer points may be mixed with what lies behind
constexpr double kMotionPlaneDepth = 0.05;  // m
constexpr double kFloorSigma = 0.0002;  // m: what patterns that differ from split to split leave

/// The standard normal's upper quantile for a small probability, by bisection of erfc.
double normal_quantile(double probability) {
    double low = 0.0, high = 10.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (std::erfc(middle / std::sqrt(2.0)) > probability ? low : high) = middle;
    }
    return low;
}

/// The motion of a point of the board, at `from` its middle in the board's plane.
Eigen::Matrix<double, 3, 6> motion_of_point(const Eigen::Vector2d& from) {
    const Eigen::Vector3d arm(from.x(), from.y(), 0.0);
    Eigen::Matrix<double, 3, 6> by;
    by << Eigen::Matrix3d::Identity(), -skew(arm);
    return by;
}

struct PairOfSplits {
    Vector6d value;
    Matrix6d covariance;
    bool sideways;
};

PairOfSplits between(const SplitPose& a, const SplitPose& b) {
    return {b.value - a.value, a.covariance + b.covariance, a.sideways && b.sideways};
}

/// Whether one of the numbers is motion; the lever turns rotations into metres.
bool is_motion(const PairOfSplits& pair, double lever, double bound, double least) {
    constexpr std::array<int, 6> kAlong = {2, 3, 4, 0, 1, 5};
    const std::size_t known = pair.sideways ? 6 : 3;
    for (std::size_t k = 0; k < known; ++k) {
        const int i = kAlong[k];
        const double scale = i < 3 ? 1.0 : lever;
        const double size = scale * std::abs(pair.value(i));
        if (size > least && size > bound * scale * std::sqrt(pair.covariance(i, i))) return true;
    }
    return false;
}

/// The pose of a split from its plane and, where its edges tell, its shift; the lever (m) turns the
/// floor of its sigma into one of rotations.
SplitPose split_pose(const PlatePlane& plane, const std::optional<PlateShift>& shift,
                     double lever) {
    SplitPose pose;
    // z = value + by_x x + by_y y: turning about x lifts y, about y it lowers x.
    Eigen::Matrix<double, 6, 3> by_plane = Eigen::Matrix<double, 6, 3>::Zero();
    by_plane(2, 0) = by_plane(3, 2) = 1.0;
    by_plane(4, 1) = -1.0;
    pose.value = by_plane * plane.value;
    pose.covariance = by_plane * plane.covariance * by_plane.transpose();
    if (shift) {
        Eigen::Matrix<double, 6, 3> by_shift = Eigen::Matrix<double, 6, 3>::Zero();
        by_shift(0, 0) = by_shift(1, 1) = by_shift(5, 2) = 1.0;
        pose.value += by_shift * shift->value;
        pose.covariance += by_shift * shift->covariance * by_shift.transpose();
        pose.sideways = true;
    }
    const double floor = kFloorSigma * kFloorSigma;
    pose.covariance.diagonal().head<3>().array() += floor;
    pose.covariance.diagonal().tail<3>().array() += floor / (lever * lever);
    return pose;
}

}  // namespace

TimeSplits time_splits(const Cloud& cloud, double shortest, std::size_t most, std::string& why) {
    TimeSplits splits;
    if (cloud.parts.size() < 2) {
        why = "the cloud is one message, or its messages are not known";
        return splits;
    }
    const double first = mrpt::Clock::toDouble(cloud.parts.front().stamp);
    const double last = mrpt::Clock::toDouble(cloud.parts.back().stamp);
    const double message = (last - first) / static_cast<double>(cloud.parts.size() - 1);
    const bool in_order = std::is_sorted(
        cloud.parts.begin(), cloud.parts.end(),
        [](const Cloud::Part& a, const Cloud::Part& b) { return a.stamp < b.stamp; });
    if (!in_order || !(message > 0.0)) {
        why = "the messages have no times, or stand in no order of time";
        return splits;
    }
    const double duration = last - first + message;
    const std::size_t count =
        std::min(most, static_cast<std::size_t>(std::floor(duration / shortest + 1e-3)));
    if (count < 2) {
        why = printed("the capture lasts %.2f s, less than two splits", duration);
        return splits;
    }
    splits.length = duration / static_cast<double>(count);
    splits.begins.push_back(0);
    for (const Cloud::Part& part : cloud.parts) {
        const double time = mrpt::Clock::toDouble(part.stamp) - first + 1e-6;
        while (splits.begins.size() < count &&
               time >= splits.length * static_cast<double>(splits.begins.size()))
            splits.begins.push_back(part.begin);
    }
    splits.begins.resize(count, cloud.size());
    splits.begins.push_back(cloud.size());
    return splits;
}

std::vector<std::optional<SplitPose>> split_poses(const Run& run, const Cloud& cloud,
                                                  const TimeSplits& splits, const LidarBoard& board,
                                                  const Target& target) {
    std::vector<std::optional<SplitPose>> poses(splits.size());
    const PlateEdges edges(target);
    auto rays =
        plate_rays(run, cloud, board.T_lidar_board, edges.width(), edges.height(), kMotionBorder);
    const auto whole = plate_plane(rays, edges, kMotionFromEdge, kMotionPlaneDepth);
    if (!whole) return poses;
    flatten(rays, *whole, edges.middle());
    const double depth = std::clamp(3.5 * whole->rms, 0.01, 0.05);

    std::vector<std::optional<PlatePlane>> planes(splits.size());
    std::vector<std::vector<EdgeRay>> beside(splits.size());
    for_pieces(run, splits.size(), 1, [&](std::size_t k, std::size_t end) {
        // Rays stand in the order of their points, as splits do.
        const auto from = [&](std::size_t split) {
            return std::partition_point(rays.begin(), rays.end(), [&](const PlateRay& ray) {
                return ray.point < splits.begins[split];
            });
        };
        for (; k < end; ++k) {
            std::vector<PlateRay> own(from(k), from(k + 1));
            planes[k] = plate_plane(own, edges, kMotionFromEdge, depth);
            if (planes[k]) flatten(own, *planes[k], edges.middle());
            beside[k] = edge_rays(own, edges, kMotionBand, depth);
        }
    });
    std::vector<EdgeRay> all;
    for (std::size_t k = 0; k < splits.size(); ++k)
        if (planes[k]) all.insert(all.end(), beside[k].begin(), beside[k].end());
    const auto shown = shown_edges(run, all, edges.edges().size());
    const double lever = 0.5 * std::hypot(edges.width(), edges.height());
    for_pieces(run, splits.size(), 1, [&](std::size_t k, std::size_t end) {
        for (; k < end; ++k)
            if (planes[k])
                poses[k] =
                    split_pose(*planes[k], plate_shift(beside[k], shown, edges.middle()), lever);
    });
    return poses;
}

std::optional<BoardMotion> board_motion(const std::vector<std::optional<SplitPose>>& poses,
                                        double half_width, double half_height, double sigmas,
                                        double least) {
    const auto known = std::count_if(poses.begin(), poses.end(),
                                     [](const auto& pose) { return pose.has_value(); });
    if (known < 2) return std::nullopt;
    const double comparisons = 6.0 * 0.5 * static_cast<double>(known * (known - 1));
    const double bound =
        normal_quantile(std::erfc(sigmas / std::sqrt(2.0)) / std::max(1.0, comparisons));
    const double lever = 0.5 * (half_width + half_height);

    BoardMotion largest;
    std::vector<std::vector<bool>> moves(poses.size(), std::vector<bool>(poses.size(), false));
    for (std::size_t a = 0; a < poses.size(); ++a)
        for (std::size_t b = a + 1; b < poses.size(); ++b) {
            if (!poses[a] || !poses[b]) continue;
            const PairOfSplits pair = between(*poses[a], *poses[b]);
            const bool moved = is_motion(pair, lever, bound, least);
            moves[a][b] = moved;
            for (const double x : {0.0, -half_width, half_width})
                for (const double y : {0.0, -half_height, half_height}) {
                    if ((x == 0.0) != (y == 0.0)) continue;  // the middle and the corners
                    const auto by = motion_of_point({x, y});
                    const Eigen::Vector3d motion = by * pair.value;
                    const Eigen::Matrix3d covariance = by * pair.covariance * by.transpose();
                    const double length = motion.norm();
                    const double sigma =
                        std::sqrt(motion.dot(covariance * motion)) / std::max(length, 1e-12);
                    // Of points that move alike the surest is told: a corner only where turning
                    // makes it move clearly farther than the middle does.
                    const double sure = length - sigma;
                    const bool better =
                        moved != largest.moved ? moved : sure > largest.length - largest.sigma;
                    if (!better && largest.sigma > 0.0) continue;
                    largest.length = length;
                    largest.sigma = sigma;
                    largest.from = a;
                    largest.to = b;
                    largest.moved = moved;
                }
        }
    for (std::size_t begin = 0; begin < poses.size(); ++begin) {
        if (!poses[begin]) continue;
        std::size_t end = begin + 1;
        const auto still = [&](std::size_t next) {
            if (!poses[next]) return false;  // nobody knows
            for (std::size_t k = begin; k < next; ++k)
                if (moves[k][next]) return false;
            return true;
        };
        while (end < poses.size() && still(end)) ++end;
        if (end - begin > largest.still_end - largest.still_begin) {
            largest.still_begin = begin;
            largest.still_end = end;
        }
    }
    return largest;
}

}  // namespace petal
