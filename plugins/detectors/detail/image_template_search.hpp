// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <array>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "detectors/detail/image_board_overlay.hpp"
#include "detectors/detail/image_template_fit.hpp"
#include "detectors/detail/image_template_judge.hpp"
#include "detectors/detail/image_template_model.hpp"
#include "petal/calibration/camera_model.hpp"

namespace petal {

struct ImageTemplateParams;

/// A board that was found, turned upright in the image.
struct TemplateBoard {
    FittedBoard fit;
    TemplateVerdict verdict;
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< raw pixels
    double size_px = 0.0;                              ///< half of its width
    int holes_seen = 0;                                ///< as regions
};

/// What one photo holds.
struct TemplateSearch {
    std::vector<TemplateBoard> boards;                    ///< from left to right
    std::vector<RejectedGroup> rejected;                  ///< the best guess first
    std::vector<std::array<Eigen::Vector2d, 4>> regions;  ///< as parallelograms, raw pixels
    int borders = 0;
    int best_holes = 0;
    int guesses = 0;  ///< places where a board may be
    int fits = 0;     ///< of them, those that looked like one
};

/// Looks for the model's boards in an 8 bit grey image. `check` is called now and then and may
/// throw.
TemplateSearch search_boards(const cv::Mat& grey, const TemplateModel& model,
                             const CameraModel& camera, const ImageTemplateParams& params,
                             const std::function<void()>& check);

/// The board's corners and their joint covariance for the packet, of rank six: that of the pose,
/// where `floor_px` (of each corner by itself) adds what a pose can take up of it.
ImageBoard to_packet(const TemplateBoard& board, const TemplateModel& model,
                     const CameraModel& camera, const std::string& label, double floor_px);

}  // namespace petal
