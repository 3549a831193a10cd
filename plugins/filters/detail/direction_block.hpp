// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/maps/CPointsMapXYZI.h>

#include <array>
#include <cstddef>
#include <limits>

namespace petal {

/// Directions and ranges of some points of a map, computed side by side: loops over plain arrays
/// that compilers vectorise. A point gives the same numbers in any block.
class DirectionBlock {
   public:
    static constexpr std::size_t kSize = 256;  ///< points at most

    /// Ranges and elevations of the points [first, last) of the map.
    void set(const mrpt::maps::CPointsMapXYZI& points, std::size_t first, std::size_t last);
    /// Their azimuths, after set().
    void set_azimuths();

    /// Of the k-th of them. False where there is no direction: a coordinate is not finite, or the
    /// point is the origin (which some sensors send where nothing came back).
    bool has_direction(std::size_t k) const {
        return range_[k] > 0.0F && range_[k] < std::numeric_limits<float>::infinity();
    }
    float range(std::size_t k) const { return range_[k]; }          ///< m
    float elevation(std::size_t k) const { return elevation_[k]; }  ///< rad, -pi/2 to pi/2
    float azimuth(std::size_t k) const { return azimuth_[k]; }      ///< rad, -pi to pi

   private:
    using Floats = std::array<float, kSize>;
    alignas(64) Floats x_{}, y_{}, z_{};
    alignas(64) Floats across_{}, range_{}, elevation_{}, azimuth_{};
};

}  // namespace petal
