// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <string>

#include "detectors/detail/image_template_fit.hpp"
#include "detectors/detail/image_template_judge.hpp"
#include "detectors/detail/image_template_model.hpp"
#include "petal/calibration/boards.hpp"
#include "petal/calibration/images.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct ImageTemplateParams : TemplateFitLimits, TemplateEvidence {
    std::filesystem::path target = "four_square_holes_500mm";
    int levels = 12;
    int min_holes = 1;
    double sigma_floor_px = 0.02;
};

/// The boards that each camera sees, by fitting the target's whole geometry - outline and holes of
/// any shape - to the edges of the raw image: one pose a board.
class ImageTemplate final : public Stage {
   public:
    using Params = ImageTemplateParams;
    static void describe(Spec<Params>& spec);

    /// \throws Error when the target cannot be read, has no hole, or fewer than `min_holes`.
    explicit ImageTemplate(Params params);
    /// \throws Error when an image is not of its camera's size, not 8 bit, or has no usable
    /// intrinsics.
    void run(Run& run) override;

   private:
    void detect(Run& run, const CameraImage& image, ImageBoards& found) const;

    Params params_;
    TemplateModel model_;
};

}  // namespace petal
