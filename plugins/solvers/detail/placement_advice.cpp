// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/placement_advice.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/extrinsics_sigma.hpp"
#include "petal/printed.hpp"
#include "solvers/detail/joint_information.hpp"

namespace petal {
namespace {

using Matrix7d = Eigen::Matrix<double, 7, 7>;

constexpr double kTurn = 30.0 / kDegrees;
constexpr double kRangeStep = 1.0;   // m
constexpr double kWorthwhile = 0.9;  // a placement that takes less than a tenth away is no advice
const char* const kPlaces[3][3] = {{"at the top left", "at the top", "at the top right"},
                                   {"at the left", "in the middle", "at the right"},
                                   {"at the bottom left", "at the bottom", "at the bottom right"}};

/// The noise of the boards that one camera saw, so that it can be carried elsewhere.
struct BoardNoise {
    std::vector<Eigen::Vector3d> corners;          ///< about their mean, m
    std::vector<Eigen::Vector3d> outline;          ///< likewise
    Matrix6d lidar_per_range2 = Matrix6d::Zero();  ///< about the centre, in the board's axes
    double sigma_px = 0.0;  ///< of an independent corner that carries as much
};

Eigen::Vector3d mean_of(const std::vector<Eigen::Vector3d>& points) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& point : points) mean += point;
    return mean / static_cast<double>(points.size());
}

Eigen::MatrixXd independent_corners(std::size_t corners, double sigma_px) {
    const auto size = static_cast<Eigen::Index>(2 * corners);
    return Eigen::MatrixXd::Identity(size, size) / sigma_px;
}

Matrix6d view_information(const CameraModel& model, const JointBoard::View& view,
                          const Eigen::Isometry3d& T_camera_lidar,
                          const Eigen::Isometry3d& T_lidar_board, double focal) {
    ViewLinear linear;
    if (!linearise(model, view, T_camera_lidar, T_lidar_board, focal, linear))
        return Matrix6d::Zero();
    return linear.by_camera.transpose() * linear.by_camera;
}

std::optional<BoardNoise> noise_of(const JointModel& model, const JointSolution& solution,
                                   std::size_t camera) {
    BoardNoise noise;
    double log_variance = 0.0;
    int views = 0;
    for (std::size_t b = 0; b < model.boards.size(); ++b)
        for (const JointBoard::View& view : model.boards[b].views) {
            if (view.camera != camera) continue;
            const Eigen::Isometry3d& pose = solution.state.T_lidar_board[b];
            const Eigen::Isometry3d& T_camera_lidar = solution.state.T_camera_lidar[camera];
            const double focal = solution.state.focal[camera];
            JointBoard::View plain = view;
            plain.whitening = independent_corners(view.corners.size(), 1.0);
            const Matrix6d measured =
                view_information(model.cameras[camera], view, T_camera_lidar, pose, focal);
            const Matrix6d unit =
                view_information(model.cameras[camera], plain, T_camera_lidar, pose, focal);
            const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> eigen(
                measured, unit, Eigen::EigenvaluesOnly | Eigen::Ax_lBx);
            if (eigen.info() != Eigen::Success || !(eigen.eigenvalues().minCoeff() > 0.0)) continue;
            log_variance -= eigen.eigenvalues().array().log().mean();
            Eigen::Isometry3d centred = pose;
            centred.translation() = pose * mean_of(view.corners);
            const Matrix6d map = adjoint(centred.inverse());
            noise.lidar_per_range2 += map * model.boards[b].covariance * map.transpose() /
                                      centred.translation().squaredNorm();
            if (++views > 1) continue;
            const Eigen::Vector3d mean = mean_of(view.corners);
            Eigen::Vector3d least = view.corners[0], most = view.corners[0];
            for (const auto& corner : view.corners) {
                noise.corners.push_back(corner - mean);
                least = least.cwiseMin(corner);
                most = most.cwiseMax(corner);
            }
            // The board's frame begins at its outline, which has the same margin on every side.
            const Eigen::Vector3d end = least.cwiseMax(0.0) + most;
            for (const double x : {0.0, end.x()})
                for (const double y : {0.0, end.y()})
                    noise.outline.push_back(Eigen::Vector3d(x, y, 0.0) - mean);
        }
    if (views == 0) return std::nullopt;
    noise.lidar_per_range2 /= views;
    noise.sigma_px = std::exp(0.5 * log_variance / views);
    return noise;
}

/// Of the pose, as JointUncertainty::covariance() tells it.
Matrix6d pose_covariance(const Matrix7d& known, const AdviceParams& params) {
    const double allowed = params.allowed_range_offset;
    Matrix7d information = known;
    information(6, 6) += 1.0 / (allowed * allowed);
    const Matrix7d inverse = inverse_information(information);
    const Vector6d answer = inverse.topRightCorner<6, 1>() / allowed;
    const double share = params.range_offset_sigma / allowed;
    return params.variance_scale * inverse.topLeftCorner<6, 6>() +
           (share * share - params.variance_scale) * answer * answer.transpose();
}

struct Sigmas : PrincipalSigma {
    Vector6d axes;  ///< of t x y z, and about x y z

    explicit Sigmas(const Matrix6d& column)
        : PrincipalSigma(principal_sigma(column)),
          axes(column.diagonal().cwiseMax(0.0).cwiseSqrt()) {}
    double worst(const AdviceParams& params) const {
        return std::max(translation / params.usable_sigma, rotation / params.usable_sigma_rotation);
    }
};

std::string turned_text(double pitch, double yaw) {
    std::string text;
    if (pitch != 0.0)
        text += printed("pitched %.0f deg (its %s edge nearer)", std::abs(pitch) * kDegrees,
                        pitch > 0.0 ? "upper" : "lower");
    if (yaw != 0.0)
        text += (text.empty() ? "" : " and ") + printed("turned %.0f deg (its %s edge nearer)",
                                                        std::abs(yaw) * kDegrees,
                                                        yaw > 0.0 ? "right" : "left");
    return text.empty() ? "facing the camera" : text;
}

/// "t_y from 14 to 4 mm": of the axis that is worst before, in units of its limit.
std::string sigma_text(const Sigmas& before, const Sigmas& after, const AdviceParams& params) {
    Vector6d limits;
    limits << Eigen::Vector3d::Constant(params.usable_sigma),
        Eigen::Vector3d::Constant(params.usable_sigma_rotation);
    Eigen::Index worst = 0;
    before.axes.cwiseQuotient(limits).maxCoeff(&worst);
    const double from = before.axes[worst], to = after.axes[worst];
    const std::array<const char*, 3> axes{"x", "y", "z"};
    const char* axis = axes[static_cast<std::size_t>(worst % 3)];
    if (worst < 3) return printed("sigma of t_%s from %.1f to %.1f mm", axis, from * 1e3, to * 1e3);
    return printed("sigma of the rotation about %s from %.3f to %.3f deg", axis, from * kDegrees,
                   to * kDegrees);
}

class PlacementSearch {
   public:
    PlacementSearch(const CameraModel& model, const Eigen::Isometry3d& T_camera_lidar, double focal,
                    const BoardNoise& noise)
        : T_camera_lidar_(T_camera_lidar), focal_(focal), noise_(noise) {
        seen_.cameras.push_back(model);
        JointBoard::View view;
        view.corners = noise.corners;
        view.image.assign(noise.corners.size(), Eigen::Vector2d::Zero());
        view.whitening = independent_corners(noise.corners.size(), noise.sigma_px);
        board_.views.push_back(view);
    }

    /// What would be known more of the pose and the range offset; none where the board would not be
    /// wholly in the image.
    std::optional<Matrix7d> gain(const Eigen::Vector2d& pixel, double range, double pitch,
                                 double yaw) {
        const CameraModel& model = seen_.cameras.front();
        const auto direction = model.unproject(pixel);
        if (!direction) return std::nullopt;
        Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
        T_camera_board.translation() = range * direction->normalized();
        T_camera_board.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()) *
                                   Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()))
                                      .toRotationMatrix();
        for (const auto& corner : noise_.outline) {
            const auto at = model.project(T_camera_board * corner);
            if (!at || at->minCoeff() < 0.0 || at->x() > model.camera().ncols - 1.0 ||
                at->y() > model.camera().nrows - 1.0)
                return std::nullopt;
        }
        const Eigen::Isometry3d T_lidar_board = T_camera_lidar_.inverse() * T_camera_board;
        const Matrix6d map = adjoint(T_lidar_board);
        const double distance = T_lidar_board.translation().norm();
        board_.T_lidar_board = T_lidar_board;
        board_.covariance = map * (distance * distance * noise_.lidar_per_range2) * map.transpose();
        const Eigen::LLT<Matrix6d> root(board_.covariance);
        if (root.info() != Eigen::Success) return std::nullopt;
        board_.whitening = root.matrixL().solve(Matrix6d::Identity());
        board_.centre = T_lidar_board.translation();
        const auto information =
            board_information(seen_, board_, {T_camera_lidar_}, T_lidar_board, {focal_}, 0.0);
        const JointLayout layout(1);
        Matrix7d told;
        told << information.normal.topLeftCorner<6, 6>(),
            information.normal.block<6, 1>(0, layout.range()),
            information.normal.block<1, 6>(layout.range(), 0),
            information.normal(layout.range(), layout.range());
        return told;
    }

   private:
    Eigen::Isometry3d T_camera_lidar_;
    double focal_;
    const BoardNoise& noise_;
    JointModel seen_;
    JointBoard board_;
};

}  // namespace

std::optional<Diagnosis::Advice> advise_placement(const JointModel& model,
                                                  const JointSolution& solution, std::size_t camera,
                                                  const Matrix7d& known,
                                                  const AdviceParams& params) {
    const auto noise = noise_of(model, solution, camera);
    if (!noise) return std::nullopt;
    const CameraModel& projection = model.cameras[camera];
    const Eigen::Isometry3d& pose = solution.state.T_camera_lidar[camera];
    PlacementSearch search(projection, pose, solution.state.focal[camera], *noise);
    const auto sigmas = [&](const Matrix7d& information) {
        return Sigmas(column_covariance(pose_covariance(information, params), pose));
    };
    const Sigmas before = sigmas(known);
    double best = kWorthwhile * before.worst(params);
    std::optional<Diagnosis::Advice> advice;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            const Eigen::Vector2d pixel((2 * column + 1) / 6.0 * projection.camera().ncols,
                                        (2 * row + 1) / 6.0 * projection.camera().nrows);
            for (double range = params.min_range; range <= params.max_range + 1e-9;
                 range += kRangeStep)
                for (const double pitch : {0.0, kTurn, -kTurn})
                    for (const double yaw : {0.0, kTurn, -kTurn}) {
                        const auto gain = search.gain(pixel, range, pitch, yaw);
                        if (!gain) continue;
                        const Sigmas after = sigmas(known + *gain);
                        // A hair's breadth is rounding, not a better place.
                        if (after.worst(params) >= best * (1.0 - 1e-6)) continue;
                        best = after.worst(params);
                        advice = Diagnosis::Advice();
                        advice->sentence =
                            std::string("a board ") + kPlaces[row][column] + " of the image, " +
                            turned_text(pitch, yaw) + printed(", at %g m: ", range) +
                            sigma_text(before, after, params) + ", if the LiDAR sees it there";
                        advice->range = range;
                        advice->u = pixel.x();
                        advice->v = pixel.y();
                        advice->pitch = pitch;
                        advice->yaw = yaw;
                        advice->sigma_translation_before = before.translation;
                        advice->sigma_translation_after = after.translation;
                        advice->sigma_rotation_before = before.rotation;
                        advice->sigma_rotation_after = after.rotation;
                    }
        }
    return advice;
}

}  // namespace petal
