// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/board_line_finder.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "petal/printed.hpp"

namespace petal {
namespace {

constexpr std::size_t kPlacementsTried = 3;
constexpr std::size_t kMinPatternPoints = 3;  ///< on a line whose direction and place are known
constexpr double kPlainTolerance = 0.018;     ///< m: a point is on a side, plain lines
constexpr double kWallShare =
    0.125;  ///< of what is seen of a hole's wall, 1 sigma of the board's shift
constexpr double kPlateSigma = 0.00015;   ///< m: of a plate's place however many points tell it
constexpr double kInflationSigma = 0.02;  ///< m: of d about zero; edges move by about half a beam

/// A line in the form normal . p = at.
struct NormalForm {
    Eigen::Vector2d normal;
    double at;
};

NormalForm normal_form(const Eigen::Vector2d& direction, const Eigen::Vector2d& point) {
    const Eigen::Vector2d normal(-direction.y(), direction.x());
    return {normal, normal.dot(point)};
}

Eigen::Vector2d crossing(const NormalForm& a, const NormalForm& b) {
    const double det = a.normal.x() * b.normal.y() - a.normal.y() * b.normal.x();
    return {(a.at * b.normal.y() - b.at * a.normal.y()) / det,
            (b.at * a.normal.x() - a.at * b.normal.x()) / det};
}

/// The lines of a family that have at least one covered side.
std::size_t covered_lines(const HoleGrid& grid, const PatternScore& score, bool vertical,
                          double min_coverage) {
    std::set<std::size_t> lines;
    for (std::size_t h = 0; h < grid.holes.size(); ++h) {
        const HoleGrid::Hole& hole = grid.holes[h];
        const std::size_t first = 4 * h + (vertical ? 0 : 2);
        if (score.coverages[first] >= min_coverage) lines.insert(vertical ? hole.left : hole.top);
        if (score.coverages[first + 1] >= min_coverage)
            lines.insert(vertical ? hole.right : hole.bottom);
    }
    return lines.size();
}

std::vector<Eigen::Vector2d> place_corners(const HoleGrid& grid, const PatternPose& pose) {
    const Eigen::Rotation2Dd turn(pose.angle);
    std::vector<Eigen::Vector2d> placed;
    for (const auto& corner : grid.corners) placed.push_back(pose.origin + turn * corner);
    return placed;
}

Eigen::Isometry3d to_lidar(const PatternPose& pose, const Eigen::Isometry3d& frame) {
    Eigen::Isometry3d in_plane = Eigen::Isometry3d::Identity();
    in_plane.linear() = Eigen::AngleAxisd(pose.angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    in_plane.translation() << pose.origin, 0.0;
    return frame * in_plane;
}

/// The rigid motion that brings `from` nearest to `to`.
PatternPose rigid_fit(const std::vector<Eigen::Vector2d>& from,
                      const std::vector<Eigen::Vector2d>& to) {
    Eigen::Vector2d mean_from = Eigen::Vector2d::Zero(), mean_to = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < from.size(); ++i) {
        mean_from += from[i] / static_cast<double>(from.size());
        mean_to += to[i] / static_cast<double>(from.size());
    }
    double cosine = 0.0, sine = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        const Eigen::Vector2d a = from[i] - mean_from, b = to[i] - mean_to;
        cosine += a.dot(b);
        sine += a.x() * b.y() - a.y() * b.x();
    }
    PatternPose pose;
    pose.angle = std::atan2(sine, cosine);
    pose.origin = mean_to - Eigen::Rotation2Dd(pose.angle) * mean_from;
    return pose;
}

}  // namespace

BoardFinder::BoardFinder(const HoleGrid& grid, const BoardFinderParams& params)
    : grid_(grid), params_(params) {}

BoardAttempt BoardFinder::find(const std::vector<Eigen::Vector3d>& points,
                               const Eigen::Isometry3d& frame, const PlatePoints& plate_points,
                               Rng& rng, const std::function<void()>& poll) const {
    BoardAttempt attempt;
    const Eigen::Isometry3d to_plane = frame.inverse();
    attempt.points.reserve(points.size());
    for (const Eigen::Vector3d& p : points) attempt.points.push_back((to_plane * p).head<2>());

    LineSearchParams search;
    search.line_threshold = params_.line_threshold;
    search.min_points = static_cast<std::size_t>(params_.min_line_points);
    search.reach = std::max(grid_.width, grid_.height);
    search.max_lines = 2 * (grid_.x.size() + grid_.y.size() + 4);
    attempt.lines = find_lines(attempt.points, search, rng, poll);
    const std::optional<LineSplit> split = split_lines(attempt.lines);
    attempt.threshold = printed("%zu + %zu lines of at least min_line_points %d points",
                                grid_.x.size(), grid_.y.size(), params_.min_line_points);
    if (!split) {
        attempt.miss = printed("no line among %zu points", points.size());
        return attempt;
    }
    const auto placements =
        place_pattern(grid_, split->angle, attempt.points, params_.max_inflation, kPlacementsTried);
    if (params_.use_target_spacing) {
        fit_spaced(attempt, placements, points, frame, plate_points);
    } else {
        fit_plain(attempt, placements, *split, frame);
    }
    return attempt;
}

void BoardFinder::fit_spaced(BoardAttempt& attempt, const std::vector<ScoredPattern>& placements,
                             const std::vector<Eigen::Vector3d>& points,
                             const Eigen::Isometry3d& frame,
                             const PlatePoints& plate_points) const {
    std::optional<BoardFit> best;
    for (const ScoredPattern& placement : placements) {
        auto fit = refine_board(grid_, points, {}, to_lidar(placement.pose, frame),
                                placement.pose.inflation, kInflationSigma);
        if (fit && (!best || fit->score.value > best->score.value)) best = std::move(fit);
    }
    if (!best) {
        attempt.corners = place_corners(grid_, placements.front().pose);
        accept(attempt, placements.front().score, placements.front().pose.inflation);
        return;
    }
    std::vector<Eigen::Vector3d> plate = plate_points(best->T_lidar_board);
    if (!plate.empty()) {
        auto fit = refine_board(grid_, points, plate, best->T_lidar_board, best->inflation,
                                kInflationSigma);
        if (fit) {
            best = std::move(fit);
        } else {
            plate.clear();  // the plane is that of the points on the sides after all
        }
    }
    const bool has_plate = !plate.empty();
    LidarBoard board;
    board.T_lidar_board = best->T_lidar_board;
    const Eigen::Isometry3d to_plane = frame.inverse();
    for (const auto& corner : grid_.corners) {
        board.corners.push_back(best->T_lidar_board * Eigen::Vector3d(corner.x(), corner.y(), 0.0));
        attempt.corners.push_back((to_plane * board.corners.back()).head<2>());
    }
    if (!accept(attempt, best->score, best->inflation)) return;
    if (best->line_rms > params_.max_line_rms) {
        attempt.miss = printed("a board whose points lie %.1f mm (RMS) off its holes' sides",
                               best->line_rms * 1e3);
        attempt.threshold = printed("max_line_rms %.1f mm", params_.max_line_rms * 1e3);
        return;
    }
    if (best->line_common > params_.max_side_offset) {
        attempt.miss = printed(
            "a board whose sides, each as a whole, lie %.1f mm (1 sigma) off the target's: its "
            "holes stand otherwise",
            best->line_common * 1e3);
        attempt.threshold = printed("max_side_offset %.1f mm", params_.max_side_offset * 1e3);
        return;
    }
    board.covariance = best->covariance;
    board.covariance->topLeftCorner<3, 3>() += unseen_shift(best->T_lidar_board, has_plate);
    board.quality = quality(best->score, attempt);
    board.quality["edge_inflation_x_mm"] = best->inflation.x() * 1e3;
    board.quality["edge_inflation_y_mm"] = best->inflation.y() * 1e3;
    board.quality["edge_inflation_sigma_x_mm"] = best->inflation_sigma.x() * 1e3;
    board.quality["edge_inflation_sigma_y_mm"] = best->inflation_sigma.y() * 1e3;
    board.quality["line_rms_mm"] = best->line_rms * 1e3;
    board.quality["line_common_mm"] = best->line_common * 1e3;
    board.quality["plane_rms_mm"] = best->plane_rms * 1e3;
    board.quality["plane_common_mm"] = best->plane_common * 1e3;
    board.quality["plate_points"] = static_cast<double>(plate.size());
    attempt.board = std::move(board);
}

/// What shifts the whole board and its own points cannot tell: covariance, LiDAR frame, m^2.
Eigen::Matrix3d BoardFinder::unseen_shift(const Eigen::Isometry3d& T_lidar_board,
                                          bool has_plate) const {
    const Eigen::Vector2d middle = grid_.middle();
    const Eigen::Vector3d ray =
        (T_lidar_board * Eigen::Vector3d(middle.x(), middle.y(), 0.0)).normalized();
    const Eigen::Vector3d on_board = T_lidar_board.linear().transpose() * ray;
    // Opposite edges moved unlike. Obliquely one sees the wall of a hole on one side only.
    Eigen::Vector3d variances;
    for (int axis = 0; axis < 2; ++axis) {
        const double wall = kWallShare * grid_.thickness * on_board(axis) / on_board.z();
        variances(axis) = params_.edge_asymmetry * params_.edge_asymmetry + wall * wall;
    }
    variances.z() = has_plate ? kPlateSigma * kPlateSigma : 0.0;
    Eigen::Matrix3d shift =
        T_lidar_board.linear() * variances.asDiagonal() * T_lidar_board.linear().transpose();
    // A beam that the rim cuts returns from a little behind the plate.
    if (!has_plate)
        shift += params_.edge_range_sigma * params_.edge_range_sigma * ray * ray.transpose();
    return shift;
}

void BoardFinder::fit_plain(BoardAttempt& attempt, const std::vector<ScoredPattern>& placements,
                            const LineSplit& split, const Eigen::Isometry3d& frame) const {
    const LineFamily vertical =
        select_by_letter(split.vertical, grid_.width, params_.min_line_distance,
                         params_.edge_tolerance, grid_.x.size());
    const LineFamily horizontal =
        select_by_letter(split.horizontal, grid_.height, params_.min_line_distance,
                         params_.edge_tolerance, grid_.y.size());
    if (intersect(attempt, vertical, horizontal, frame)) return;
    for (const ScoredPattern& placement : placements) {
        const LineSplit lines =
            lines_of_pattern(grid_, split, placement.pose, attempt.points, kMinPatternPoints);
        if (intersect(attempt, lines.vertical, lines.horizontal, frame)) return;
    }
}

bool BoardFinder::intersect(BoardAttempt& attempt, const LineFamily& vertical,
                            const LineFamily& horizontal, const Eigen::Isometry3d& frame) const {
    if (vertical.lines.size() != grid_.x.size() || horizontal.lines.size() != grid_.y.size()) {
        const double closeness =
            0.01 * static_cast<double>(std::min(vertical.lines.size(), grid_.x.size()) +
                                       std::min(horizontal.lines.size(), grid_.y.size()));
        if (closeness >= attempt.closeness) {
            attempt.closeness = closeness;
            attempt.miss = printed("%zu of %zu vertical and %zu of %zu horizontal lines",
                                   vertical.lines.size(), grid_.x.size(), horizontal.lines.size(),
                                   grid_.y.size());
        }
        return false;
    }
    std::vector<NormalForm> x, y;
    for (const auto& line : vertical.lines)
        x.push_back(normal_form(vertical.direction, line.point));
    for (const auto& line : horizontal.lines)
        y.push_back(normal_form(horizontal.direction, line.point));
    std::vector<Eigen::Vector2d> corners;
    for (const auto& [i, j] : grid_.crossings) corners.push_back(crossing(x[i], y[j]));
    PatternPose pose = rigid_fit(grid_.corners, corners);

    // How much larger the holes are than the target's, in both directions.
    const Eigen::Rotation2Dd to_board(-pose.angle);
    for (std::size_t c = 0; c < corners.size(); ++c) {
        const Eigen::Vector2d off = to_board * (corners[c] - pose.origin) - grid_.corners[c];
        const auto& [i, j] = grid_.crossings[c];
        pose.inflation +=
            Eigen::Vector2d(grid_.x[i].outward * off.x(), grid_.y[j].outward * off.y()) /
            static_cast<double>(corners.size());
    }
    PatternScorer scorer(grid_, pose.inflation, kPlainTolerance);
    for (const auto& p : attempt.points) scorer.add(to_board * (p - pose.origin));
    const PatternScore score = scorer.score();
    attempt.corners = corners;
    if (!accept(attempt, score, pose.inflation)) return false;

    LidarBoard board;
    board.T_lidar_board = to_lidar(pose, frame);
    for (const auto& corner : corners)
        board.corners.push_back(frame * Eigen::Vector3d(corner.x(), corner.y(), 0.0));
    board.quality = quality(score, attempt);
    double side_x = 0.0, side_y = 0.0;
    for (const HoleGrid::Hole& hole : grid_.holes) {
        side_x += vertical.lines[hole.right].at - vertical.lines[hole.left].at;
        side_y += horizontal.lines[hole.bottom].at - horizontal.lines[hole.top].at;
    }
    const double holes = static_cast<double>(grid_.holes.size());
    board.quality["hole_side_x_mm"] = side_x / holes * 1e3;
    board.quality["hole_side_y_mm"] = side_y / holes * 1e3;
    attempt.board = std::move(board);
    return true;
}

bool BoardFinder::accept(BoardAttempt& attempt, const PatternScore& score,
                         const Eigen::Vector2d& inflation) const {
    const std::size_t sides = score.sides_covered(params_.min_side_coverage);
    const std::size_t needed = static_cast<std::size_t>(
        std::ceil(params_.min_sides * static_cast<double>(grid_.side_count()) - 1e-9));
    const double points = static_cast<double>(score.rim + score.in_holes);
    const double in_holes = points > 0.0 ? static_cast<double>(score.in_holes) / points : 0.0;
    attempt.closeness = 1.0 + score.value;
    if (sides < needed) {
        attempt.miss = printed(
            "%zu of %zu vertical and %zu of %zu horizontal lines, %zu of %zu hole sides covered",
            covered_lines(grid_, score, true, params_.min_side_coverage), grid_.x.size(),
            covered_lines(grid_, score, false, params_.min_side_coverage), grid_.y.size(), sides,
            grid_.side_count());
        attempt.threshold = printed("needed %zu + %zu lines and %zu sides (min_sides %.2f)",
                                    grid_.x.size(), grid_.y.size(), needed, params_.min_sides);
        return false;
    }
    if (in_holes > params_.max_hole_points) {
        attempt.miss =
            printed("all lines, but %zu points inside the holes against %zu on their sides",
                    score.in_holes, score.rim);
        attempt.threshold = printed("max_hole_points %.2f", params_.max_hole_points);
        return false;
    }
    const double enlarged = inflation.cwiseAbs().maxCoeff();
    if (enlarged > params_.max_inflation) {
        attempt.miss =
            printed("all lines, but the holes' sides are off by %.1f mm (x) and %.1f mm (y)",
                    inflation.x() * 1e3, inflation.y() * 1e3);
        attempt.threshold = printed("max_inflation %.1f mm", params_.max_inflation * 1e3);
        return false;
    }
    return true;
}

std::map<std::string, double> BoardFinder::quality(const PatternScore& score,
                                                   const BoardAttempt& attempt) const {
    return {{"points", static_cast<double>(score.rim)},
            {"points_in_holes", static_cast<double>(score.in_holes)},
            {"coverage", score.coverage()},
            {"sides_covered", static_cast<double>(score.sides_covered(params_.min_side_coverage))},
            {"lines_found", static_cast<double>(attempt.lines.size())}};
}

}  // namespace petal
