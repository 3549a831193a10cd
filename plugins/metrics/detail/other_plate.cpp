// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/other_plate.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "metrics/detail/board_shape.hpp"
#include "metrics/detail/plate_edges.hpp"
#include "metrics/detail/plate_rays.hpp"
#include "petal/calibration/angles.hpp"
#include "petal/calibration/plane_fit.hpp"

namespace petal {
namespace {

constexpr double kCell = 0.01;   // m
constexpr double kDepth = 0.03;  // m along the ray: nearer to the plane is on it
constexpr double kSmallestScale = 0.6, kLargestScale = 1.6;  // times the target's size
constexpr double kProportion = 0.12;  // relative: width over height against the target's
constexpr double kAgreement = 0.8;    // share of rays that the scaled target must explain
constexpr double kBeyondHalf = 0.52;  // a plate that fills this much is no frame
constexpr double kOpening = 0.05;     // m: strips narrower than this are no plate

/// The rays that pass near the plane's points, in a frame in the plane about their middle.
struct PlaneView {
    Eigen::Isometry3d T_lidar_view = Eigen::Isometry3d::Identity();
    double size = 0.0;
    std::vector<PlateRay> rays;
};

std::optional<PlaneView> view_of(const Run& run, const Cloud& cloud, const Plane& plane,
                                 double reach) {
    if (!plane.normal.allFinite() || !std::isfinite(plane.offset)) return std::nullopt;
    const auto& points = *plane.inliers.points;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    double count = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        float x = 0.0F, y = 0.0F, z = 0.0F;
        points.getPoint(i, x, y, z);
        const Eigen::Vector3d p(static_cast<double>(x), static_cast<double>(y),
                                static_cast<double>(z));
        if (!p.allFinite()) continue;
        middle += p;
        count += 1.0;
    }
    if (count < 3.0) return std::nullopt;
    middle /= count;
    middle -= plane.normal * (plane.normal.dot(middle) + plane.offset);
    PlaneView view;
    view.size = 2.0 * reach;
    view.T_lidar_view = plane_frame(plane.normal, middle);
    view.T_lidar_view.translation() -=
        view.T_lidar_view.linear() * Eigen::Vector3d(reach, reach, 0.0);
    view.rays = plate_rays(run, cloud, view.T_lidar_view, view.size, view.size, 0.0);
    return view;
}

bool on_plane(const PlateRay& ray) {
    return std::abs(ray.depth) <= kDepth;
}

/// Cells that hold more hits than rays gone past, without thin strips.
cv::Mat plate_cells(const PlaneView& view) {
    const int cells = static_cast<int>(std::ceil(view.size / kCell));
    cv::Mat hits = cv::Mat::zeros(cells, cells, CV_32F), passed = hits.clone();
    for (const PlateRay& ray : view.rays) {
        const int x = std::clamp(static_cast<int>(ray.at.x() / kCell), 0, cells - 1);
        const int y = std::clamp(static_cast<int>(ray.at.y() / kCell), 0, cells - 1);
        if (ray.depth < -kDepth) continue;
        (on_plane(ray) ? hits : passed).at<float>(y, x) += 1.0F;
    }
    // Smoothed: a scan leaves cells without any ray.
    cv::GaussianBlur(hits, hits, {5, 5}, 1.0);
    cv::GaussianBlur(passed, passed, {5, 5}, 1.0);
    cv::Mat plate = (hits > passed) & (hits > 0.05F);
    const int opening = static_cast<int>(std::lround(kOpening / kCell));
    cv::morphologyEx(plate, plate, cv::MORPH_OPEN,
                     cv::getStructuringElement(cv::MORPH_RECT, {opening, opening}));
    return plate;
}

/// Share of the rays about the plate that the scaled target explains; edges do not count. That of
/// the holes, where it is the lesser: they are a tenth of a board, and what makes it one.
double agreement_with(const PlaneView& view, const Eigen::Isometry2d& to_board,
                      const PlateEdges& edges) {
    struct Share {
        double right = 0.0, all = 0.0;
    };
    Share holes, rest;
    for (const PlateRay& ray : view.rays) {
        if (ray.depth < -kDepth) continue;
        const Eigen::Vector2d at = to_board * ray.at;
        const double inside = edges.inside(at);
        if (std::abs(inside) < 0.008 || inside < -0.06) continue;
        const bool hole = inside < 0.0 && at.minCoeff() > 0.0 && at.x() < edges.width() &&
                          at.y() < edges.height();
        Share& share = hole ? holes : rest;
        share.all += 1.0;
        if (on_plane(ray) == (inside > 0.0)) share.right += 1.0;
    }
    if (holes.all < 40.0 || rest.all < 200.0) return 0.0;
    return std::min(holes.right / holes.all, rest.right / rest.all);
}

std::optional<OtherPlate> look(const PlaneView& view, const Target& target) {
    const cv::Mat cells = plate_cells(view);
    std::vector<std::vector<cv::Point>> contours;
    cv::findContours(cells, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    std::optional<OtherPlate> best;
    for (const auto& contour : contours) {
        if (contour.size() < 20) continue;
        const cv::RotatedRect box = cv::minAreaRect(contour);
        // Cells are counted from middle to middle: half a cell more on either side.
        double along = (static_cast<double>(box.size.width) + 1.0) * kCell;
        double across = (static_cast<double>(box.size.height) + 1.0) * kCell;
        if (cv::contourArea(contour) * kCell * kCell < kBeyondHalf * along * across) continue;
        const Eigen::Vector2d middle((static_cast<double>(box.center.x) + 0.5) * kCell,
                                     (static_cast<double>(box.center.y) + 0.5) * kCell);
        double angle = static_cast<double>(box.angle) / kDegrees;
        while (angle > kPi / 4.0) {
            angle -= kPi / 2.0;
            std::swap(along, across);
        }
        while (angle < -kPi / 4.0) {
            angle += kPi / 2.0;
            std::swap(along, across);
        }
        const double by_width = along / target.width(), by_height = across / target.height();
        const double scale = std::sqrt(by_width * by_height);
        if (scale < kSmallestScale || scale > kLargestScale ||
            std::abs(std::log(by_width / by_height)) > kProportion)
            continue;
        // The box is a few per cent too large or too small: the holes' pattern tells the rest.
        for (double s = 0.94 * scale; s <= 1.06 * scale; s += 0.01 * scale) {
            const PlateEdges edges(scaled(target, s));
            Eigen::Isometry2d to_board = Eigen::Isometry2d::Identity();
            to_board.linear() = Eigen::Rotation2Dd(-angle).toRotationMatrix();
            to_board.translation() = edges.middle() - to_board.linear() * middle;
            const double agreement = agreement_with(view, to_board, edges);
            if (agreement < kAgreement || (best && agreement <= best->agreement)) continue;
            const Eigen::Vector3d at =
                view.T_lidar_view * Eigen::Vector3d(middle.x(), middle.y(), 0.0);
            OtherPlate plate;
            plate.range = at.norm();
            plate.scale = s;
            plate.agreement = agreement;
            Eigen::Isometry3d T_view_board = Eigen::Isometry3d::Identity();
            T_view_board.linear().topLeftCorner<2, 2>() = to_board.linear().transpose();
            T_view_board.translation().head<2>() = to_board.inverse().translation();
            plate.T_lidar_board = view.T_lidar_view * T_view_board;
            best = plate;
        }
    }
    return best;
}

/// The pattern was tried in steps of a per cent; the holes' sides tell the size to a few mm.
void measure(OtherPlate& plate, const Run& run, const Cloud& cloud, const Target& target) {
    if (const auto shape =
            board_shape(run, cloud, plate.T_lidar_board, scaled(target, plate.scale));
        shape && shape->pitch_x && shape->pitch_y)
        plate.scale *= 1.0 + 0.5 * (shape->pitch_x->value + shape->pitch_y->value);
    plate.width = plate.scale * target.width();
    plate.height = plate.scale * target.height();
}

}  // namespace

std::vector<OtherPlate> other_plates(const Run& run, const Cloud& cloud, const Planes& planes,
                                     const Target& target) {
    std::vector<OtherPlate> plates;
    const double reach = kLargestScale * std::hypot(target.width(), target.height());
    for (const Plane& plane : planes.planes) {
        const auto view = view_of(run, cloud, plane, reach);
        if (!view) continue;
        auto plate = look(*view, target);
        if (!plate) continue;
        measure(*plate, run, cloud, target);
        const bool known = std::any_of(plates.begin(), plates.end(), [&](const OtherPlate& other) {
            return std::abs(other.range - plate->range) < 0.1 &&
                   std::abs(other.scale - plate->scale) < 0.05;
        });
        if (!known) plates.push_back(*plate);
    }
    return plates;
}

}  // namespace petal
