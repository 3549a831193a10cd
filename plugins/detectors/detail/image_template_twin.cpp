// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_template_twin.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

namespace petal {
namespace {

/// Squared sigmas between two fits: nearer ones are one and the same.
constexpr double kOneAndTheSame = 9.0;
constexpr double kLeastOdds = 1e-6;

Eigen::Vector3d middle_of(const TemplatePose& pose, const TemplateModel& model) {
    return pose.T_camera_board * Eigen::Vector3d(model.center().x(), model.center().y(), 0.0);
}

/// -2 log likelihood but for what both fits have in common: the offsets of n sides have the
/// variance that they show.
double minus_log_likelihood(const FittedBoard& board, const TemplateModel& model) {
    double holes = 0.0, outline = 0.0;
    for (std::size_t s = 0; s < board.sides.size(); ++s)
        if (board.sides[s].samples > 0) (model.sides()[s].outline ? outline : holes) += 1.0;
    return 2.0 * (holes * std::log(board.hole_scatter) + outline * std::log(board.outline_scatter));
}

/// The step that leads from one pose to the other: see TemplatePose.
Eigen::Matrix<double, 6, 1> step_between(const TemplatePose& from, const TemplatePose& to,
                                         const TemplateModel& model) {
    const Eigen::AngleAxisd turn(to.T_camera_board.linear() *
                                 from.T_camera_board.linear().transpose());
    Eigen::Matrix<double, 6, 1> step;
    step << middle_of(to, model) - middle_of(from, model), turn.angle() * turn.axis();
    return step;
}

}  // namespace

TemplatePose mirrored(const TemplatePose& pose, const TemplateModel& model) {
    const Eigen::Vector3d middle = middle_of(pose, model);
    const Eigen::Vector3d sight = middle.normalized();
    const Eigen::Vector3d away = pose.T_camera_board.linear().col(2);
    const Eigen::Vector3d other = 2.0 * away.dot(sight) * sight - away;
    const Eigen::Matrix3d turn = Eigen::Quaterniond::FromTwoVectors(away, other).toRotationMatrix();
    TemplatePose result = pose;
    result.T_camera_board.linear() = turn * pose.T_camera_board.linear();
    result.T_camera_board.translation() =
        middle + turn * (pose.T_camera_board.translation() - middle);
    return result;
}

FittedBoard of_two_tilts(const FittedBoard& first, const FittedBoard& second,
                         const TemplateModel& model) {
    const double worse = minus_log_likelihood(second, model) - minus_log_likelihood(first, model);
    FittedBoard board = worse < 0.0 ? second : first;
    const FittedBoard& other = worse < 0.0 ? first : second;
    const double odds = 1.0 / (1.0 + std::exp(0.5 * std::abs(worse)));
    const auto step = step_between(board.pose, other.pose, model);
    const double apart = step.dot(board.covariance.llt().solve(step));
    if (odds > kLeastOdds && apart > kOneAndTheSame)
        board.covariance += odds * step * step.transpose();
    return board;
}

}  // namespace petal
