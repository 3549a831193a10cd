// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/shown_edges.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "petal/calibration/for_pieces.hpp"

namespace petal {
namespace {

constexpr double kFromCorner = 0.012;    // m: a beam of some width rounds corners
constexpr std::size_t kFewestRays = 15;  // of hits, and of misses
constexpr double kSteepest = 2000.0;     // 1/m, 1 sigma of a prior: an edge shows over 0.5 mm
constexpr double kContradicts = 5.0;     // logit: one in 150 by chance, an occluder otherwise
constexpr double kSureOfShift = 4.0;     // logit: beyond it a ray tells of no shift
constexpr int kTurns = 30;
constexpr double kLargestFactors = 1e300;  // twice that is still finite

double probability(double logit) {
    return logit >= 0.0 ? 1.0 / (1.0 + std::exp(-logit))
                        : std::exp(logit) / (1.0 + std::exp(logit));
}

/// Whether a ray says the opposite of what lies there, so clearly that it is no edge's noise.
bool contradicts(bool hit, double logit) {
    return hit ? logit < -kContradicts : logit > kContradicts;
}

/// Of a ray beside an edge what the fit of the edge asks for.
struct RayOutcome {
    double inside;
    bool hit;
};

/// The law of one edge, logit = x + y inside, against its rays.
struct Likelihood {
    double loss;  ///< minus its logarithm
    Eigen::Vector2d gradient;
    Eigen::Matrix2d information;
};

Likelihood likelihood(const std::vector<RayOutcome>& rays, const Eigen::Vector2d& value) {
    constexpr double kPrior = 1.0 / (kSteepest * kSteepest);
    double loss = 0.5 * kPrior * value.y() * value.y();
    double at = 0.0, by = -kPrior * value.y();         // gradient
    double at_at = 1e-9, at_by = 0.0, by_by = kPrior;  // information
    double factors = 1.0;  // of one logarithm for many rays: it would cost more than all else
    for (const RayOutcome& ray : rays) {
        const double logit = value.x() + value.y() * ray.inside;
        const double e = std::exp(-std::abs(logit));
        const double p = (logit >= 0.0 ? 1.0 : e) / (1.0 + e);
        const double miss = (ray.hit ? 1.0 : 0.0) - p;
        const double weight = p * (1.0 - p);
        at += miss;
        by += miss * ray.inside;
        at_at += weight;
        at_by += weight * ray.inside;
        by_by += weight * ray.inside * ray.inside;
        // -log p of what the ray did is log(1 + e), and the logit too where it did the unlikely.
        if (ray.hit != (logit >= 0.0)) loss += std::abs(logit);
        factors *= 1.0 + e;
        if (factors < kLargestFactors) continue;
        loss += std::log(factors);
        factors = 1.0;
    }
    Likelihood found{loss + std::log(factors), {at, by}, {}};
    found.information << at_at, at_by, at_by, by_by;
    return found;
}

struct Logistic {
    Eigen::Vector2d value = Eigen::Vector2d(0.0, 200.0);  ///< at the edge, by inside (1/m)
    Eigen::Matrix2d information = Eigen::Matrix2d::Identity();
};

/// Newton's method: the likelihood is concave, so damping by halves is all that it needs.
Logistic fit_logistic(const std::vector<RayOutcome>& rays, Logistic fit) {
    Likelihood best = likelihood(rays, fit.value);
    for (int turn = 0; turn < kTurns; ++turn) {
        Eigen::Vector2d step = best.information.ldlt().solve(best.gradient);
        Likelihood now = likelihood(rays, fit.value + step);
        for (int half = 0; half < 20 && now.loss > best.loss; ++half) {
            step *= 0.5;
            now = likelihood(rays, fit.value + step);
        }
        if (!(now.loss <= best.loss)) break;
        fit.value += step;
        const bool settled = best.loss - now.loss < 1e-9 * (1.0 + best.loss);
        best = now;
        if (settled) break;
    }
    fit.information = best.information;
    return fit;
}

/// One edge from the rays beside it; those that contradict the fit to all are left out of another.
std::optional<ShownEdge> shown_edge(std::vector<RayOutcome> rays) {
    const auto hits = static_cast<std::size_t>(
        std::count_if(rays.begin(), rays.end(), [](const RayOutcome& ray) { return ray.hit; }));
    if (hits < kFewestRays || rays.size() - hits < kFewestRays) return std::nullopt;
    Logistic fit = fit_logistic(rays, Logistic{});
    const auto wrong = [&fit](const RayOutcome& ray) {
        return contradicts(ray.hit, fit.value.x() + fit.value.y() * ray.inside);
    };
    rays.erase(std::remove_if(rays.begin(), rays.end(), wrong), rays.end());
    fit = fit_logistic(rays, fit);
    const double slope = fit.value.y();
    if (!(slope > 20.0)) return std::nullopt;  // no step at all: something hides this edge
    const double out = fit.value.x() / slope;
    const Eigen::Vector2d by(1.0 / slope, -out / slope);
    const double variance = by.dot(fit.information.ldlt().solve(by));
    if (!(variance > 0.0)) return std::nullopt;
    return ShownEdge{out, std::sqrt(variance), slope};
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

std::vector<std::optional<ShownEdge>> shown_edges(const Run& run, const std::vector<EdgeRay>& rays,
                                                  std::size_t edges) {
    std::vector<std::vector<RayOutcome>> by_edge(edges);
    for (const EdgeRay& ray : rays) by_edge[ray.edge].push_back({ray.inside, ray.hit});
    std::vector<std::optional<ShownEdge>> shown(edges);
    for_pieces(run, edges, 1, [&](std::size_t edge, std::size_t end) {
        for (; edge < end; ++edge) shown[edge] = shown_edge(std::move(by_edge[edge]));
    });
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
