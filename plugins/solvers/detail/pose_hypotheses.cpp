// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/pose_hypotheses.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/se3.hpp"
#include "solvers/detail/least_kept.hpp"
#include "solvers/detail/pixel_fit.hpp"
#include "solvers/detail/pose_starts.hpp"

namespace petal {
namespace {

/// What one board in one image says of the pose. Beside its minimum the squared pixels grow by
/// x' information x, x = (where the board's centre comes to lie, m; rotation, rad): about the
/// centre, since a turn about the camera would move a board far off its straight line.
struct BoardView {
    std::size_t lidar = 0, image = 0;
    int rotation = 0;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    Eigen::Vector3d centre_lidar = Eigen::Vector3d::Zero();
    Eigen::Vector3d centre_camera = Eigen::Vector3d::Zero();
    Matrix6d information = Matrix6d::Zero();
    double gate_px = 0.0;
    double corners = 0.0;
};

/// The views of one LiDAR board as one image board; none where no pose puts it before the camera.
std::vector<BoardView> views_of(const BoardSet& boards, std::size_t l, std::size_t b) {
    std::vector<BoardView> views;
    const BoardSet::FromLidar& seen = boards.lidar()[l];
    const auto pairs = boards.pairs({{static_cast<int>(l), static_cast<int>(b), 0}});
    for (const Eigen::Isometry3d& start : planar_poses(boards.model(), pairs)) {
        const auto fit = fit_pixels(boards.model(), pairs, start);
        if (!fit) continue;
        BoardView view;
        view.lidar = l;
        view.image = b;
        view.centre_lidar = seen.centre;
        view.centre_camera = fit->pose.T_camera_lidar * seen.centre;
        if (!(view.centre_camera.z() > 0.0)) continue;
        Matrix6d about_centre = Matrix6d::Identity();  // rho = d - phi x c
        about_centre.topRightCorner<3, 3>() = skew(view.centre_camera);
        view.information = about_centre.transpose() * fit->information * about_centre;
        view.gate_px = boards.gate_px(seen, fit->pose.T_camera_lidar);
        view.corners = static_cast<double>(pairs.size());
        // Another rotation is the same view of a LiDAR frame that is turned with the board.
        for (std::size_t r = 0; r < seen.turns.size(); ++r) {
            view.rotation = static_cast<int>(r);
            view.pose = fit->pose.T_camera_lidar * seen.turns[r].inverse();
            views.push_back(view);
        }
    }
    return views;
}

/// (where the centre lies, rotation) of a pose as the view has it.
Vector6d off(const BoardView& view, const Eigen::Isometry3d& pose) {
    const Eigen::AngleAxisd turn(pose.linear() * view.pose.linear().transpose());
    Vector6d x;
    x << pose * view.centre_lidar - view.centre_camera, turn.angle() * turn.axis();
    return x;
}

/// The pose that suits both, and how many squared gates it costs them together. None where it
/// costs one too much.
struct Agreement {
    Eigen::Isometry3d pose;
    double cost = 0.0;
};
std::optional<Agreement> agreement(const BoardView& a, const BoardView& b) {
    constexpr double kHopelessGates = 2.0;
    constexpr double kHopelessTurn = 1.2;  // rad: two views of one pose do not differ by so much
    constexpr int kSteps = 3;
    if (rotation_angle(a.pose.linear() * b.pose.linear().transpose()) > kHopelessTurn)
        return std::nullopt;
    Eigen::Isometry3d pose = a.pose;
    for (int step = 0; step < kSteps; ++step) {
        Matrix6d information = 1e-9 * Matrix6d::Identity();
        Vector6d gradient = Vector6d::Zero();
        for (const BoardView* view : {&a, &b}) {
            Matrix6d by_pose = Matrix6d::Identity();  // d = rho + phi x (T p)
            by_pose.topRightCorner<3, 3>() = -skew(pose * view->centre_lidar);
            const Matrix6d weighted = by_pose.transpose() * view->information;
            information += weighted * by_pose;
            gradient -= weighted * off(*view, pose);
        }
        const Vector6d delta = information.ldlt().solve(gradient);
        if (!delta.allFinite()) return std::nullopt;
        pose = se3_exp(delta) * pose;
    }
    Agreement found{pose, 0.0};
    for (const BoardView* view : {&a, &b}) {
        const Vector6d x = off(*view, pose);
        const double gates =
            x.dot(view->information * x) / (view->corners * view->gate_px * view->gate_px);
        if (!(gates <= kHopelessGates * kHopelessGates)) return std::nullopt;
        found.cost += gates;
    }
    return found;
}

/// The distance of two centres is the same for both sensors, up to the error of their depths.
bool as_far_apart(const BoardView& a, const BoardView& b) {
    constexpr double kDepthError = 0.1;
    const double for_lidar = (a.centre_lidar - b.centre_lidar).norm();
    const double for_camera = (a.centre_camera - b.centre_camera).norm();
    return std::abs(for_camera - for_lidar) <=
           kDepthError * (a.centre_camera.norm() + b.centre_camera.norm());
}

std::vector<Eigen::Isometry3d> agreements(const std::vector<std::vector<BoardView>>& views,
                                          const std::function<void()>& poll) {
    constexpr std::size_t kMost = 3000;
    LeastKept<Eigen::Isometry3d> found(kMost);
    for (std::size_t i = 0; i < views.size(); ++i) {
        poll();
        for (std::size_t j = i + 1; j < views.size(); ++j) {
            const BoardView &first = views[i].front(), &second = views[j].front();
            if (first.lidar == second.lidar || first.image == second.image) continue;
            for (const BoardView& a : views[i])
                for (const BoardView& b : views[j])
                    if (as_far_apart(a, b))
                        if (const auto both = agreement(a, b)) found.add(both->cost, both->pose);
        }
    }
    return found.take();
}

}  // namespace

bool near_pose(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    constexpr double kNearTurn = 5.0 / kDegrees;
    constexpr double kNearShift = 0.2;  // m
    return (a.translation() - b.translation()).norm() < kNearShift &&
           rotation_angle(a.linear() * b.linear().transpose()) < kNearTurn;
}

std::vector<PoseHypothesis> pose_hypotheses(const BoardSet& boards,
                                            const std::function<void()>& poll) {
    std::vector<std::vector<BoardView>> views;
    for (std::size_t l = 0; l < boards.lidar().size(); ++l)
        for (std::size_t b = 0; b < boards.image().size(); ++b) {
            if (!boards.alike(l, b)) continue;
            auto seen = views_of(boards, l, b);
            if (!seen.empty()) views.push_back(std::move(seen));
        }
    std::vector<Eigen::Isometry3d> poses = agreements(views, poll);
    for (const auto& board : views)
        for (const BoardView& view : board) poses.push_back(view.pose);

    std::vector<PoseHypothesis> hypotheses;
    for (const Eigen::Isometry3d& pose : poses) {
        PoseHypothesis made{pose, boards.explained(pose)};
        if (made.explained.matches.empty()) continue;
        const bool known =
            std::any_of(hypotheses.begin(), hypotheses.end(), [&](const PoseHypothesis& other) {
                return other.explained.matches == made.explained.matches &&
                       near_pose(other.pose, pose);
            });
        if (!known) hypotheses.push_back(std::move(made));
    }
    std::stable_sort(hypotheses.begin(), hypotheses.end(), [](const auto& a, const auto& b) {
        return a.explained.misfit < b.explained.misfit;
    });
    return hypotheses;
}

}  // namespace petal
