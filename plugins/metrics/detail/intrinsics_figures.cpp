// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/intrinsics_figures.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace petal {
namespace {

constexpr double kSameLine = 1e-6;       // m: corners of a target on one line
constexpr double kAlmostRight = 1.5690;  // rad: a model that grows up to here never turns back

/// The covariance of corners i and j, px^2.
Eigen::Matrix2d covariance_of(const ImageBoard& board, std::size_t i, std::size_t j) {
    const auto size = 2 * static_cast<Eigen::Index>(board.corners.size());
    if (board.joint_covariance.rows() == size && board.joint_covariance.cols() == size)
        return board.joint_covariance.block<2, 2>(2 * static_cast<Eigen::Index>(i),
                                                  2 * static_cast<Eigen::Index>(j));
    if (i != j || board.covariance.size() != board.corners.size()) return Eigen::Matrix2d::Zero();
    return board.covariance[i];
}

/// The largest angle off the axis towards `direction` (x, y) that the model projects.
double largest_angle(const CameraModel& model, const Eigen::Vector2d& direction) {
    const auto projects = [&](double theta) {
        const Eigen::Vector2d aside = std::sin(theta) * direction;
        return model.project({aside.x(), aside.y(), std::cos(theta)}).has_value();
    };
    double low = 0.0, high = kAlmostRight;
    if (projects(high)) return high;
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        (projects(middle) ? low : high) = middle;
    }
    return low;
}

/// Groups of at least three corners that share one coordinate.
std::vector<std::vector<std::size_t>> lines_of(const std::vector<Eigen::Vector2d>& target) {
    std::vector<std::vector<std::size_t>> lines;
    for (const int axis : {0, 1}) {
        std::map<long long, std::vector<std::size_t>> by_place;
        for (std::size_t i = 0; i < target.size(); ++i)
            by_place[std::llround(target[i](axis) / kSameLine)].push_back(i);
        for (auto& [place, members] : by_place)
            if (members.size() >= 3) lines.push_back(std::move(members));
    }
    return lines;
}

}  // namespace

std::optional<FoldAtCorner> fold_inside_image(const CameraModel& model) {
    const double right = model.camera().ncols - 0.5, lower = model.camera().nrows - 0.5;
    const std::array<Eigen::Vector2d, 4> corners = {
        Eigen::Vector2d{-0.5, -0.5}, Eigen::Vector2d{right, -0.5}, Eigen::Vector2d{right, lower},
        Eigen::Vector2d{-0.5, lower}};
    const Eigen::Vector2d centre(model.cx(), model.cy());
    std::optional<FoldAtCorner> worst;
    for (const Eigen::Vector2d& corner : corners) {
        const Eigen::Vector2d from = corner - centre;
        const Eigen::Vector2d towards =
            Eigen::Vector2d(from.x() / model.fx(), from.y() / model.fy()).normalized();
        const double theta = largest_angle(model, towards);
        if (theta >= kAlmostRight) continue;
        const Eigen::Vector2d aside = std::sin(theta) * towards;
        const auto pixel = model.project({aside.x(), aside.y(), std::cos(theta)});
        if (!pixel) continue;
        const FoldAtCorner found{(*pixel - centre).norm(), from.norm()};
        if (found.fold_px >= found.corner_px) continue;
        if (!worst || found.corner_px - found.fold_px > worst->corner_px - worst->fold_px)
            worst = found;
    }
    return worst;
}

void StraightnessSum::add(const CameraModel& model, const ImageBoard& board,
                          const std::vector<Eigen::Vector2d>& target) {
    if (board.corners.size() != target.size()) return;
    std::vector<Eigen::Vector2d> ideal;
    for (const Eigen::Vector2d& corner : board.corners) {
        const auto straight = model.undistort(corner);
        if (!straight || !straight->allFinite()) return;
        ideal.push_back(*straight);
    }
    for (const auto& members : lines_of(target)) add_line(ideal, board, members);
}

void StraightnessSum::add_line(const std::vector<Eigen::Vector2d>& ideal, const ImageBoard& board,
                               const std::vector<std::size_t>& members) {
    const auto n = static_cast<Eigen::Index>(members.size());
    const Eigen::Vector2d along = ideal[members.back()] - ideal[members.front()];
    if (!(along.norm() > 1.0)) return;
    const Eigen::Vector2d direction = along.normalized();
    const Eigen::Vector2d across(-direction.y(), direction.x());
    Eigen::MatrixXd line(n, 2), covariance(n, n);
    Eigen::VectorXd off(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const std::size_t a = members[static_cast<std::size_t>(i)];
        const Eigen::Vector2d from = ideal[a] - ideal[members.front()];
        line.row(i) << 1.0, direction.dot(from);
        off(i) = across.dot(from);
        for (Eigen::Index j = 0; j < n; ++j)
            covariance(i, j) =
                across.dot(covariance_of(board, a, members[static_cast<std::size_t>(j)]) * across);
    }
    const Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(n, n) -
                                 line * (line.transpose() * line).inverse() * line.transpose();
    const Eigen::VectorXd deviations = rest * off;
    if (!deviations.allFinite() || !covariance.allFinite()) return;
    squares_ += deviations.squaredNorm();
    expected_ += (rest * covariance * rest).trace();
    freedoms_ += static_cast<double>(n - 2);
    count_ += members.size();
}

Straightness StraightnessSum::result() const {
    if (!(freedoms_ > 0.0)) return {};
    return {std::sqrt(squares_ / freedoms_), std::sqrt(std::max(0.0, expected_ / freedoms_)),
            count_};
}

}  // namespace petal
