// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "detectors/image_contours.hpp"
#include "image_render.hpp"
#include "petal/testing/stage_harness.hpp"
#include "real_data.hpp"

namespace petal {
namespace {

using testing::Photo;
using testing::real_data;
using testing::StageHarness;

struct Scene {
    cv::Mat pixels;
    mrpt::img::TCamera camera;
    std::vector<Eigen::Vector2d> reference;
};

/// Written with a point, whatever the locale of the process.
double number(const std::string& text) {
    std::istringstream in(text);
    in.imbue(std::locale::classic());
    double value = 0.0;
    in >> value;
    EXPECT_TRUE(in) << text;
    return value;
}

/// Columns 3 and 4 (from 0) of a CSV file.
std::vector<Eigen::Vector2d> read_pixels(const std::filesystem::path& file) {
    std::vector<Eigen::Vector2d> pixels;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::stringstream cells(line);
        std::vector<std::string> cell;
        for (std::string text; std::getline(cells, text, ',');) cell.push_back(text);
        pixels.emplace_back(number(cell.at(3)), number(cell.at(4)));
    }
    return pixels;
}

Scene read_scene(const std::string& name, const std::string& reference) {
    Scene scene;
    scene.pixels = cv::imread((real_data() / name / "image.jpg").string());
    scene.camera.ncols = static_cast<std::uint32_t>(scene.pixels.cols);
    scene.camera.nrows = static_cast<std::uint32_t>(scene.pixels.rows);
    scene.reference = read_pixels(real_data() / name / reference);
    return scene;
}

Scene campus() {
    Scene scene = read_scene("sjtu_campus", "reference_corners_image.csv");
    scene.camera.setIntrinsicParamsFromValues(920.52948, 920.92645, 645.0882, 358.04642);
    scene.camera.setDistortionPlumbBob(-0.00633318, 0.00222445, -0.00020834, -0.00099644, 0.0);
    return scene;
}

Scene indoor() {
    Scene scene = read_scene("sjtu_indoor", "published_corner_pairs.csv");
    scene.camera.setIntrinsicParamsFromValues(349.778091, 349.067100, 315.445567, 279.04059);
    scene.camera.setDistortionPlumbBob(-0.00633318, 0.00222445, -0.00020834, -0.00099644, 0.0);
    return scene;
}

ImageBoards detect(const cv::Mat& pixels, const mrpt::img::TCamera& camera) {
    StageHarness stage = StageHarness::of<ImageContours>("detector.image_contours");
    stage.set("target", PETAL_SOURCE_DIR "/datasets/targets/four_square_holes_500mm.json");
    stage.give<Images>("images", Images{{Photo::wrap(pixels, camera)}});
    stage.fire();
    return stage.out<ImageBoards>("boards");
}

std::vector<Eigen::Vector2d> all_corners(const ImageBoards& boards) {
    std::vector<Eigen::Vector2d> corners;
    for (const auto& board : boards.boards)
        corners.insert(corners.end(), board.corners.begin(), board.corners.end());
    return corners;
}

/// For each reference point the distance of the nearest corner, ascending.
std::vector<double> distances(const std::vector<Eigen::Vector2d>& reference,
                              const std::vector<Eigen::Vector2d>& corners) {
    std::vector<double> all;
    for (const auto& point : reference) {
        double nearest = 1e9;
        for (const auto& corner : corners) nearest = std::min(nearest, (corner - point).norm());
        all.push_back(nearest);
    }
    std::sort(all.begin(), all.end());
    return all;
}

double median(const std::vector<double>& sorted) {
    return sorted.at(sorted.size() / 2);
}

TEST(ImageContoursReal, CampusHas32CornersAndNoFalseBoard) {
    PETAL_NEEDS_REAL_DATA();
    const Scene scene = campus();
    const ImageBoards found = detect(scene.pixels, scene.camera);
    ASSERT_EQ(found.boards.size(), 2u);
    const auto off = distances(scene.reference, all_corners(found));
    // Asked for: 0.8 and 2.5. The reference itself is good to about 0.3 px.
    EXPECT_LT(median(off), 0.15);
    EXPECT_LT(off.back(), 0.7);
    RecordProperty("median_px", std::to_string(median(off)));
    RecordProperty("max_px", std::to_string(off.back()));
    // Row by row from the top left: the reference file is in that order, board by board.
    const auto corners = all_corners(found);
    for (std::size_t i = 0; i < corners.size(); ++i)
        EXPECT_LT((corners[i] - scene.reference[i]).norm(), 0.7) << i;
}

TEST(ImageContoursReal, IndoorHas64CornersAndNoFalseBoard) {
    PETAL_NEEDS_REAL_DATA();
    const Scene scene = indoor();
    const ImageBoards found = detect(scene.pixels, scene.camera);
    ASSERT_EQ(found.boards.size(), 4u);
    const auto corners = all_corners(found);

    // The published pixels do not belong to the raw photo: its authors rectified it with a new
    // camera matrix (all pixels kept) and took the corners there. In that picture the figures asked
    // for hold: 1 and 3.
    cv::Mat k = (cv::Mat_<double>(3, 3) << scene.camera.fx(), 0, scene.camera.cx(), 0,
                 scene.camera.fy(), scene.camera.cy(), 0, 0, 1);
    cv::Mat d = (cv::Mat_<double>(1, 4) << -0.00633318, 0.00222445, -0.00020834, -0.00099644);
    const cv::Mat rectified = cv::getOptimalNewCameraMatrix(k, d, scene.pixels.size(), 1.0);
    std::vector<cv::Point2d> raw, moved;
    for (const auto& c : corners) raw.emplace_back(c.x(), c.y());
    cv::undistortPoints(raw, moved, k, d, cv::noArray(), rectified);
    std::vector<Eigen::Vector2d> in_theirs;
    for (const auto& p : moved) in_theirs.emplace_back(p.x, p.y);
    const auto off = distances(scene.reference, in_theirs);
    EXPECT_LE(median(off), 1.0);
    EXPECT_LE(off.back(), 3.0);

    // As raw pixels, which they are not: 0.5 % nearer together.
    const auto raw_off = distances(scene.reference, corners);
    EXPECT_LE(median(raw_off), 1.1);
    EXPECT_LE(raw_off.back(), 3.05);
    RecordProperty("median_px", std::to_string(median(off)));
    RecordProperty("max_px", std::to_string(off.back()));
    RecordProperty("raw_median_px", std::to_string(median(raw_off)));
    RecordProperty("raw_max_px", std::to_string(raw_off.back()));
}

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
        const Scene scene = outdoors ? campus() : indoor();
        const auto plain = [](const cv::Mat& pixels, double focal) {
            return testing::make_camera(pixels.cols, pixels.rows, focal);
        };
        const double focal = outdoors ? 920.0 : 349.0;
        const cv::Mat pixels = change.change(scene.pixels);
        const auto before = all_corners(detect(scene.pixels, plain(scene.pixels, focal)));
        const ImageBoards found = detect(pixels, plain(pixels, focal));
        ASSERT_EQ(found.boards.size(), outdoors ? 2u : 4u);
        std::vector<Eigen::Vector2d> expected;
        for (const auto& corner : before)
            expected.push_back(change.move(corner, scene.pixels.size()));
        const auto off = distances(expected, all_corners(found));
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
