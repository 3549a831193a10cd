// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/line_search.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

namespace petal {
namespace {

constexpr int kMinIterations = 100;
constexpr int kPollEvery = 64;
constexpr double kMinBase = 0.04;  ///< m: two points nearer than this give no direction

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

bool supports(const PlanarLine& line, const Eigen::Vector2d& p, const LineSearchParams& params) {
    const Eigen::Vector2d offset = p - line.point;
    return std::abs(cross(line.direction, offset)) < params.line_threshold &&
           std::abs(line.direction.dot(offset)) <= params.reach;
}

/// Orthogonal least squares over the line's own points, twice.
void refit(PlanarLine& line, const std::vector<Eigen::Vector2d>& points,
           const LineSearchParams& params) {
    for (int round = 0; round < 2; ++round) {
        Eigen::Vector2d sum = Eigen::Vector2d::Zero();
        Eigen::Matrix2d products = Eigen::Matrix2d::Zero();
        double n = 0.0;
        for (const Eigen::Vector2d& p : points) {
            if (!supports(line, p, params)) continue;
            const Eigen::Vector2d q = p - line.point;
            sum += q;
            products += q * q.transpose();
            n += 1.0;
        }
        if (n < 2.0) return;
        const Eigen::Vector2d mean = sum / n;
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(products / n -
                                                                    mean * mean.transpose());
        line.point += mean;
        line.direction = solver.eigenvectors().col(1);
    }
}

}  // namespace

std::vector<PlanarLine> find_lines(const std::vector<Eigen::Vector2d>& points,
                                   const LineSearchParams& params, Rng& rng,
                                   const std::function<void()>& poll) {
    std::vector<PlanarLine> lines;
    std::vector<Eigen::Vector2d> remaining = points;
    while (lines.size() < params.max_lines && remaining.size() >= params.min_points) {
        PlanarLine best;
        double needed = params.max_iterations;
        for (int i = 0; i < params.max_iterations && (i < kMinIterations || i < needed); ++i) {
            if (i % kPollEvery == 0) poll();
            PlanarLine line;
            line.point = remaining[rng() % remaining.size()];
            const Eigen::Vector2d base = remaining[rng() % remaining.size()] - line.point;
            const double length = base.norm();
            if (length < kMinBase || length > params.reach) continue;
            line.direction = base / length;
            for (const Eigen::Vector2d& p : remaining) line.count += supports(line, p, params);
            if (line.count <= best.count) continue;
            best = line;
            const double share =
                static_cast<double>(line.count) / static_cast<double>(remaining.size());
            needed =
                share < 1.0 ? std::log(1.0 - params.confidence) / std::log1p(-share * share) : 1;
        }
        refit(best, remaining, params);
        std::vector<Eigen::Vector2d> rest;
        rest.reserve(remaining.size());
        for (const Eigen::Vector2d& p : remaining)
            if (!supports(best, p, params)) rest.push_back(p);
        best.count = remaining.size() - rest.size();
        if (best.count < params.min_points) break;
        lines.push_back(best);
        remaining = std::move(rest);
    }
    return lines;
}

}  // namespace petal
