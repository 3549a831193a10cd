// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace petal {

/// Whether a point lies inside a simple polygon, in either order of its corners; on a side it may
/// be either. Never for a point with NaN.
inline bool inside_polygon(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& p) {
    bool in = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const Eigen::Vector2d& a = polygon[i];
        const Eigen::Vector2d& b = polygon[j];
        if ((a.y() > p.y()) != (b.y() > p.y()) &&
            p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
            in = !in;
    }
    return in;
}

/// The distance of a point, inside or outside, to the nearest side of a polygon without sides of
/// no length. Infinity where there are no sides.
inline double distance_to_polygon(const std::vector<Eigen::Vector2d>& polygon,
                                  const Eigen::Vector2d& p) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d& a = polygon[i];
        const Eigen::Vector2d d = polygon[(i + 1) % polygon.size()] - a;
        const double t = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (a + t * d - p).norm());
    }
    return nearest;
}

}  // namespace petal
