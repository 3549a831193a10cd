// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/TCamera.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

#include "petal/run.hpp"
#include "simulation/world/world.hpp"

namespace petal::simulation {

/// The light of a scene: one distant lamp (the sun, or a ceiling lamp) that casts shadows, and
/// light from everywhere.
struct Light {
    Eigen::Vector3d to_lamp = Eigen::Vector3d(-0.3, 0.5, 0.8).normalized();  ///< unit, world frame
    float lamp = 0.7F;     ///< radiance of a white surface that faces the lamp, from the lamp alone
    float ambient = 0.3F;  ///< the same from everywhere
    Eigen::Vector3f sky = {0.75F, 0.85F, 1.0F};  ///< radiance where no surface is
};

/// A camera with its lens and sensor.
struct CameraDevice {
    std::string label = "CAMERA";
    mrpt::img::TCamera intrinsics;  ///< none, plumb bob or Kannala-Brandt
    double blur_px = 0.6;       ///< sigma of the lens' point spread, beside the pixel's own area
    double vignetting = 0.25;   ///< share of light lost at the image's corners
    double exposure = 1.0;      ///< radiance 1 becomes this share of full scale
    double electrons = 8000.0;  ///< at full scale: shot noise
    double read_noise = 6.0;    ///< electrons, 1 sigma
    bool colour = true;         ///< 3 channels (BGR), else 1
};

/// Linear radiance at the sensor, CV_32FC3 (BGR), before the exposure: anti-aliased, shaded, with
/// shadows, lens blur and vignetting. Pixel (0, 0) has its centre at (0, 0). `run` is asked for its
/// threads and for a cancel.
cv::Mat render(const World& world, const Light& light, const CameraDevice& camera,
               const Eigen::Isometry3d& T_world_camera, const Run& run);

/// An 8-bit image of it: exposure, shot and read noise, quantisation, clipping. The same seed gives
/// the same bytes.
cv::Mat expose(const cv::Mat& radiance, const CameraDevice& camera, std::uint64_t seed);

}  // namespace petal::simulation
