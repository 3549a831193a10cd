// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <limits>
#include <memory>
#include <opencv2/core.hpp>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/images.hpp"
#include "petal/testing/stage_harness.hpp"

/// A LiDAR that looks along its x axis, a camera 10 cm before it that looks the same way, and a
/// photo that is red on the left and blue on the right.
namespace petal::judged_example {

inline Extrinsics pose() {
    CameraExtrinsics camera;
    camera.camera = "CAMERA";
    camera.lidar = "LIDAR";
    camera.T_camera_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    camera.T_camera_lidar.translation() << 0.0, 0.0, -0.1;
    Extrinsics extrinsics;
    extrinsics.cameras.push_back(camera);
    return extrinsics;
}

inline Images photo() {
    cv::Mat pixels(120, 160, CV_8UC3, cv::Scalar(0, 0, 255));
    pixels.colRange(80, 160) = cv::Scalar(255, 0, 0);
    CameraImage image;
    image.image = mrpt::img::CImage(pixels, mrpt::img::DEEP_COPY);
    image.camera.ncols = 160;
    image.camera.nrows = 120;
    image.camera.setIntrinsicParamsFromValues(100.0, 100.0, 79.5, 59.5);
    return Images{{image}};
}

/// Seen left, seen right, hidden behind the first, beside the photo, behind the camera, no number.
inline Cloud cloud() {
    auto points = std::make_shared<mrpt::maps::CPointsMapXYZI>();
    points->insertPointFast(2.0F, 0.5F, 0.0F);
    points->insertPointFast(2.0F, -0.5F, 0.0F);
    // On the first one's ray from the camera, at 0.1 m: (5.9 / 1.9) times as far.
    points->insertPointFast(6.0F, 0.5F * 5.9F / 1.9F, 0.0F);
    points->insertPointFast(1.0F, 3.0F, 0.0F);
    points->insertPointFast(-2.0F, 0.0F, 0.0F);
    points->insertPointFast(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F);
    Cloud cloud;
    cloud.points = points;
    return cloud;
}

inline void give(testing::StageHarness& stage, const Extrinsics& extrinsics) {
    stage.give<Images>("images", photo(), "hall");
    stage.give<Cloud>("cloud", cloud(), "hall");
    stage.give<Extrinsics>("extrinsics", extrinsics);
}

template <class S>
testing::StageHarness stage() {
    testing::StageHarness harness = testing::StageHarness::of<S>();
    give(harness, pose());
    return harness;
}

}  // namespace petal::judged_example
