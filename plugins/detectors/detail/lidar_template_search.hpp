// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "detectors/detail/lidar_template_cells.hpp"
#include "detectors/detail/lidar_template_shape.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/run.hpp"

namespace petal {

/// A place where a plate of the target's size may be.
struct PlateCandidate {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();   ///< m, LiDAR frame
    Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< unit, towards the sensor
    double filled = 0.0;   ///< share of the plate's area that lies in the plane
    double around = 0.0;   ///< share of a ring around the plate that lies in the plane too
    double closeness = 0;  ///< filled less around: what the nearest misses are sorted by
};

/// Finds plates that stand free anywhere in a cloud: planar patches of about the target's area,
/// with little in their plane around them. The points are gathered into cubic cells of a tenth of
/// the board's lesser side; cells, not points, are then searched, so that the time is linear in
/// the points and near surfaces do not count more than far ones.
class PlateSearch {
   public:
    PlateSearch(const Cloud& cloud, const PlateShape& shape);

    /// All plates, the most likely first. Seeds are cells in an order drawn from `rng`.
    std::vector<PlateCandidate> find(Rng& rng, const std::function<void()>& poll);
    /// A plate near a given plane patch.
    void try_patch(const Eigen::Vector3d& centre, const Eigen::Vector3d& normal);

    std::size_t cell_count() const { return cells_.size(); }
    /// The nearest to a plate that was none; closeness 0 where nothing was looked at.
    const PlateCandidate& nearest_miss() const { return nearest_miss_; }

   private:
    using Key = std::uint64_t;
    void sort_into_blocks();
    void collect(const Eigen::Vector3d& centre, double radius,
                 std::vector<std::uint32_t>& found) const;
    bool settle(PlateCandidate& plate) const;
    void measure(PlateCandidate& plate) const;
    void keep(const PlateCandidate& plate);

    double cell_size_, tolerance_, plate_radius_, plate_area_;
    std::vector<PlateCell> cells_;
    /// Cubes of the plate's radius, each a range of the cells, which are sorted by them.
    std::unordered_map<Key, std::pair<std::uint32_t, std::uint32_t>> blocks_;
    std::vector<PlateCandidate> plates_;
    PlateCandidate nearest_miss_;
};

}  // namespace petal
