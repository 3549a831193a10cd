// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

#include "petal/calibration/extrinsics.hpp"

namespace petal {

/// Poses of the sensors of a calibration on the vehicle, from that of one of them.
class SensorPoses {
   public:
    /// `reference` is the label of the sensor whose own pose stays; empty: the LiDAR of the first
    /// camera. \throws Error where no entry has it, sensors hang together in two ways, or one does
    /// not hang together with the reference.
    SensorPoses(const std::vector<CameraExtrinsics>& cameras, const std::string& reference);

    const std::string& reference() const { return reference_; }
    /// All sensors but the reference: label, pose of the sensor in the reference's frame.
    const std::map<std::string, Eigen::Isometry3d>& others() const { return others_; }
    /// The factor on the given focal length that the pose of a camera belongs to; 1 for most.
    double focal_scale(const std::string& camera) const;

    /// Gives the observation its sensor's pose, and an image the focal length, where its label is
    /// one of others() or focal_scale() knows it. `vehicle` is the pose of the reference.
    void apply(mrpt::obs::CObservation& observation, const mrpt::poses::CPose3D& vehicle) const;

   private:
    std::string reference_;
    std::map<std::string, Eigen::Isometry3d> others_;
    std::map<std::string, double> focal_;
};

}  // namespace petal
