// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_input.hpp"

#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <string>
#include <system_error>
#include <utility>

#include "petal/error.hpp"

namespace petal {

namespace {

std::string pixels_by(int width, int height) {
    return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

cv::Mat pixels_of(const CameraImage& camera) {
    if (camera.image.isEmpty())
        throw Error("camera '" + camera.label +
                    "' has an image without pixels: check the file, or that " +
                    "the image beside the rawlog can be read");
    cv::Mat pixels = camera.image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
    if (pixels.depth() != CV_8U || (pixels.channels() != 1 && pixels.channels() != 3))
        throw Error("camera '" + camera.label +
                    "': its image must have 8 bit and 1 or 3 channels; convert it before");
    const auto width = static_cast<int>(camera.camera.ncols);
    const auto height = static_cast<int>(camera.camera.nrows);
    if (pixels.cols != width || pixels.rows != height)
        throw Error("camera '" + camera.label + "': the image is " +
                    pixels_by(pixels.cols, pixels.rows) + " pixels, but its intrinsics are for " +
                    pixels_by(width, height) +
                    ": give the intrinsics of this resolution, or the photo in its original size");
    return pixels;
}

cv::Mat grey_of(const cv::Mat& pixels) {
    if (pixels.channels() == 1) return pixels;
    cv::Mat grey;
    cv::cvtColor(pixels, grey, cv::COLOR_BGR2GRAY);
    return grey;
}

CameraModel model_of(const CameraImage& camera) {
    try {
        return CameraModel(camera.camera);
    } catch (const Error& error) {
        throw Error("camera '" + camera.label + "': " + error.what());
    }
}

void write_image_boards(Run& run, const std::string& target,
                        const std::function<void(const CameraImage&, ImageBoards&)>& detect) {
    const Images& images = run.in<Images>("images");
    std::error_code ignored;
    if (std::filesystem::is_regular_file(target, ignored)) run.used_file(target);
    ImageBoards found;
    for (const CameraImage& image : images.cameras) {
        run.check_cancelled();
        found.cameras.push_back({image.label, image.camera});
        detect(image, found);
    }
    if (images.cameras.empty())
        run.note({"boards in images", "the scene has no image", "",
                  "check which cameras the source reads"});
    run.write("boards", std::move(found));
}

}  // namespace petal
