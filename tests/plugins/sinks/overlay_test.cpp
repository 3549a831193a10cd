// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/overlay.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/images.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;
using testing::StageHarness;

constexpr int kWidth = 200;
constexpr int kHeight = 160;
constexpr int kMagnification = 2;

Images grey_photo() {
    CameraImage image;
    cv::Mat grey(kHeight, kWidth, CV_8U, cv::Scalar::all(100));
    image.image = mrpt::img::CImage(grey, mrpt::img::DEEP_COPY);
    image.camera.ncols = kWidth;
    image.camera.nrows = kHeight;
    image.camera.setIntrinsicParamsFromValues(100.0, 100.0, 100.0, 80.0);
    return Images{{image}};
}

Extrinsics identity() {
    CameraExtrinsics solved;
    solved.camera = "CAMERA";
    Extrinsics extrinsics;
    extrinsics.cameras.push_back(solved);
    return extrinsics;
}

cv::Mat picture_of(StageHarness& sink) {
    sink.fire();
    return cv::imread((sink.folder() / "stages" / "stage" / "scene_0_CAMERA.png").string());
}

/// The colour (BGR) of the picture where a raw pixel lies.
cv::Vec3b colour_at(const cv::Mat& picture, double u, double v) {
    const auto place = [](double value) {
        return static_cast<int>(std::lround((value + 0.5) * kMagnification - 0.5));
    };
    return picture.at<cv::Vec3b>(place(v), place(u));
}

bool is_grey(const cv::Vec3b& colour) {
    return colour[0] == colour[1] && colour[1] == colour[2];
}

TEST(OverlayTest, PointsLandWhereTheyProject) {
    auto points = std::make_shared<mrpt::maps::CPointsMapXYZI>();
    points->insertPointFast(0.2F, 0.1F, 1.0F);    // pixel (120, 90)
    points->insertPointFast(-0.2F, -0.2F, 2.0F);  // pixel (90, 70)
    points->insertPointFast(0.0F, 0.0F, -1.0F);   // behind the camera
    points->insertPointFast(std::nanf(""), 0.0F, 1.0F);
    Cloud cloud;
    cloud.points = points;
    StageHarness sink = StageHarness::of<Overlay>();
    sink.give<Images>("images", grey_photo()).give<Extrinsics>("extrinsics", identity());
    sink.give<Cloud>("cloud", cloud);
    const cv::Mat picture = picture_of(sink);
    ASSERT_EQ(picture.cols, kWidth * kMagnification);
    const cv::Vec3b nearer = colour_at(picture, 120.0, 90.0);
    const cv::Vec3b farther = colour_at(picture, 90.0, 70.0);
    EXPECT_GT(nearer[2], 200) << "near is red";
    EXPECT_LT(nearer[0], 60);
    EXPECT_GT(farther[0], 200) << "far is blue";
    EXPECT_TRUE(is_grey(colour_at(picture, 100.0, 80.0))) << "what lies behind is not drawn";
}

TEST(OverlayTest, CornersAndEnlargedResidualsAreDrawn) {
    ImageBoards boards;
    ImageBoard board;
    board.camera = "CAMERA";
    board.corners = {{50.0, 40.0}};
    boards.boards.push_back(board);
    CameraPairs camera;
    camera.camera = "CAMERA";
    PointPair pair;
    pair.lidar << -0.5, -0.4, 1.0;  // projects to (50, 40)
    pair.image << 52.0, 40.0;       // 2 px right: the line ends 20 px right of (52, 40)
    camera.pairs.push_back(pair);
    Correspondences pairs;
    pairs.cameras.push_back(camera);
    StageHarness sink = StageHarness::of<Overlay>();
    sink.give<Images>("images", grey_photo()).give<Extrinsics>("extrinsics", identity());
    sink.give<ImageBoards>("image_boards", boards).give<Correspondences>("correspondences", pairs);
    const cv::Mat picture = picture_of(sink);
    const cv::Vec3b cross = colour_at(picture, 50.0, 40.0);
    EXPECT_GT(cross[1], 180) << "a green cross on the detected corner";
    EXPECT_LT(cross[2], 120);
    const cv::Vec3b line = colour_at(picture, 70.0, 40.0);
    EXPECT_GT(line[2], 180) << "the yellow line reaches 20 px";
    EXPECT_LT(line[0], 60);
    EXPECT_TRUE(is_grey(colour_at(picture, 76.0, 40.0))) << "and no farther";
}

TEST(OverlayTest, WithoutExtrinsicsThePhotoIsStillDrawnAndThePacketUntouched) {
    const Images photo = grey_photo();
    StageHarness sink = StageHarness::of<Overlay>();
    sink.give<Images>("images", photo).give<Extrinsics>("extrinsics", Extrinsics{});
    sink.set("magnification", 1);
    EXPECT_FALSE(picture_of(sink).empty());
    const cv::Mat pixels = photo.cameras[0].image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
    EXPECT_EQ(cv::countNonZero(pixels != 100), 0);
}

TEST(OverlayTest, LabelsAreNoPathsAndDoNotMeet) {
    Images photos;
    const std::vector<std::string> labels = {"/cam/front", "_cam_front", "../../esc", "a/b", "a_b"};
    for (const std::string& label : labels) {
        photos.cameras.push_back(grey_photo().cameras[0]);
        photos.cameras.back().label = label;
    }
    StageHarness sink = StageHarness::of<Overlay>();
    sink.give<Images>("images", photos).give<Extrinsics>("extrinsics", Extrinsics{});
    sink.fire();
    std::size_t pictures = 0;
    for (const auto& entry : fs::directory_iterator(sink.folder() / "stages" / "stage")) {
        EXPECT_TRUE(entry.is_regular_file()) << entry.path();
        ++pictures;
    }
    EXPECT_EQ(pictures, labels.size());
}

TEST(OverlayTest, ScenesOfOneNameHaveTheirOwnPictures) {
    StageHarness sink = StageHarness::of<Overlay>();
    sink.give<Extrinsics>("extrinsics", Extrinsics{});
    sink.give<Images>("images", grey_photo(), "../scene");
    sink.give<Images>("images", grey_photo(), "../scene");
    sink.fire();
    const fs::path folder = sink.folder() / "stages" / "stage";
    EXPECT_TRUE(fs::exists(folder / "%2E.%2Fscene_CAMERA.png"));
    EXPECT_TRUE(fs::exists(folder / "%2E.%2Fscene_CAMERA_2.png"));
}

}  // namespace
}  // namespace petal
