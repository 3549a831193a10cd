// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "detectors/detail/image_layout.hpp"

namespace petal {

/// An edge point that was found near a hole side.
struct SidePoint {
    std::size_t side = 0;                             ///< index in HoleLayout::sides()
    double t = 0.0;                                   ///< along the side, 0 to 1
    Eigen::Vector2d image = Eigen::Vector2d::Zero();  ///< ideal px
    double strength = 0.0;                            ///< EdgePoint::strength
};

/// What of a side depends on the homography alone.
struct SideFrame {
    Eigen::Vector2d normal;  ///< ideal px, unit length, out of the hole
    double px_per_m = 0.0;   ///< along it
};

/// One for each of HoleLayout::sides().
std::vector<SideFrame> side_frames(const HoleLayout& layout, const Homography& h);

/// How far a point lies out of the hole from where the homography puts its side, px.
double side_residual(const HoleLayout& layout, const Homography& h, const SideFrame& frame,
                     const SidePoint& point);

/// Small changes of a homography: H (I + D) in board coordinates centred on the board and divided
/// by `scale`, so that all eight numbers are alike. Row k of D: 3k, 3k + 1, 3k + 2; the last entry
/// is 0.
class HomographyStep {
   public:
    using Vector8d = Eigen::Matrix<double, 8, 1>;

    explicit HomographyStep(const HoleLayout& layout)
        : center_(layout.center()), scale_(0.5 * layout.target().width()) {}

    /// d (image) / d (D) at a board point.
    Eigen::Matrix<double, 2, 8> jacobian(const Homography& h, const Eigen::Vector2d& board) const;
    /// H (I + D), scaled so that its last entry is 1.
    Homography apply(const Homography& h, const Vector8d& d) const;

   private:
    Eigen::Vector2d center_;
    double scale_;
};

}  // namespace petal
