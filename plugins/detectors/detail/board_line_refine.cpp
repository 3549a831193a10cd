// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/board_line_refine.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "petal/calibration/se3.hpp"

namespace petal {
namespace {

using Vector8d = Eigen::Matrix<double, 8, 1>;
using Matrix8d = Eigen::Matrix<double, 8, 8>;

constexpr int kSteps = 15;
constexpr double kFirstTolerance = 0.025;  ///< m: a point is on a side, first step
constexpr double kTolerance = 0.015;       ///< m: last steps
constexpr double kTukey = 4.685;           ///< 95 % efficient for normal errors
constexpr double kMinSigma = 0.001;        ///< m: LiDARs resolve no less
constexpr double kMinCommonSigma =
    0.0002;                       ///< m: of a side's own error, or of a cell's of the plate
constexpr int kWeighedSteps = 3;  ///< last ones: each side weighs as the covariance takes it
constexpr int kPlateCells = 5;    ///< in each direction: points of one may share an error
constexpr double kMinSine = 0.1;  ///< of a ray to the board, 6 deg: flatter ones show no place
constexpr std::size_t kMinPoints = 24;
/// Free parameters that the common errors of the groups see: x, y, turn, d_x, d_y; offset and two
/// tilts.
constexpr double kLineFreedoms = 5.0;
constexpr double kPlaneFreedoms = 3.0;
constexpr double kShiftFreedoms = 3.0;  ///< those that opposite sides see together: x, y, turn
constexpr double kScatterWeight = 1.0;  ///< pairs that the scatter of all sides counts as

/// One equation: `error` across a side or across the plane, its derivative, and with which others
/// it may share an error: those of its side, or of its cell of the plate.
struct Equation {
    double error = 0.0;
    Vector8d jacobian = Vector8d::Zero();
    int group = 0;
};

/// Across the sides. A point's range errs by far more than its direction, and seen obliquely that
/// would move it along the board: the point counts where its ray meets the board.
std::vector<Equation> side_equations(const HoleGrid& grid,
                                     const std::vector<Eigen::Vector3d>& points,
                                     const Eigen::Isometry3d& T, const Eigen::Vector2d& inflation,
                                     double tolerance) {
    std::vector<Equation> equations;
    const Eigen::Isometry3d to_board = T.inverse();
    const Eigen::Matrix3d turn = to_board.linear();
    const Eigen::Vector3d sensor = to_board.translation();
    for (const Eigen::Vector3d& p : points) {
        const Eigen::Vector3d ray = turn * p;
        if (!(ray.z() > kMinSine * ray.norm())) continue;
        const double reach = -sensor.z() / ray.z();
        const SideHit hit = find_side(grid, inflation, (sensor + reach * ray).head<2>(), tolerance);
        if (hit.side < 0) continue;
        // T' = Exp((rho, phi)) T moves what is fixed in the LiDAR's frame by -R^T (rho + phi x p);
        // the ray then meets the board elsewhere.
        Eigen::Matrix<double, 3, 6> dq;
        dq.leftCols<3>() = -turn;
        dq.rightCols<3>() = turn * skew(reach * p);
        const int axis = hit.side % 4 < 2 ? 0 : 1;
        Equation line;
        line.group = hit.side;
        line.error = hit.across;
        line.jacobian.head<6>() = (dq.row(axis) - ray(axis) / ray.z() * dq.row(2)).transpose();
        line.jacobian(6 + axis) = hit.side % 2 == 0 ? 1.0 : -1.0;
        equations.push_back(line);
    }
    return equations;
}

/// Across the plane; `group_of` gives a point's group from its place on the board, -1 for none.
template <class GroupOf>
std::vector<Equation> plane_equations(const std::vector<Eigen::Vector3d>& points,
                                      const Eigen::Isometry3d& T, const GroupOf& group_of) {
    std::vector<Equation> equations;
    const Eigen::Isometry3d to_board = T.inverse();
    const Eigen::Vector3d into = to_board.linear().row(2);
    for (const Eigen::Vector3d& p : points) {
        const Eigen::Vector3d q = to_board * p;
        Equation plane;
        plane.group = group_of(q);
        if (plane.group < 0) continue;
        plane.error = q.z();
        plane.jacobian.head<3>() = -into;
        plane.jacobian.segment<3>(3) = -p.cross(into);
        equations.push_back(plane);
    }
    return equations;
}

/// Scale by the median of absolute errors.
double robust_sigma(const std::vector<Equation>& equations) {
    std::vector<double> errors;
    errors.reserve(equations.size());
    for (const Equation& e : equations) errors.push_back(std::abs(e.error));
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    return std::max(1.4826 * *middle, kMinSigma);
}

double tukey(double error, double sigma) {
    const double relative = error / (kTukey * sigma);
    if (std::abs(relative) >= 1.0) return 0.0;
    const double root = 1.0 - relative * relative;
    return root * root;
}

/// Errors split into one that the points of a group share and one of each point.
struct Components {
    double common = 0.0;               ///< m, sigma
    double point = 0.0;                ///< m, sigma
    double rms = 0.0;                  ///< m, of both together
    std::vector<double> group_weight;  ///< sum of the points' robust weights
};

Components components(const std::vector<Equation>& equations, double sigma, std::size_t groups,
                      double freedoms, bool opposite_pairs) {
    Components result;
    std::vector<double> weight(groups, 0.0), mean(groups, 0.0);
    double total = 0.0, squares = 0.0;
    for (const Equation& e : equations) {
        const double w = tukey(e.error, sigma);
        weight[static_cast<std::size_t>(e.group)] += w;
        mean[static_cast<std::size_t>(e.group)] += w * e.error;
        total += w;
        squares += w * e.error * e.error;
    }
    double used = 0.0, between = 0.0, inverse = 0.0;
    for (std::size_t s = 0; s < groups; ++s) {
        if (weight[s] < 1.0) continue;
        mean[s] /= weight[s];
        used += 1.0;
        between += mean[s] * mean[s];
        inverse += 1.0 / weight[s];
    }
    double common = between / std::max(used - freedoms, 1.0);
    if (opposite_pairs) {
        // A hole that is smaller than the others shifts nothing: its two sides move apart. What
        // moves the board is what opposite sides have in common; but these pairs are few.
        double shifts = 0.0, pairs = -kShiftFreedoms;
        for (std::size_t s = 0; s + 1 < groups; s += 2) {
            if (weight[s] < 1.0 || weight[s + 1] < 1.0) continue;
            const double shift = 0.5 * (mean[s] + mean[s + 1]);
            shifts += shift * shift;
            pairs += 1.0;
        }
        if (pairs > 0.0)
            common = (2.0 * shifts + kScatterWeight * common) / (pairs + kScatterWeight);
    }
    double within = squares;
    for (std::size_t s = 0; s < groups; ++s)
        if (weight[s] >= 1.0) within -= weight[s] * mean[s] * mean[s];
    result.rms = std::sqrt(squares / std::max(total, 1.0));
    result.point =
        std::max(std::sqrt(std::max(within, 0.0) / std::max(total - used, 1.0)), kMinSigma);
    // The mean square of the groups' means is their common error plus what the points leave in a
    // mean.
    const double excess = common - result.point * result.point * inverse / std::max(used, 1.0);
    result.common = std::max(std::sqrt(std::max(excess, 0.0)), kMinCommonSigma);
    result.group_weight = std::move(weight);
    return result;
}

/// The normal equations.
struct NormalEquations {
    Matrix8d matrix = Matrix8d::Zero();
    Vector8d right = Vector8d::Zero();

    void add(const Equation& e, double weight) {
        matrix.noalias() += weight * e.jacobian * e.jacobian.transpose();
        right.noalias() -= weight * e.error * e.jacobian;
    }
    /// Every point by itself.
    void add(const std::vector<Equation>& equations, double sigma) {
        for (const Equation& e : equations) add(e, tukey(e.error, sigma) / (sigma * sigma));
    }
    /// Each group's points together weigh 1 / (common^2 + point^2 / n).
    void add(const std::vector<Equation>& equations, double sigma, const Components& parts) {
        for (const Equation& e : equations) {
            const double n = parts.group_weight[static_cast<std::size_t>(e.group)];
            if (n > 0.0)
                add(e, tukey(e.error, sigma) /
                           (n * parts.common * parts.common + parts.point * parts.point));
        }
    }
};

/// The points that tell the plane: the plate's own or, without these, those on the sides.
class PlanePoints {
   public:
    PlanePoints(const HoleGrid& grid, const std::vector<Eigen::Vector3d>& rim,
                const std::vector<Eigen::Vector3d>& plate)
        : grid_(grid), points_(plate.empty() ? rim : plate), plate_(!plate.empty()) {}

    std::size_t groups() const {
        return plate_ ? static_cast<std::size_t>(kPlateCells * kPlateCells) : grid_.side_count();
    }
    std::vector<Equation> equations(const Eigen::Isometry3d& T, const Eigen::Vector2d& inflation,
                                    double tolerance) const {
        return plane_equations(points_, T, [&](const Eigen::Vector3d& q) {
            if (!plate_) return find_side(grid_, inflation, q.head<2>(), tolerance).side;
            const auto cell = [](double at, double size) {
                return std::clamp(static_cast<int>(at / size * kPlateCells), 0, kPlateCells - 1);
            };
            return kPlateCells * cell(q.y(), grid_.height) + cell(q.x(), grid_.width);
        });
    }

   private:
    const HoleGrid& grid_;
    const std::vector<Eigen::Vector3d>& points_;
    bool plate_;
};

}  // namespace

std::optional<BoardFit> refine_board(const HoleGrid& grid,
                                     const std::vector<Eigen::Vector3d>& points,
                                     const std::vector<Eigen::Vector3d>& plate,
                                     const Eigen::Isometry3d& start,
                                     const Eigen::Vector2d& inflation, double prior_sigma) {
    BoardFit fit;
    fit.T_lidar_board = start;
    fit.inflation = inflation;
    const PlanePoints plane_points(grid, points, plate);
    std::vector<Equation> sides, plane;
    Components side_parts, plane_parts;
    double side_sigma = kTolerance, plane_sigma = kTolerance;
    NormalEquations prior;
    prior.matrix(6, 6) = prior.matrix(7, 7) = 1.0 / (prior_sigma * prior_sigma);
    // False where the points do not fix the board.
    const auto take_points = [&](double tolerance, bool scales) {
        sides = side_equations(grid, points, fit.T_lidar_board, fit.inflation, tolerance);
        plane = plane_points.equations(fit.T_lidar_board, fit.inflation, tolerance);
        if (sides.size() < kMinPoints || plane.size() < kMinPoints) return false;
        if (scales) {
            side_sigma = robust_sigma(sides);
            plane_sigma = robust_sigma(plane);
        }
        side_parts = components(sides, side_sigma, grid.side_count(), kLineFreedoms, true);
        plane_parts = components(plane, plane_sigma, plane_points.groups(), kPlaneFreedoms, false);
        return true;
    };
    for (int step = 0; step < kSteps + kWeighedSteps; ++step) {
        const bool weighed = step >= kSteps;
        if (!take_points(step < kSteps / 3 ? kFirstTolerance : kTolerance, !weighed))
            return std::nullopt;
        NormalEquations normal = prior;
        normal.right.tail<2>() = -fit.inflation * prior.matrix(6, 6);
        if (weighed) {
            normal.add(sides, side_sigma, side_parts);
            normal.add(plane, plane_sigma, plane_parts);
        } else {
            normal.add(sides, side_sigma);
            normal.add(plane, plane_sigma);
        }
        const Eigen::LDLT<Matrix8d> solver(normal.matrix);
        if (solver.info() != Eigen::Success || !solver.isPositive()) return std::nullopt;
        const Vector8d delta = solver.solve(normal.right);
        if (!delta.allFinite() || delta.tail<5>().cwiseAbs().maxCoeff() > 0.5) return std::nullopt;
        fit.T_lidar_board = se3_exp(delta.head<6>()) * fit.T_lidar_board;
        fit.inflation += delta.tail<2>();
    }
    fit.T_lidar_board.linear() =
        Eigen::Quaterniond(fit.T_lidar_board.linear()).normalized().toRotationMatrix();

    if (!take_points(kTolerance, false)) return std::nullopt;
    fit.line_rms = side_parts.rms;
    fit.line_common = side_parts.common;
    fit.plane_rms = plane_parts.rms;
    fit.plane_common = plane_parts.common;
    NormalEquations information = prior;
    information.add(sides, side_sigma, side_parts);
    information.add(plane, plane_sigma, plane_parts);
    const Eigen::LDLT<Matrix8d> solver(information.matrix);
    if (solver.info() != Eigen::Success || !solver.isPositive()) return std::nullopt;
    const Matrix8d covariance = solver.solve(Matrix8d::Identity());
    const Matrix6d pose = covariance.topLeftCorner<6, 6>();
    fit.covariance = 0.5 * (pose + pose.transpose());
    fit.inflation_sigma = covariance.diagonal().tail<2>().cwiseMax(0.0).cwiseSqrt();

    // Only points of the board's own plane speak for it or against it.
    const double depth = std::max(kTukey * plane_sigma, 0.02);
    PatternScorer scorer(grid, fit.inflation, kTolerance);
    const Eigen::Isometry3d to_board = fit.T_lidar_board.inverse();
    for (const Eigen::Vector3d& p : points) {
        const Eigen::Vector3d q = to_board * p;
        if (std::abs(q.z()) <= depth) scorer.add(q.head<2>());
    }
    fit.score = scorer.score();
    return fit;
}

}  // namespace petal
