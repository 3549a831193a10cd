// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/detail/direction_block.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "petal/calibration/angles.hpp"

namespace petal {
namespace {

constexpr auto kStraight = static_cast<float>(kPi);
constexpr std::size_t kSize = DirectionBlock::kSize;

using Floats = std::array<float, kSize>;
// Eigen, since compilers leave a loop as it is where a root may set errno, or a choice may trap.
using Block = Eigen::Map<Eigen::Array<float, kSize, 1>, Eigen::Aligned64>;
using ConstBlock = Eigen::Map<const Eigen::Array<float, kSize, 1>, Eigen::Aligned64>;

/// 1 where the number is negative, else 0.
inline float negative(float number) {
    return 0.5F - std::copysign(0.5F, number);
}

/// The angles of (x, y), like std::atan2 but without branches: an odd polynomial through the
/// Chebyshev nodes of [0, 1], good to 6e-8, and the octants' symmetry.
void find_angles(const Floats& ys, const Floats& xs, Floats& angles) {
    const ConstBlock y(ys.data()), x(xs.data());
    Block angle(angles.data());
    alignas(64) Floats squares;
    Block square(squares.data());
    constexpr float kLeast = 1e-30F;  // for (0, 0), whose angle is 0
    angle = x.abs().min(y.abs()) / x.abs().max(y.abs()).max(kLeast);
    square = angle * angle;
    angle *= ((((((-0.00455979199F * square + 0.0237805186F) * square - 0.0588297531F) * square +
                 0.0986886546F) *
                    square -
                0.140032902F) *
                   square +
               0.199669618F) *
                  square -
              0.333318127F) *
                 square +
             0.999999882F;
    for (std::size_t k = 0; k < kSize; ++k) {
        const float steep = negative(std::abs(xs[k]) - std::abs(ys[k]));
        const float quadrant = angles[k] + steep * (0.5F * kStraight - 2.0F * angles[k]);
        const float half = quadrant + negative(xs[k]) * (kStraight - 2.0F * quadrant);
        angles[k] = std::copysign(half, ys[k]);
    }
}

}  // namespace

void DirectionBlock::set(const mrpt::maps::CPointsMapXYZI& points, std::size_t first,
                         std::size_t last) {
    const auto copy = [&](const auto& from, Floats& to) {
        std::copy(from.data() + first, from.data() + last, to.begin());
    };
    copy(points.getPointsBufferRef_x(), x_);
    copy(points.getPointsBufferRef_y(), y_);
    copy(points.getPointsBufferRef_z(), z_);
    // The whole block always, so that nothing depends on how many points are asked for.
    const ConstBlock x(x_.data()), y(y_.data()), z(z_.data());
    Block(across_.data()) = (x * x + y * y).sqrt();
    // A sum of squares that is infinite or NaN tells of all three coordinates at once.
    Block(range_.data()) = (x * x + y * y + z * z).sqrt();
    find_angles(z_, across_, elevation_);
}

void DirectionBlock::set_azimuths() {
    find_angles(y_, x_, azimuth_);
}

}  // namespace petal
