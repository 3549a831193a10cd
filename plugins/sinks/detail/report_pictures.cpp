// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/report_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

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

}  // namespace

std::vector<ReportPicture> report_pictures(
    const Run& run, const Extrinsics& extrinsics, const std::map<std::uint64_t, SceneView>& scenes,
    const ScenePlaces& places, const std::map<std::uint64_t, std::shared_ptr<const Cloud>>& edges,
    const PictureSettings& settings) {
    std::vector<ReportPicture> pictures;
    for (const auto& [number, seen] : scenes) {
        const SceneView& scene = seen;  // a lambda may not capture what a binding names
        if (!scene.images) continue;
        const auto edge_cloud = edges.find(number);
        const Cloud* const cloud =
            edge_cloud == edges.end() ? scene.cloud.get() : edge_cloud->second.get();
        const auto place = places.find(number);
        for (const CameraImage& image : scene.images->cameras) {
            run.check_cancelled();
            const CameraExtrinsics* solved = extrinsics_of(extrinsics, image.label);
            const auto draw = [&](int magnification, int line_width, const cv::Rect& part,
                                  double dot) {
                OverlayCanvas canvas(image, magnification, line_width, part);
                draw_scene(canvas, scene, cloud, image.label, solved, settings.max_points,
                           settings.residual_scale, dot);
                return canvas.picture();
            };
            ReportPicture picture;
            picture.scene = scene.name;
            if (place != places.end())
                picture.scene_from = "/scenes/" + std::to_string(place->second);
            picture.camera = image.label;
            picture.solved = solved != nullptr;
            const int photo_width = static_cast<int>(image.image.getWidth());
            const int line_width = std::max(1, (photo_width + settings.width / 2) / settings.width);
            const int magnification = photo_width < settings.width / 2 ? 2 : 1;
            picture.photo =
                jpeg_of(shrunk(draw(magnification, line_width, cv::Rect(), 1.0), settings.width));
            if (scene.image_boards)
                for (const ImageBoard& board : scene.image_boards->boards) {
                    if (board.camera != image.label) continue;
                    const cv::Rect part = part_of_photo(board, image);
                    if (part.empty()) continue;
                    const int enlarged = std::clamp(kBoardWidth / part.width, 1, kMostEnlarged);
                    const int wide = std::max(1, part.width / kBoardWidth);
                    // Lines twice as wide as the photo's, and dots that leave them to be seen.
                    picture.boards.push_back(
                        jpeg_of(shrunk(draw(enlarged, 2 * wide, part, 0.3), kBoardWidth)));
                }
            pictures.push_back(std::move(picture));
        }
    }
    return pictures;
}

}  // namespace petal
