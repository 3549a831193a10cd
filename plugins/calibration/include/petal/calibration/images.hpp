// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/img/CImage.h>
#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <string>
#include <vector>

#include "petal/packet.hpp"

namespace petal {

/// One still of one camera. Pixels are raw (distorted); the centre of the top-left pixel is (0, 0).
struct CameraImage {
    std::string label = "CAMERA";
    mrpt::img::CImage image;    ///< 8 bit, 1 or 3 channels; loaded
    mrpt::img::TCamera camera;  ///< ncols x nrows are those of `image`
    mrpt::Clock::time_point stamp{};
    mrpt::poses::CPose3D sensor_pose;  ///< recorded, never applied
};

/// The images of a scene: one a camera, labels unique. Empty where the scene has none.
struct Images {
    std::vector<CameraImage> cameras;
    /// More images of those cameras in the same scene, where the source keeps them: recorders write
    /// them too (sink.rawlog), detectors pass over them.
    std::vector<CameraImage> others{};
};

template <>
struct PacketTraits<Images> {
    static constexpr const char* name = "Images";
    static void seal(Images& images);
    static std::size_t bytes(const Images& images);
};

}  // namespace petal
