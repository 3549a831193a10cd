// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_likelihood.hpp"

#include <algorithm>
#include <cmath>

#include "petal/calibration/se3.hpp"

namespace petal {
namespace {

constexpr double kFar = 12.0;           ///< widths off an edge: what it does there is below 1e-5
constexpr double kAlongUp = 0.995;      ///< cosine, 6 deg
constexpr double kLeastWidth = 0.0003;  ///< m

/// What one place adds for a probability of `p` with slope dp/dD.
struct Passage {
    double p = 0.0, slope = 0.0;
};

Passage passage(double inside, double width, double floor) {
    const double e = std::exp(-std::clamp(inside / width, -40.0, 40.0));
    const double s = 1.0 / (1.0 + e);
    return {floor + (1.0 - 2.0 * floor) * s, (1.0 - 2.0 * floor) * s * (1.0 - s) / width};
}

/// A Gaussian prior of one parameter.
void add_prior(PlateEvaluation& evaluation, int index, double value, double mean, double sigma) {
    const double weight = 1.0 / (sigma * sigma);
    evaluation.value -= 0.5 * weight * (value - mean) * (value - mean);
    evaluation.gradient(index) -= weight * (value - mean);
    evaluation.expected(index, index) += weight;
    evaluation.observed(index, index) += weight;
}

}  // namespace

PlateState moved(const PlateState& state, const PlateVector& step) {
    PlateState next = state;
    next.T_lidar_middle = state.T_lidar_middle * se3_exp(step.head<6>());
    next.T_lidar_middle.linear() =
        Eigen::Quaterniond(next.T_lidar_middle.linear()).normalized().toRotationMatrix();
    next.shift += step.segment<2>(kShiftLevel);
    next.log_width += step.segment<2>(kWidthLevel);
    next.wall += step.segment<2>(kWallLevel);
    next.stretch += step.segment<2>(kStretchX);
    return next;
}

Eigen::Matrix<double, 2, 6> Crossing::jacobian() const {
    // A board that moves by Exp(rho, phi) in its own frame leaves what is fixed outside at
    // v - rho - phi x v; the ray then meets z = 0 elsewhere.
    Eigen::Matrix<double, 2, 6> j;
    const double x = place.x(), y = place.y();
    j << -1.0, 0.0, slope.x(), slope.x() * y, -slope.x() * x, y,  //
        0.0, -1.0, slope.y(), slope.y() * y, -slope.y() * x, -x;
    return j;
}

Crossing cross_board(const Eigen::Isometry3d& T_middle_lidar, const Eigen::Vector3d& point) {
    const Eigen::Vector3d sensor = T_middle_lidar.translation();
    const Eigen::Vector3d ray = T_middle_lidar.linear() * point;
    Crossing crossing;
    crossing.slope = ray.head<2>() / ray.z();
    crossing.place = sensor.head<2>() - sensor.z() * crossing.slope;
    return crossing;
}

Eigen::Matrix2d beam_axes(const Eigen::Isometry3d& T_lidar_middle) {
    const Eigen::Vector3d ray = T_lidar_middle.translation().normalized();
    const Eigen::Vector3d up =
        std::abs(ray.z()) > kAlongUp ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d level = up.cross(ray).normalized();
    const Eigen::Vector3d upright = ray.cross(level);
    const Eigen::Matrix3d to_board = T_lidar_middle.linear().transpose();
    const Eigen::Vector3d along = to_board * ray;
    const auto on_board = [&](const Eigen::Vector3d& axis) {
        const Eigen::Vector3d a = to_board * axis;
        return Eigen::Vector2d(a.head<2>() - a.z() / along.z() * along.head<2>());
    };
    Eigen::Matrix2d axes;
    axes << on_board(level), on_board(upright);
    return axes;
}

SeenEdge see_edge(const PlateShape& shape, const PlateState& state, const Eigen::Matrix2d& axes,
                  const Eigen::Vector2d& widths, const Crossing& crossing) {
    const Eigen::Vector2d scale = (Eigen::Vector2d::Ones() + state.stretch).cwiseInverse();
    SeenEdge seen;
    seen.place = crossing.place.cwiseProduct(scale);
    const auto width_of = [&](const Eigen::Vector2d& through) {
        return std::max(through.cwiseProduct(widths).norm(), kLeastWidth);
    };
    const auto sure = [&](double inside, const Eigen::Vector2d& inward) {
        const Eigen::Vector2d through = axes.transpose() * inward;
        return (inside + through.cwiseAbs().dot(state.shift)) / width_of(through);
    };
    PlateShape::Edge edge = shape.edge_by(seen.place, sure);
    const double certain = sure(edge.inside, edge.inward);
    if (state.wall.maxCoeff() > 0.0 &&
        std::abs(certain) < kFar + state.wall.maxCoeff() / kLeastWidth) {
        const Eigen::Matrix2d moves = axes * (axes.inverse() * crossing.slope).asDiagonal();
        const Eigen::Vector2d behind = (crossing.place + moves * state.wall).cwiseProduct(scale);
        const PlateShape::Edge back = shape.edge_by(behind, sure);
        if (sure(back.inside, back.inward) > certain) {
            edge = back;
            seen.place = behind;
            seen.behind = moves;
        }
    }
    seen.side = edge.side;
    seen.inward = edge.inward;
    const Eigen::Vector2d through = axes.transpose() * edge.inward;
    seen.across = through.cwiseAbs();
    seen.inside = edge.inside + seen.across.dot(state.shift);
    seen.width = width_of(through);
    return seen;
}

PlateVector edge_jacobian(const SeenEdge& edge, const Crossing& crossing) {
    PlateVector jacobian = PlateVector::Zero();
    jacobian.head<6>() = crossing.jacobian().transpose() * edge.inward;
    jacobian.segment<2>(kShiftLevel) = edge.across;
    jacobian.segment<2>(kWallLevel) = edge.behind.transpose() * edge.inward;
    jacobian.segment<2>(kStretchX) = -edge.inward.cwiseProduct(edge.place);
    return jacobian;
}

PlateEvaluation evaluate_plate(const PlateShape& shape, const PlateState& state,
                               const PlatePriors& priors, const ToldRays& rays) {
    PlateEvaluation evaluation;
    evaluation.sides.resize(shape.side_count());
    const Eigen::Isometry3d to_middle = state.T_lidar_middle.inverse();
    const Eigen::Matrix2d axes = beam_axes(state.T_lidar_middle);
    const Eigen::Vector2d widths = state.log_width.array().exp();
    const double log_floor = std::log(rays.floor), log_rest = std::log1p(-rays.floor);

    // `sign`: +1 a hit, -1 a miss, 0 a silent place of `count` rays.
    const auto add = [&](const Eigen::Vector3d& point, int sign, double count) {
        const Crossing crossing = cross_board(to_middle, point);
        const SeenEdge edge = see_edge(shape, state, axes, widths, crossing);
        if (std::abs(edge.inside) > kFar * edge.width) {
            const bool on_plate = edge.inside > 0.0;
            if (sign == 0)
                evaluation.rays_value -= count * (on_plate ? 1.0 - rays.floor : rays.floor);
            else
                evaluation.rays_value += on_plate == (sign > 0) ? log_rest : log_floor;
            return;
        }
        const Passage at = passage(edge.inside, edge.width, rays.floor);
        PlateVector jacobian = edge_jacobian(edge, crossing);
        // dD/dw enters as -D / w: a wider passage is the same as a shorter way to the edge.
        const Eigen::Vector2d share = edge.across.cwiseProduct(widths) / edge.width;
        jacobian.segment<2>(kWidthLevel) = -edge.inside * share.cwiseAbs2();
        double score, expected, observed;
        if (sign == 0) {
            evaluation.rays_value -= count * at.p;
            score = -count * at.slope;
            expected = count * at.slope * at.slope / at.p;
            observed = 0.0;
        } else {
            const double p = sign > 0 ? at.p : 1.0 - at.p;
            evaluation.rays_value += std::log(p);
            score = sign * at.slope / p;
            expected = at.slope * at.slope / (at.p * (1.0 - at.p));
            observed = score * score;
        }
        evaluation.gradient.noalias() += score * jacobian;
        evaluation.expected.selfadjointView<Eigen::Lower>().rankUpdate(jacobian, expected);
        evaluation.observed.selfadjointView<Eigen::Lower>().rankUpdate(jacobian, observed);
        PlateEvaluation::Side& side = evaluation.sides[static_cast<std::size_t>(edge.side)];
        side.score += score;
        side.information += observed;
        side.pull += observed * jacobian;
    };
    evaluation.rays_value = rays.right * log_rest + rays.wrong * log_floor;
    for (const ToldRays::Ray& ray : rays.rays) add(ray.point, ray.hit ? 1 : -1, 1.0);
    for (const ToldRays::Silent& silent : rays.silent) add(silent.point, 0, silent.rays);

    evaluation.expected = evaluation.expected.selfadjointView<Eigen::Lower>();
    evaluation.observed = evaluation.observed.selfadjointView<Eigen::Lower>();
    evaluation.value = evaluation.rays_value;
    add_prior(evaluation, kShiftLevel, state.shift.x(), 0.0, priors.shift_level_sigma);
    add_prior(evaluation, kShiftUpright, state.shift.y(), 0.0, priors.shift_upright_sigma);
    for (int axis = 0; axis < 2; ++axis) {
        add_prior(evaluation, kWidthLevel + axis, state.log_width(axis), std::log(priors.width),
                  priors.width_log_sigma);
        add_prior(evaluation, kWallLevel + axis, state.wall(axis), priors.wall(axis),
                  priors.wall_sigma(axis));
        add_prior(evaluation, kStretchX + axis, state.stretch(axis), 0.0, priors.stretch_sigma);
    }
    return evaluation;
}

}  // namespace petal
