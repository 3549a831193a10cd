// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_fit.hpp"

#include <tbb/parallel_invoke.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "detectors/detail/lidar_template_background.hpp"
#include "detectors/detail/lidar_template_covariance.hpp"
#include "detectors/detail/lidar_template_silent.hpp"

namespace petal {
namespace {

constexpr int kFirstSteps = 12, kFitSteps = 20;
constexpr int kRounds = 2;
constexpr int kTurns = 3;
constexpr double kBand = 0.035;  ///< m: rays farther off an edge tell nothing of its place
/// Where edges are known: rays farther off than as many widths tell nothing, nor do they move more.
constexpr double kBandWidths = 10.0, kBandMoves = 0.003;  ///< m
constexpr std::size_t kFirstRays = 8000;
constexpr double kFirstWidth = 0.008;   ///< m
constexpr double kLeastGained = 0.003;  ///< of the log likelihood, in a step: 0.08 sigma
constexpr double kPlateMargin = 0.025;  ///< m: half of a Mid-70's beam at 10 m
constexpr double kMarginShare = 0.6;    ///< of PlateShape::rim(), at most
constexpr double kLeastFloor = 0.002, kMostFloor = 0.1;
constexpr std::size_t kLeastRays = 60;
/// Of the plate's thickness, how much the beam sees of a hole's wall: measured in the simulation.
/// Along its level axis a beam is narrower than the wall looks at 20 deg; along its upright axis
/// far wider, and what little the wall sends back makes no hit.
constexpr double kWallLevelShare = 0.85, kWallUprightShare = 0.15, kWallShareSigma = 0.15;

using Mask = std::array<bool, kPlateParameters>;

Mask mask_of(std::initializer_list<int> free) {
    Mask mask{};
    for (const int index : free) mask[static_cast<std::size_t>(index)] = true;
    return mask;
}

/// Levenberg's steps over the free parameters. False where nothing fixes them.
bool climb(const PlateShape& shape, const PlatePriors& priors, const ToldRays& rays,
           const Mask& free, int steps, PlateState& state) {
    PlateEvaluation at = evaluate_plate(shape, state, priors, rays, PlateScores::left_out);
    std::vector<int> index;
    for (int i = 0; i < kPlateParameters; ++i)
        if (free[static_cast<std::size_t>(i)]) index.push_back(i);
    const auto count = static_cast<Eigen::Index>(index.size());
    double damping = 1e-3;
    for (int step = 0; step < steps; ++step) {
        Eigen::MatrixXd matrix(count, count);
        Eigen::VectorXd gradient(count);
        for (Eigen::Index i = 0; i < count; ++i) {
            const int row = index[static_cast<std::size_t>(i)];
            gradient(i) = at.gradient(row);
            for (Eigen::Index j = 0; j < count; ++j)
                matrix(i, j) = at.expected(row, index[static_cast<std::size_t>(j)]);
            matrix(i, i) *= 1.0 + damping;
        }
        const Eigen::LDLT<Eigen::MatrixXd> solver(matrix);
        if (solver.info() != Eigen::Success || !solver.isPositive()) return false;
        const Eigen::VectorXd solved = solver.solve(gradient);
        if (!solved.allFinite()) return false;
        PlateVector move = PlateVector::Zero();
        for (Eigen::Index i = 0; i < count; ++i)
            move(index[static_cast<std::size_t>(i)]) = solved(i);
        // No step beyond half a width's order: the likelihood is bent there.
        const double most =
            std::max({move.head<3>().cwiseAbs().maxCoeff() / 0.01,
                      move.segment<3>(kPhiX).cwiseAbs().maxCoeff() / 0.03,
                      move.segment<2>(kShiftLevel).cwiseAbs().maxCoeff() / 0.01,
                      move.segment<2>(kGlareLevel).cwiseAbs().maxCoeff() / 0.01,
                      move.segment<2>(kWidthLevel).cwiseAbs().maxCoeff() / 0.7, 1.0});
        move /= most;
        PlateState next = moved(state, move);
        PlateEvaluation there = evaluate_plate(shape, next, priors, rays, PlateScores::left_out);
        if (there.value > at.value) {
            const double gained = there.value - at.value;
            state = next;
            at = std::move(there);
            damping = std::max(damping * 0.2, 1e-6);
            if (most <= 1.0 && gained < kLeastGained) return true;
        } else {
            damping *= 10.0;
            if (damping > 1e3) return true;
        }
    }
    return true;
}

/// The share of rays that tell the wrong thing far off the edges.
double floor_of(const PlateShape& shape, const RayBundle& rays, double margin) {
    double plate = 0.0, plate_missed = 0.0, hole = 0.0, hole_hit = 0.0;
    for (const PlaneRay& ray : rays.rays) {
        const Told told = rays.told(ray);
        if (told == Told::nothing || !shape.in_zone(ray.place)) continue;
        const int beyond = shape.beyond(ray.place, margin);
        if (beyond > 0) {
            plate += 1.0;
            plate_missed += told == Told::miss;
        } else if (beyond < 0) {
            hole += 1.0;
            hole_hit += told == Told::hit;
        }
    }
    const double wrong = std::max(plate > 0.0 ? plate_missed / plate : 0.0,
                                  hole > 20.0 ? std::min(hole_hit / hole, 0.5 * kMostFloor) : 0.0);
    return std::clamp(wrong, kLeastFloor, kMostFloor);
}

/// How far from the template's edges rays tell of their place, once they are nearly known.
double known_band(const PlateShape& shape, const PlateState& state) {
    const Eigen::Vector3d sensor = state.T_lidar_middle.inverse().translation();
    const double walls = shape.thickness() * sensor.head<2>().norm() / std::abs(sensor.z());
    return std::min(kBand, kBandMoves + walls + state.shift.cwiseAbs().maxCoeff() +
                               kBandWidths * std::exp(state.log_width.maxCoeff()));
}

/// Fills `zone` but for its silent places and its floor: every `stride`-th ray within `band` of an
/// edge, and how many there are farther off.
void choose_rays(const PlateShape& shape, const RayBundle& bundle, std::size_t stride, double band,
                 ToldRays& zone) {
    const std::vector<double> backgrounds = backgrounds_of(shape, bundle);
    zone.rays.clear();
    zone.right = zone.wrong = zone.far_hits = 0.0;
    std::size_t near = 0;
    for (const PlaneRay& ray : bundle.rays) {
        const Told told = bundle.told(ray);
        if (told == Told::nothing || !shape.in_zone(ray.place)) continue;
        const int beyond = shape.beyond(ray.place, band);
        if (beyond == 0) {
            if (near++ % stride != 0) continue;
            const auto side = static_cast<std::size_t>(shape.edge(ray.place).side);
            zone.rays.push_back({ray.point, told == Told::hit, backgrounds[side]});
            continue;
        }
        ((beyond > 0) == (told == Told::hit) ? zone.right : zone.wrong) += 1.0;
        if (told == Told::hit) zone.far_hits += 1.0;
    }
}

Eigen::Vector2d wall_seen(const PlateShape& shape) {
    return shape.thickness() * Eigen::Vector2d(kWallLevelShare, kWallUprightShare);
}

/// Where a fit starts: at a placement, or from a state that is nearly it.
struct PlateStart {
    PlateState state;
    bool settled = false;
};

bool fit_from(const PlateTemplate& target, const PlateBeam& beam, RayBundle rays,
              const PlateStart& start, PlateFit& fit) {
    const PlateShape& shape = target.holes;
    PlatePriors priors;
    priors.shift_level_sigma = beam.shift_level_sigma;
    priors.shift_upright_sigma = beam.shift_upright_sigma;
    priors.wall = wall_seen(shape);
    priors.wall_sigma.setConstant(std::max(kWallShareSigma * shape.thickness(), 1e-5));
    const double margin = std::min(kPlateMargin, kMarginShare * shape.rim());

    PlateState& state = fit.state;
    state = start.state;

    const auto take_plane = [&] {
        replace_plane(rays, state.T_lidar_middle);
        // What stands close behind the rim alone, a pole or a floor, hides no edge that counts.
        measure_ranges(
            rays, [&](const auto& p) { return target.all.beyond(p, margin) > 0; },
            [&](const auto& p) { return shape.in_zone(p) && shape.beyond(p, margin) < 0; });
    };
    const auto settle = [&](std::size_t stride, double band) {
        tbb::parallel_invoke([&] { choose_rays(shape, rays, stride, band, fit.zone); },
                             [&] { fit.zone.floor = floor_of(shape, rays, margin); },
                             [&] { fit.density = add_silent(target, rays, margin, fit.zone); });
        for (ToldRays::Silent& silent : fit.zone.silent) silent.rays /= static_cast<double>(stride);
        return fit.zone.rays.size() >= kLeastRays;
    };
    const Mask first = mask_of({kRhoX, kRhoY, kPhiZ, kShiftLevel, kShiftUpright});
    const Mask full = mask_of({kRhoX, kRhoY, kPhiZ, kShiftLevel, kShiftUpright, kWidthLevel,
                               kWidthUpright, kGlareLevel, kGlareUpright});
    take_plane();
    const std::size_t stride = rays.rays.size() / kFirstRays + 1;
    if (!start.settled &&
        (!settle(stride, kBand) || !climb(shape, priors, fit.zone, first, kFirstSteps, state)))
        return false;
    for (int round = start.settled ? kRounds - 1 : 0; round < kRounds; ++round) {
        // A first plane that is far off cuts away some of the plate's own points; a draft's does
        // not.
        for (int turn = start.settled ? kTurns - 1 : 0; turn < kTurns; ++turn) {
            if (!turn_into_plate(target.all, rays, margin, state.T_lidar_middle)) return false;
            take_plane();
        }
        const bool last = round + 1 == kRounds;
        if (!settle(last ? 1 : stride, last ? known_band(shape, state) : kBand) ||
            !climb(shape, priors, fit.zone, full, kFitSteps, state))
            return false;
    }
    replace_plane(rays, state.T_lidar_middle);
    fit.plane = measure_plate(target.all, rays, margin);

    const PlateEvaluation at =
        evaluate_plate(shape, state, priors, fit.zone, PlateScores::gathered);
    fit.side_common = common_of(shape, at);
    const PlateMatrix covariance = plate_covariance(at, fit.plane, fit.side_common, false);
    fit.covariance = covariance.topLeftCorner<6, 6>();
    fit.shift_sigma = covariance.diagonal().segment<2>(kShiftLevel).cwiseMax(0.0).cwiseSqrt();
    fit.gain = gain_over_share(fit.zone, at.rays_value);

    PlateState other = state;
    Mask stretched = full;
    stretched[kStretchX] = stretched[kStretchY] = true;
    if (climb(shape, priors, fit.zone, stretched, kFitSteps, other)) {
        fit.stretch = other.stretch;
        const PlateEvaluation stretched_at =
            evaluate_plate(shape, other, priors, fit.zone, PlateScores::gathered);
        fit.stretch_sigma =
            plate_covariance(stretched_at, fit.plane, common_of(shape, stretched_at), true)
                .diagonal()
                .segment<2>(kStretchX)
                .cwiseMax(0.0)
                .cwiseSqrt();
    }
    fit.rays = std::move(rays);
    return true;
}

}  // namespace

bool fit_plate(const PlateTemplate& target, const PlateBeam& beam, RayBundle rays,
               const PlatePlacement& placement, PlateFit& fit) {
    PlateStart start;
    start.state.T_lidar_middle =
        rays.T_lidar_plane * Eigen::Translation3d(placement.middle.x(), placement.middle.y(), 0.0) *
        Eigen::AngleAxisd(placement.angle, Eigen::Vector3d::UnitZ());
    start.state.log_width.setConstant(std::log(kFirstWidth));
    start.state.wall = wall_seen(target.holes);
    return fit_from(target, beam, std::move(rays), start, fit);
}

bool fit_plate(const PlateTemplate& target, const PlateBeam& beam, RayBundle rays,
               const PlateState& start, PlateFit& fit) {
    return fit_from(target, beam, std::move(rays), {start, true}, fit);
}

}  // namespace petal
