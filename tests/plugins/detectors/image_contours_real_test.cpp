// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "detectors/image_contours.hpp"
#include "image_render.hpp"
#include "petal/testing/stage_harness.hpp"
#include "real_data.hpp"
#include "real_scenes.hpp"

namespace petal {
namespace {

using testing::Photo;
using testing::StageHarness;

ImageBoards detect(const cv::Mat& pixels, const mrpt::img::TCamera& camera,
                   bool model_walls = true) {
    StageHarness stage = StageHarness::of<ImageContours>("detector.image_contours");
    stage.set("target", PETAL_SOURCE_DIR "/datasets/targets/four_square_holes_500mm.json");
    stage.set("model_walls", model_walls);
    stage.give<Images>("images", Images{{Photo::wrap(pixels, camera)}});
    stage.fire();
    return stage.out<ImageBoards>("boards");
}

/// With the walls of the holes modelled (calibrations) and without (the letter).
class ImageContoursReal : public ::testing::TestWithParam<bool> {};

TEST_P(ImageContoursReal, CampusHas32CornersAndNoFalseBoard) {
    PETAL_NEEDS_REAL_DATA();
    const testing::RealScene scene = testing::campus_scene();
    const ImageBoards found = detect(scene.pixels, scene.camera, GetParam());
    ASSERT_EQ(found.boards.size(), 2u);
    const auto off = testing::distances_to_nearest(scene.reference, testing::all_corners(found));
    // Asked for: 0.8 and 2.5. The reference itself is good to about 0.3 px.
    EXPECT_LT(testing::median_of_sorted(off), 0.15);
    EXPECT_LT(off.back(), 0.7);
    RecordProperty("median_px", std::to_string(testing::median_of_sorted(off)));
    RecordProperty("max_px", std::to_string(off.back()));
    // Row by row from the top left: the reference file is in that order, board by board.
    const auto corners = testing::all_corners(found);
    for (std::size_t i = 0; i < corners.size(); ++i)
        EXPECT_LT((corners[i] - scene.reference[i]).norm(), 0.7) << i;
}

TEST_P(ImageContoursReal, IndoorHas64CornersAndNoFalseBoard) {
    PETAL_NEEDS_REAL_DATA();
    const testing::RealScene scene = testing::indoor_scene();
    const ImageBoards found = detect(scene.pixels, scene.camera, GetParam());
    ASSERT_EQ(found.boards.size(), 4u);
    const auto corners = testing::all_corners(found);

    // The published pixels do not belong to the raw photo: its authors rectified it with a new
    // camera matrix (all pixels kept) and took the corners there. In that picture the figures asked
    // for hold: 1 and 3.
    const auto in_theirs = testing::in_published_picture(scene, corners);
    const auto off = testing::distances_to_nearest(scene.reference, in_theirs);
    EXPECT_LE(testing::median_of_sorted(off), 1.0);
    EXPECT_LE(off.back(), 3.0);
    RecordProperty("median_px", std::to_string(testing::median_of_sorted(off)));
    RecordProperty("max_px", std::to_string(off.back()));
    if (GetParam()) return;

    // As raw pixels, which they are not: 0.5 % nearer together. And they follow the dark of the
    // holes, so walls count as plate.
    const auto raw_off = testing::distances_to_nearest(scene.reference, corners);
    EXPECT_LE(testing::median_of_sorted(raw_off), 1.1);
    EXPECT_LE(raw_off.back(), 3.05);
    RecordProperty("raw_median_px", std::to_string(testing::median_of_sorted(raw_off)));
    RecordProperty("raw_max_px", std::to_string(raw_off.back()));
}

INSTANTIATE_TEST_SUITE_P(Walls, ImageContoursReal, ::testing::Bool(), [](const auto& tested) {
    return std::string(tested.param ? "modelled" : "as_seen");
});

/// A changed photo: corners must be where the change moves those of the original.
struct Change {
    const char* name;
    std::function<cv::Mat(const cv::Mat&)> change;
    /// Takes a corner, and the size of the photo before.
    std::function<Eigen::Vector2d(const Eigen::Vector2d&, const cv::Size&)> move;
    double tolerance_px;  ///< RMS, in pixels of the changed photo
};

std::ostream& operator<<(std::ostream& out, const Change& change) {
    return out << change.name;
}

class ImageContoursChanged : public ::testing::TestWithParam<Change> {};

cv::Mat gamma(const cv::Mat& image, double exponent) {
    cv::Mat table(1, 256, CV_8U), out;
    for (int i = 0; i < 256; ++i)
        table.at<std::uint8_t>(i) =
            cv::saturate_cast<std::uint8_t>(255.0 * std::pow(i / 255.0, exponent));
    cv::LUT(image, table, out);
    return out;
}
cv::Mat scaled(const cv::Mat& image, double factor, int interpolation) {
    cv::Mat out;
    cv::resize(image, out, cv::Size(), factor, factor, interpolation);
    return out;
}
cv::Mat blurred(const cv::Mat& image) {
    cv::Mat out;
    cv::GaussianBlur(image, out, cv::Size(), 1.2);
    return out;
}
cv::Mat turned(const cv::Mat& image, int code) {
    cv::Mat out;
    cv::rotate(image, out, code);
    return out;
}
cv::Mat compressed(const cv::Mat& image, int quality) {
    std::vector<std::uint8_t> bytes;
    cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
    return cv::imdecode(bytes, cv::IMREAD_COLOR);
}
Eigen::Vector2d same(const Eigen::Vector2d& p, const cv::Size&) {
    return p;
}

TEST_P(ImageContoursChanged, SameBoardsAndCorners) {
    PETAL_NEEDS_REAL_DATA();
    const Change& change = GetParam();
    for (const bool outdoors : {false, true}) {
        const testing::RealScene scene =
            outdoors ? testing::campus_scene() : testing::indoor_scene();
        const auto plain = [](const cv::Mat& pixels, double focal) {
            return testing::make_camera(pixels.cols, pixels.rows, focal);
        };
        const double focal = outdoors ? 920.0 : 349.0;
        const cv::Mat pixels = change.change(scene.pixels);
        const auto before = testing::all_corners(detect(scene.pixels, plain(scene.pixels, focal)));
        const ImageBoards found = detect(pixels, plain(pixels, focal));
        ASSERT_EQ(found.boards.size(), outdoors ? 2u : 4u);
        std::vector<Eigen::Vector2d> expected;
        for (const auto& corner : before)
            expected.push_back(change.move(corner, scene.pixels.size()));
        const auto off = testing::distances_to_nearest(expected, testing::all_corners(found));
        double squares = 0.0;
        for (const double d : off) squares += d * d;
        const double rms = std::sqrt(squares / static_cast<double>(off.size()));
        EXPECT_LT(rms, change.tolerance_px);
        RecordProperty(outdoors ? "campus_rms_px" : "indoor_rms_px", std::to_string(rms));
        for (const auto& board : found.boards) {  // upright in the image, whatever the photo's turn
            EXPECT_LT(board.corners.front().x(), board.corners[3].x());
            EXPECT_LT(board.corners.front().y(), board.corners[12].y());
        }
    }
}

// Turning is exact; the others lose or add information. At half the size the campus holes have 9
// pixels, and the kerb behind two of them, 2 pixels inside, bends one side (0.83 px RMS; indoors
// 0.17).
INSTANTIATE_TEST_SUITE_P(
    Changes, ImageContoursChanged,
    ::testing::Values(
        Change{"turned_by_180", [](const cv::Mat& m) { return turned(m, cv::ROTATE_180); },
               [](const Eigen::Vector2d& p, const cv::Size& size) -> Eigen::Vector2d {
                   return Eigen::Vector2d(size.width - 1, size.height - 1) - p;
               },
               0.1},
        Change{"turned_by_90", [](const cv::Mat& m) { return turned(m, cv::ROTATE_90_CLOCKWISE); },
               [](const Eigen::Vector2d& p, const cv::Size& size) {
                   return Eigen::Vector2d(size.height - 1 - p.y(), p.x());
               },
               0.1},
        Change{"brighter", [](const cv::Mat& m) { return gamma(m, 0.6); }, same, 0.3},
        Change{"darker", [](const cv::Mat& m) { return gamma(m, 1.6); }, same, 0.3},
        Change{"half_the_contrast", [](const cv::Mat& m) { return cv::Mat(m * 0.5); }, same, 0.2},
        Change{"blurred", blurred, same, 0.4},
        Change{"jpeg_50", [](const cv::Mat& m) { return compressed(m, 50); }, same, 0.4},
        Change{"twice_the_size", [](const cv::Mat& m) { return scaled(m, 2.0, cv::INTER_CUBIC); },
               [](const Eigen::Vector2d& p, const cv::Size&) -> Eigen::Vector2d {
                   return 2.0 * p + Eigen::Vector2d(0.5, 0.5);
               },
               0.6},
        Change{"half_the_size", [](const cv::Mat& m) { return scaled(m, 0.5, cv::INTER_AREA); },
               [](const Eigen::Vector2d& p, const cv::Size&) -> Eigen::Vector2d {
                   return 0.5 * p - Eigen::Vector2d(0.25, 0.25);
               },
               1.0}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace petal
