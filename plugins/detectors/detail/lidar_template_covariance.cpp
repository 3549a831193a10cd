// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_covariance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace petal {
namespace {

constexpr double kLeastCommon = 0.0002;  ///< m, of a side
/// What the fit takes from the sides that an axis passes: x (or y) and its shift, and half a turn.
constexpr double kAxisFreedoms = 2.5;
constexpr double kAxisPairFreedoms = 1.5;  ///< the same without the shift

double common_along(const PlateShape& shape, const PlateEvaluation& at, int axis) {
    double shifts = 0.0, pairs = -kAxisPairFreedoms, all = 0.0, noise = 0.0, count = 0.0;
    for (std::size_t s = 0; s < at.sides.size(); ++s) {
        const PlateEvaluation::Side& side = at.sides[s];
        if (!(side.information > 0.0)) continue;
        const double share = side.share()(axis);
        const double mean = side.score / side.information;
        all += share * mean * mean;
        count += share;
        noise += share / side.information;
        const int other = shape.opposite(s);
        if (other <= static_cast<int>(s)) continue;
        const PlateEvaluation::Side& across = at.sides[static_cast<std::size_t>(other)];
        if (!(across.information > 0.0)) continue;
        // Both count into the plate, so a shift of the board is half their difference.
        const double shift = 0.5 * (mean - across.score / across.information);
        shifts += share * shift * shift;
        pairs += share;
    }
    if (count <= 0.0) return kLeastCommon;
    double variance = all / std::max(count - kAxisFreedoms, 1.0);
    if (pairs > 0.0) variance = (2.0 * shifts + variance) / (pairs + 1.0);
    return std::max(std::sqrt(std::max(variance - noise / count, 0.0)), kLeastCommon);
}

}  // namespace

// From how the sides scatter: opposite sides moved alike shift the board, moved unlike they make
// holes smaller.
Eigen::Vector2d common_of(const PlateShape& shape, const PlateEvaluation& at) {
    return {common_along(shape, at, 0), common_along(shape, at, 1)};
}

PlateMatrix plate_covariance(const PlateEvaluation& at, const PlaneOfPlate& plane,
                             const Eigen::Vector2d& common, bool stretches) {
    PlateMatrix information = at.observed;
    information.block<3, 3>(kRhoZ, kRhoZ) += plane.information;
    if (!stretches)
        for (int axis = 0; axis < 2; ++axis) information(kStretchX + axis, kStretchX + axis) = 1e12;
    PlateMatrix covariance = information.ldlt().solve(PlateMatrix::Identity());
    // What the sides share: each side's shift into the plate moves every parameter.
    PlateMatrix shared = PlateMatrix::Zero();
    for (const PlateEvaluation::Side& side : at.sides)
        if (side.information > 0.0)
            shared += side.share().dot(common.cwiseAbs2()) * side.pull * side.pull.transpose();
    covariance += covariance * shared * covariance;
    return 0.5 * (covariance + covariance.transpose());
}

}  // namespace petal
