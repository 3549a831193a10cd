// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>

#include "detectors/detail/image_template_fit.hpp"

namespace petal {

/// What a region of the image must show to be a board.
struct TemplateEvidence {
    double min_edges = 0.35;     ///< share of the holes' edges that are in place
    double min_outline = 0.55;   ///< share of the outline that is
    double min_plate = 0.7;      ///< share of the plate that is of one brightness
    double min_evidence = 0.57;  ///< product of the last two
    double max_scatter = 0.02;   ///< of the sides about the pose, over a hole's size
    double max_inset = 0.04;     ///< of the holes' sides beside the target's, over a hole's size
    double min_hole_px = 5.0;    ///< a hole's size in the image
};

struct TemplateVerdict {
    double edges = 0.0;
    double outline = 0.0;
    int outline_sides = 0;  ///< at least half in place
    double plate = 0.0;
    double contrast = 0.0;  ///< the holes' usual edge over the plate's brightness
    std::string rejected;   ///< empty: a board; else why not, with figure and threshold
};

/// A first look at a guess, before anything is fitted, 0 to 1: the share of hole sides that have an
/// edge near, times that of the plate that is even between them. 0 where either is too small for a
/// board, or the holes are.
double glance(const TemplatePose& pose, const EdgeSampler& edges, const TemplateModel& model,
              const CameraModel& camera, double noise, const TemplateEvidence& limits);

/// Whether the image bears a fitted board out: its holes have edges where the geometry puts them,
/// and so has the outline, by which a board differs from windows and tiles; between them lies one
/// plate, evenly bright but for a slope and what hides a part of it.
TemplateVerdict judge_board(const FittedBoard& board, const EdgeSampler& edges,
                            const TemplateModel& model, const CameraModel& camera, double noise,
                            const TemplateEvidence& limits);

}  // namespace petal
