// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/report_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "petal/calibration/for_pieces.hpp"
#include "petal/error.hpp"

namespace petal {

namespace {

constexpr int kBoardWidth = 480;  // px of an enlarged board's picture
constexpr int kMostEnlarged = 6;
constexpr int kQuality = 80;  // of JPEG: lines of one pixel stay clear

ReportJpeg jpeg_of(const cv::Mat& picture) {
    ReportJpeg jpeg{picture.cols, picture.rows, {}};
    if (!cv::imencode(".jpg", picture, jpeg.bytes, {cv::IMWRITE_JPEG_QUALITY, kQuality}))
        throw Error("OpenCV cannot write JPEG, which the report's pictures are");
    return jpeg;
}

/// Not wider than `width`.
cv::Mat shrunk(const cv::Mat& picture, int width) {
    if (picture.cols <= width) return picture;
    cv::Mat small;
    const int height = std::max(1, picture.rows * width / picture.cols);
    cv::resize(picture, small, {width, height}, 0.0, 0.0, cv::INTER_AREA);
    return small;
}

/// A board and what is about it, within the photo; empty where it lies outside.
cv::Rect part_of_photo(const ImageBoard& board, const CameraImage& image) {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& corner : board.corners)
        if (corner.allFinite()) box.extend(corner);
    if (box.isEmpty()) return {};
    // Corners are those of holes: the board's rim lies a third of their extent farther out.
    const double room = 0.5 * std::max(8.0, box.sizes().maxCoeff());
    const auto within = [](double value, std::size_t size) {
        return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(size)));
    };
    const std::size_t width = image.image.getWidth();
    const std::size_t height = image.image.getHeight();
    const cv::Point begin(within(box.min().x() - room, width),
                          within(box.min().y() - room, height));
    const cv::Point end(within(box.max().x() + room, width), within(box.max().y() + room, height));
    return {begin, end};
}

/// A picture to make: a whole photo, or a board on it.
struct Drawing {
    const SceneView* scene;
    const Cloud* cloud;
    const CameraImage* image;
    const CameraExtrinsics* solved;
    std::size_t picture;  ///< of the report
    int magnification, line_width, width;
    cv::Rect part;
    double dot;
};

Drawing photo_drawing(Drawing drawing, int width) {
    const int photo_width = static_cast<int>(drawing.image->image.getWidth());
    drawing.line_width = std::max(1, (photo_width + width / 2) / width);
    drawing.magnification = photo_width < width / 2 ? 2 : 1;
    drawing.width = width;
    drawing.dot = 1.0;
    return drawing;
}

Drawing board_drawing(Drawing drawing, const cv::Rect& part) {
    drawing.magnification = std::clamp(kBoardWidth / part.width, 1, kMostEnlarged);
    // Lines twice as wide as the photo's, and dots that leave them to be seen.
    drawing.line_width = 2 * std::max(1, part.width / kBoardWidth);
    drawing.dot = 0.3;
    drawing.part = part;
    drawing.width = kBoardWidth;
    return drawing;
}

ReportJpeg drawn(const Drawing& drawing, const PictureSettings& settings) {
    OverlayCanvas canvas(*drawing.image, drawing.magnification, drawing.line_width, drawing.part);
    draw_scene(canvas, *drawing.scene, drawing.cloud, drawing.image->label, drawing.solved,
               settings.max_points, settings.residual_scale, drawing.dot);
    return jpeg_of(shrunk(canvas.picture(), drawing.width));
}

}  // namespace

std::vector<ReportPicture> report_pictures(
    const Run& run, const Extrinsics& extrinsics, const std::map<std::uint64_t, SceneView>& scenes,
    const ScenePlaces& places, const std::map<std::uint64_t, std::shared_ptr<const Cloud>>& edges,
    const PictureSettings& settings) {
    std::vector<ReportPicture> pictures;
    std::vector<Drawing> drawings;
    for (const auto& [number, scene] : scenes) {
        if (!scene.images) continue;
        const auto edge_cloud = edges.find(number);
        const auto place = places.find(number);
        for (const CameraImage& image : scene.images->cameras) {
            Drawing drawing{};
            drawing.scene = &scene;
            drawing.cloud =
                edge_cloud == edges.end() ? scene.cloud.get() : edge_cloud->second.get();
            drawing.image = &image;
            drawing.solved = extrinsics_of(extrinsics, image.label);
            drawing.picture = pictures.size();
            ReportPicture picture;
            picture.scene = scene.name;
            if (place != places.end())
                picture.scene_from = "/scenes/" + std::to_string(place->second);
            picture.camera = image.label;
            picture.solved = drawing.solved != nullptr;
            pictures.push_back(std::move(picture));
            drawings.push_back(photo_drawing(drawing, settings.width));
            if (!scene.image_boards) continue;
            for (const ImageBoard& board : scene.image_boards->boards) {
                if (board.camera != image.label) continue;
                const cv::Rect part = part_of_photo(board, image);
                if (!part.empty()) drawings.push_back(board_drawing(drawing, part));
            }
        }
    }
    std::vector<ReportJpeg> jpegs(drawings.size());
    for_pieces(run, drawings.size(), 1, [&](std::size_t i, std::size_t end) {
        for (; i < end; ++i) jpegs[i] = drawn(drawings[i], settings);
    });
    for (std::size_t i = 0; i < drawings.size(); ++i) {
        ReportPicture& picture = pictures[drawings[i].picture];
        if (drawings[i].part.empty())
            picture.photo = std::move(jpegs[i]);
        else
            picture.boards.push_back(std::move(jpegs[i]));
    }
    return pictures;
}

}  // namespace petal
