// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_layout.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <string>

#include "petal/calibration/polygon.hpp"
#include "petal/error.hpp"

namespace petal {

namespace {

/// Two board points closer than this are the same, m.
constexpr double kSamePoint = 1e-6;

std::size_t index_of(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& p) {
    for (std::size_t i = 0; i < points.size(); ++i)
        if ((points[i] - p).norm() < kSamePoint) return i;
    return points.size();
}

}  // namespace

Eigen::Vector2d map_point(const Homography& h, const Eigen::Vector2d& board) {
    return (h * board.homogeneous()).hnormalized();
}

Eigen::Matrix2d map_jacobian(const Homography& h, const Eigen::Vector2d& board) {
    const Eigen::Vector3d p = h * board.homogeneous();
    const Eigen::Vector2d image = p.hnormalized();
    return (h.topLeftCorner<2, 2>() - image * h.bottomLeftCorner<1, 2>()) / p.z();
}

std::optional<Homography> fit_affine(const std::vector<Eigen::Vector2d>& board,
                                     const std::vector<Eigen::Vector2d>& image) {
    Eigen::Vector2d board_mean = Eigen::Vector2d::Zero(), image_mean = Eigen::Vector2d::Zero();
    const double n = static_cast<double>(board.size());
    for (std::size_t i = 0; i < board.size(); ++i) {
        board_mean += board[i] / n;
        image_mean += image[i] / n;
    }
    Eigen::Matrix2d bb = Eigen::Matrix2d::Zero(), ib = Eigen::Matrix2d::Zero();
    for (std::size_t i = 0; i < board.size(); ++i) {
        const Eigen::Vector2d b = board[i] - board_mean;
        bb += b * b.transpose();
        ib += (image[i] - image_mean) * b.transpose();
    }
    if (std::abs(bb.determinant()) < 1e-18) return std::nullopt;
    Homography h = Homography::Identity();
    h.topLeftCorner<2, 2>() = ib * bb.inverse();
    h.topRightCorner<2, 1>() = image_mean - h.topLeftCorner<2, 2>() * board_mean;
    return h;
}

std::optional<Homography> fit_homography(const std::vector<Eigen::Vector2d>& board,
                                         const std::vector<Eigen::Vector2d>& image) {
    std::vector<cv::Point2d> from, to;
    for (std::size_t i = 0; i < board.size(); ++i) {
        from.emplace_back(board[i].x(), board[i].y());
        to.emplace_back(image[i].x(), image[i].y());
    }
    const cv::Mat found = cv::findHomography(from, to, 0);  // plain least squares: nothing random
    if (found.empty()) return std::nullopt;
    Homography h;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) h(r, c) = found.at<double>(r, c);
    if (!h.allFinite()) return std::nullopt;
    return h;
}

HoleLayout::HoleLayout(const Target& target) : target_(target), corners_(target.corners()) {
    if (target_.holes.size() < 2)
        throw Error("target '" + target_.name + "' shows " + target_.features() +
                    "; image_contours needs two or more holes with four corners: take another "
                    "target or another image_board_detector");
    double length = 0.0;
    for (std::size_t h = 0; h < target_.holes.size(); ++h) {
        const auto& hole = target_.holes[h];
        if (hole.size() != 4)
            throw Error("target '" + target_.name + "': hole " + std::to_string(h) + " has " +
                        std::to_string(hole.size()) +
                        " corners; this detector finds holes with four: use another detector");
        centers_.push_back(0.25 * (hole[0] + hole[1] + hole[2] + hole[3]));
        for (std::size_t i = 0; i < 4; ++i) {
            const Eigen::Vector2d& from = hole[i];
            const Eigen::Vector2d& to = hole[(i + 1) % 4];
            sides_.push_back({h, from, to, index_of(corners_, from), index_of(corners_, to)});
            length += (to - from).norm();
        }
    }
    hole_side_ = length / static_cast<double>(sides_.size());
    Eigen::Vector2d low = target_.outline.front(), high = low;
    for (const auto& p : target_.outline) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    center_ = 0.5 * (low + high);
    turns_ = BoardTurns(corners_, center_);
    sample_points();
}

void HoleLayout::sample_points() {
    const double margin = 0.1 * hole_side_;
    const double step = 0.15 * hole_side_;
    Eigen::Vector2d low = target_.outline.front(), high = low;
    for (const auto& p : target_.outline) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    for (double y = low.y(); y <= high.y(); y += step) {
        for (double x = low.x(); x <= high.x(); x += step) {
            const Eigen::Vector2d p(x, y);
            if (!inside_polygon(target_.outline, p) ||
                distance_to_polygon(target_.outline, p) < margin)
                continue;
            bool in_hole = false, near_edge = false;
            for (const auto& hole : target_.holes) {
                in_hole = in_hole || inside_polygon(hole, p);
                near_edge = near_edge || distance_to_polygon(hole, p) < margin;
            }
            if (near_edge) continue;
            (in_hole ? hole_points_ : plate_points_).push_back(p);
        }
    }
}

Homography HoleLayout::upright(const Homography& h) const {
    for (const Homography& turn : turns_.all())
        if (is_upright(map_jacobian(h * turn, center_))) return h * turn;
    return h;
}

bool HoleLayout::plausible(const Homography& h, double min_foreshortening) const {
    std::vector<Eigen::Vector2d> image;
    for (const auto& p : target_.outline) {
        if ((h * p.homogeneous()).z() <= 1e-9) return false;
        image.push_back(map_point(h, p));
    }
    for (const auto& p : target_.outline)
        if (map_jacobian(h, p).determinant() <= 0.0) return false;  // a mirror image or a fold
    const Eigen::Vector2d s = map_jacobian(h, center_).jacobiSvd().singularValues();
    return s(1) >= min_foreshortening * s(0);
}

}  // namespace petal
