// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/shown_edges.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace petal {
namespace {

constexpr double kFromCorner = 0.012;    // m: a beam of some width rounds corners
constexpr std::size_t kFewestRays = 15;  // of hits, and of misses
constexpr double kSteepest = 2000.0;     // 1/m, 1 sigma of a prior: an edge shows over 0.5 mm
constexpr double kContradicts = 5.0;     // logit: one in 150 by chance, an occluder otherwise
constexpr double kSureOfShift = 4.0;     // logit: beyond it a ray tells of no shift
constexpr int kTurns = 30;

double probability(double logit) {
    return logit >= 0.0 ? 1.0 / (1.0 + std::exp(-logit))
                        : std::exp(logit) / (1.0 + std::exp(logit));
}

/// Whether a ray says the opposite of what lies there, so clearly that it is no edge's noise.
bool contradicts(bool hit, double logit) {
    return hit ? logit < -kContradicts : logit > kContradicts;
}

struct Logistic {
    Eigen::Vector2d value = Eigen::Vector2d(0.0, 200.0);  ///< at the edge, by inside (1/m)
    Eigen::Matrix2d information = Eigen::Matrix2d::Identity();
};

/// Newton's method: the likelihood is concave, so damping by halves is all that it needs.
Logistic fit_logistic(const std::vector<const EdgeRay*>& rays, Logistic fit, bool trim) {
    const auto loss = [&](const Eigen::Vector2d& value, const Logistic& kept_by) {
        double sum = 0.5 * value.y() * value.y() / (kSteepest * kSteepest);
        for (const EdgeRay* ray : rays) {
            if (trim && contradicts(ray->hit, kept_by.value.x() + kept_by.value.y() * ray->inside))
                continue;
            const double logit = value.x() + value.y() * ray->inside;
            const double wrong = ray->hit ? -logit : logit;
            sum += wrong > 30.0 ? wrong : std::log1p(std::exp(wrong));
        }
        return sum;
    };
    const Logistic kept_by = fit;
    double best = loss(fit.value, kept_by);
    for (int turn = 0; turn < kTurns; ++turn) {
        Eigen::Vector2d gradient(0.0, -fit.value.y() / (kSteepest * kSteepest));
        Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
        information(0, 0) = 1e-9;
        information(1, 1) = 1.0 / (kSteepest * kSteepest);
        for (const EdgeRay* ray : rays) {
            if (trim && contradicts(ray->hit, kept_by.value.x() + kept_by.value.y() * ray->inside))
                continue;
            const Eigen::Vector2d row(1.0, ray->inside);
            const double p = probability(fit.value.dot(row));
            gradient += ((ray->hit ? 1.0 : 0.0) - p) * row;
            information += p * (1.0 - p) * row * row.transpose();
        }
        fit.information = information;
        Eigen::Vector2d step = information.ldlt().solve(gradient);
        double now = loss(fit.value + step, kept_by);
        for (int half = 0; half < 20 && now > best; ++half) {
            step *= 0.5;
            now = loss(fit.value + step, kept_by);
        }
        if (!(now <= best)) break;
        fit.value += step;
        const bool settled = best - now < 1e-9 * (1.0 + best);
        best = now;
        if (settled) break;
    }
    return fit;
}

}  // namespace

std::vector<EdgeRay> edge_rays(const std::vector<PlateRay>& rays, const PlateEdges& edges,
                               double band, double depth) {
    std::vector<EdgeRay> beside;
    for (const PlateRay& ray : rays) {
        if (ray.depth < -depth) continue;
        const auto place = edges.near(ray.at, band, kFromCorner);
        if (place)
            beside.push_back(
                {place->edge, place->inside, place->inward, ray.at, ray.point, ray.depth <= depth});
    }
    return beside;
}

std::vector<std::optional<ShownEdge>> shown_edges(const std::vector<EdgeRay>& rays,
                                                  std::size_t edges) {
    std::vector<std::vector<const EdgeRay*>> by_edge(edges);
    for (const EdgeRay& ray : rays) by_edge[ray.edge].push_back(&ray);
    std::vector<std::optional<ShownEdge>> shown(edges);
    for (std::size_t e = 0; e < edges; ++e) {
        const auto hits = static_cast<std::size_t>(std::count_if(
            by_edge[e].begin(), by_edge[e].end(), [](const EdgeRay* ray) { return ray->hit; }));
        if (hits < kFewestRays || by_edge[e].size() - hits < kFewestRays) continue;
        Logistic fit = fit_logistic(by_edge[e], Logistic{}, false);
        fit = fit_logistic(by_edge[e], fit, true);
        const double slope = fit.value.y();
        if (!(slope > 20.0)) continue;  // no step at all: something hides this edge
        const double out = fit.value.x() / slope;
        const Eigen::Vector2d by(1.0 / slope, -out / slope);
        const double variance = by.dot(fit.information.ldlt().solve(by));
        if (variance > 0.0) shown[e] = ShownEdge{out, std::sqrt(variance), slope};
    }
    return shown;
}

std::optional<PlateShift> plate_shift(const std::vector<EdgeRay>& rays,
                                      const std::vector<std::optional<ShownEdge>>& shown,
                                      const Eigen::Vector2d& middle) {
    PlateShift shift;
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    // Roll is reckoned in metres at a lever of 0.25 m, so that all three numbers are alike.
    constexpr double kLever = 0.25;
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
    for (int turn = 0; turn < kTurns; ++turn) {
        Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
        information.setZero();
        double pearson = 0.0;
        std::size_t count = 0;
        for (const EdgeRay& ray : rays) {
            if (!shown[ray.edge]) continue;
            const ShownEdge& edge = *shown[ray.edge];
            const Eigen::Vector2d from = ray.at - middle;
            const Eigen::Vector3d row(
                -ray.inward.x(), -ray.inward.y(),
                (ray.inward.x() * from.y() - ray.inward.y() * from.x()) / kLever);
            const double logit = edge.slope * (ray.inside + edge.out + row.dot(value));
            if (contradicts(ray.hit, logit) || std::abs(logit) > kSureOfShift) continue;
            const double p = probability(logit);
            const double miss = (ray.hit ? 1.0 : 0.0) - p;
            gradient += miss * edge.slope * row;
            information += p * (1.0 - p) * edge.slope * edge.slope * row * row.transpose();
            pearson += miss * miss / (p * (1.0 - p));
            ++count;
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
        if (count < 2 * kFewestRays || !(eigen.eigenvalues().x() > 1.0 / (0.02 * 0.02)))
            return std::nullopt;
        Eigen::Vector3d step = information.ldlt().solve(gradient);
        const double longest = step.cwiseAbs().maxCoeff();
        if (longest > 0.005) step *= 0.005 / longest;  // the rays that tell change on the way
        value += step;
        const double spread = std::max(1.0, pearson / static_cast<double>(count - 3));
        const Eigen::DiagonalMatrix<double, 3> metres(1.0, 1.0, 1.0 / kLever);
        shift.value = metres * value;
        shift.covariance = metres * (spread * information.inverse()) * metres;
        if (longest < 1e-6) break;
    }
    if (!shift.value.allFinite() || shift.value.head<2>().norm() > 0.05) return std::nullopt;
    return shift;
}

}  // namespace petal
