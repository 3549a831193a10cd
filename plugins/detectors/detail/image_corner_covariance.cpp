// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_corner_covariance.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace petal {
namespace {

constexpr double kFitted = 9.0;   ///< eight of the homography and the inset
constexpr double kLeast = 0.005;  ///< px: each coordinate's own; keeps the matrix regular

using SideJacobian = Eigen::Matrix<double, 2, 8>;

/// How the homography's eight numbers move each side's line: offset and tilt.
std::vector<SideJacobian> side_jacobians(const HoleLayout& layout, const Homography& h) {
    const std::vector<SideFrame> frame = side_frames(layout, h);
    const HomographyStep step(layout);
    std::vector<SideJacobian> all;
    for (std::size_t s = 0; s < layout.sides().size(); ++s) {
        const auto& side = layout.sides()[s];
        const auto start = (frame[s].normal.transpose() * step.jacobian(h, side.from)).eval();
        const auto end = (frame[s].normal.transpose() * step.jacobian(h, side.to)).eval();
        SideJacobian j;
        j.row(0) = 0.5 * (start + end);
        j.row(1) = 0.5 * (end - start);
        all.push_back(j);
    }
    return all;
}

/// How the sides lie about the homography.
struct SideMisfit {
    double variance = 0.0;                            ///< of one point, px^2
    Eigen::Vector2d inset = Eigen::Vector2d::Zero();  ///< m, of left and right, of upper and lower
};

/// 0 for left and right sides, 1 for upper and lower ones.
int axis_of(const HoleLayout::Side& side) {
    const Eigen::Vector2d along = side.to - side.from;
    return std::abs(along.x()) > std::abs(along.y()) ? 1 : 0;
}

SideMisfit side_misfit(const HoleLayout& layout, const std::vector<SideFrame>& frame,
                       const std::vector<SideJacobian>& jacobians,
                       const std::vector<MeasuredSide>& sides, double scatter, double inset) {
    // The homography took up part of the insets: both are fitted once more, together.
    using Matrix10d = Eigen::Matrix<double, 10, 10>;
    using Vector10d = Eigen::Matrix<double, 10, 1>;
    Matrix10d normal = Matrix10d::Zero();
    Vector10d right = Vector10d::Zero();
    double squares = 0.0, figures = 0.0;
    for (std::size_t s = 0; s < sides.size(); ++s) {
        if (sides[s].information(0, 0) <= 0.0) continue;
        Eigen::Matrix<double, 2, 10> j = Eigen::Matrix<double, 2, 10>::Zero();
        j.leftCols<8>() = jacobians[s];
        j(0, 8 + axis_of(layout.sides()[s])) = -frame[s].px_per_m;
        Eigen::Vector2d off = sides[s].measured;
        off(0) -= inset * frame[s].px_per_m;
        normal += j.transpose() * sides[s].information * j;
        right += j.transpose() * sides[s].information * off;
        squares += off.dot(sides[s].information * off);
        figures += 2.0;
    }
    const Vector10d fitted = normal.ldlt().solve(right);
    SideMisfit misfit;
    misfit.variance = std::max((squares - fitted.dot(right)) / std::max(figures - kFitted, 1.0),
                               scatter * scatter);
    misfit.inset = fitted.tail<2>();
    return misfit;
}

}  // namespace

Eigen::MatrixXd corner_covariance(const HoleLayout& layout, const Homography& h,
                                  const std::vector<MeasuredSide>& sides,
                                  const std::vector<CornerCrossing>& corners, double scatter,
                                  double inset, const std::vector<double>& wall_sigma) {
    const auto lines = static_cast<Eigen::Index>(sides.size());
    const std::vector<SideJacobian> jacobians = side_jacobians(layout, h);
    const std::vector<SideFrame> frame = side_frames(layout, h);
    Eigen::Matrix<double, 8, 8> information = Eigen::Matrix<double, 8, 8>::Zero();
    Eigen::Matrix2d usual = Eigen::Matrix2d::Zero();  // of a side's information
    double measured = 0.0;
    for (std::size_t s = 0; s < sides.size(); ++s) {
        information += jacobians[s].transpose() * sides[s].information * jacobians[s];
        usual += sides[s].information;
        measured += sides[s].information(0, 0) > 0.0 ? 1.0 : 0.0;
    }
    usual /= std::max(measured, 1.0);
    const Eigen::Matrix<double, 8, 8> of_homography = information.inverse();

    // Errors of the lines, in units of a point's: own points by the gain, geometry by the rest.
    const auto unit = Eigen::Matrix2d::Identity();
    Eigen::MatrixXd of_lines = Eigen::MatrixXd::Zero(2 * lines, 2 * lines);
    for (Eigen::Index a = 0; a < lines; ++a) {
        const MeasuredSide& one = sides[static_cast<std::size_t>(a)];
        for (Eigen::Index b = 0; b < lines; ++b) {
            const MeasuredSide& other = sides[static_cast<std::size_t>(b)];
            const Eigen::Matrix2d geometry = jacobians[static_cast<std::size_t>(a)] *
                                             of_homography *
                                             jacobians[static_cast<std::size_t>(b)].transpose();
            of_lines.block<2, 2>(2 * a, 2 * b) =
                geometry - one.gain * geometry * other.gain.transpose();
        }
        const bool own = one.information(0, 0) > 0.0;
        of_lines.block<2, 2>(2 * a, 2 * a) +=
            own ? Eigen::Matrix2d(one.gain * one.information.inverse() * one.gain.transpose())
                : Eigen::Matrix2d(usual.inverse() * unit);
    }
    const SideMisfit misfit = side_misfit(layout, frame, jacobians, sides, scatter, inset);
    of_lines *= misfit.variance;
    // A wall that shows moves one side of each hole inwards: so much inset, so much shift.
    for (int axis = 0; axis < 2; ++axis) {
        Eigen::VectorXd smaller = Eigen::VectorXd::Zero(2 * lines);
        Eigen::VectorXd shifted = Eigen::VectorXd::Zero(2 * lines);
        for (Eigen::Index a = 0; a < lines; ++a) {
            const auto& side = layout.sides()[static_cast<std::size_t>(a)];
            if (axis_of(side) != axis) continue;
            const double moved = misfit.inset(axis) * frame[static_cast<std::size_t>(a)].px_per_m;
            // Which of the two it is cannot be seen without points of its own.
            if (sides[static_cast<std::size_t>(a)].information(0, 0) <= 0.0)
                of_lines(2 * a, 2 * a) += 4.0 * moved * moved;
            const double middle = layout.hole_center(side.hole)(axis);
            smaller(2 * a) = moved;
            shifted(2 * a) = side.from(axis) > middle ? moved : -moved;
        }
        Eigen::VectorXd walls = Eigen::VectorXd::Zero(2 * lines);
        for (Eigen::Index a = 0; a < lines; ++a) {
            const auto s = static_cast<std::size_t>(a);
            if (axis_of(layout.sides()[s]) == axis)
                walls(2 * a) = wall_sigma[s] * frame[s].px_per_m;
        }
        of_lines += smaller * smaller.transpose() + shifted * shifted.transpose() +
                    walls * walls.transpose();
    }

    const auto size = static_cast<Eigen::Index>(2 * corners.size());
    Eigen::MatrixXd carry = Eigen::MatrixXd::Zero(size, 2 * lines);
    for (std::size_t c = 0; c < corners.size(); ++c) {
        const CornerCrossing& corner = corners[c];
        const Eigen::Matrix2d move = corner.distortion * corner.crossing;
        for (int k = 0; k < 2; ++k) {
            const auto row = static_cast<Eigen::Index>(2 * c);
            const auto column = static_cast<Eigen::Index>(2 * corner.side[k]);
            carry.block<2, 1>(row, column) = move.col(k);
            carry.block<2, 1>(row, column + 1) = corner.sign[k] * move.col(k);
        }
    }
    const Eigen::MatrixXd covariance = carry * of_lines * carry.transpose();
    return 0.5 * (covariance + covariance.transpose()) +
           kLeast * kLeast * Eigen::MatrixXd::Identity(size, size);
}

}  // namespace petal
