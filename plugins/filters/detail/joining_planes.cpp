// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/detail/joining_planes.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace petal {
namespace {

constexpr int kDraws = 60;              // finds a plane that holds 3 of 10 points in 4 of 5 cases
constexpr std::size_t kScoredOn = 200;  // points that a draw is judged by
constexpr double kLeastSine = 1e-3;     // of three points' angle, to define a plane
constexpr double kNoise = 3.0;   // times plane_threshold: what lies within is the plane's noise
constexpr double kSlack = 1e-9;  // rad: 90 deg are 90 deg, whatever the rounding

}  // namespace

const std::vector<std::uint8_t>& JoiningPlanes::at_joins(const std::vector<Eigen::Vector3d>& points,
                                                         Rng& rng) {
    marked_.assign(points.size(), 0);
    find_planes(points, rng);
    if (surfaces_.size() < 2) return marked_;
    share_out(points);
    for (std::size_t a = 0; a < surfaces_.size(); ++a)
        for (std::size_t b = a + 1; b < surfaces_.size(); ++b)
            mark_join(points, surfaces_[a], surfaces_[b]);
    return marked_;
}

bool JoiningPlanes::draw_plane(const std::vector<Eigen::Vector3d>& points, Rng& rng,
                               PlaneFit& best) const {
    const std::size_t stride = (remaining_.size() + kScoredOn - 1) / kScoredOn;
    std::size_t best_count = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
        const Eigen::Vector3d& p = points[remaining_[rng() % remaining_.size()]];
        const Eigen::Vector3d u = points[remaining_[rng() % remaining_.size()]] - p;
        const Eigen::Vector3d v = points[remaining_[rng() % remaining_.size()]] - p;
        const Eigen::Vector3d normal = u.cross(v);
        if (!(normal.norm() > kLeastSine * u.norm() * v.norm())) continue;
        PlaneFit plane;
        plane.normal = normal.normalized();
        plane.offset = -plane.normal.dot(p);
        std::size_t count = 0;
        for (std::size_t k = 0; k < remaining_.size(); k += stride)
            if (std::abs(plane.distance(points[remaining_[k]])) <= params_.plane_threshold) ++count;
        if (count <= best_count) continue;
        best_count = count;
        best = plane;
    }
    return best_count > 0;
}

void JoiningPlanes::find_planes(const std::vector<Eigen::Vector3d>& points, Rng& rng) {
    surfaces_.clear();
    remaining_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) remaining_[i] = static_cast<std::uint32_t>(i);
    const std::size_t least =
        std::max(static_cast<std::size_t>(params_.min_points),
                 static_cast<std::size_t>(params_.min_share * static_cast<double>(points.size())));
    while (static_cast<int>(surfaces_.size()) < params_.max_planes && remaining_.size() >= least) {
        PlaneFit plane;
        if (!draw_plane(points, rng, plane)) return;
        PlaneFitter fitter;
        for (const std::uint32_t i : remaining_)
            if (std::abs(plane.distance(points[i])) <= params_.plane_threshold)
                fitter.add(points[i]);
        if (fitter.size() < least) return;
        if (const auto fit = fitter.fit()) plane = *fit;
        const double noise = kNoise * params_.plane_threshold;
        remaining_.erase(std::remove_if(remaining_.begin(), remaining_.end(),
                                        [&](std::uint32_t i) {
                                            return std::abs(plane.distance(points[i])) <= noise;
                                        }),
                         remaining_.end());
        surfaces_.push_back({plane, {}});
    }
}

void JoiningPlanes::share_out(const std::vector<Eigen::Vector3d>& points) {
    for (std::size_t i = 0; i < points.size(); ++i)
        for (Surface& surface : surfaces_)
            if (std::abs(surface.plane.distance(points[i])) <= params_.plane_threshold) {
                surface.points.push_back(static_cast<std::uint32_t>(i));
                break;
            }
}

void JoiningPlanes::mark_join(const std::vector<Eigen::Vector3d>& points, const Surface& a,
                              const Surface& b) {
    const Eigen::Vector3d &m = a.plane.normal, &n = b.plane.normal;
    const double cosine = m.dot(n);
    const Eigen::Vector3d direction = m.cross(n);
    const double angle = std::atan2(direction.norm(), std::abs(cosine));
    // Of (nearly) parallel planes no line is known.
    if (angle < min_angle_ - kSlack || angle > max_angle_ + kSlack || direction.norm() < kLeastSine)
        return;
    // The point of the line that is nearest to the middle of the two: middle + M^T x.
    const Eigen::Vector3d middle = 0.5 * (a.plane.centroid + b.plane.centroid);
    const Eigen::Vector2d off(-a.plane.distance(middle), -b.plane.distance(middle));
    Eigen::Matrix2d products;
    products << 1.0, cosine, cosine, 1.0;
    const Eigen::Vector2d x = products.inverse() * off;
    const Eigen::Vector3d origin = middle + m * x(0) + n * x(1);
    const auto of_a = near_line(points, a, origin, direction.normalized());
    const auto of_b = near_line(points, b, origin, direction.normalized());
    mark_beside(of_a, of_b);
    mark_beside(of_b, of_a);
}

std::vector<JoiningPlanes::Along> JoiningPlanes::near_line(
    const std::vector<Eigen::Vector3d>& points, const Surface& surface,
    const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    std::vector<Along> near;
    for (const std::uint32_t i : surface.points) {
        const Eigen::Vector3d q = points[i] - origin;
        const double t = q.dot(direction);
        if ((q - t * direction).norm() <= params_.line_distance) near.push_back({t, i});
    }
    std::sort(near.begin(), near.end(), [](const Along& a, const Along& b) { return a.t < b.t; });
    return near;
}

void JoiningPlanes::mark_beside(const std::vector<Along>& some, const std::vector<Along>& others) {
    auto other = others.begin();
    for (const Along& one : some) {
        while (other != others.end() && other->t < one.t - params_.max_gap) ++other;
        if (other == others.end()) return;
        if (other->t <= one.t + params_.max_gap) marked_[one.point] = 1;
    }
}

}  // namespace petal
