// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scene.hpp"

#include <cmath>

namespace petal::synthetic {

namespace {

Eigen::AngleAxisd turn(double degrees, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(degrees * M_PI / 180.0, axis);
}

/// A board whose centre is at `centre` (LiDAR frame), upright and facing the sensor, then yawed,
/// pitched and rolled about its centre.
Eigen::Isometry3d board_at(const Target& target, const Eigen::Vector3d& centre, double yaw_deg,
                           double pitch_deg, double roll_deg) {
    // Board x right, y down, z away from the sensor, seen from a LiDAR with x forward, y left, z
    // up.
    Eigen::Matrix3d facing;
    facing << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() =
        (turn(yaw_deg, Eigen::Vector3d::UnitZ()) * turn(pitch_deg, Eigen::Vector3d::UnitY()) *
         turn(roll_deg, Eigen::Vector3d::UnitX()))
            .toRotationMatrix() *
        facing;
    pose.translation() =
        centre - pose.linear() * Eigen::Vector3d(target.width() / 2, target.height() / 2, 0.0);
    return pose;
}

}  // namespace

Scene make_scene() {
    Scene scene;
    scene.target = load_target("four_square_holes_500mm");
    scene.camera.ncols = 960;
    scene.camera.nrows = 720;
    scene.camera.setIntrinsicParamsFromValues(780.0, 779.0, 481.5, 357.0);
    scene.camera.setDistortionPlumbBob(-0.08, 0.03, 0.0004, -0.0003);

    Eigen::Matrix3d axes;  // LiDAR x forward, y left, z up, to camera x right, y down, z forward
    axes << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    scene.T_camera_lidar.linear() =
        (turn(1.1, Eigen::Vector3d::UnitX()) * turn(-1.8, Eigen::Vector3d::UnitY()) *
         turn(0.7, Eigen::Vector3d::UnitZ()))
            .toRotationMatrix() *
        axes;
    scene.T_camera_lidar.translation() << 0.05, -0.12, 0.07;

    scene.T_lidar_board = {board_at(scene.target, {2.2, 0.75, -0.35}, 20.0, 8.0, 2.0),
                           board_at(scene.target, {3.0, -0.1, 0.55}, -15.0, -18.0, -3.0),
                           board_at(scene.target, {2.6, -0.9, -0.30}, -25.0, 10.0, 4.0),
                           board_at(scene.target, {3.6, 0.35, -0.45}, 5.0, 25.0, 0.0)};
    return scene;
}

}  // namespace petal::synthetic
