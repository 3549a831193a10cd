// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/board_shape.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "metrics/detail/plate_edges.hpp"
#include "metrics/detail/plate_rays.hpp"
#include "metrics/detail/shown_edges.hpp"

namespace petal {
namespace {

constexpr double kShapeBorder = 0.06;      // m around the board: a wrong target's edges lie aside
constexpr double kShapeBand = 0.045;       // m on either side of an edge; bars are 0.1 m wide
constexpr double kShapeFromEdge = 0.015;   // m: nearer points may be mixed with what lies behind
constexpr double kShapePlaneDepth = 0.05;  // m
constexpr double kPatch = 0.05;            // m
constexpr std::size_t kFewestPoints = 200;
constexpr std::size_t kFewestInPatch = 8;
constexpr double kEdgeFloor = 0.0007;  // m, 1 sigma: what lies behind one edge and not another
/// m, 1 sigma: a coarse pattern of the scan, and intensities, that differ over the plate.
constexpr double kBowFloor = 0.0005;

/// The plate's points about its plane: in patches, and as a quadratic.
void measure_surface(const std::vector<PlateRay>& rays, const PlateEdges& edges, double depth,
                     BoardShape& shape) {
    struct Patch {
        double sum = 0.0, squares = 0.0, count = 0.0;
    };
    std::map<std::pair<int, int>, Patch> patches;
    using Vector6 = Eigen::Matrix<double, 6, 1>;
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Vector6 right = Vector6::Zero();
    const double half = 0.5 * std::max(edges.width(), edges.height());
    const auto row_of = [half](const Eigen::Vector2d& from) {
        const Eigen::Vector2d p = from / half;
        Vector6 row;
        row << 1.0, p.x(), p.y(), p.x() * p.x(), p.x() * p.y(), p.y() * p.y();
        return row;
    };
    for (const PlateRay& ray : rays) {
        if (std::abs(ray.off) > depth || edges.inside(ray.at) < kShapeFromEdge) continue;
        Patch& patch = patches[{static_cast<int>(std::floor(ray.at.x() / kPatch)),
                                static_cast<int>(std::floor(ray.at.y() / kPatch))}];
        patch.sum += ray.off;
        patch.squares += ray.off * ray.off;
        patch.count += 1.0;
        const Vector6 row = row_of(ray.at - edges.middle());
        normal += row * row.transpose();
        right += row * ray.off;
    }
    double within = 0.0, freedoms = 0.0, means = 0.0, noise_of_means = 0.0, counted = 0.0;
    for (const auto& [place, patch] : patches) {
        if (patch.count < static_cast<double>(kFewestInPatch)) continue;
        within += patch.squares - patch.sum * patch.sum / patch.count;
        freedoms += patch.count - 1.0;
        means += patch.sum * patch.sum / (patch.count * patch.count);
        noise_of_means += 1.0 / patch.count;
        counted += 1.0;
    }
    if (counted < 4.0) return;
    const double variance = within / freedoms;
    shape.noise = std::sqrt(variance);
    shape.flatness = std::sqrt(std::max(0.0, (means - variance * noise_of_means) / counted));

    const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> ldlt(normal);
    const Vector6 surface = ldlt.solve(right);
    if (!surface.allFinite()) return;
    // Heights of the quadratic part alone, where the plate is: its plane is the board's pose.
    Vector6 highest = Vector6::Zero(), lowest = Vector6::Zero();
    double high = -1e9, low = 1e9;
    for (int i = -4; i <= 4; ++i)
        for (int j = -4; j <= 4; ++j) {
            Vector6 row = row_of({0.125 * i * edges.width(), 0.125 * j * edges.height()});
            row.head<3>().setZero();
            const double height = row.dot(surface);
            if (height > high) {
                high = height;
                highest = row;
            }
            if (height < low) {
                low = height;
                lowest = row;
            }
        }
    const Vector6 difference = highest - lowest;
    shape.bow.value = high - low;
    shape.bow.sigma =
        std::hypot(shape.noise * std::sqrt(difference.dot(ldlt.solve(difference))), kBowFloor);
}

/// A few numbers by weighted least squares, with their covariance.
struct SmallFit {
    Eigen::VectorXd value;
    Eigen::MatrixXd covariance;
};

std::optional<SmallFit> solve(const std::vector<Eigen::VectorXd>& rows,
                              const std::vector<double>& right, const std::vector<double>& sigmas) {
    if (rows.empty() || rows.size() < static_cast<std::size_t>(rows.front().size()))
        return std::nullopt;
    const Eigen::Index n = rows.front().size();
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(n);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double weight = 1.0 / (sigmas[i] * sigmas[i]);
        normal += weight * rows[i] * rows[i].transpose();
        sum += weight * right[i] * rows[i];
    }
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(normal);
    if (!lu.isInvertible()) return std::nullopt;
    SmallFit fit{lu.solve(sum), lu.inverse()};
    if (!fit.value.allFinite()) return std::nullopt;
    double chi2 = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i)
        chi2 += std::pow((rows[i].dot(fit.value) - right[i]) / sigmas[i], 2);
    const double freedom = static_cast<double>(rows.size()) - static_cast<double>(n);
    if (freedom > 0.0) fit.covariance *= std::max(1.0, chi2 / freedom);
    return fit;
}

/// One direction: the sides of holes across it tell shift, roll, pitch and how far the plate grows
/// into its holes; the outline's two sides then tell its extent.
void measure_axis(int axis, const PlateEdges& edges,
                  const std::vector<std::optional<ShownEdge>>& shown,
                  std::optional<Measured>& pitch, std::optional<Measured>& extent) {
    const Eigen::Vector2d direction =
        axis == 0 ? Eigen::Vector2d::UnitX() : Eigen::Vector2d::UnitY();
    std::vector<Eigen::VectorXd> rows;
    std::vector<double> outs, sigmas;
    double outline = 0.0, outline_variance = 0.0;
    int outline_sides = 0;
    for (std::size_t e = 0; e < edges.edges().size(); ++e) {
        const PlateEdges::Edge& edge = edges.edges()[e];
        const double facing = edge.inward.dot(direction);
        if (!shown[e] || std::abs(facing) < 0.7) continue;
        const double sigma = std::hypot(shown[e]->sigma, kEdgeFloor);
        if (edge.of_outline) {
            outline += shown[e]->out;
            outline_variance += sigma * sigma;
            ++outline_sides;
            continue;
        }
        const Eigen::Vector2d from = edge.middle - edges.middle();
        // The edge moves outward by -inward . (shift + roll x from + pitch from) + growth.
        Eigen::VectorXd row(4);
        row << -facing, edge.inward.x() * from.y() - edge.inward.y() * from.x(),
            -facing * from.dot(direction), 1.0;
        rows.push_back(row);
        outs.push_back(shown[e]->out);
        sigmas.push_back(sigma);
    }
    const auto fit = solve(rows, outs, sigmas);
    if (fit) pitch = Measured{fit->value(2), std::sqrt(fit->covariance(2, 2))};
    if (outline_sides != 2) return;
    const double size = axis == 0 ? edges.width() : edges.height();
    const double growth = fit ? fit->value(3) : 0.0;
    const double growth_variance = fit ? fit->covariance(3, 3) : 0.0;
    extent = Measured{size + outline - 2.0 * growth,
                      std::sqrt(outline_variance + 4.0 * growth_variance)};
}

}  // namespace

std::optional<BoardShape> board_shape(const Run& run, const Cloud& cloud,
                                      const Eigen::Isometry3d& T_lidar_board,
                                      const Target& target) {
    const PlateEdges edges(target);
    auto rays = plate_rays(run, cloud, T_lidar_board, edges.width(), edges.height(), kShapeBorder);
    const auto plane = plate_plane(rays, edges, kShapeFromEdge, kShapePlaneDepth);
    if (!plane || plane->count < kFewestPoints) return std::nullopt;
    flatten(rays, *plane, edges.middle());
    const double depth = std::clamp(3.5 * plane->rms, 0.01, 0.05);
    BoardShape shape;
    measure_surface(rays, edges, depth, shape);
    const auto shown =
        shown_edges(run, edge_rays(rays, edges, kShapeBand, depth), edges.edges().size());
    measure_axis(0, edges, shown, shape.pitch_x, shape.width);
    measure_axis(1, edges, shown, shape.pitch_y, shape.height);
    return shape;
}

}  // namespace petal
