// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/image_contours.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <filesystem>
#include <opencv2/imgproc.hpp>

#include "image_render.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

using testing::board_pose;
using ::testing::HasSubstr;
using testing::make_camera;
using testing::Photo;
using testing::StageHarness;
using testing::true_corners;

const std::string kTarget = PETAL_SOURCE_DIR "/datasets/targets/four_square_holes_500mm.json";

StageHarness detector() {
    StageHarness stage = StageHarness::of<ImageContours>("detector.image_contours");
    stage.set("target", kTarget.c_str());
    return stage;
}

ImageBoards detect(const CameraImage& image) {
    return testing::boards_in(detector(), image);
}

std::size_t files_with(const std::filesystem::path& folder, const std::string& part) {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.path().filename().string().find(part) != std::string::npos) ++count;
    return count;
}

struct View {
    double distance, yaw, pitch, roll;
};

class ImageContoursView : public ::testing::TestWithParam<View> {};

// 0.15 px: a seventh of a pixel is what edges 20 px long give with 3 grey levels of noise, and a
// third of the 0.5 px at which the solver begins to notice.
TEST_P(ImageContoursView, FindsCornersOfARenderedBoard) {
    const Target target = load_target(kTarget);
    const auto camera = make_camera(640, 480, 500.0);
    const View view = GetParam();
    const auto pose =
        board_pose(target, {0.1, -0.05, view.distance}, view.yaw, view.pitch, view.roll);
    const ImageBoards found = detect(Photo(camera).add(target, pose).take(0.8, 3.0));
    ASSERT_EQ(found.boards.size(), 1u);
    const auto truth = true_corners(target, CameraModel(camera), pose);
    EXPECT_LT(testing::rms_distance(found.boards[0].corners, truth), 0.15);
    RecordProperty("rms_px", std::to_string(testing::rms_distance(found.boards[0].corners, truth)));
    EXPECT_EQ(found.boards[0].target, target.name);
    EXPECT_EQ(found.boards[0].camera, "CAMERA");
}

INSTANTIATE_TEST_SUITE_P(Tilts, ImageContoursView,
                         ::testing::Values(View{1.5, 0, 0, 0}, View{2.5, 0, 0, 10},
                                           View{1.5, 45, 0, 0}, View{1.5, -45, 0, 5},
                                           View{1.5, 0, 45, 0}, View{1.5, 0, -45, -20},
                                           View{1.5, 30, 30, 0}, View{2.0, -30, 25, 30},
                                           View{0.8, 20, -10, 0}));

TEST(ImageContours, CovarianceSaysHowFarCornersAreOff) {
    const Target target = load_target(kTarget);
    const auto camera = make_camera(640, 480, 500.0);
    double normalised = 0.0, joint = 0.0, count = 0.0;
    for (int i = 0; i < 6; ++i) {
        const auto pose =
            board_pose(target, {0.05 * i, 0.03 * i, 1.8 + 0.13 * i}, 5.0 * i, 12.0, 3.0 * i);
        const ImageBoards found = detect(Photo(camera).add(target, pose).take(0.8, 3.0));
        ASSERT_EQ(found.boards.size(), 1u);
        const auto truth = true_corners(target, CameraModel(camera), pose);
        Eigen::VectorXd errors(32);
        for (std::size_t c = 0; c < truth.size(); ++c, count += 2.0) {
            const Eigen::Vector2d error = found.boards[0].corners[c] - truth[c];
            errors.segment<2>(static_cast<Eigen::Index>(2 * c)) = error;
            normalised += error.dot(found.boards[0].covariance[c].inverse() * error);
        }
        ASSERT_EQ(found.boards[0].joint_covariance.rows(), 32);
        joint += errors.dot(found.boards[0].joint_covariance.inverse() * errors);
    }
    // 1 where the covariance is right. It may be too careful (the floor is for real photos), hardly
    // too bold.
    EXPECT_LT(normalised / count, 1.5);
    EXPECT_GT(normalised / count, 0.1);
    // Of all together no floor hides what is too bold. Six boards of 32 figures, each with a
    // variance known from 22: 1.1 +- 0.2.
    EXPECT_LT(joint / count, 2.0);
    EXPECT_GT(joint / count, 0.4);
}

TEST(ImageContours, KeepsToRawPixelsUnderDistortion) {
    const Target target = load_target(kTarget);
    const auto camera = make_camera(800, 600, 450.0, -0.25);
    // Off the axis, where the distortion moves pixels by more than ten.
    const auto pose = board_pose(target, {0.8, 0.5, 1.6}, 20.0, 10.0);
    const ImageBoards found = detect(Photo(camera).add(target, pose).take(0.8, 2.0));
    ASSERT_EQ(found.boards.size(), 1u);
    EXPECT_LT(testing::rms_distance(found.boards[0].corners,
                                    true_corners(target, CameraModel(camera), pose)),
              0.15);
}

TEST(ImageContours, ABrightThingBehindAHoleDoesNotBendItsCorners) {
    const Target target = load_target(kTarget);
    const auto camera = make_camera(640, 480, 500.0);
    const auto pose = board_pose(target, {0.0, 0.0, 2.0}, 8.0, 4.0);
    // Hole 2 (lower left, y 0.3 to 0.4) ends 22 mm early: 5 px of 25.
    const ImageBoards found = detect(Photo(camera).add(target, pose, 180.0, 0.378).take(0.8, 2.0));
    ASSERT_EQ(found.boards.size(), 1u);
    const ImageBoard& board = found.boards[0];
    EXPECT_EQ(board.quality.at("sides_from_geometry"), 1.0);
    const auto truth = true_corners(target, CameraModel(camera), pose);
    EXPECT_LT(testing::rms_distance(board.corners, truth), 0.15);
    // Corners 12 and 13 end the hidden side: they must not claim to be as good as the others.
    EXPECT_GT(board.covariance[12](1, 1), 2.0 * board.covariance[15](1, 1));
    EXPECT_GT(board.covariance[13](1, 1), 2.0 * board.covariance[14](1, 1));
}

// The walls of 5 mm are 0.7 px wide here. 0.15 px as for plates without thickness.
TEST(ImageContours, FindsTheFrontEdgesWhereWallsShowInTheHoles) {
    const Target target = load_target(kTarget);
    const auto camera = make_camera(640, 480, 500.0);
    const auto pose = board_pose(target, {0.05, -0.1, 1.4}, 25.0, -18.0, 4.0);
    const auto truth = true_corners(target, CameraModel(camera), pose);
    const auto off = [&](double wall, bool model_walls) {
        StageHarness stage = detector();
        stage.set("model_walls", model_walls);
        stage.give<Images>(
            "images", Images{{Photo(camera).add(target, pose, 180.0, 1e9, wall).take(0.8, 2.0)}});
        stage.fire();
        const auto& found = stage.out<ImageBoards>("boards");
        return found.boards.size() == 1 ? testing::rms_distance(found.boards[0].corners, truth)
                                        : 1e9;
    };
    EXPECT_LT(off(0.9, true), 0.15);
    EXPECT_GT(off(0.9, false), 0.3) << "the bias that the model is there for";
    // Hardly brighter than what is behind the holes: the front edges are seen as they are.
    EXPECT_LT(off(0.5, true), 0.15);
    // Lit from above: the edge that is seen lies behind the wall's back edge.
    EXPECT_LT(off(1.3, true), 0.15);
}

TEST(ImageContours, SeveralBoardsFromLeftToRight) {
    const Target target = load_target(kTarget);
    const auto camera = make_camera(960, 480, 500.0);
    Photo photo(camera);
    const std::vector<double> x{1.2, -1.0, 0.1};
    for (const double place : x)
        photo.add(target, board_pose(target, {place, 0.0, 2.2}, 10.0, 0.0));
    const ImageBoards found = detect(photo.take(0.8, 2.0));
    ASSERT_EQ(found.boards.size(), 3u);
    EXPECT_LT(found.boards[0].corners[0].x(), found.boards[1].corners[0].x());
    EXPECT_LT(found.boards[1].corners[0].x(), found.boards[2].corners[0].x());
}

TEST(ImageContours, ColourAndGreyGiveTheSameCorners) {
    const Target target = load_target(kTarget);
    const auto camera = make_camera(640, 480, 500.0);
    const auto pose = board_pose(target, {0.0, 0.0, 2.0}, 8.0, 4.0);
    const CameraImage grey = Photo(camera).add(target, pose).take(0.8, 2.0);
    cv::Mat bgr;
    cv::cvtColor(grey.image.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY), bgr, cv::COLOR_GRAY2BGR);
    const ImageBoards a = detect(grey), b = detect(Photo::wrap(bgr, camera));
    ASSERT_EQ(a.boards.size(), 1u);
    ASSERT_EQ(b.boards.size(), 1u);
    EXPECT_EQ(testing::rms_distance(a.boards[0].corners, b.boards[0].corners), 0.0);
}

TEST(ImageContours, AllCamerasAreListedAlsoThoseThatFoundNothing) {
    const Target target = load_target(kTarget);
    const auto camera = make_camera(640, 480, 500.0);
    const auto pose = board_pose(target, {0.0, 0.0, 2.0}, 0.0, 0.0);
    StageHarness stage = detector();
    stage.give<Images>("images", Images{{Photo(camera).take(0.8, 2.0, "left"),
                                         Photo(camera).add(target, pose).take(0.8, 2.0, "right")}});
    stage.fire();
    const ImageBoards& found = stage.out<ImageBoards>("boards");
    ASSERT_EQ(found.cameras.size(), 2u);
    EXPECT_EQ(found.cameras[0].label, "left");
    EXPECT_EQ(found.cameras[1].label, "right");
    ASSERT_EQ(found.boards.size(), 1u);
    EXPECT_EQ(found.boards[0].camera, "right");
}

TEST(ImageContours, APhotoWithoutABoardGivesANoteAndAPicture) {
    StageHarness stage = detector();
    stage.give<Images>("images",
                       Images{{Photo(make_camera(640, 480, 500.0)).take(0.8, 2.0, "cam/0")}});
    stage.fire();
    EXPECT_TRUE(stage.out<ImageBoards>("boards").boards.empty());
    EXPECT_EQ(stage.out<ImageBoards>("boards").cameras.size(), 1u);
    ASSERT_EQ(stage.notes().size(), 1u);
    EXPECT_THAT(stage.notes()[0].looked_for, HasSubstr("cam/0"));
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("dark squares"));
    EXPECT_EQ(files_with(stage.folder(), "squares_cam%2F0.png"), 1u);
}

TEST(ImageContours, TwoOfFourHolesAreToldAsTheNearestMiss) {
    Target half = load_target(kTarget);
    half.holes.resize(2);
    const auto camera = make_camera(640, 480, 500.0);
    StageHarness stage = detector();
    stage.give<Images>(
        "images",
        Images{{Photo(camera).add(half, board_pose(half, {0, 0, 2.0}, 5, 0)).take(0.8, 2.0)}});
    stage.fire();
    EXPECT_TRUE(stage.out<ImageBoards>("boards").boards.empty());
    ASSERT_EQ(stage.notes().size(), 1u);
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("2 of 4 holes"));
    EXPECT_THAT(stage.notes()[0].threshold, HasSubstr("min_holes 3"));
}

TEST(ImageContours, BlackTinyAndFlatImagesFindNothing) {
    for (const auto& [width, height, grey] :
         {std::array<int, 3>{640, 480, 0}, {640, 480, 255}, {3, 2, 10}, {1, 1, 0}}) {
        const cv::Mat flat(height, width, CV_8U, cv::Scalar(grey));
        EXPECT_TRUE(detect(Photo::wrap(flat, make_camera(width, height, 500.0))).boards.empty());
    }
}

TEST(ImageContours, AnImageOfAnotherSizeThanItsIntrinsicsIsRefused) {
    CameraImage image = Photo(make_camera(640, 480, 500.0)).take(0.0, 0.0, "front");
    image.camera = make_camera(1280, 720, 500.0);
    StageHarness stage = detector();
    stage.give<Images>("images", Images{{image}});
    try {
        stage.fire();
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("front"));
        EXPECT_THAT(error.what(), HasSubstr("640 x 480"));
        EXPECT_THAT(error.what(), HasSubstr("1280 x 720"));
    }
}

TEST(ImageContours, IntrinsicsThatAreNoCameraAreRefusedByLabel) {
    CameraImage image = Photo(make_camera(640, 480, 500.0)).take(0.0, 0.0, "front");
    image.camera.setIntrinsicParamsFromValues(0.0, 0.0, 0.0, 0.0);
    StageHarness stage = detector();
    stage.give<Images>("images", Images{{image}});
    try {
        stage.fire();
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("front"));
    }
}

TEST(ImageContours, NoImageGivesANote) {
    StageHarness stage = detector();
    stage.give<Images>("images", Images{});
    stage.fire();
    EXPECT_TRUE(stage.out<ImageBoards>("boards").cameras.empty());
    EXPECT_EQ(stage.notes().size(), 1u);
}

TEST(ImageContours, StopsWhenCancelled) {
    StageHarness stage = detector();
    stage.give<Images>("images", Images{{Photo(make_camera(640, 480, 500.0)).take(0.0, 0.0)}});
    stage.cancel();
    EXPECT_THROW(stage.fire(), Cancelled);
}

TEST(ImageContours, ATargetWithoutHolesOfFourCornersIsRefused) {
    const std::pair<const char*, const char*> targets[] = {
        {"four_round_holes_aruco", "4 round holes, 4 markers"}, {"checkerboard", "1 checkerboard"}};
    for (const auto& [target, shows] : targets) {
        StageHarness stage = detector();
        stage.set("target", target).give<Images>("images", Images{});
        try {
            stage.fire();
            FAIL() << "no error";
        } catch (const Error& error) {
            EXPECT_THAT(error.what(), HasSubstr(target));
            EXPECT_THAT(error.what(), HasSubstr(shows));
            EXPECT_THAT(error.what(), HasSubstr("holes with four corners"));
        }
    }
}

TEST(ImageContours, MoreHolesAskedForThanTheTargetHasIsRefused) {
    StageHarness stage = detector();
    stage.set("min_holes", 5).give<Images>("images", Images{});
    EXPECT_THROW(stage.fire(), Error);
}

}  // namespace
}  // namespace petal
