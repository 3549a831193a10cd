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
constexpr double kMinCommonSigma = 0.001;  ///< m: of a side's own error
constexpr std::size_t kMinPoints = 24;
/// Free parameters that the common errors of the sides see: x, y, turn, d_x, d_y; offset and two
/// tilts.
constexpr double kLineFreedoms = 5.0;
constexpr double kPlaneFreedoms = 3.0;

/// One equation: `error` across a side or across the plane, and its derivative.
struct Equation {
    double error = 0.0;
    Vector8d jacobian = Vector8d::Zero();
    int side = 0;
};

struct Equations {
    std::vector<Equation> line, plane;
};

Equations linearise(const HoleGrid& grid, const std::vector<Eigen::Vector3d>& points,
                    const Eigen::Isometry3d& T, const Eigen::Vector2d& inflation,
                    double tolerance) {
    Equations equations;
    const Eigen::Isometry3d to_board = T.inverse();
    const Eigen::Matrix3d turn = to_board.linear();
    for (const Eigen::Vector3d& p : points) {
        const Eigen::Vector3d q = to_board * p;
        const SideHit hit = find_side(grid, inflation, q.head<2>(), tolerance);
        if (hit.side < 0) continue;
        // T' = Exp((rho, phi)) T moves q by -R^T (rho + phi x p).
        Eigen::Matrix<double, 3, 6> dq;
        dq.leftCols<3>() = -turn;
        dq.rightCols<3>() = turn * skew(p);
        const int axis = hit.side % 4 < 2 ? 0 : 1;
        Equation line;
        line.side = hit.side;
        line.error = hit.across;
        line.jacobian.head<6>() = dq.row(axis).transpose();
        line.jacobian(6 + axis) = hit.side % 2 == 0 ? 1.0 : -1.0;
        Equation plane;
        plane.side = hit.side;
        plane.error = q.z();
        plane.jacobian.head<6>() = dq.row(2).transpose();
        equations.line.push_back(line);
        equations.plane.push_back(plane);
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

/// Errors split into one that the points of a side share and one of each point.
struct Components {
    double common = 0.0;              ///< m, sigma
    double point = 0.0;               ///< m, sigma
    double rms = 0.0;                 ///< m, of both together
    std::vector<double> side_weight;  ///< sum of the points' robust weights
};

Components components(const std::vector<Equation>& equations, double sigma, std::size_t sides,
                      double freedoms) {
    Components result;
    std::vector<double> weight(sides, 0.0), mean(sides, 0.0);
    double total = 0.0, squares = 0.0;
    for (const Equation& e : equations) {
        const double w = tukey(e.error, sigma);
        weight[static_cast<std::size_t>(e.side)] += w;
        mean[static_cast<std::size_t>(e.side)] += w * e.error;
        total += w;
        squares += w * e.error * e.error;
    }
    double used = 0.0, between = 0.0, inverse = 0.0;
    for (std::size_t s = 0; s < sides; ++s) {
        if (weight[s] < 1.0) continue;
        mean[s] /= weight[s];
        used += 1.0;
        between += mean[s] * mean[s];
        inverse += 1.0 / weight[s];
    }
    double within = squares;
    for (std::size_t s = 0; s < sides; ++s)
        if (weight[s] >= 1.0) within -= weight[s] * mean[s] * mean[s];
    result.rms = std::sqrt(squares / std::max(total, 1.0));
    result.point =
        std::max(std::sqrt(std::max(within, 0.0) / std::max(total - used, 1.0)), kMinSigma);
    // The mean square of the sides' means is their common error plus what the points leave in a
    // mean.
    const double excess = between / std::max(used - freedoms, 1.0) -
                          result.point * result.point * inverse / std::max(used, 1.0);
    result.common = std::max(std::sqrt(std::max(excess, 0.0)), kMinCommonSigma);
    result.side_weight = std::move(weight);
    return result;
}

void accumulate(const std::vector<Equation>& equations, double sigma, Matrix8d& hessian,
                Vector8d& gradient) {
    for (const Equation& e : equations) {
        const double w = tukey(e.error, sigma) / (sigma * sigma);
        hessian.noalias() += w * e.jacobian * e.jacobian.transpose();
        gradient.noalias() += w * e.error * e.jacobian;
    }
}

/// Each side's points together weigh 1 / (common^2 + point^2 / n).
void accumulate_information(const std::vector<Equation>& equations, double sigma,
                            const Components& parts, Matrix8d& information) {
    for (const Equation& e : equations) {
        const double n = parts.side_weight[static_cast<std::size_t>(e.side)];
        if (n <= 0.0) continue;
        const double variance = n * parts.common * parts.common + parts.point * parts.point;
        information.noalias() +=
            tukey(e.error, sigma) / variance * e.jacobian * e.jacobian.transpose();
    }
}

}  // namespace

std::optional<BoardFit> refine_board(const HoleGrid& grid,
                                     const std::vector<Eigen::Vector3d>& points,
                                     const Eigen::Isometry3d& start,
                                     const Eigen::Vector2d& inflation, double prior_sigma) {
    BoardFit fit;
    fit.T_lidar_board = start;
    fit.inflation = inflation;
    Matrix8d prior = Matrix8d::Zero();
    prior(6, 6) = prior(7, 7) = 1.0 / (prior_sigma * prior_sigma);

    Equations equations;
    double line_sigma = kTolerance, plane_sigma = kTolerance;
    for (int step = 0; step < kSteps; ++step) {
        const double tolerance = step < kSteps / 3 ? kFirstTolerance : kTolerance;
        equations = linearise(grid, points, fit.T_lidar_board, fit.inflation, tolerance);
        if (equations.line.size() < kMinPoints) return std::nullopt;
        line_sigma = robust_sigma(equations.line);
        plane_sigma = robust_sigma(equations.plane);
        Matrix8d hessian = prior;
        Vector8d gradient = Vector8d::Zero();
        gradient.tail<2>() = fit.inflation * prior(6, 6);
        accumulate(equations.line, line_sigma, hessian, gradient);
        accumulate(equations.plane, plane_sigma, hessian, gradient);
        const Eigen::LDLT<Matrix8d> solver(hessian);
        if (solver.info() != Eigen::Success || !solver.isPositive()) return std::nullopt;
        const Vector8d delta = -solver.solve(gradient);
        if (!delta.allFinite() || delta.tail<5>().cwiseAbs().maxCoeff() > 0.5) return std::nullopt;
        fit.T_lidar_board = se3_exp(delta.head<6>()) * fit.T_lidar_board;
        fit.inflation += delta.tail<2>();
    }
    fit.T_lidar_board.linear() =
        Eigen::Quaterniond(fit.T_lidar_board.linear()).normalized().toRotationMatrix();

    equations = linearise(grid, points, fit.T_lidar_board, fit.inflation, kTolerance);
    if (equations.line.size() < kMinPoints) return std::nullopt;
    const Components line =
        components(equations.line, line_sigma, grid.side_count(), kLineFreedoms);
    const Components plane =
        components(equations.plane, plane_sigma, grid.side_count(), kPlaneFreedoms);
    fit.line_rms = line.rms;
    fit.plane_rms = plane.rms;
    Matrix8d information = prior;
    accumulate_information(equations.line, line_sigma, line, information);
    accumulate_information(equations.plane, plane_sigma, plane, information);
    const Eigen::LDLT<Matrix8d> solver(information);
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
