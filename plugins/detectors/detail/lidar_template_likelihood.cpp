// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_likelihood.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "petal/calibration/se3.hpp"

namespace petal {
namespace {

constexpr double kFar = 12.0;           ///< widths off an edge: what it does there is below 1e-5
constexpr double kAlongUp = 0.995;      ///< cosine, 6 deg
constexpr double kGlareShare = 0.4;     ///< of the shifts' sigmas: what a factor e may do
constexpr double kLeastWidth = 0.0003;  ///< m
constexpr std::size_t kPiece = 2048;    ///< rays that are summed together

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
    next.glare += step.segment<2>(kGlareLevel);
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
                  const Eigen::Vector2d& widths, const Crossing& crossing, double brightness) {
    const Eigen::Vector2d scale = (Eigen::Vector2d::Ones() + state.stretch).cwiseInverse();
    const Eigen::Vector2d shift = state.shift - brightness * state.glare;
    SeenEdge seen;
    seen.brightness = brightness;
    seen.place = crossing.place.cwiseProduct(scale);
    const auto width_of = [&](const Eigen::Vector2d& through) {
        return std::max(through.cwiseProduct(widths).norm(), kLeastWidth);
    };
    const auto sure = [&](double inside, const Eigen::Vector2d& inward) {
        const Eigen::Vector2d through = axes.transpose() * inward;
        return (inside + through.cwiseAbs().dot(shift)) / width_of(through);
    };
    PlateShape::Edge edge = shape.edge_by(seen.place, sure);
    const double certain = sure(edge.inside, edge.inward);
    const Eigen::Matrix2d moves = axes * (axes.inverse() * crossing.slope).asDiagonal();
    const Eigen::Vector2d deeper = moves * state.wall;
    // What is surely on the plate is so on the back too, and what is farther off than a wall
    // reaches is not (axes may shrink widths on the board, but hardly by half).
    const double reach = deeper.norm() / std::max(kLeastWidth, 0.5 * widths.minCoeff());
    if (reach > 0.0 && certain < kFar && certain > -kFar - reach) {
        const Eigen::Vector2d behind = (crossing.place + deeper).cwiseProduct(scale);
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
    seen.inside = edge.inside + seen.across.dot(shift);
    seen.width = width_of(through);
    return seen;
}

PlateVector edge_jacobian(const SeenEdge& edge, const Crossing& crossing) {
    PlateVector jacobian = PlateVector::Zero();
    jacobian.head<6>() = crossing.jacobian().transpose() * edge.inward;
    jacobian.segment<2>(kShiftLevel) = edge.across;
    jacobian.segment<2>(kGlareLevel) = -edge.brightness * edge.across;
    jacobian.segment<2>(kWallLevel) = edge.behind.transpose() * edge.inward;
    jacobian.segment<2>(kStretchX) = -edge.inward.cwiseProduct(edge.place);
    return jacobian;
}

namespace {

/// Adds up what rays and silent places say.
class PlateSum {
   public:
    PlateSum(const PlateShape& shape, const PlateState& state, double floor, PlateScores scores)
        : shape_(shape),
          state_(state),
          to_middle_(state.T_lidar_middle.inverse()),
          axes_(beam_axes(state.T_lidar_middle)),
          widths_(state.log_width.array().exp()),
          floor_(floor),
          log_floor_(std::log(floor)),
          log_rest_(std::log1p(-floor)),
          scores_(scores == PlateScores::gathered) {}

    /// `sign`: +1 a hit, -1 a miss, 0 a silent place of `count` rays.
    void add(const Eigen::Vector3d& point, int sign, double count, double brightness,
             PlateEvaluation& sum) const {
        const Crossing crossing = cross_board(to_middle_, point);
        const SeenEdge edge = see_edge(shape_, state_, axes_, widths_, crossing, brightness);
        if (std::abs(edge.inside) > kFar * edge.width) {
            const bool on_plate = edge.inside > 0.0;
            if (sign == 0)
                sum.rays_value -= count * (on_plate ? 1.0 - floor_ : floor_);
            else
                sum.rays_value += on_plate == (sign > 0) ? log_rest_ : log_floor_;
            return;
        }
        const Passage at = passage(edge.inside, edge.width, floor_);
        PlateVector jacobian = edge_jacobian(edge, crossing);
        // dD/dw enters as -D / w: a wider passage is the same as a shorter way to the edge.
        const Eigen::Vector2d share = edge.across.cwiseProduct(widths_) / edge.width;
        jacobian.segment<2>(kWidthLevel) = -edge.inside * share.cwiseAbs2();
        double score, expected, observed;
        if (sign == 0) {
            sum.rays_value -= count * at.p;
            score = -count * at.slope;
            expected = count * at.slope * at.slope / at.p;
            observed = 0.0;
        } else {
            const double p = sign > 0 ? at.p : 1.0 - at.p;
            sum.rays_value += std::log(p);
            score = sign * at.slope / p;
            expected = at.slope * at.slope / (at.p * (1.0 - at.p));
            observed = score * score;
        }
        sum.gradient.noalias() += score * jacobian;
        sum.expected.selfadjointView<Eigen::Lower>().rankUpdate(jacobian, expected);
        if (!scores_) return;
        sum.observed.selfadjointView<Eigen::Lower>().rankUpdate(jacobian, observed);
        PlateEvaluation::Side& side = sum.sides[static_cast<std::size_t>(edge.side)];
        side.score += score;
        side.information += observed;
        side.pull += observed * jacobian;
        side.across += observed * edge.across.cwiseAbs2();
    }

    PlateEvaluation of(const ToldRays& rays, std::size_t begin, std::size_t end) const {
        PlateEvaluation sum;
        if (scores_) sum.sides.resize(shape_.side_count());
        for (std::size_t i = begin; i < std::min(end, rays.rays.size()); ++i)
            add(rays.rays[i].point, rays.rays[i].hit ? 1 : -1, 1.0, rays.rays[i].brightness, sum);
        for (std::size_t i = std::max(begin, rays.rays.size()); i < end; ++i) {
            const ToldRays::Silent& silent = rays.silent[i - rays.rays.size()];
            add(silent.point, 0, silent.rays, 0.0, sum);
        }
        return sum;
    }

    double far(const ToldRays& rays) const {
        return rays.right * log_rest_ + rays.wrong * log_floor_;
    }

   private:
    const PlateShape& shape_;
    const PlateState& state_;
    Eigen::Isometry3d to_middle_;
    Eigen::Matrix2d axes_;
    Eigen::Vector2d widths_;
    double floor_, log_floor_, log_rest_;
    bool scores_;
};

void add_up(const PlateEvaluation& part, PlateEvaluation& sum) {
    sum.rays_value += part.rays_value;
    sum.gradient += part.gradient;
    sum.expected += part.expected;
    sum.observed += part.observed;
    for (std::size_t s = 0; s < part.sides.size(); ++s) {
        sum.sides[s].score += part.sides[s].score;
        sum.sides[s].information += part.sides[s].information;
        sum.sides[s].pull += part.sides[s].pull;
        sum.sides[s].across += part.sides[s].across;
    }
}

}  // namespace

PlateEvaluation evaluate_plate(const PlateShape& shape, const PlateState& state,
                               const PlatePriors& priors, const ToldRays& rays,
                               PlateScores scores) {
    const PlateSum plate(shape, state, rays.floor, scores);
    const std::size_t count = rays.rays.size() + rays.silent.size();
    std::vector<PlateEvaluation> parts((count + kPiece - 1) / kPiece);
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t k) {
        parts[k] = plate.of(rays, k * kPiece, std::min(count, (k + 1) * kPiece));
    });
    PlateEvaluation evaluation;
    if (scores == PlateScores::gathered) evaluation.sides.resize(shape.side_count());
    evaluation.rays_value = plate.far(rays);
    for (const PlateEvaluation& part : parts) add_up(part, evaluation);

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
        add_prior(
            evaluation, kGlareLevel + axis, state.glare(axis), 0.0,
            kGlareShare * (axis == 0 ? priors.shift_level_sigma : priors.shift_upright_sigma));
    }
    return evaluation;
}

}  // namespace petal
