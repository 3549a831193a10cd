// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <vector>

#include "detectors/detail/image_template_guesses.hpp"
#include "detectors/detail/image_template_ideal.hpp"

namespace petal {

/// Guesses by one region alone. Its moments give an affine map but for a turn; taken are the turns
/// that let the corners of its polygon lie on its hull (ideal pixels).
void guess_by_plate(const IdealRegion& plate, const std::vector<Eigen::Vector2d>& hull,
                    const TemplateModel& model, std::vector<TemplateGuess>& guesses);

/// The same by a hole, which may be any of the board's that is a polygon: for boards of which
/// something hides so much that no two holes are whole. A round hole has no turn.
void guess_by_hole(const IdealRegion& hole, const std::vector<Eigen::Vector2d>& hull,
                   const TemplateModel& model, std::vector<TemplateGuess>& guesses);

}  // namespace petal
