// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_attempt.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/plane_fit.hpp"
#include "petal/calibration/se3.hpp"
#include "petal/printed.hpp"

namespace petal {
namespace {

constexpr std::size_t kAttemptPlacements = 2;
constexpr double kLeastScore = 0.4;    ///< of a placement: a plate without holes has 1/3
constexpr double kAroundPlate = 0.35;  ///< of the lesser side: rays gathered beyond the plate
constexpr double kPlaneRadius = 0.8;   ///< of the plate's radius: points that tell a first plane
constexpr double kPlaneDepth = 0.05;   ///< m
constexpr std::size_t kEdgePlacements = 3;
constexpr double kNearPlane = 0.05;  ///< m: points looked at with a patch
constexpr double kFlat = 0.01;       ///< m of flatness that outweigh all gain
constexpr std::size_t kMostDrawn = 40000, kMostKept = 4000;
constexpr double kOnBoard = 0.7;  ///< of the lesser side: middles so near are not of two boards
constexpr std::size_t kDraftRays = 24000;

/// What the points cannot tell: m, 1 sigma along x, y and z of the board.
constexpr double kUnseenAcross = 0.0001, kUnseenDeep = 0.00015;

void keep_places(const RayBundle& rays, PlateAttempt& attempt) {
    const std::size_t stride = rays.rays.size() / kMostDrawn + 1;
    attempt.hits.clear();
    attempt.misses.clear();
    for (std::size_t i = 0; i < rays.rays.size(); i += stride) {
        const Told told = rays.told(rays.rays[i]);
        if (told == Told::hit) attempt.hits.push_back(rays.rays[i].place);
        if (told == Told::miss) attempt.misses.push_back(rays.rays[i].place);
    }
}

/// Limits that a fit to some of the rays keeps wherever one to all of them may keep `limits`. A
/// target of other measures is told by all rays.
PlateLimits loosened(const PlateLimits& limits) {
    PlateLimits loose;
    loose.min_gain = 0.6 * limits.min_gain;
    loose.min_open = 0.6 * limits.min_open;
    loose.min_outline = 0.6 * limits.min_outline;
    loose.max_flatness = 3.0 * limits.max_flatness;
    loose.max_shift = 2.0 * limits.max_shift;
    loose.max_stretch = std::numeric_limits<double>::infinity();
    return loose;
}

/// A fit and what it is worth.
struct JudgedFit {
    PlateFit fit;
    PlateSupport support;
    PlateVerdict verdict;
};

/// None where the rays do not fix the target. What comes near a board with some of the rays is
/// fitted to all: from there, and where that is no board (the draft may lie in another minimum)
/// from the placement.
std::optional<JudgedFit> fit_and_judge(const PlateTemplate& target, const PlateBeam& beam,
                                       const PlateLimits& limits, const CloudDirections& cloud,
                                       const RayBundle& some, const PlatePlacement& placement) {
    const auto judged = [&](JudgedFit made) {
        made.support = measure_support(target, made.fit);
        made.verdict = judge_plate(target, limits, made.fit, made.support);
        return made;
    };
    JudgedFit draft;
    if (!fit_plate(target, beam, some, placement, draft.fit)) return std::nullopt;
    draft = judged(std::move(draft));
    if (some.crossed == some.rays.size() ||
        !judge_plate(target, loosened(limits), draft.fit, draft.support).board)
        return draft;
    JudgedFit whole;
    const PlateState& start = draft.fit.state;
    if (fit_plate(target, beam, gather_rays(cloud, start.T_lidar_middle, reach_of(target)), start,
                  whole.fit)) {
        whole = judged(std::move(whole));
        if (whole.verdict.board) return whole;
    }
    JudgedFit again;
    if (!fit_plate(target, beam, gather_rays(cloud, some.T_lidar_plane, reach_of(target)),
                   placement, again.fit))
        return std::nullopt;
    return judged(std::move(again));
}

}  // namespace

double reach_of(const PlateTemplate& target) {
    return target.all.radius() + kAroundPlate * target.all.least_side();
}

LidarBoard board_at(const PlateTemplate& target, const Target& names,
                    const Eigen::Isometry3d& T_lidar_middle, const Matrix6d& covariance) {
    LidarBoard board;
    board.target = names.name;
    const Eigen::Isometry3d seen =
        plane_frame(-T_lidar_middle.linear().col(2), T_lidar_middle.translation());
    const Eigen::Vector3d x = seen.linear().transpose() * T_lidar_middle.linear().col(0);
    const double step = 2.0 * kPi / target.all.symmetry();
    const double turn = -step * std::round(std::atan2(x.y(), x.x()) / step);
    board.T_lidar_board =
        T_lidar_middle * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) *
        Eigen::Translation3d(-target.all.middle().x(), -target.all.middle().y(), 0.0);
    for (const Eigen::Vector2d& corner : names.corners())
        board.corners.push_back(board.T_lidar_board * Eigen::Vector3d(corner.x(), corner.y(), 0.0));
    Matrix6d unseen = Matrix6d::Zero();
    unseen(0, 0) = unseen(1, 1) = kUnseenAcross * kUnseenAcross;
    unseen(2, 2) = kUnseenDeep * kUnseenDeep;
    const Matrix6d to_lidar = adjoint(T_lidar_middle);
    const Matrix6d left = to_lidar * (covariance + unseen) * to_lidar.transpose();
    board.covariance = 0.5 * (left + left.transpose());
    return board;
}

PlacedPlate place_on_rays(const PlateTemplate& target, const PlatePlacer& placer,
                          const CloudDirections& cloud, const PlateCandidate& plate) {
    PlacedPlate placed;
    placed.plate = plate;
    placed.rays =
        gather_rays(cloud, plane_frame(plate.normal, plate.centre), reach_of(target), kDraftRays);
    if (fit_plane(placed.rays, kPlaneRadius * target.all.radius(), kPlaneDepth))
        placed.placements = placer.place(placed.rays, kAttemptPlacements, kLeastScore);
    if (placed.score() < kLeastScore) {
        // Its rays are no longer needed, but for the picture.
        const std::size_t stride = placed.rays.rays.size() / kMostKept + 1;
        std::vector<PlaneRay> kept;
        for (std::size_t i = 0; i < placed.rays.rays.size(); i += stride)
            kept.push_back(placed.rays.rays[i]);
        placed.rays.rays = std::move(kept);
    }
    return placed;
}

PlateAttempt try_rays(const PlateTemplate& target, const PlateBeam& beam, const PlateLimits& limits,
                      const CloudDirections& cloud, const PlacedPlate& placed,
                      const std::vector<Eigen::Vector3d>& boards, const Target& names) {
    PlateAttempt attempt;
    attempt.plate = placed.plate;
    attempt.middle = placed.plate.centre;
    attempt.closeness = placed.score();
    keep_places(placed.rays, attempt);
    if (placed.placements.empty()) {
        attempt.miss = printed("a plate of %zu rays", placed.rays.crossed);
        attempt.threshold = "too few for a plane";
        return attempt;
    }
    for (const PlatePlacement& placement : placed.placements) {
        if (placement.score < kLeastScore) {
            if (&placement != &placed.placements.front()) break;
            attempt.miss = printed("a plate on which the target agrees with the rays by %.2f",
                                   placement.score);
            attempt.threshold = printed("needed %.2f", kLeastScore);
            break;
        }
        const Eigen::Vector3d at = placed.middle(placement);
        if (std::any_of(boards.begin(), boards.end(), [&](const Eigen::Vector3d& board) {
                return (board - at).norm() < kOnBoard * target.all.least_side();
            })) {
            attempt.miss = "a board that another plate shows too";
            attempt.closeness = 0.0;
            continue;
        }
        auto made = fit_and_judge(target, beam, limits, cloud, placed.rays, placement);
        if (!made) {
            if (attempt.miss.empty()) {
                attempt.miss = "a plate whose rays do not fix the target";
                attempt.threshold.clear();
            }
            continue;
        }
        const PlateFit& fit = made->fit;
        PlateVerdict& verdict = made->verdict;
        if (!verdict.board && attempt.placed && verdict.closeness <= attempt.closeness) continue;
        attempt.placed = true;
        attempt.middle = fit.state.T_lidar_middle.translation();
        attempt.miss = std::move(verdict.miss);
        attempt.threshold = std::move(verdict.threshold);
        attempt.finding = std::move(verdict.finding);
        attempt.closeness = verdict.closeness;
        attempt.merit = fit.gain - fit.plane.flatness / kFlat;
        keep_places(fit.rays, attempt);
        if (!verdict.board) continue;
        LidarBoard board = board_at(target, names, fit.state.T_lidar_middle, fit.covariance);
        board.quality = plate_quality(target, fit, made->support);
        board.quality["agreement"] = placement.score;
        attempt.board = std::move(board);
        break;
    }
    return attempt;
}

/// False, with the reason in the attempt, where the fit is no board's.
static bool accept_edges(const PlateEdgeLimits& limits, const PlateEdgeFit& fit, double max_shift,
                         PlateAttempt& attempt) {
    const double shift = fit.state.shift.cwiseAbs().maxCoeff();
    if (fit.coverage < limits.min_edge_coverage) {
        attempt.miss = printed("points on %.0f %% of the holes' sides", fit.coverage * 100.0);
        attempt.threshold = printed("min_edge_coverage %.2f", limits.min_edge_coverage);
    } else if (fit.inside > limits.max_inside) {
        attempt.miss =
            printed("%.0f %% of the points well inside the plate or its holes", fit.inside * 100.0);
        attempt.threshold = printed("max_inside %.2f", limits.max_inside);
    } else if (fit.edge_rms > limits.max_edge_rms) {
        attempt.miss = printed("a board whose points lie %.1f mm (RMS) off its holes' sides",
                               fit.edge_rms * 1e3);
        attempt.threshold = printed("max_edge_rms %.1f mm", limits.max_edge_rms * 1e3);
    } else if (shift > max_shift) {
        attempt.miss = printed("a board whose edges are shifted by %.1f mm", shift * 1e3);
        attempt.threshold = printed("max_shift %.1f mm", max_shift * 1e3);
    } else {
        return true;
    }
    return false;
}

PlateAttempt try_edges(const PlateTemplate& target, const PlateBeam& beam,
                       const PlateEdgeLimits& limits, double max_shift,
                       const std::vector<Eigen::Vector3d>& points, const PlateCandidate& patch,
                       const Target& names) {
    PlateAttempt attempt;
    attempt.plate = patch;
    attempt.middle = patch.centre;
    const double radius = reach_of(target);
    const Eigen::Isometry3d frame = plane_frame(patch.normal, patch.centre);
    std::vector<Eigen::Vector3d> near;
    for (const Eigen::Vector3d& p : points) {
        const Eigen::Vector3d q = frame.inverse() * p;
        if (std::abs(q.z()) > kNearPlane || q.head<2>().norm() > radius) continue;
        near.push_back(p);
        attempt.hits.push_back(q.head<2>());
    }
    attempt.miss = printed("%zu points near a plane that fix no target", near.size());
    for (const PlatePlacement& placement :
         place_edges(target.all, attempt.hits, radius, kEdgePlacements)) {
        const Eigen::Isometry3d start =
            frame * Eigen::Translation3d(placement.middle.x(), placement.middle.y(), 0.0) *
            Eigen::AngleAxisd(placement.angle, Eigen::Vector3d::UnitZ());
        PlateEdgeFit fit;
        if (!fit_edges(target, beam, near, start, fit)) continue;
        const double merit = fit.coverage - fit.inside;
        if (attempt.placed && merit <= attempt.merit) continue;
        attempt.placed = true;
        attempt.merit = merit;
        attempt.closeness = 1.0 + merit;
        attempt.middle = fit.state.T_lidar_middle.translation();
        attempt.board.reset();
        const bool good = accept_edges(limits, fit, max_shift, attempt);
        if (!good) continue;
        LidarBoard board = board_at(target, names, fit.state.T_lidar_middle, fit.covariance);
        board.quality = {{"points", static_cast<double>(fit.points)},
                         {"coverage", fit.coverage},
                         {"inside", fit.inside},
                         {"edge_rms_mm", fit.edge_rms * 1e3},
                         {"side_common_mm", fit.side_common * 1e3},
                         {"plane_rms_mm", fit.plane_rms * 1e3},
                         {"edge_shift_level_mm", fit.state.shift.x() * 1e3},
                         {"edge_shift_upright_mm", fit.state.shift.y() * 1e3},
                         {"edge_shift_sigma_level_mm", fit.shift_sigma.x() * 1e3},
                         {"edge_shift_sigma_upright_mm", fit.shift_sigma.y() * 1e3}};
        attempt.board = std::move(board);
    }
    if (attempt.placed) {
        const Eigen::Isometry3d to_middle =
            (attempt.board
                 ? attempt.board->T_lidar_board *
                       Eigen::Translation3d(target.all.middle().x(), target.all.middle().y(), 0.0)
                 : frame)
                .inverse();
        attempt.hits.clear();
        for (const Eigen::Vector3d& p : near) attempt.hits.push_back((to_middle * p).head<2>());
        attempt.placed = attempt.board.has_value();
    }
    return attempt;
}

}  // namespace petal
