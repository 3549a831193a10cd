// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "margin_points.hpp"

#include <random>

namespace petal::synthetic {

namespace {

constexpr double kInflation = 0.010;    // m: holes look larger by that on each side
constexpr double kAcrossNoise = 0.003;  // m, in the board's plane
constexpr double kRangeNoise = 0.006;   // m
constexpr int kPointsPerMetre = 110;
constexpr int kClutter = 120;

class Sampler {
   public:
    explicit Sampler(std::uint64_t seed) : random_(seed) {}
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    double normal(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random_); }

   private:
    std::mt19937_64 random_;
};

/// Points beside the sides of a polygon that runs clockwise as seen from the front (x right, y
/// down); `outwards` m off, away from its inside.
void along(const std::vector<Eigen::Vector2d>& polygon, double outwards, Sampler& sampler,
           std::vector<Eigen::Vector2d>& points) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d from = polygon[i];
        const Eigen::Vector2d side = polygon[(i + 1) % polygon.size()] - from;
        const Eigen::Vector2d normal = Eigen::Vector2d(side.y(), -side.x()).normalized();
        const int count = static_cast<int>(side.norm() * kPointsPerMetre);
        for (int k = 0; k < count; ++k)
            points.push_back(from + side * sampler.uniform(0.0, 1.0) +
                             normal * (outwards + sampler.normal(kAcrossNoise)));
    }
}

}  // namespace

std::vector<Eigen::Vector3d> margin_points(const Scene& scene, std::uint64_t seed) {
    Sampler sampler(seed);
    std::vector<Eigen::Vector3d> points;
    for (const Eigen::Isometry3d& board : scene.T_lidar_board) {
        std::vector<Eigen::Vector2d> on_board;
        along(scene.target.outline, -kInflation, sampler, on_board);
        for (const auto& hole : scene.target.holes) along(hole, kInflation, sampler, on_board);
        for (const Eigen::Vector2d& p : on_board) {
            const Eigen::Vector3d exact = board * Eigen::Vector3d(p.x(), p.y(), 0.0);
            points.push_back(exact * (1.0 + sampler.normal(kRangeNoise) / exact.norm()));
        }
    }
    for (int i = 0; i < kClutter; ++i)
        points.emplace_back(sampler.uniform(1.8, 4.2), sampler.uniform(-1.6, 1.6),
                            sampler.uniform(-0.9, 1.2));
    return points;
}

}  // namespace petal::synthetic
