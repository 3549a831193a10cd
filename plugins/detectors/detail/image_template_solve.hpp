// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "detectors/detail/image_template_fit.hpp"

namespace petal {

struct SolveSettings {
    double pixels_share = 1.0;  ///< neighbouring samples share pixels: how many count as one
    int rounds = 8;             ///< of reweighting
    /// Begin with the weights that follow from the board as it is, not with all alike.
    bool go_on = false;
};

/// One step of the pose (TemplatePose::step), with EdgeShifts, from the board's samples: linear
/// least squares over twelve unknowns with Cauchy weights, of samples and of sides. Sets all of the
/// board but its samples and `plate_grey`. False where the samples do not fix it, or where what
/// they fix is no board.
bool solve_template(const TemplateModel& model, const TemplateFitLimits& limits, double noise,
                    const SolveSettings& settings, FittedBoard& board);

}  // namespace petal
