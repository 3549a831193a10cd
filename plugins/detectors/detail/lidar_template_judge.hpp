// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <map>
#include <string>
#include <vector>

#include "detectors/detail/lidar_template_fit.hpp"

namespace petal {

struct PlateLimits {
    double min_gain = 0.35;
    double min_open = 0.6;
    double min_outline = 0.5;
    double max_flatness = 0.006;
    double max_shift = 0.03;
    double max_stretch = 0.02;
};

/// What the rays around a fit say of it.
struct PlateSupport {
    double plate = 0.0;                 ///< share of the rays on the plate that hit it
    std::vector<double> holes;          ///< share of each hole that lets rays through; -1: hidden
    std::vector<double> outline;        ///< the same beyond each side of the outline
    std::vector<double> side_coverage;  ///< of each side of a hole: share of its fifths with rays
                                        ///< on both sides of it
    double open_holes() const;          ///< mean over those seen; 0: none seen
    double open_outline() const;
    double mean_coverage() const;
};
PlateSupport measure_support(const PlateTemplate& target, const PlateFit& fit);

struct PlateVerdict {
    bool board = false;
    double closeness = 0.0;  ///< of a failure: the higher the nearer to a board
    std::string miss;        ///< of a failure: what was found
    std::string threshold;   ///< of a failure: what was needed
    std::string finding;     ///< what casts doubt on the target file; empty: nothing
};
/// Whether a fit is a board: better than a plate without holes or a wall, with holes that are
/// open, edges that stand free, and of the target's measures.
PlateVerdict judge_plate(const PlateTemplate& target, const PlateLimits& limits,
                         const PlateFit& fit, const PlateSupport& support);

/// The figures of LidarBoard::quality.
std::map<std::string, double> plate_quality(const PlateTemplate& target, const PlateFit& fit,
                                            const PlateSupport& support);

}  // namespace petal
