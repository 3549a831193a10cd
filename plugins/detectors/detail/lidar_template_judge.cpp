// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_judge.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "petal/printed.hpp"

namespace petal {
namespace {

constexpr double kGridStep = 0.01;      ///< of the board's lesser side
constexpr double kWidths = 2.0;         ///< of the passage: nearer to an edge nothing is sure
constexpr double kDeepShare = 0.6;      ///< of PlateShape::rim(), at most
constexpr double kLeastExpected = 3.0;  ///< rays in an opening: fewer are no evidence
constexpr double kHidden = 0.5;         ///< share of rays stopped before the plane
constexpr int kJudgeFifths = 5;
constexpr double kJudgeLeastPlate = 0.8;  ///< share of hits on the plate
constexpr double kDoubtful = 0.01;        ///< of stretch
constexpr double kFindingSigmas = 5.0;

struct Opening {
    double area = 0.0, hits = 0.0, misses = 0.0, hidden = 0.0;
    double open(double density) const {
        const double expected = std::max(area * density, hits + misses + hidden);
        if (expected < kLeastExpected || hidden > kHidden * expected) return -1.0;
        return 1.0 - hits / std::max(expected - hidden, 1.0);
    }
};

double mean_seen(const std::vector<double>& shares) {
    double sum = 0.0, count = 0.0;
    for (const double share : shares)
        if (share >= 0.0) {
            sum += share;
            count += 1.0;
        }
    return count > 0.0 ? sum / count : 0.0;
}

}  // namespace

double PlateSupport::open_holes() const {
    return mean_seen(holes);
}
double PlateSupport::open_outline() const {
    return mean_seen(outline);
}
double PlateSupport::mean_coverage() const {
    return mean_seen(side_coverage);
}

PlateSupport measure_support(const PlateTemplate& target, const PlateFit& fit) {
    const PlateShape& all = target.all;
    const std::size_t holes = all.hole_count();
    const Eigen::Vector2d widths = fit.state.log_width.array().exp();
    const double deep =
        std::min(kWidths * widths.maxCoeff() + fit.state.shift.cwiseAbs().maxCoeff(),
                 kDeepShare * all.rim());
    const double ring = all.reach();
    // Openings: holes first, then what lies beyond the sides of the outline.
    std::vector<Opening> openings(holes + all.side_count());
    // Of a place off the plate.
    const auto opening_at = [&](const Eigen::Vector2d& p) -> Opening* {
        const PlateShape::Edge edge = all.edge(p);
        const int hole = all.hole_of(edge.side);
        if (hole >= 0) return &openings[static_cast<std::size_t>(hole)];
        if (edge.inside < -deep - ring) return nullptr;
        return &openings[holes + static_cast<std::size_t>(edge.side)];
    };
    const double step = kGridStep * all.least_side();
    const double reach = all.radius() + deep + ring;
    for (double x = -reach; x <= reach; x += step)
        for (double y = -reach; y <= reach; y += step)
            if (all.beyond({x, y}, deep) < 0)
                if (Opening* opening = opening_at({x, y})) opening->area += step * step;

    PlateSupport support;
    double plate = 0.0, plate_hits = 0.0;
    // Of each fifth of each side of a hole: rays that hit inside, and room or misses outside.
    std::vector<std::array<int, kJudgeFifths>> hits(target.holes.side_count());
    for (const PlaneRay& ray : fit.rays.rays) {
        const Told told = fit.rays.told(ray);
        const int beyond = all.beyond(ray.place, deep);
        if (beyond < 0) {
            if (Opening* opening = opening_at(ray.place))
                (told == Told::hit    ? opening->hits
                 : told == Told::miss ? opening->misses
                                      : opening->hidden) += 1.0;
        } else if (told != Told::nothing && beyond > 0) {
            plate += 1.0;
            plate_hits += told == Told::hit;
        }
        if (told != Told::hit || target.holes.beyond(ray.place, 2.0 * deep) != 0) continue;
        const PlateShape::Edge edge = target.holes.edge(ray.place);
        if (edge.inside < 0.0 || edge.inside > 2.0 * deep) continue;
        const double along = target.holes.share_along(edge.side, ray.place);
        ++hits[static_cast<std::size_t>(edge.side)][static_cast<std::size_t>(
            std::clamp(static_cast<int>(along * kJudgeFifths), 0, kJudgeFifths - 1))];
    }
    support.plate = plate > 0.0 ? plate_hits / plate : 0.0;
    for (std::size_t i = 0; i < openings.size(); ++i) {
        const double open = openings[i].open(fit.density);
        if (i < holes)
            support.holes.push_back(open);
        else if (openings[i].area > 0.0)
            support.outline.push_back(open);
    }
    for (const auto& side : hits)
        support.side_coverage.push_back(
            static_cast<double>(
                std::count_if(side.begin(), side.end(), [](int count) { return count > 0; })) /
            kJudgeFifths);
    return support;
}

PlateVerdict judge_plate(const PlateTemplate& target, const PlateLimits& limits,
                         const PlateFit& fit, const PlateSupport& support) {
    PlateVerdict verdict;
    verdict.closeness = 1.0 + fit.gain;
    const double shift = fit.state.shift.cwiseAbs().maxCoeff();
    const double stretch = fit.stretch.cwiseAbs().maxCoeff();
    if (support.plate < kJudgeLeastPlate) {
        verdict.miss =
            printed("a plate of which only %.0f %% of the rays return", support.plate * 100.0);
        verdict.threshold = printed("needed %.0f %%", kJudgeLeastPlate * 100.0);
    } else if (target.all.has_holes() && support.open_holes() < limits.min_open) {
        verdict.miss = printed("a plate whose holes let only %.0f %% of the rays through",
                               support.open_holes() * 100.0);
        verdict.threshold = printed("min_open %.2f", limits.min_open);
    } else if (support.open_outline() < limits.min_outline) {
        verdict.miss = printed("a surface that goes on behind %.0f %% of the board's outline",
                               (1.0 - support.open_outline()) * 100.0);
        verdict.threshold = printed("min_outline %.2f", limits.min_outline);
    } else if (fit.gain < limits.min_gain) {
        verdict.miss = printed("a plate whose template tells %.2f of hits from misses", fit.gain);
        verdict.threshold = printed("min_gain %.2f", limits.min_gain);
    } else if (fit.plane.flatness > limits.max_flatness) {
        verdict.miss = printed("a plate that is not flat by %.1f mm", fit.plane.flatness * 1e3);
        verdict.threshold = printed("max_flatness %.1f mm", limits.max_flatness * 1e3);
    } else if (shift > limits.max_shift) {
        verdict.miss =
            printed("a board whose edges are shifted by %.1f mm (level) and %.1f mm (upright)",
                    fit.state.shift.x() * 1e3, fit.state.shift.y() * 1e3);
        verdict.threshold = printed("max_edge_shift %.1f mm", limits.max_shift * 1e3);
    } else if (stretch > limits.max_stretch) {
        verdict.miss = printed(
            "a board whose sides stand %+.1f %% (x) and %+.1f %% (y) farther apart "
            "than the target's",
            fit.stretch.x() * 100.0, fit.stretch.y() * 100.0);
        verdict.threshold = printed("max_stretch %.1f %%", limits.max_stretch * 100.0);
        if (((fit.stretch.cwiseAbs() - kFindingSigmas * fit.stretch_sigma).array() > 0.0).any())
            verdict.finding = verdict.miss + "; is the target's file that of the board?";
    } else {
        verdict.board = true;
        if (((fit.stretch.cwiseAbs() - kFindingSigmas * fit.stretch_sigma).array() > 0.0).any() &&
            stretch > kDoubtful)
            verdict.finding = printed(
                "a board whose sides stand %+.1f %% (x) and %+.1f %% (y) farther apart than the "
                "target's; is the target's file that of the board?",
                fit.stretch.x() * 100.0, fit.stretch.y() * 100.0);
    }
    return verdict;
}

std::map<std::string, double> plate_quality(const PlateTemplate& target, const PlateFit& fit,
                                            const PlateSupport& support) {
    const Eigen::Vector2d widths = fit.state.log_width.array().exp();
    std::map<std::string, double> quality{
        {"rays", static_cast<double>(fit.zone.rays.size())},
        {"plate_points", static_cast<double>(fit.plane.points)},
        {"edge_shift_level_mm", fit.state.shift.x() * 1e3},
        {"edge_shift_upright_mm", fit.state.shift.y() * 1e3},
        {"edge_shift_sigma_level_mm", fit.shift_sigma.x() * 1e3},
        {"edge_shift_sigma_upright_mm", fit.shift_sigma.y() * 1e3},
        {"edge_width_level_mm", widths.x() * 1e3},
        {"edge_width_upright_mm", widths.y() * 1e3},
        {"flatness_mm", fit.plane.flatness * 1e3},
        {"plane_rms_mm", fit.plane.rms * 1e3},
        {"side_common_level_mm", fit.side_common.x() * 1e3},
        {"side_common_upright_mm", fit.side_common.y() * 1e3},
        {"gain", fit.gain},
        {"coverage", support.mean_coverage()},
        {"open_outline", support.open_outline()},
        {"pitch_x_percent", fit.stretch.x() * 100.0},
        {"pitch_y_percent", fit.stretch.y() * 100.0},
        {"pitch_sigma_x_percent", fit.stretch_sigma.x() * 100.0},
        {"pitch_sigma_y_percent", fit.stretch_sigma.y() * 100.0},
        {"silent_rays", 0.0}};
    for (const ToldRays::Silent& silent : fit.zone.silent)
        quality["silent_rays"] += silent.on_plate ? 0.0 : silent.rays;
    if (target.all.has_holes()) quality["open_holes"] = support.open_holes();
    for (std::size_t i = 0; i < support.outline.size(); ++i)
        quality[printed("outline_open_%zu", i + 1)] = support.outline[i];
    return quality;
}

}  // namespace petal
