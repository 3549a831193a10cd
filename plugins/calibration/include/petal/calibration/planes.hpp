// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "petal/calibration/cloud.hpp"
#include "petal/packet.hpp"

namespace petal {

/// A plane n . p + d = 0 (equation (2) of the letter) and the points that made it.
struct Plane {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< unit length, towards the sensor (d > 0)
    double offset = 0.0;  ///< d, in metres: the distance of the sensor
    Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< of (normal, offset); rank 3
    double rms = 0.0;                                      ///< of the inliers' distances, m
    Cloud inliers;
};

struct Planes {
    std::vector<Plane> planes;
};

template <>
struct PacketTraits<Planes> {
    static constexpr const char* name = "Planes";
    static void seal(Planes& planes);
    static std::size_t bytes(const Planes& planes);
};

}  // namespace petal
