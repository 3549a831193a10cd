// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "petal/run.hpp"
#include "simulation/lidar/lidar_profile.hpp"
#include "simulation/world/motion.hpp"
#include "simulation/world/world.hpp"

namespace petal::simulation {

/// One device of a profile, with the errors that are its own.
struct LidarDevice {
    LidarProfile profile;
    double range_offset = 0.0;         ///< m: added to every range
    double direction_error_deg = 0.0;  ///< at the rim of the field of view: a systematic error that
                                       ///< grows with the angle off the axis
};

/// What the sensor sends in 0.1 s. LiDAR frame: x forward, y left, z up.
struct LidarMessage {
    double stamp = 0.0;            ///< s after the scene's beginning
    std::vector<float> x, y, z;    ///< m
    std::vector<float> intensity;  ///< 0 to 1
    std::vector<std::uint8_t>
        label;  ///< as in labels.u8: 0 background, 1 board, 2 vacant, 3 other foreground
};

/// `duration` s of pulses against the world. The LiDAR sits at motion.at(t). The same seed gives
/// the same bytes for any number of threads: each message has random numbers of its own.
std::vector<LidarMessage> simulate_lidar(const World& world, const LidarDevice& device,
                                         const Motion& motion, double duration, std::uint64_t seed,
                                         const Run& run);

}  // namespace petal::simulation
