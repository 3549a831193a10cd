// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/run.hpp"

namespace petal {

/// A group of squares that was looked at closely and is no board.
struct RejectedGroup {
    std::array<Eigen::Vector2d, 4> outline;  ///< of the board it would have been, raw pixels
    std::string reason;
};

/// What the image detector saw in one photo.
struct ImageSearchPicture {
    cv::Mat image;                                        ///< 8 bit, 1 or 3 channels
    std::vector<std::array<Eigen::Vector2d, 4>> squares;  ///< candidate holes, raw pixels
    std::vector<RejectedGroup> rejected;
    std::vector<ImageBoard> boards;  ///< of this camera
    std::vector<std::vector<bool>>
        corner_measured;  ///< false: a side that ends there is geometry's
};

/// The photo, enlarged where it is small: candidate squares thin yellow, rejected groups magenta
/// with the reason, boards green with the index of every corner; corners that lean on the board's
/// geometry orange.
void write_overlay(const ImageSearchPicture& picture, const std::filesystem::path& file);

/// One board cut out and enlarged, with corners, indices and 3-sigma ellipses.
void write_board_crop(const ImageSearchPicture& picture, std::size_t board,
                      const std::filesystem::path& file);

/// Where nothing was found, or the run asks for it: saves the photo as `<name>_<camera>.png` and
/// each board as `board_<camera>_<number>.png`.
void save_pictures(Run& run, const std::string& name, const std::string& camera,
                   const ImageSearchPicture& picture);

}  // namespace petal
