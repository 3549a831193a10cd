// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/images.hpp"
#include "petal/run.hpp"

namespace petal {

/// One scene's cloud with the cameras whose pose is known.
struct JudgedScene {
    struct View {
        const CameraImage* image;  ///< lives as long as `images`
        CameraImage judged;        ///< the same pixels, with the intrinsics that the pose is for
        Eigen::Isometry3d T_camera_lidar;
    };
    std::string name;  ///< unique in the run, fit for a file's name
    std::shared_ptr<const Cloud> cloud;
    std::shared_ptr<const Images> images;
    std::vector<View> views;
};

/// The scenes of the gathering ports `images`, `cloud` and `extrinsics` that have a cloud and an
/// image of a camera with a pose; a note where there is none. An estimated focal length is applied.
std::vector<JudgedScene> judged_scenes(Run& run);

}  // namespace petal
