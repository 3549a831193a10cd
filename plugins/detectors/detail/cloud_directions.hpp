// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "petal/calibration/cloud.hpp"

namespace petal {

/// The points of a cloud by their direction from the sensor, so that those around a place are
/// found without going over all of them. Indices, no copies; what is not finite, or in the sensor,
/// has no direction and is left out.
class CloudDirections {
   public:
    /// Linear in the points. On the threads of the calling task. `cloud` must outlive this.
    explicit CloudDirections(const Cloud& cloud);

    const Cloud& cloud() const { return cloud_; }

    /// Calls visit(begin, end) with ranges of indices that hold all points within `angle` (rad) of
    /// `axis` (unit), and some others: tile by tile, of each tile in the cloud's order.
    template <class Visit>
    void around(const Eigen::Vector3d& axis, double angle, const Visit& visit) const {
        for (std::size_t tile = 0; tile < tiles_.size(); ++tile)
            if (begins_[tile] != begins_[tile + 1] && tiles_[tile].reaches(axis, angle))
                visit(indices_.data() + begins_[tile], indices_.data() + begins_[tile + 1]);
    }

   private:
    /// A cone around a square of a cube's face.
    struct Tile {
        Eigen::Vector3d axis;
        double angle = 0.0;  ///< rad
        bool reaches(const Eigen::Vector3d& other, double others_angle) const;
    };
    const Cloud& cloud_;
    std::vector<Tile> tiles_;
    std::vector<std::uint32_t> begins_, indices_;
};

}  // namespace petal
