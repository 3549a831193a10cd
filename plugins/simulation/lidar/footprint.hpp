// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "simulation/lidar/echo.hpp"
#include "simulation/world/world.hpp"

namespace petal::simulation {

/// What the footprint of a pulse meets. The footprint is a rectangle, evenly lit: as high as
/// footprint_vertical and as wide as footprint_horizontal, upright in the sensor's frame.
///
/// It is sampled by rays on a grid of 57 along its longer side and 9 along the shorter. The centre
/// and two opposite corners come first: where they meet one plane all of it does. Else lines of the
/// grid, and rays of a line, are halved until neighbours meet the same. So what is smaller than
/// half a footprint can be missed.
class Footprint {
   public:
    Footprint(const World& world, const LidarProfile& profile);

    /// `beam`: its axis, world frame. `up`: the sensor's z axis there. The patches are ordered by
    /// range, and stay until the next call; none where all is sky.
    const std::vector<Patch>& meet(const Ray& beam, const Eigen::Vector3d& up);

   private:
    static constexpr int kAlong = 57;
    static constexpr int kAcross = 9;
    /// What one ray of the grid meets.
    struct Sample {
        Hit hit;
        Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m, world frame
        double energy = 0.0;  ///< as if the whole footprint met the same
    };
    using Line = std::array<Sample, 3>;  ///< first, middle and last of a line along

    void aim(const Ray& beam, const Eigen::Vector3d& up);
    Sample sample(int along, int across) const;
    Line line(int across) const;
    void take_whole(const Sample& centre, const Sample& low, const Sample& high);
    void take_lines();
    void split_lines(int low, int high, const Line& at_low, const Line& at_high,
                     std::array<double, kAcross>& weights);
    void take_line(int across, const Line& line, double weight);
    void split(int across, int low, int high, const Sample& at_low, const Sample& at_high,
               double weight);
    void add(const Surface* surface, double range, double whole_energy, double cells);
    static bool alike(const Sample& a, const Sample& b);

    const World& world_;
    double range_max_;
    bool upright_;      ///< the longer side is the vertical one
    double long_side_;  ///< rad
    double short_side_;
    Ray beam_;
    Eigen::Vector3d step_along_, step_across_;
    bool falling_ = false;  ///< the diagonal that was probed
    std::vector<Patch> patches_;
};

}  // namespace petal::simulation
