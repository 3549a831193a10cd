// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_template_judge.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "petal/printed.hpp"

namespace petal {

namespace {

constexpr double kLeastOfEachHole = 0.15;  ///< in place
/// No hole is darker than black; the rest is for edges that sharpening lets overshoot.
constexpr double kMostContrast = 1.3;
constexpr int kLeastOutlineSides = 2;
constexpr double kOutlineSide = 0.6;  ///< of a side's samples in place, beyond chance
/// The plate is even where it differs by less than this part of the holes' edge, and 3 sigma.
constexpr double kEven = 0.3;

/// A first look, at a guess that is up to a third of a hole off.
constexpr double kGlanceNoise = 1.5;
constexpr double kGlanceSides = 0.6;
constexpr double kGlanceEven = 0.6;

constexpr double kGlanceSize = 0.8;

double hole_pixels(const TemplatePose& pose, const TemplateModel& model,
                   const CameraModel& camera) {
    const auto seen = pose.see(model, camera, model.center());
    return seen ? model.hole_size() * std::sqrt(std::abs(seen->by_board.determinant())) : 0.0;
}

struct PlateLook {
    double even = 0.0;   ///< share of its points
    double grey = 0.0;   ///< in its middle
    bool whole = false;  ///< half of it lies in the image
};

/// The plate's brightness as a plane over the board, fitted with weights that fall (Cauchy).
PlateLook look_at_plate(const TemplatePose& pose, double usual_strength, const EdgeSampler& edges,
                        const TemplateModel& model, const CameraModel& camera, double noise,
                        std::size_t most_points) {
    PlateLook look;
    const std::size_t every = 1 + (model.plate_points().size() - 1) / most_points;
    std::vector<Eigen::Vector3d> rows;
    std::vector<double> greys;
    for (std::size_t i = 0; i < model.plate_points().size(); i += every) {
        const Eigen::Vector2d& p = model.plate_points()[i];
        const auto seen = pose.see(model, camera, p);
        const auto grey = seen ? edges.grey(seen->pixel) : std::nullopt;
        if (!grey) continue;
        const Eigen::Vector2d arm = (p - model.center()) / model.target().width();
        rows.emplace_back(1.0, arm.x(), arm.y());
        greys.push_back(*grey);
    }
    look.whole = 2 * every * greys.size() >= model.plate_points().size() && greys.size() >= 6;
    if (!look.whole) return look;
    const double allowed = kEven * usual_strength + 3.0 * noise;
    std::vector<double> sorted = greys;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    Eigen::Vector3d plane(*middle, 0.0, 0.0);
    for (int round = 0; round < 6; ++round) {
        Eigen::Matrix3d normal = 1e-9 * Eigen::Matrix3d::Identity();
        Eigen::Vector3d right = Eigen::Vector3d::Zero();
        for (std::size_t i = 0; i < greys.size(); ++i) {
            const double ratio = (greys[i] - rows[i].dot(plane)) / (0.5 * allowed);
            const double w = 1.0 / (1.0 + ratio * ratio);
            normal += w * rows[i] * rows[i].transpose();
            right += w * greys[i] * rows[i];
        }
        plane = normal.ldlt().solve(right);
    }
    double even = 0.0;
    for (std::size_t i = 0; i < greys.size(); ++i)
        even += std::abs(greys[i] - rows[i].dot(plane)) < allowed ? 1.0 : 0.0;
    look.even = even / static_cast<double>(greys.size());
    look.grey = plane(0);
    return look;
}

}  // namespace

double glance(const TemplatePose& pose, const EdgeSampler& edges, const TemplateModel& model,
              const CameraModel& camera, double noise, const TemplateEvidence& limits) {
    if (hole_pixels(pose, model, camera) < kGlanceSize * limits.min_hole_px) return 0.0;
    std::vector<double> strengths;
    const std::vector<EdgeSample> samples =
        sample_edges(edges, model, camera, pose, {}, {0.35, 2.5, 14.0, 1, false});
    for (const EdgeSample& sample : samples)
        if (sample.seen && sample.strength > kGlanceNoise * noise)
            strengths.push_back(sample.strength);
    if (strengths.empty()) return 0.0;
    const double sides =
        static_cast<double>(strengths.size()) / static_cast<double>(samples.size());
    if (sides < kGlanceSides) return 0.0;
    const auto middle = strengths.begin() + static_cast<std::ptrdiff_t>(strengths.size() / 2);
    std::nth_element(strengths.begin(), middle, strengths.end());
    const PlateLook plate = look_at_plate(pose, *middle, edges, model, camera, noise, 40);
    return plate.whole && plate.even > kGlanceEven ? sides * plate.even : 0.0;
}

TemplateVerdict judge_board(const FittedBoard& board, const EdgeSampler& edges,
                            const TemplateModel& model, const CameraModel& camera, double noise,
                            const TemplateEvidence& limits) {
    TemplateVerdict verdict;
    if (!board.converged) {
        verdict.rejected = "its edges fit no pose of the board";
        return verdict;
    }
    std::vector<EdgesInPlace> edges_of(model.holes() + 1);
    for (std::size_t s = 0; s < board.sides.size(); ++s) {
        const TemplateSide& side = model.sides()[s];
        const FittedSide& fitted = board.sides[s];
        fitted.add_to(edges_of[side.contour]);
        EdgesInPlace own;
        fitted.add_to(own);
        if (side.outline && own.share() >= kOutlineSide) ++verdict.outline_sides;
    }
    EdgesInPlace holes;
    double fewest = 1.0;
    for (std::size_t h = 1; h < edges_of.size(); ++h) {
        holes.in_place += edges_of[h].in_place;
        holes.chance += edges_of[h].chance;
        holes.samples += edges_of[h].samples;
        fewest = std::min(fewest, edges_of[h].share());
    }
    verdict.edges = holes.share();
    verdict.outline = edges_of[0].share();
    const PlateLook plate =
        look_at_plate(board.pose, board.usual_strength, edges, model, camera, noise, 1000);
    verdict.plate = plate.even;
    verdict.contrast = board.usual_strength / std::max(plate.grey, 1.0);
    const double scatter = board.hole_scatter / model.hole_size();
    const double inset = board.shifts.inset / model.hole_size();
    const double pixels = hole_pixels(board.pose, model, camera);
    const double evidence = verdict.outline * verdict.plate;
    if (!plate.whole)
        verdict.rejected = "the board reaches out of the image";
    else if (verdict.edges < limits.min_edges)
        verdict.rejected = printed("%.2f of the holes' edges are in place (min_edges %.2f)",
                                   verdict.edges, limits.min_edges);
    else if (verdict.contrast > kMostContrast)
        verdict.rejected = printed(
            "its holes are darker than the plate by %.2f of the plate's brightness (most %.2f)",
            verdict.contrast, kMostContrast);
    else if (fewest < kLeastOfEachHole)
        verdict.rejected =
            printed("a hole has %.2f of its edges in place (least %.2f)", fewest, kLeastOfEachHole);
    else if (scatter > limits.max_scatter)
        verdict.rejected = printed("its sides lie %.3f of a hole off the pose (max_scatter %.3f)",
                                   scatter, limits.max_scatter);
    else if (std::abs(inset) > limits.max_inset)
        verdict.rejected =
            printed("its holes look smaller by %.3f of their size on each side (max_inset %.3f)",
                    inset, limits.max_inset);
    else if (pixels < limits.min_hole_px)
        verdict.rejected =
            printed("its holes have %.1f px (min_hole_px %.1f)", pixels, limits.min_hole_px);
    else if (verdict.plate < limits.min_plate)
        verdict.rejected = printed("%.2f of the plate is evenly bright (min_plate %.2f)",
                                   verdict.plate, limits.min_plate);
    else if (verdict.outline < limits.min_outline || verdict.outline_sides < kLeastOutlineSides)
        verdict.rejected = printed(
            "%.2f of its outline is there, %.0f sides (min_outline %.2f, and 2 sides)",
            verdict.outline, static_cast<double>(verdict.outline_sides), limits.min_outline);
    else if (evidence < limits.min_evidence)
        verdict.rejected =
            printed("outline and plate together are %.2f in place (min_evidence %.2f)", evidence,
                    limits.min_evidence);
    return verdict;
}

}  // namespace petal
