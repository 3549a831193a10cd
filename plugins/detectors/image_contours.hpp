// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <string>

#include "detectors/detail/image_board_grouping.hpp"
#include "detectors/detail/image_board_overlay.hpp"
#include "detectors/detail/image_board_refinement.hpp"
#include "detectors/detail/image_layout.hpp"
#include "detectors/detail/image_squares.hpp"
#include "petal/calibration/boards.hpp"
#include "petal/calibration/images.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct ImageContoursParams : SquareLimits, RefinementLimits {
    std::filesystem::path target = "four_square_holes_500mm";
    int min_holes = 3;
};

/// Algorithm 2 of the letter (section III.C): the boards that each camera sees, by the contours of
/// their square holes.
class ImageContours final : public Stage {
   public:
    using Params = ImageContoursParams;
    static void describe(Spec<Params>& spec);

    /// \throws Error when the target cannot be read, or its holes have not four corners each.
    explicit ImageContours(Params params);
    /// \throws Error when an image is not of its camera's size, not 8 bit, or has no usable
    /// intrinsics.
    void run(Run& run) override;

   private:
    void detect(Run& run, const CameraImage& image, ImageBoards& found) const;
    void tell(Run& run, const std::string& camera, const ImageSearchPicture& picture,
              const SquareSearch& search, const Grouping& grouping) const;

    Params params_;
    HoleLayout layout_;
};

}  // namespace petal
