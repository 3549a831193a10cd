// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/testing/stage_harness.hpp"
#include "sinks/report.hpp"

namespace petal::report_samples {

/// What a label may be, as labels come from files: a name that would run if it were not escaped.
inline const std::string kHostile = "</script><img src=x onerror=\"document.title='run'\"><b>'&\"";

inline Eigen::Isometry3d camera_of_lidar() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    T.translation() << 0.04, -0.11, -0.03;
    return T;
}

inline mrpt::img::TCamera intrinsics() {
    mrpt::img::TCamera camera;
    camera.ncols = 320;
    camera.nrows = 240;
    camera.setIntrinsicParamsFromValues(300.0, 300.0, 160.0, 120.0);
    return camera;
}

inline Eigen::Vector2d pixel_of(const Eigen::Vector3d& lidar) {
    const Eigen::Vector3d p = camera_of_lidar() * lidar;
    return {300.0 * p.x() / p.z() + 160.0, 300.0 * p.y() / p.z() + 120.0};
}

/// 16 corners of a board that stands `x` m ahead of the LiDAR.
inline std::vector<Eigen::Vector3d> corners_at(double x) {
    std::vector<Eigen::Vector3d> corners;
    for (const double z : {0.15, 0.05, -0.05, -0.15})
        for (const double y : {0.15, 0.05, -0.05, -0.15}) corners.emplace_back(x, y, z);
    return corners;
}

inline Images photo(const std::vector<std::string>& cameras) {
    Images images;
    for (const std::string& label : cameras) {
        cv::Mat pixels(240, 320, CV_8UC3, cv::Scalar(60, 90, 120));
        cv::rectangle(pixels, {120, 90}, {200, 170}, cv::Scalar(230, 230, 230), cv::FILLED);
        CameraImage image;
        image.label = label;
        image.image = mrpt::img::CImage(pixels, mrpt::img::DEEP_COPY);
        image.camera = intrinsics();
        images.cameras.push_back(image);
    }
    return images;
}

/// A plate and a wall behind it.
inline Cloud plate_and_wall(double x) {
    auto points = std::make_shared<mrpt::maps::CPointsMapXYZI>();
    for (int y = -40; y <= 40; ++y)
        for (int z = -30; z <= 30; ++z) {
            points->insertPointFast(4.0F, 0.05F * static_cast<float>(y),
                                    0.05F * static_cast<float>(z));
            points->insertPointFast(static_cast<float>(x), 0.006F * static_cast<float>(y),
                                    0.008F * static_cast<float>(z));
        }
    Cloud cloud;
    cloud.points = points;
    return cloud;
}

inline Diagnosis diagnosis(const std::vector<std::string>& scenes) {
    Diagnosis told;
    told.covariance_considered = 4e-6 * Matrix6d::Identity();
    told.variance_scale = 1.25;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        Diagnosis::Scene scene;
        scene.scene = i;
        scene.name = scenes[i];
        scene.chi2 = 5.5;
        scene.degrees_of_freedom = 6;
        scene.influence = 0.5;
        scene.shift_sigmas = 2.25;
        told.scenes.push_back(scene);
    }
    told.drifts = {{5.0, 0.4, 1.25}, {20.0, 0.5, 1.5}};
    told.advice = Diagnosis::Advice{"a board at the left", 3, 10, 20, 0, 0, 2e-3, 1e-3, 5e-4, 2e-4};
    told.focal = Diagnosis::FocalScale{1.002, 0.0015, false};
    return told;
}

/// Two scenes, two cameras of which the second was not solved; the second scene has a board that
/// the LiDAR alone saw.
struct Sample {
    std::vector<std::string> scenes{"hall " + kHostile, "yard"};
    std::vector<std::string> cameras{"FRONT " + kHostile, "REAR"};
    Extrinsics extrinsics;

    Sample() {
        CameraExtrinsics solved;
        solved.camera = cameras[0];
        solved.lidar = "LIDAR " + kHostile;
        solved.model = intrinsics();
        solved.T_camera_lidar = camera_of_lidar();
        solved.covariance = 1e-6 * Matrix6d::Identity();
        solved.sigma_translation << 1.1e-3, 2.2e-3, 3.3e-3;
        solved.sigma_rotation << 1e-4, 2e-4, 3e-4;
        solved.weakest_direction = "tilting about x";
        solved.chi2 = 11.0;
        solved.degrees_of_freedom = 12;
        solved.order.by = DecidedBy::data;
        solved.order.runner_up_rms_ratio = 7.5;
        for (std::uint64_t scene = 0; scene < 2; ++scene)
            for (int corner = 0; corner < 16; ++corner)
                solved.residuals.push_back(
                    {scene, 0, corner, {0, 0}, {0.1 * corner - 0.7, 0.05 * corner}});
        solved.diagnosis = diagnosis(scenes);
        extrinsics.cameras.push_back(solved);
        extrinsics.level = Level::weak;
        extrinsics.reasons = {"two boards only " + kHostile};
    }

    /// The sink with everything wired.
    testing::StageHarness harness() const {
        auto sink = testing::StageHarness::of<Report>("sink.report");
        sink.give<Extrinsics>("extrinsics", extrinsics);
        for (std::size_t i = 0; i < 2; ++i) {
            const double x = 2.0 + 0.5 * static_cast<double>(i);
            LidarBoards lidar{"LIDAR", {}};
            ImageBoards image;
            CameraPairs pairs;
            pairs.scene = i;
            pairs.scene_name = scenes[i];
            pairs.camera = cameras[0];
            LidarBoard board;
            board.target = "t";
            board.corners = corners_at(x);
            lidar.boards.push_back(board);
            ImageBoard seen;
            seen.target = "t";
            seen.camera = cameras[0];
            pairs.boards.emplace_back();
            pairs.boards.back().lidar = 0;
            pairs.boards.back().image = 0;
            for (std::size_t corner = 0; corner < board.corners.size(); ++corner) {
                seen.corners.push_back(pixel_of(board.corners[corner]));
                PointPair pair;
                pair.lidar = board.corners[corner];
                pair.image = seen.corners.back();
                pair.board = 0;
                pair.corner = static_cast<int>(corner);
                pairs.pairs.push_back(pair);
            }
            image.boards.push_back(seen);
            if (i == 1) lidar.boards.push_back(board);
            Correspondences correspondences;
            correspondences.cameras.push_back(pairs);
            Metrics metrics;
            metrics.values = {{"reprojection.rms_px", 0.125, "px", i == 0 ? "" : scenes[0]},
                              {"odd/na~me_px" + kHostile, 1.0 / 3.0, "px", ""}};
            metrics.findings = {{Level::weak, "the board moved " + kHostile}};
            sink.give<Images>("images", photo(cameras), scenes[i])
                .give<Cloud>("cloud", plate_and_wall(x), scenes[i])
                .give<Correspondences>("correspondences", correspondences, scenes[i])
                .give<LidarBoards>("lidar_boards", lidar, scenes[i])
                .give<ImageBoards>("image_boards", image, scenes[i])
                .give<Metrics>("metrics", metrics);
        }
        return sink;
    }
};

}  // namespace petal::report_samples
