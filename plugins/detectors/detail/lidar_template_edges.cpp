// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_edges.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "petal/calibration/se3.hpp"

namespace petal {
namespace {

constexpr int kEdgeFitSteps = 20;
constexpr int kWeighedFitSteps = 4;  ///< last ones: each side weighs as the covariance takes it
constexpr double kFirstReach = 0.025, kEdgesReach = 0.015;  ///< m: a point is on a side
constexpr double kEdgeTukey = 4.685;                        ///< 95 % efficient for normal errors
constexpr double kLeastSigma = 0.001;                       ///< m: LiDARs resolve no less
constexpr double kLeastShared = 0.0002;                     ///< m
constexpr double kSharedRange = 0.0025;  ///< m, 1 sigma: points on edges lie behind the plate
constexpr std::size_t kLeastEdgePoints = 24;
constexpr double kInsideDeep = 0.022;  ///< m: well inside, no side's
constexpr int kFifthsOfSide = 5;
constexpr double kCorner = 0.015;  ///< m off a side's ends: a beam of some width rounds corners

using Vector8 = Eigen::Matrix<double, 8, 1>;
using Matrix8 = Eigen::Matrix<double, 8, 8>;

/// One point: its error across a side or across the plane.
struct EdgeEquation {
    double error = 0.0;
    Vector8 jacobian = Vector8::Zero();
    int side = -1;
    double along = 0.0;
};

struct EdgeEquations {
    std::vector<EdgeEquation> sides, plane;
    std::size_t inside = 0, near = 0;
};

EdgeEquations equations_at(const PlateTemplate& target, const std::vector<Eigen::Vector3d>& points,
                           const PlateState& state, double reach) {
    EdgeEquations equations;
    const Eigen::Isometry3d to_middle = state.T_lidar_middle.inverse();
    const Eigen::Matrix2d axes = beam_axes(state.T_lidar_middle);
    for (const Eigen::Vector3d& p : points) {
        const Eigen::Vector3d q = to_middle * p;
        if (!(std::abs(q.z()) <= 2.0 * kEdgesReach)) continue;
        const Crossing crossing = cross_board(to_middle, p);
        const SeenEdge edge =
            see_edge(target.holes, state, axes, Eigen::Vector2d::Constant(1e-3), crossing);
        if (!target.holes.in_zone(crossing.place)) continue;
        ++equations.near;
        if (std::abs(edge.inside) > reach) {
            if (std::abs(edge.inside) > kInsideDeep) ++equations.inside;
            continue;
        }
        const PlateVector whole = edge_jacobian(edge, crossing);
        EdgeEquation across;
        across.error = edge.inside;
        across.jacobian = whole.head<8>();
        across.side = edge.side;
        across.along = target.holes.share_along(edge.side, edge.place);
        const double length = target.holes.side_length(static_cast<std::size_t>(edge.side));
        // Corners of straight sides: see above.
        if (std::min(across.along, 1.0 - across.along) * length < kCorner &&
            !target.holes.is_round(edge.side))
            continue;
        EdgeEquation deep;
        deep.error = q.z();
        deep.jacobian(kRhoZ) = -1.0;
        deep.jacobian(kPhiX) = -q.y();
        deep.jacobian(kPhiY) = q.x();
        deep.side = edge.side;
        equations.sides.push_back(across);
        equations.plane.push_back(deep);
    }
    return equations;
}

double robust_scale(const std::vector<EdgeEquation>& equations) {
    std::vector<double> errors;
    errors.reserve(equations.size());
    for (const EdgeEquation& e : equations) errors.push_back(std::abs(e.error));
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    return std::max(1.4826 * *middle, kLeastSigma);
}

double tukey_weight(double error, double sigma) {
    const double relative = error / (kEdgeTukey * sigma);
    if (std::abs(relative) >= 1.0) return 0.0;
    const double root = 1.0 - relative * relative;
    return root * root;
}

/// The error of single points and the one that those of a side share.
struct Scatter {
    double point = 0.0, shared = 0.0, rms = 0.0;
    std::vector<double> weights;  ///< of each side, summed
};

Scatter scatter_of(const PlateShape& shape, const std::vector<EdgeEquation>& equations,
                   double sigma, bool opposite) {
    Scatter scatter;
    std::vector<double> mean(shape.side_count(), 0.0);
    scatter.weights.assign(shape.side_count(), 0.0);
    double total = 0.0, squares = 0.0;
    for (const EdgeEquation& e : equations) {
        const double w = tukey_weight(e.error, sigma);
        scatter.weights[static_cast<std::size_t>(e.side)] += w;
        mean[static_cast<std::size_t>(e.side)] += w * e.error;
        total += w;
        squares += w * e.error * e.error;
    }
    double used = 0.0, between = 0.0, inverse = 0.0, within = squares;
    for (std::size_t s = 0; s < mean.size(); ++s) {
        if (scatter.weights[s] < 1.0) continue;
        mean[s] /= scatter.weights[s];
        used += 1.0;
        between += mean[s] * mean[s];
        inverse += 1.0 / scatter.weights[s];
        within -= scatter.weights[s] * mean[s] * mean[s];
    }
    double common = between / std::max(used - (opposite ? 5.0 : 3.0), 1.0);
    if (opposite) {
        double shifts = 0.0, pairs = -3.0;
        for (std::size_t s = 0; s < mean.size(); ++s) {
            const int other = shape.opposite(s);
            if (other <= static_cast<int>(s)) continue;
            const auto o = static_cast<std::size_t>(other);
            if (scatter.weights[s] < 1.0 || scatter.weights[o] < 1.0) continue;
            const double shift = 0.5 * (mean[s] - mean[o]);
            shifts += shift * shift;
            pairs += 1.0;
        }
        if (pairs > 0.0) common = (2.0 * shifts + common) / (pairs + 1.0);
    }
    scatter.rms = std::sqrt(squares / std::max(total, 1.0));
    scatter.point =
        std::max(std::sqrt(std::max(within, 0.0) / std::max(total - used, 1.0)), kLeastSigma);
    const double excess = common - scatter.point * scatter.point * inverse / std::max(used, 1.0);
    scatter.shared = std::max(std::sqrt(std::max(excess, 0.0)), kLeastShared);
    return scatter;
}

void add_equations(const std::vector<EdgeEquation>& equations, double sigma, const Scatter* scatter,
                   Matrix8& matrix, Vector8& right) {
    for (const EdgeEquation& e : equations) {
        double weight = tukey_weight(e.error, sigma);
        if (scatter != nullptr) {
            const double n = scatter->weights[static_cast<std::size_t>(e.side)];
            if (!(n > 0.0)) continue;
            weight /= n * scatter->shared * scatter->shared + scatter->point * scatter->point;
        } else {
            weight /= sigma * sigma;
        }
        matrix.noalias() += weight * e.jacobian * e.jacobian.transpose();
        right.noalias() -= weight * e.error * e.jacobian;
    }
}

double coverage_of(const PlateShape& shape, const std::vector<EdgeEquation>& sides) {
    std::vector<unsigned> fifths(shape.side_count(), 0U);
    for (const EdgeEquation& e : sides)
        fifths[static_cast<std::size_t>(e.side)] |=
            1U << std::clamp(static_cast<int>(e.along * kFifthsOfSide), 0, kFifthsOfSide - 1);
    int count = 0;
    for (unsigned side : fifths)
        for (; side != 0U; side &= side - 1U) ++count;
    return static_cast<double>(count) /
           static_cast<double>(kFifthsOfSide * static_cast<int>(shape.side_count()));
}

}  // namespace

bool fit_edges(const PlateTemplate& target, const PlateBeam& beam,
               const std::vector<Eigen::Vector3d>& points, const Eigen::Isometry3d& T_lidar_middle,
               PlateEdgeFit& fit) {
    PlateState& state = fit.state;
    state = PlateState{};
    state.T_lidar_middle = T_lidar_middle;
    const double shift_weights[2] = {1.0 / (beam.edge_sigma * beam.edge_sigma),
                                     1.0 / (beam.edge_sigma * beam.edge_sigma)};
    double side_sigma = kEdgesReach, plane_sigma = kEdgesReach;
    EdgeEquations equations;
    Scatter sides, plane;
    Matrix8 matrix;
    Vector8 right;
    const auto set_up = [&](double reach, bool scales, bool weighed) {
        equations = equations_at(target, points, state, reach);
        if (equations.sides.size() < kLeastEdgePoints) return false;
        if (scales) {
            side_sigma = robust_scale(equations.sides);
            plane_sigma = robust_scale(equations.plane);
        }
        sides = scatter_of(target.holes, equations.sides, side_sigma, true);
        plane = scatter_of(target.holes, equations.plane, plane_sigma, false);
        matrix.setZero();
        right.setZero();
        for (int axis = 0; axis < 2; ++axis) {
            matrix(kShiftLevel + axis, kShiftLevel + axis) = shift_weights[axis];
            right(kShiftLevel + axis) = -shift_weights[axis] * state.shift(axis);
        }
        add_equations(equations.sides, side_sigma, weighed ? &sides : nullptr, matrix, right);
        add_equations(equations.plane, plane_sigma, weighed ? &plane : nullptr, matrix, right);
        return true;
    };
    for (int step = 0; step < kEdgeFitSteps + kWeighedFitSteps; ++step) {
        const bool weighed = step >= kEdgeFitSteps;
        if (!set_up(step < kEdgeFitSteps / 3 ? kFirstReach : kEdgesReach, !weighed, weighed))
            return false;
        const Eigen::LDLT<Matrix8> solver(matrix);
        if (solver.info() != Eigen::Success || !solver.isPositive()) return false;
        const Vector8 delta = solver.solve(right);
        if (!delta.allFinite() || delta.cwiseAbs().maxCoeff() > 0.5) return false;
        PlateVector move = PlateVector::Zero();
        move.head<8>() = delta;
        state = moved(state, move);
    }
    if (!set_up(kEdgesReach, false, true)) return false;
    const Matrix8 covariance = matrix.ldlt().solve(Matrix8::Identity());
    fit.covariance = covariance.topLeftCorner<6, 6>();
    // Points on edges lie behind the plate together: along the ray to the middle.
    const Eigen::Vector3d ray =
        state.T_lidar_middle.linear().transpose() * state.T_lidar_middle.translation().normalized();
    fit.covariance.topLeftCorner<3, 3>() += kSharedRange * kSharedRange * ray * ray.transpose();
    fit.shift_sigma = covariance.diagonal().tail<2>().cwiseMax(0.0).cwiseSqrt();
    fit.points = equations.sides.size();
    fit.coverage = coverage_of(target.holes, equations.sides);
    fit.inside = static_cast<double>(equations.inside) /
                 static_cast<double>(std::max<std::size_t>(equations.near, 1));
    fit.edge_rms = sides.rms;
    fit.side_common = sides.shared;
    fit.plane_rms = plane.rms;
    return true;
}

}  // namespace petal
