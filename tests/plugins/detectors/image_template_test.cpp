// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/image_template.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <filesystem>
#include <fstream>
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

const std::string kTemplateTarget =
    PETAL_SOURCE_DIR "/datasets/targets/four_square_holes_500mm.json";

StageHarness template_detector(const std::string& target = kTemplateTarget) {
    StageHarness stage = StageHarness::of<ImageTemplate>("detector.image_template");
    stage.set("target", target.c_str());
    return stage;
}

ImageBoards find_templates(const CameraImage& image, const std::string& target = kTemplateTarget) {
    return testing::boards_in(template_detector(target), image);
}

/// A target file of the test's own, below `folder`.
std::string write_target(const std::filesystem::path& folder, const std::string& name,
                         const std::string& shape) {
    const std::filesystem::path file = folder / (name + ".json");
    std::ofstream(file) << R"({"petal_target": 1, "name": ")" << name << R"(", "thickness": 0.0, )"
                        << shape << "}";
    return file.string();
}

struct TemplateView {
    double distance, yaw, pitch, roll;
};

class ImageTemplateView : public ::testing::TestWithParam<TemplateView> {};

// Six numbers from some 500 edge points of 3 grey levels of noise: 0.1 px is three times what they
// allow for the corners of the farthest of these boards.
TEST_P(ImageTemplateView, FindsCornersOfARenderedBoard) {
    const Target target = load_target(kTemplateTarget);
    const auto camera = make_camera(640, 480, 500.0);
    const TemplateView view = GetParam();
    const auto pose =
        board_pose(target, {0.1, -0.05, view.distance}, view.yaw, view.pitch, view.roll);
    const ImageBoards found = find_templates(Photo(camera).add(target, pose).take(0.8, 3.0));
    ASSERT_EQ(found.boards.size(), 1u);
    const auto truth = true_corners(target, CameraModel(camera), pose);
    EXPECT_LT(testing::rms_distance(found.boards[0].corners, truth), 0.1);
    RecordProperty("rms_px", std::to_string(testing::rms_distance(found.boards[0].corners, truth)));
    EXPECT_EQ(found.boards[0].target, target.name);
    EXPECT_EQ(found.boards[0].camera, "CAMERA");
}

INSTANTIATE_TEST_SUITE_P(
    Tilts, ImageTemplateView,
    ::testing::Values(TemplateView{1.5, 0, 0, 0}, TemplateView{2.5, 0, 0, 10},
                      TemplateView{1.5, 50, 0, 0}, TemplateView{1.5, -45, 0, 5},
                      TemplateView{1.5, 0, 50, 0}, TemplateView{1.5, 0, -45, -20},
                      TemplateView{1.5, 30, 30, 0}, TemplateView{2.0, -30, 25, 30},
                      TemplateView{0.8, 20, -10, 0}));

// The covariance of a pose has rank six. The 36 numbers of six boards have a mean square of 1 where
// it is right (0.6 to 1.5 in 95 of 100); a board that is rendered without any tolerance of its cut
// comes out below, hardly anything may come out above.
TEST(ImageTemplate, CovarianceSaysHowFarCornersAreOff) {
    const Target target = load_target(kTemplateTarget);
    const auto camera = make_camera(640, 480, 500.0);
    double squares = 0.0, freedoms = 0.0;
    for (int i = 0; i < 6; ++i) {
        const auto pose =
            board_pose(target, {0.05 * i, 0.03 * i, 1.8 + 0.13 * i}, 5.0 * i, 12.0, 3.0 * i);
        const ImageBoards found = find_templates(Photo(camera).add(target, pose).take(0.8, 3.0));
        ASSERT_EQ(found.boards.size(), 1u);
        const ImageBoard& board = found.boards[0];
        const auto truth = true_corners(target, CameraModel(camera), pose);
        ASSERT_EQ(board.joint_covariance.rows(), 32);
        Eigen::VectorXd off(32);
        for (std::size_t c = 0; c < truth.size(); ++c) {
            const auto at = static_cast<Eigen::Index>(2 * c);
            off.segment<2>(at) = board.corners[c] - truth[c];
            EXPECT_EQ(board.covariance[c], (board.joint_covariance.block<2, 2>(at, at)));
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(board.joint_covariance);
        int rank = 0;
        for (Eigen::Index k = 0; k < 32; ++k) {
            if (eigen.eigenvalues()(k) < 1e-9 * eigen.eigenvalues()(31)) continue;
            const double along = eigen.eigenvectors().col(k).dot(off);
            squares += along * along / eigen.eigenvalues()(k);
            ++rank;
        }
        EXPECT_EQ(rank, 6);
        freedoms += rank;
    }
    EXPECT_GT(squares / freedoms, 0.1);
    EXPECT_LT(squares / freedoms, 3.0);
    RecordProperty("nees_per_freedom", std::to_string(squares / freedoms));
}

TEST(ImageTemplate, DistortionIsTakenIntoAccount) {
    const Target target = load_target(kTemplateTarget);
    mrpt::img::TCamera fisheye = make_camera(640, 480, 250.0);
    fisheye.setDistortionKannalaBrandt(-0.012, 0.003, -0.002, 0.0003);
    for (const auto& camera : {make_camera(640, 480, 500.0, -0.25), fisheye}) {
        const double aside = camera.fx() < 300.0 ? 1.3 : 0.55;
        const auto pose = board_pose(target, {aside, 0.3, 1.5}, -20.0, 10.0, 5.0);
        const ImageBoards found = find_templates(Photo(camera).add(target, pose).take(0.8, 2.0));
        ASSERT_EQ(found.boards.size(), 1u);
        EXPECT_LT(testing::rms_distance(found.boards[0].corners,
                                        true_corners(target, CameraModel(camera), pose)),
                  0.1);
    }
}

// The kerb: something as bright as the plate, 5 px inside a hole.
TEST(ImageTemplate, ABrightThingBehindAHoleIsNotItsEdge) {
    const Target target = load_target(kTemplateTarget);
    const auto camera = make_camera(640, 480, 500.0);
    const auto pose = board_pose(target, {0.0, 0.0, 2.0}, 10.0, 5.0);
    const ImageBoards found =
        find_templates(Photo(camera).add(target, pose, 180.0, 0.378).take(0.8, 2.0));
    ASSERT_EQ(found.boards.size(), 1u);
    EXPECT_LT(found.boards[0].quality.at("edges_in_place"), 0.97);
    EXPECT_LT(testing::rms_distance(found.boards[0].corners,
                                    true_corners(target, CameraModel(camera), pose)),
              0.1);
}

// Walls of 5 mm are 0.7 px wide here; their share of brightness is fitted, not given.
TEST(ImageTemplate, FindsTheFrontEdgesWhereWallsShow) {
    const Target target = load_target(kTemplateTarget);
    const auto camera = make_camera(640, 480, 500.0);
    const auto pose = board_pose(target, {0.05, -0.1, 1.4}, 25.0, -18.0, 4.0);
    const auto truth = true_corners(target, CameraModel(camera), pose);
    const auto off = [&](double wall, bool model_walls) {
        StageHarness stage = template_detector();
        stage.set("model_walls", model_walls);
        stage.give<Images>(
            "images", Images{{Photo(camera).add(target, pose, 180.0, 1e9, wall).take(0.8, 2.0)}});
        stage.fire();
        const auto& found = stage.out<ImageBoards>("boards");
        return found.boards.size() == 1 ? testing::rms_distance(found.boards[0].corners, truth)
                                        : 1e9;
    };
    EXPECT_LT(off(0.9, true), 0.12);
    EXPECT_GT(off(0.9, false), 2.0 * off(0.9, true)) << "the bias that the model is there for";
}

// Grey behind the upper holes, nearly black behind the lower ones: walls of 0.6 of the plate's
// brightness move the upper edges by -0.4 of their width, the lower ones by +0.5. One share for all
// left 0.2 px.
TEST(ImageTemplate, AWallMovesAFaintEdgeOtherwiseThanAStrongOne) {
    const Target target = load_target(kTemplateTarget);
    const auto camera = make_camera(640, 480, 500.0);
    const auto pose = board_pose(target, {0.0, 0.0, 1.2}, 20.0, 20.0, 0.0);
    const auto two_greys = [](cv::Mat& pixels) {
        pixels.rowRange(0, 240) = 130.0;
        pixels.rowRange(240, 480) = 30.0;
    };
    const ImageBoards found = find_templates(
        Photo(camera).draw(two_greys).add(target, pose, 180.0, 1e9, 0.6).take(0.8, 2.0));
    ASSERT_EQ(found.boards.size(), 1u);
    EXPECT_LT(testing::rms_distance(found.boards[0].corners,
                                    true_corners(target, CameraModel(camera), pose)),
              0.08);
}

// One path for any target: other holes, other outlines, round ones, one alone.
TEST(ImageTemplate, TargetsOfOtherShapes) {
    const std::filesystem::path folder = ::testing::TempDir();
    const std::pair<const char*, const char*> shapes[] = {
        {"one_hole",
         R"("outline": [[0,0],[0.5,0],[0.5,0.4],[0,0.4]], "holes": [[[0.1,0.1],[0.3,0.1],[0.3,0.3],[0.1,0.3]]])"},
        {"triangles",
         R"("outline": [[0,0],[0.6,0],[0.6,0.5],[0,0.5]],
            "holes": [[[0.1,0.1],[0.25,0.1],[0.1,0.25]], [[0.35,0.25],[0.5,0.25],[0.5,0.4]], [[0.1,0.4],[0.25,0.3],[0.25,0.4]]])"},
        {"hexagon",
         R"("outline": [[0.15,0],[0.45,0],[0.6,0.25],[0.45,0.5],[0.15,0.5],[0,0.25]],
            "holes": [[[0.15,0.1],[0.27,0.1],[0.27,0.2],[0.15,0.2]], [[0.35,0.3],[0.45,0.3],[0.45,0.4],[0.35,0.4]]])"}};
    const auto camera = make_camera(640, 480, 500.0);
    for (const auto& [name, shape] : shapes) {
        const std::string file = write_target(folder, name, shape);
        const Target target = load_target(file);
        const auto pose = board_pose(target, {0.05, 0.0, 1.5}, 18.0, -12.0, 8.0);
        const ImageBoards found =
            find_templates(Photo(camera).add(target, pose).take(0.8, 2.0), file);
        ASSERT_EQ(found.boards.size(), 1u) << name;
        EXPECT_LT(testing::rms_distance(found.boards[0].corners,
                                        true_corners(target, CameraModel(camera), pose)),
                  0.12)
            << name;
    }
}

// Windows: four dark squares in place, but no plate that ends around them.
TEST(ImageTemplate, SquaresWithoutAPlateAreNoBoard) {
    cv::Mat wall(480, 640, CV_8U, cv::Scalar(170));
    for (int y = 20; y + 60 < 480; y += 120)
        for (int x = 30; x + 60 < 640; x += 120)
            cv::rectangle(wall, cv::Rect(x, y, 60, 60), cv::Scalar(40), cv::FILLED);
    cv::GaussianBlur(wall, wall, cv::Size(), 0.8);
    StageHarness stage = template_detector();
    stage.give<Images>("images", Images{{Photo::wrap(wall, make_camera(640, 480, 500.0))}});
    stage.fire();
    EXPECT_TRUE(stage.out<ImageBoards>("boards").boards.empty());
    ASSERT_EQ(stage.notes().size(), 1u);
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("outline"));
}

// Two grey levels between holes and plate, one of noise: no single threshold parts them.
TEST(ImageTemplate, FaintHoles) {
    const Target target = load_target(kTemplateTarget);
    const auto camera = make_camera(640, 480, 500.0);
    const auto pose = board_pose(target, {0.05, 0.0, 1.5}, 8.0, -6.0, 2.0);
    const ImageBoards found =
        find_templates(Photo(camera, 171.0).add(target, pose, 178.0).take(0.8, 1.0));
    ASSERT_EQ(found.boards.size(), 1u);
    // Edges of 7 grey levels place a point to 0.2 px, and some 200 of them a board to 0.05.
    EXPECT_LT(testing::rms_distance(found.boards[0].corners,
                                    true_corners(target, CameraModel(camera), pose)),
              0.3);
}

TEST(ImageTemplate, SeveralBoardsFromLeftToRight) {
    const Target target = load_target(kTemplateTarget);
    const auto camera = make_camera(960, 480, 500.0);
    Photo photo(camera);
    for (const double place : {1.2, -1.0, 0.1})
        photo.add(target, board_pose(target, {place, 0.0, 2.2}, 10.0, 0.0));
    const ImageBoards found = find_templates(photo.take(0.8, 2.0));
    ASSERT_EQ(found.boards.size(), 3u);
    EXPECT_LT(found.boards[0].corners[0].x(), found.boards[1].corners[0].x());
    EXPECT_LT(found.boards[1].corners[0].x(), found.boards[2].corners[0].x());
}

TEST(ImageTemplate, ColourAndGreyGiveTheSameCorners) {
    const Target target = load_target(kTemplateTarget);
    const auto camera = make_camera(640, 480, 500.0);
    const auto pose = board_pose(target, {0.0, 0.0, 2.0}, 8.0, 4.0);
    const CameraImage grey = Photo(camera).add(target, pose).take(0.8, 2.0);
    cv::Mat bgr;
    cv::cvtColor(grey.image.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY), bgr, cv::COLOR_GRAY2BGR);
    const ImageBoards a = find_templates(grey), b = find_templates(Photo::wrap(bgr, camera));
    ASSERT_EQ(a.boards.size(), 1u);
    ASSERT_EQ(b.boards.size(), 1u);
    EXPECT_EQ(testing::rms_distance(a.boards[0].corners, b.boards[0].corners), 0.0);
}

TEST(ImageTemplate, APhotoWithoutABoardGivesANoteAndAPicture) {
    StageHarness stage = template_detector();
    stage.give<Images>("images",
                       Images{{Photo(make_camera(640, 480, 500.0)).take(0.8, 2.0, "cam/0")}});
    stage.fire();
    EXPECT_TRUE(stage.out<ImageBoards>("boards").boards.empty());
    EXPECT_EQ(stage.out<ImageBoards>("boards").cameras.size(), 1u);
    ASSERT_EQ(stage.notes().size(), 1u);
    EXPECT_THAT(stage.notes()[0].looked_for, HasSubstr("cam/0"));
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("dark regions"));
    bool saved = false;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(stage.folder()))
        saved = saved || entry.path().filename() == "boards_cam%2F0.png";
    EXPECT_TRUE(saved);
}

TEST(ImageTemplate, BlackTinyAndFlatImagesFindNothing) {
    for (const auto& [width, height, grey] :
         {std::array<int, 3>{640, 480, 0}, {640, 480, 255}, {3, 2, 10}, {1, 1, 0}}) {
        const cv::Mat flat(height, width, CV_8U, cv::Scalar(grey));
        EXPECT_TRUE(
            find_templates(Photo::wrap(flat, make_camera(width, height, 500.0))).boards.empty());
    }
}

TEST(ImageTemplate, ImagesWithoutUsableIntrinsicsAreRefusedByLabel) {
    CameraImage image = Photo(make_camera(640, 480, 500.0)).take(0.0, 0.0, "front");
    std::vector<mrpt::img::TCamera> cameras(2, image.camera);
    cameras[0].setIntrinsicParamsFromValues(0.0, 0.0, 0.0, 0.0);
    cameras[1] = make_camera(1280, 720, 500.0);
    for (const auto& camera : cameras) {
        image.camera = camera;
        StageHarness stage = template_detector();
        stage.give<Images>("images", Images{{image}});
        try {
            stage.fire();
            FAIL() << "accepted";
        } catch (const Error& error) {
            EXPECT_THAT(error.what(), HasSubstr("front"));
        }
    }
}

TEST(ImageTemplate, StopsWhenCancelled) {
    StageHarness stage = template_detector();
    stage.give<Images>("images", Images{{Photo(make_camera(640, 480, 500.0)).take(0.0, 0.0)}});
    stage.cancel();
    EXPECT_THROW(stage.fire(), Cancelled);
}

TEST(ImageTemplate, ATargetWithoutHolesIsRefused) {
    StageHarness stage = template_detector("checkerboard");
    stage.give<Images>("images", Images{});
    try {
        stage.fire();
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("1 checkerboard"));
    }
}

TEST(ImageTemplate, MoreHolesAskedForThanTheTargetHasIsRefused) {
    StageHarness stage = template_detector();
    stage.set("min_holes", 5).give<Images>("images", Images{});
    EXPECT_THROW(stage.fire(), Error);
}

}  // namespace
}  // namespace petal
