// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "detectors/detail/image_template_edges.hpp"
#include "detectors/detail/image_template_fit.hpp"
#include "detectors/detail/image_template_model.hpp"

namespace petal {

/// The pose with its tilt mirrored about the line of sight to the board's middle. From far away a
/// plane looks the same tilted either way, and a fit may end at the wrong one.
TemplatePose mirrored(const TemplatePose& pose, const TemplateModel& model);

/// Of two fits to one board the likelier, by how its sides scatter about it. As far as the other
/// may be the true one, its covariance spans both: with the odds p of the other, d away, p d d^T.
FittedBoard of_two_tilts(const FittedBoard& first, const FittedBoard& second,
                         const TemplateModel& model);

}  // namespace petal
