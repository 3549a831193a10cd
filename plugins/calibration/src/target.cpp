// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/target.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace petal {
namespace {

/// Two sides nearer than this are the same line: far below what a saw can do, far above rounding.
constexpr double kSameLine = 1e-6;  // m

Eigen::AlignedBox2d outline_box(const Target& target) {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : target.outline) box.extend(p);
    return box;
}

std::vector<double> distinct(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const auto same = [](double a, double b) { return b - a < kSameLine; };
    values.erase(std::unique(values.begin(), values.end(), same), values.end());
    return values;
}

}  // namespace

std::vector<Eigen::Vector2d> Target::corners() const {
    std::vector<Eigen::Vector2d> all;
    for (const auto& hole : holes) all.insert(all.end(), hole.begin(), hole.end());
    if (all.empty())
        for (const RoundHole& hole : round_holes) all.push_back(hole.centre);
    if (all.empty())
        for (const Checkerboard& board : checkerboards)
            for (int row = 1; row < board.rows; ++row)
                for (int column = 1; column < board.columns; ++column)
                    all.emplace_back(board.corner + board.square * Eigen::Vector2d(column, row));
    std::sort(all.begin(), all.end(),
              [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.y() < b.y(); });
    for (auto row = all.begin(); row != all.end();) {
        const auto end = std::find_if(row, all.end(), [&](const Eigen::Vector2d& p) {
            return p.y() - row->y() >= kSameLine;
        });
        std::sort(row, end,
                  [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() < b.x(); });
        row = end;
    }
    return all;
}

std::vector<double> Target::lines_x() const {
    std::vector<double> values;
    for (const auto& hole : holes)
        for (const Eigen::Vector2d& p : hole) values.push_back(p.x());
    return distinct(std::move(values));
}

std::vector<double> Target::lines_y() const {
    std::vector<double> values;
    for (const auto& hole : holes)
        for (const Eigen::Vector2d& p : hole) values.push_back(p.y());
    return distinct(std::move(values));
}

double Target::width() const {
    return outline.empty() ? 0.0 : outline_box(*this).sizes().x();
}

double Target::height() const {
    return outline.empty() ? 0.0 : outline_box(*this).sizes().y();
}

std::string Target::features() const {
    std::string text;
    const auto tell = [&text](std::size_t count, const char* one) {
        if (count == 0) return;
        text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + one +
                (count == 1 ? "" : "s");
    };
    tell(holes.size(), "polygonal hole");
    tell(round_holes.size(), "round hole");
    tell(checkerboards.size(), "checkerboard");
    tell(markers.size(), "marker");
    return text.empty() ? "nothing" : text;
}

}  // namespace petal
