// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_corner_fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "detectors/detail/image_board_refinement.hpp"

namespace petal {

namespace {

using Matrix8d = Eigen::Matrix<double, 8, 8>;
using Vector8d = HomographyStep::Vector8d;

/// Neighbouring edge points share pixels: they count as half as many independent ones.
constexpr double kPointsShare = 2.0;

}  // namespace

bool CornerFit::fit(const std::vector<SidePoint>& points, RefinedBoard& board) const {
    return intersect(fit_lines(points, board), points, board);
}

std::vector<CornerFit::SideLine> CornerFit::fit_lines(const std::vector<SidePoint>& points,
                                                      RefinedBoard& board) const {
    const Homography& h = board.board_to_image;
    const std::vector<SideFrame> frame = side_frames(layout_, h);
    std::vector<SideLine> lines(layout_.sides().size());
    double scatter = 0.1;
    // Twice: the points' scatter is known only after the first fit.
    for (int round = 0; round < 2; ++round) {
        double squares = 0.0, counted = 0.0, off_squares = 0.0;
        for (std::size_t s = 0; s < lines.size(); ++s) {
            const double expected = -board.hole_inset * frame[s].px_per_m;
            const double behind = board.wall[s] * frame[s].px_per_m;
            const double prior_sigma = tolerance_ * frame[s].px_per_m;
            Eigen::Matrix2d normal_matrix =
                Eigen::Matrix2d::Identity() / (prior_sigma * prior_sigma);
            Eigen::Vector2d right = Eigen::Vector2d::Zero();
            std::vector<std::array<double, 2>> own;  // (place along the side, -1 to 1; offset)
            for (const SidePoint& point : points)
                if (board.side_measured[s] && point.side == s)
                    own.push_back({2.0 * point.t - 1.0,
                                   side_residual(layout_, h, frame[s], point) + behind - expected});
            const double weight = 1.0 / (kPointsShare * scatter * scatter);
            Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
            for (const auto& [u, r] : own) {
                const double huber = std::min(1.0, 3.0 * scatter / std::max(std::abs(r), 1e-9));
                const Eigen::Vector2d row(1.0, u);
                information += huber * row * row.transpose();
                right += huber * weight * r * row;
            }
            normal_matrix += weight * information;
            const Eigen::Matrix2d covariance = normal_matrix.inverse();
            const Eigen::Vector2d solution = covariance * right;
            lines[s] = {
                expected + solution(0), solution(1), covariance(0, 0), covariance(1, 1), {}};
            // Two points at least, or they show no direction.
            if (own.size() >= 2)
                lines[s].own = {information.inverse() * right / weight, information,
                                weight * covariance * information};
            if (!own.empty()) off_squares += solution(0) * solution(0);
            for (const auto& [u, r] : own) {
                const double left = r - solution(0) - u * solution(1);
                squares += left * left;
                counted += 1.0;
            }
        }
        board.line_rms_px = std::sqrt(squares / std::max(1.0, counted));
        board.board_rms_px = std::sqrt(off_squares / std::max(1, board.sides_measured));
        scatter = std::max(board.line_rms_px, kLeastScatter);
    }
    return lines;
}

bool CornerFit::intersect(const std::vector<SideLine>& lines, const std::vector<SidePoint>& points,
                          RefinedBoard& board) const {
    const Homography& h = board.board_to_image;
    const std::vector<SideFrame> frame = side_frames(layout_, h);
    const HomographyStep perturbation(layout_);
    const double scatter = std::max(board.line_rms_px, kLeastScatter);
    Matrix8d information = Matrix8d::Zero();
    for (const SidePoint& point : points) {
        if (!board.side_measured[point.side]) continue;
        const auto& side = layout_.sides()[point.side];
        const Vector8d row =
            perturbation.jacobian(h, side.from + point.t * (side.to - side.from)).transpose() *
            frame[point.side].normal;
        information += row * row.transpose() / (kPointsShare * scatter * scatter);
    }
    const Matrix8d board_covariance = information.inverse();
    const std::size_t count = layout_.corners().size();
    board.corners.assign(count, Eigen::Vector2d::Zero());
    board.covariance.assign(count, Eigen::Matrix2d::Identity());
    std::vector<CornerCrossing> crossings;
    for (std::size_t c = 0; c < count; ++c) {
        Eigen::Matrix2d normals;
        Eigen::Vector2d distances, variances;
        CornerCrossing crossed;
        int met = 0;
        for (std::size_t s = 0; s < lines.size() && met < 2; ++s) {
            const auto& side = layout_.sides()[s];
            if (side.from_corner != c && side.to_corner != c) continue;
            const SideLine& line = lines[s];
            const Eigen::Vector2d start =
                map_point(h, side.from) + frame[s].normal * (line.offset - line.tilt);
            const Eigen::Vector2d end =
                map_point(h, side.to) + frame[s].normal * (line.offset + line.tilt);
            const Eigen::Vector2d along = (end - start).normalized();
            normals.row(met) << along.y(), -along.x();
            distances(met) = normals.row(met).dot(start.transpose());
            variances(met) = line.offset_variance + line.tilt_variance;
            crossed.side[met] = s;
            crossed.sign[met] = side.to_corner == c ? 1.0 : -1.0;
            ++met;
        }
        if (met < 2 || std::abs(normals.determinant()) < 0.1) return false;
        const Eigen::Matrix2d inverse = normals.inverse();
        const Eigen::Vector2d ideal = inverse * distances;
        const Eigen::Matrix<double, 2, 8> j = perturbation.jacobian(h, layout_.corners()[c]);
        Eigen::Matrix2d covariance = inverse * variances.asDiagonal() * inverse.transpose() +
                                     j * board_covariance * j.transpose();
        const auto raw = camera_.distort(ideal);
        const auto right = camera_.distort(ideal + Eigen::Vector2d(0.5, 0.0));
        const auto down = camera_.distort(ideal + Eigen::Vector2d(0.0, 0.5));
        if (!raw || !right || !down || !covariance.allFinite()) return false;
        Eigen::Matrix2d distortion;
        distortion << 2.0 * (*right - *raw), 2.0 * (*down - *raw);
        crossed.crossing = inverse;
        crossed.distortion = distortion;
        crossings.push_back(crossed);
        covariance = distortion * covariance * distortion.transpose();
        covariance += sigma_floor_px_ * sigma_floor_px_ * Eigen::Matrix2d::Identity();
        board.corners[c] = *raw;
        board.covariance[c] = 0.5 * (covariance + covariance.transpose());
    }
    std::vector<MeasuredSide> measured;
    measured.reserve(lines.size());
    for (const SideLine& line : lines) measured.push_back(line.own);
    board.joint_covariance = corner_covariance(layout_, h, measured, crossings, scatter,
                                               board.hole_inset, board.wall_sigma);
    return board.joint_covariance.allFinite();
}

}  // namespace petal
