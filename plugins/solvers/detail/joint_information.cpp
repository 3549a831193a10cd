// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/joint_information.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace petal {
namespace {

constexpr double kUnseenSigma = 1e3;

}  // namespace

JointInformation board_information(const JointModel& model, const JointBoard& board,
                                   const std::vector<Eigen::Isometry3d>& T_camera_lidar,
                                   const Eigen::Isometry3d& T_lidar_board,
                                   const std::vector<double>& focal, double range_offset) {
    const JointLayout layout(model.cameras.size());
    JointInformation shared(layout.size());
    const BoardLinear lidar = linearise(board, T_lidar_board, range_offset);
    Matrix6d own = lidar.by_board.transpose() * lidar.by_board;
    Vector6d own_gradient = lidar.by_board.transpose() * lidar.error;
    Eigen::MatrixXd cross = Eigen::MatrixXd::Zero(layout.size(), 6);  // shared x own
    const Eigen::Index range = layout.range();
    shared.normal(range, range) = lidar.by_range.squaredNorm();
    shared.gradient(range) = lidar.by_range.dot(lidar.error);
    cross.row(range) = lidar.by_range.transpose() * lidar.by_board;
    for (const JointBoard::View& view : board.views) {
        ViewLinear image;
        if (!linearise(model.cameras[view.camera], view, T_camera_lidar[view.camera], T_lidar_board,
                       focal[view.camera], image))
            continue;
        Eigen::MatrixXd by_shared(image.error.size(), 9);
        by_shared << image.by_camera, image.by_focal, image.by_centre;
        const Eigen::Index at = layout.pose(view.camera);
        shared.normal.block<9, 9>(at, at) += by_shared.transpose() * by_shared;
        shared.gradient.segment<9>(at) += by_shared.transpose() * image.error;
        cross.middleRows<9>(at) += by_shared.transpose() * image.by_board;
        own += image.by_board.transpose() * image.by_board;
        own_gradient += image.by_board.transpose() * image.error;
    }
    const Eigen::LDLT<Matrix6d> solver(own);
    const Eigen::MatrixXd reduced = cross * solver.solve(cross.transpose());
    shared.normal -= 0.5 * (reduced + reduced.transpose());
    shared.gradient -= cross * solver.solve(own_gradient);
    return shared;
}

std::vector<JointInformation> scene_information(const JointModel& model,
                                                const JointSolution& solution) {
    const JointLayout layout(model.cameras.size());
    const JointState& state = solution.state;
    std::vector<JointInformation> scenes(model.scenes.size(), JointInformation(layout.size()));
    for (std::size_t b = 0; b < model.boards.size(); ++b) {
        JointInformation board =
            board_information(model, model.boards[b], state.T_camera_lidar, state.T_lidar_board[b],
                              state.focal, state.range_offset);
        board.normal *= state.board_weights[b];
        board.gradient *= state.board_weights[b];
        scenes[model.boards[b].scene] += board;
    }
    for (std::size_t i = 0; i < model.points.size(); ++i) {
        const JointPoint& point = model.points[i];
        PointLinear image;
        if (!linearise(model.cameras[point.camera], point, model.point_sigma,
                       state.T_camera_lidar[point.camera], state.focal[point.camera],
                       state.range_offset, image))
            continue;
        Eigen::MatrixXd by_shared = Eigen::MatrixXd::Zero(2, layout.size());
        by_shared.middleCols<6>(layout.pose(point.camera)) = image.by_camera;
        by_shared.col(layout.focal(point.camera)) = image.by_focal;
        by_shared.middleCols<2>(layout.centre(point.camera)) = image.by_centre;
        by_shared.col(layout.range()) = image.by_range;
        JointInformation& scene = scenes[point.scene];
        scene.normal += state.point_weights[i] * by_shared.transpose() * by_shared;
        scene.gradient += state.point_weights[i] * by_shared.transpose() * image.error;
    }
    return scenes;
}

JointInformation prior_information(const JointLayout& layout, const TranslationPrior& prior,
                                   const JointState& state) {
    JointInformation information(layout.size());
    const Eigen::Vector3d t = state.T_camera_lidar[prior.camera].translation();
    Eigen::Matrix<double, 3, 6> by_twist;
    by_twist << Eigen::Matrix3d::Identity(), -skew(t);
    by_twist /= prior.sigma;
    const Eigen::Index at = layout.pose(prior.camera);
    information.normal.block<6, 6>(at, at) = by_twist.transpose() * by_twist;
    information.gradient.segment<6>(at) =
        by_twist.transpose() * (t - prior.translation) / prior.sigma;
    return information;
}

Eigen::MatrixXd inverse_information(const Eigen::MatrixXd& information) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(information);
    const Eigen::VectorXd values =
        eigen.eigenvalues().cwiseMax(1.0 / (kUnseenSigma * kUnseenSigma));
    const Eigen::MatrixXd inverse = eigen.eigenvectors() * values.cwiseInverse().asDiagonal() *
                                    eigen.eigenvectors().transpose();
    return 0.5 * (inverse + inverse.transpose());
}

}  // namespace petal
