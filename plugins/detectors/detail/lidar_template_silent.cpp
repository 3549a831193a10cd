// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_silent.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "detectors/detail/lidar_template_fit.hpp"

namespace petal {
namespace {

constexpr int kSilentCellsInSide = 100;  ///< of the board's lesser side
constexpr double kNearby = 0.12;         ///< of the lesser side: 1 sigma of the mean of densities
constexpr double kReturned = 0.75;       ///< where more of the expected rays returned, all did
constexpr double kSilentLeastExpected = 5.0;  ///< rays in a hole: fewer tell no share

struct SilentOpening {
    double expected = 0.0, missed = 0.0;
};

}  // namespace

double add_silent(const PlateTemplate& target, const RayBundle& bundle, double margin,
                  ToldRays& zone) {
    const PlateShape& shape = target.holes;
    const double cell = shape.least_side() / kSilentCellsInSide;
    const double reach = shape.radius() + shape.reach();
    const int half = static_cast<int>(std::ceil(reach / cell)), size = 2 * half + 1;
    const auto place = [&](int column, int row) {
        return Eigen::Vector2d(cell * (column - half), cell * (row - half));
    };
    cv::Mat hits = cv::Mat::zeros(size, size, CV_32F), plate = hits.clone();
    const double square = cell * cell;
    double area = 0.0, count = 0.0;
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column)
            if (target.all.beyond(place(column, row), margin) > 0) {
                plate.at<float>(row, column) = static_cast<float>(square);
                area += square;
            }
    // By hole; by side of the outline behind them.
    std::vector<SilentOpening> openings(shape.hole_count() + target.all.side_count());
    const auto opening_of = [&](const Eigen::Vector2d& p, int side) -> SilentOpening& {
        const int hole = shape.hole_at(p);
        return openings[hole >= 0 ? static_cast<std::size_t>(hole)
                                  : shape.hole_count() + static_cast<std::size_t>(side)];
    };
    for (const PlaneRay& ray : bundle.rays) {
        const Told told = bundle.told(ray);
        const int column = static_cast<int>(std::floor(ray.place.x() / cell + 0.5)) + half;
        const int row = static_cast<int>(std::floor(ray.place.y() / cell + 0.5)) + half;
        if (column < 0 || row < 0 || column >= size || row >= size) continue;
        if (told == Told::hit && plate.at<float>(row, column) > 0.0F) {
            hits.at<float>(row, column) += 1.0F;
            count += 1.0;
        } else if (told != Told::hit) {  // what is hidden did return
            if (shape.beyond(ray.place, margin) < 0)
                opening_of(ray.place, shape.edge(ray.place).side).missed += 1.0;
        }
    }
    zone.silent.clear();
    if (!(area > 0.0) || !(count > 0.0)) return 0.0;
    const double sigma = kNearby * shape.least_side() / cell;
    cv::Mat density, held;
    cv::GaussianBlur(hits, density, cv::Size(), sigma, sigma, cv::BORDER_CONSTANT);
    cv::GaussianBlur(plate, held, cv::Size(), sigma, sigma, cv::BORDER_CONSTANT);
    cv::divide(density, held, density);
    const auto rays_at = [&](int column, int row) {
        const float h = held.at<float>(row, column);
        return h > 1e-3F * static_cast<float>(square)
                   ? square * static_cast<double>(density.at<float>(row, column))
                   : 0.0;
    };
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) {
            const Eigen::Vector2d p = place(column, row);
            const PlateShape::Edge edge = shape.edge(p);
            if (edge.inside < -margin && shape.in_zone(p))
                opening_of(p, edge.side).expected += rays_at(column, row);
        }
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) {
            const Eigen::Vector2d p = place(column, row);
            if (!shape.in_zone(p)) continue;
            const PlateShape::Edge edge = shape.edge(p);
            // On the plate: the opening that the nearest edge leads to.
            const Eigen::Vector2d in = p - (edge.inside + margin) * edge.inward;
            const SilentOpening& opening = opening_of(edge.inside < 0.0 ? p : in, edge.side);
            if (opening.expected < kSilentLeastExpected) continue;
            const double returned = opening.missed / opening.expected;
            if (returned > kReturned) continue;
            const double rays = (1.0 - returned) * rays_at(column, row);
            if (rays > 0.0)
                zone.silent.push_back({bundle.T_lidar_plane * Eigen::Vector3d(p.x(), p.y(), 0.0),
                                       rays, edge.inside > 0.0});
        }
    return count / area;
}

double gain_over_share(const ToldRays& zone, double log_likelihood) {
    double hits = zone.far_hits, misses = zone.right + zone.wrong - zone.far_hits;
    double silent = 0.0, best = 0.0;
    for (const ToldRays::Ray& ray : zone.rays) (ray.hit ? hits : misses) += 1.0;
    for (const ToldRays::Silent& place : zone.silent) {
        silent += place.rays;
        // The Poisson process's logarithm has no zero of its own: it is counted from all known.
        if (place.on_plate) best -= place.rays;
    }
    if (!(hits > 0.0) || !(misses + silent > 0.0)) return 0.0;
    // The share at which hits / p - misses / (1 - p) - silent = 0.
    const double b = hits + misses + silent;
    const double p =
        silent > 0.0 ? (b - std::sqrt(b * b - 4.0 * silent * hits)) / (2.0 * silent) : hits / b;
    const double alone =
        hits * std::log(p) + (misses > 0.0 ? misses * std::log1p(-p) : 0.0) - silent * p;
    return alone < best ? 1.0 - (log_likelihood - best) / (alone - best) : 0.0;
}

}  // namespace petal
