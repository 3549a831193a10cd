// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_hole_sides.hpp"

#include <Eigen/LU>

namespace petal {

std::vector<SideFrame> side_frames(const HoleLayout& layout, const Homography& h) {
    std::vector<SideFrame> all;
    for (const auto& side : layout.sides()) {
        const Eigen::Vector2d along =
            (map_point(h, side.to) - map_point(h, side.from)).normalized();
        const Eigen::Vector2d normal(along.y(), -along.x());  // clockwise, y down: out of the hole
        const Eigen::Vector2d board = (side.to - side.from).normalized();
        const Eigen::Matrix2d j = map_jacobian(h, 0.5 * (side.from + side.to));
        all.push_back({normal, normal.dot(j * Eigen::Vector2d(board.y(), -board.x()))});
    }
    return all;
}

double side_residual(const HoleLayout& layout, const Homography& h, const SideFrame& frame,
                     const SidePoint& point) {
    const auto& side = layout.sides()[point.side];
    return frame.normal.dot(point.image -
                            map_point(h, side.from + point.t * (side.to - side.from)));
}

Eigen::Matrix<double, 2, 8> HomographyStep::jacobian(const Homography& h,
                                                     const Eigen::Vector2d& board) const {
    const Eigen::Vector2d x = (board - center_) / scale_;
    Eigen::Matrix<double, 2, 8> d = Eigen::Matrix<double, 2, 8>::Zero();
    d.row(0) << x.x(), x.y(), 1.0, 0.0, 0.0, 0.0, -x.x() * x.x(), -x.x() * x.y();
    d.row(1) << 0.0, 0.0, 0.0, x.x(), x.y(), 1.0, -x.y() * x.x(), -x.y() * x.y();
    return scale_ * map_jacobian(h, board) * d;
}

Homography HomographyStep::apply(const Homography& h, const Vector8d& d) const {
    Eigen::Matrix3d to_board = Eigen::Matrix3d::Identity();
    to_board(0, 0) = to_board(1, 1) = scale_;
    to_board.topRightCorner<2, 1>() = center_;
    Eigen::Matrix3d change = Eigen::Matrix3d::Identity();
    for (int i = 0; i < 8; ++i) change(i / 3, i % 3) += d(i);
    const Homography moved = h * to_board * change * to_board.inverse();
    return moved / moved(2, 2);
}

}  // namespace petal
