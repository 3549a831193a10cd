// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/cloud_directions.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "petal/calibration/angles.hpp"

namespace petal {
namespace {

constexpr int kAcross = 32;  ///< tiles of a cube's face, each way: about 3 deg
constexpr std::size_t kTiles = 6U * kAcross * kAcross;
constexpr std::size_t kDirectionsPiece = 65536;

/// Where on a face something lies: `u` and `v` from -1 to 1.
std::uint16_t tile_on(int face, float u, float v) {
    const auto cell = [](float at) {
        return std::min(static_cast<int>((at + 1.0F) * (0.5F * kAcross)), kAcross - 1);
    };
    return static_cast<std::uint16_t>((face * kAcross + cell(u)) * kAcross + cell(v));
}

/// kTiles: none.
std::uint16_t tile_of(float x, float y, float z) {
    const float ax = std::abs(x), ay = std::abs(y), az = std::abs(z);
    // With what is not finite the sum is not either.
    if (!(ax + ay + az > 0.0F) || !std::isfinite(ax + ay + az)) return kTiles;
    if (ax >= ay && ax >= az) return tile_on(x > 0.0F ? 0 : 1, y / ax, z / ax);
    if (ay >= az) return tile_on(y > 0.0F ? 2 : 3, x / ay, z / ay);
    return tile_on(z > 0.0F ? 4 : 5, x / az, y / az);
}

Eigen::Vector3d direction_of(int face, double u, double v) {
    const double w = face % 2 == 0 ? 1.0 : -1.0;
    const Eigen::Vector3d at = face < 2   ? Eigen::Vector3d(w, u, v)
                               : face < 4 ? Eigen::Vector3d(u, w, v)
                                          : Eigen::Vector3d(u, v, w);
    return at.normalized();
}

}  // namespace

bool CloudDirections::Tile::reaches(const Eigen::Vector3d& other, double others_angle) const {
    const double both = angle + others_angle;
    return both >= kPi || axis.dot(other) >= std::cos(both);
}

CloudDirections::CloudDirections(const Cloud& cloud) : cloud_(cloud) {
    for (int face = 0; face < 6; ++face)
        for (int column = 0; column < kAcross; ++column)
            for (int row = 0; row < kAcross; ++row) {
                const auto at = [&](double right, double down) {
                    return direction_of(face, 2.0 * (column + right) / kAcross - 1.0,
                                        2.0 * (row + down) / kAcross - 1.0);
                };
                Tile tile;
                tile.axis = at(0.5, 0.5);
                for (const double right : {0.0, 1.0})
                    for (const double down : {0.0, 1.0})
                        tile.angle = std::max(
                            tile.angle,
                            std::acos(std::clamp(tile.axis.dot(at(right, down)), -1.0, 1.0)));
                tile.angle += 1e-5;  // points are rounded to a tile in single precision
                tiles_.push_back(tile);
            }
    const auto& xs = cloud.points->getPointsBufferRef_x();
    const auto& ys = cloud.points->getPointsBufferRef_y();
    const auto& zs = cloud.points->getPointsBufferRef_z();
    std::vector<std::uint16_t> tile_of_point(cloud.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cloud.size(), kDirectionsPiece),
                      [&](const auto& piece) {
                          for (std::size_t i = piece.begin(); i < piece.end(); ++i)
                              tile_of_point[i] = tile_of(xs[i], ys[i], zs[i]);
                      });
    begins_.assign(kTiles + 2, 0);
    for (const std::uint16_t tile : tile_of_point) ++begins_[tile + 1U];
    for (std::size_t k = 1; k < begins_.size(); ++k) begins_[k] += begins_[k - 1];
    std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
    indices_.resize(cloud.size());
    for (std::size_t i = 0; i < tile_of_point.size(); ++i)
        indices_[next[tile_of_point[i]]++] = static_cast<std::uint32_t>(i);
}

}  // namespace petal
