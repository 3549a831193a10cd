// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/line_selection.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "petal/calibration/angles.hpp"

namespace petal {
namespace {

constexpr double kSameDirection = 6.0 * kPi / 180.0;  ///< rad

/// To (-pi/4, pi/4]: directions that differ by a quarter turn are those of one board.
double quarter(double angle) {
    const double wrapped = std::remainder(angle, kPi / 2.0);
    return wrapped <= -kPi / 4.0 ? wrapped + kPi / 2.0 : wrapped;
}

double angle_of(const Eigen::Vector2d& v) {
    return std::atan2(v.y(), v.x());
}

bool near_in_direction(double a, double b) {
    return std::abs(std::remainder(a - b, kPi / 2.0)) < kSameDirection;
}

void sort_lines(LineFamily& family) {
    std::stable_sort(family.lines.begin(), family.lines.end(),
                     [](const auto& a, const auto& b) { return a.at < b.at; });
}

}  // namespace

std::optional<LineSplit> split_lines(const std::vector<PlanarLine>& lines) {
    std::size_t best_points = 0;
    double pivot = 0.0;
    for (const PlanarLine& candidate : lines) {
        std::size_t points = 0;
        for (const PlanarLine& other : lines)
            if (near_in_direction(angle_of(other.direction), angle_of(candidate.direction)))
                points += other.count;
        if (points <= best_points) continue;
        best_points = points;
        pivot = quarter(angle_of(candidate.direction));
    }
    if (best_points == 0) return std::nullopt;

    LineSplit split;
    const Eigen::Vector2d right(std::cos(pivot), std::sin(pivot));
    const Eigen::Vector2d down(-right.y(), right.x());
    double points_horizontal = 0.0, points_vertical = 0.0;
    for (const PlanarLine& line : lines) {
        if (!near_in_direction(angle_of(line.direction), pivot)) continue;
        const bool horizontal =
            std::abs(line.direction.dot(right)) > std::abs(line.direction.dot(down));
        LineFamily& family = horizontal ? split.horizontal : split.vertical;
        const Eigen::Vector2d& axis = horizontal ? right : down;
        const double weight = static_cast<double>(line.count);
        family.direction += weight * (line.direction.dot(axis) < 0.0 ? -1.0 : 1.0) * line.direction;
        family.lines.push_back({0.0, line.count, line.point});
        (horizontal ? points_horizontal : points_vertical) += weight;
    }
    double turn = 0.0;  // from the pivot
    if (points_horizontal > 0.0) {
        split.horizontal.direction.normalize();
        turn += points_horizontal * std::asin(split.horizontal.direction.dot(down));
    }
    if (points_vertical > 0.0) {
        split.vertical.direction.normalize();
        turn -= points_vertical * std::asin(split.vertical.direction.dot(right));
    }
    // A direction that no line shows is across the other.
    if (points_horizontal <= 0.0)
        split.horizontal.direction =
            Eigen::Vector2d(split.vertical.direction.y(), -split.vertical.direction.x());
    if (points_vertical <= 0.0)
        split.vertical.direction =
            Eigen::Vector2d(-split.horizontal.direction.y(), split.horizontal.direction.x());
    split.angle = quarter(pivot + turn / (points_horizontal + points_vertical));
    // The wrap may have crossed 45 deg: then what was horizontal is vertical now.
    if (std::abs(split.angle - pivot) > kPi / 4.0) std::swap(split.horizontal, split.vertical);

    const Eigen::Rotation2Dd to_board(-split.angle);
    for (auto& line : split.horizontal.lines) line.at = (to_board * line.point).y();
    for (auto& line : split.vertical.lines) line.at = (to_board * line.point).x();
    sort_lines(split.horizontal);
    sort_lines(split.vertical);
    return split;
}

LineFamily select_by_letter(const LineFamily& family, double board_length, double min_distance,
                            double tolerance, std::size_t wanted) {
    const auto by_count = [](const auto& a, const auto& b) { return a.count > b.count; };
    LineFamily kept;
    kept.direction = family.direction;
    std::vector<LineFamily::Line> lines = family.lines;
    std::stable_sort(lines.begin(), lines.end(), by_count);
    for (const auto& line : lines)
        if (std::none_of(kept.lines.begin(), kept.lines.end(), [&](const auto& other) {
                return std::abs(other.at - line.at) < min_distance;
            }))
            kept.lines.push_back(line);

    std::vector<LineFamily::Line> inner;
    for (const auto& line : kept.lines)
        if (std::none_of(kept.lines.begin(), kept.lines.end(), [&](const auto& other) {
                return std::abs(std::abs(other.at - line.at) - board_length) < tolerance;
            }))
            inner.push_back(line);
    if (inner.size() == wanted + 1) inner.erase(inner.begin());  // the most points
    kept.lines = std::move(inner);
    sort_lines(kept);
    return kept;
}

}  // namespace petal
