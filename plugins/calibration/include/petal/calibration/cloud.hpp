// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "petal/packet.hpp"

namespace petal {

/// Points of one LiDAR in its own frame, in metres.
///
/// The points are shared, so a Cloud is cheap to copy; a stage that drops or moves points makes a
/// new map. Points may be NaN where the input had them: sources keep what they read, detectors skip
/// them.
struct Cloud {
    /// One LiDAR message of the scene: where its points begin, and when it was taken.
    struct Part {
        std::size_t begin = 0;
        mrpt::Clock::time_point stamp{};
    };

    std::shared_ptr<const mrpt::maps::CPointsMapXYZI> points =
        std::make_shared<mrpt::maps::CPointsMapXYZI>();
    std::string sensor_label = "LIDAR";
    mrpt::poses::CPose3D sensor_pose;  ///< sensor on the vehicle: recorded, never applied
    std::vector<Part> parts;           ///< the messages accumulated; empty after a filter
    /// For each point its index in the scene's own cloud; empty where they are the same.
    std::vector<std::uint32_t> scene_index;

    std::size_t size() const { return points->size(); }
};

template <>
struct PacketTraits<Cloud> {
    static constexpr const char* name = "Cloud";
    static void seal(Cloud& cloud);
    static std::size_t bytes(const Cloud& cloud);
};

}  // namespace petal
