// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <vector>

#include "detectors/detail/image_template_edges.hpp"
#include "petal/calibration/boards.hpp"

namespace petal {

/// Which share of samples is in place beyond what chance brings: 0 where edges lie anywhere, 1
/// where all are in place. Faint edges lie anywhere within their noise, so they are worth little.
struct EdgesInPlace {
    double in_place = 0.0, chance = 0.0, samples = 0.0;
    double share() const {
        const double more = samples - chance;
        return more > 0.0 ? (in_place > chance ? (in_place - chance) / more : 0.0) : 0.0;
    }
};

/// What the fit assumes before it has seen the image.
struct TemplateFitLimits {
    bool model_walls = true;    ///< the plate's thickness shows in the holes and at its outline
    double tolerance = 0.0002;  ///< m, 1 sigma: how well in place the sides of holes are
};

/// A side as the fit left it.
struct FittedSide {
    int samples = 0;         ///< places that lie in the image
    int in_place = 0;        ///< of them, those whose edge lies where the pose puts it
    double chance = 0.0;     ///< of them, those that would if edges lay anywhere in reach
    double offset_px = 0.0;  ///< of its own edge points from there
    bool measured = false;   ///< it took part in the pose

    void add_to(EdgesInPlace& edges) const {
        edges.in_place += in_place;
        edges.chance += chance;
        edges.samples += samples;
    }
};

struct FittedBoard {
    TemplatePose pose;
    Matrix6d covariance = Matrix6d::Identity();  ///< of a TemplatePose step
    EdgeShifts shifts;
    std::vector<FittedSide> sides;  ///< TemplateModel::sides() order
    std::vector<EdgeSample> samples;
    double plate_grey = 0.0;       ///< its median
    double usual_strength = 0.0;   ///< grey levels: the median edge of the holes
    double sample_sigma_px = 0.0;  ///< of an ordinary edge point about its side
    double hole_scatter = 0.0;     ///< m, 1 sigma: of the holes' sides about the pose
    double outline_scatter = 0.0;  ///< m
    double last_step = 0.0;        ///< of the pose, in its own sigmas
    bool converged = false;
};

/// An edge of a hole that is weaker than this part of the board's usual one is not its edge.
inline constexpr double kLeastEdgeShare = 0.2;

/// How well an edge point of that strength is placed, px, 1 sigma; `noise` is the image's, grey
/// levels.
double edge_sigma(double noise, double strength);

/// The pose (six numbers) that lets the template's edges lie on those of the image, by generalised
/// least squares over all edge samples: a sample has noise of its own (its edge's strength over the
/// image's noise), the samples of a side share an offset and a tilt (a side that is cut, lit or
/// hidden a little off), whose size is estimated from the board itself, and holes and outline share
/// the shifts of EdgeShifts. Samples and sides that disagree lose their weight (Cauchy).
class TemplateFit {
   public:
    TemplateFit(const EdgeSampler& edges, const TemplateModel& model, const CameraModel& camera,
                double noise, const TemplateFitLimits& limits)
        : edges_(edges), model_(model), camera_(camera), noise_(noise), limits_(limits) {}

    /// From a guess that is up to a third of a hole off, by the holes alone, at a few places a
    /// side. What it costs is little: most guesses are no boards.
    FittedBoard coarse(const TemplatePose& guess) const;
    /// From a coarse fit to the final one.
    FittedBoard fine(const FittedBoard& coarse) const;

    /// EdgesInPlace of the holes together.
    double holes_in_place(const FittedBoard& board) const;

   private:
    double plate_grey(const TemplatePose& pose) const;
    void count(FittedBoard& board, const EdgeReach& reach) const;

    const EdgeSampler& edges_;
    const TemplateModel& model_;
    const CameraModel& camera_;
    double noise_;
    TemplateFitLimits limits_;
};

}  // namespace petal
