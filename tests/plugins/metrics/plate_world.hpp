// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <random>

#include "metrics/detail/plate_edges.hpp"
#include "petal/calibration/boards.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/target.hpp"

namespace petal::testing {

/// A plate before a wall, scanned at random for some seconds: noise of ranges 1 cm, of directions 3
/// mm at the plate.
struct PlateWorld {
    Target target = load_target("four_square_holes_500mm");  ///< the plate that stands there
    double seconds = 10.0;
    int points = 60000;
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< of the plate along its axes, m/s
    double moves_from = 0.0;                             ///< s
    double bow = 0.0;  ///< m: how far its middle column lies behind its left and right sides
    double wall = 0.4;
    unsigned seed = 1;

    /// 3 m ahead of the LiDAR, a little to the left, turned and tilted.
    static Eigen::Isometry3d T_lidar_board() {
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
        T.translation() << 3.0, 0.3, 0.25;
        T.rotate(Eigen::AngleAxisd(0.2, Eigen::Vector3d(0.3, 1.0, 0.1).normalized()));
        return T;
    }
    LidarBoards boards() const {
        LidarBoard board;
        board.target = target.name;
        board.T_lidar_board = T_lidar_board();
        for (const Eigen::Vector2d& p : target.corners())
            board.corners.push_back(board.T_lidar_board * Eigen::Vector3d(p.x(), p.y(), 0.0));
        return {"LIDAR", {board}};
    }
    Cloud cloud() const {
        std::mt19937 random(seed);
        std::normal_distribution<double> noise;
        std::uniform_real_distribution<double> even(-0.1, target.width() + 0.1);
        const PlateEdges edges(target);
        const Eigen::Isometry3d T = T_lidar_board();
        const Eigen::Vector3d sensor = T.inverse().translation();
        auto map = std::make_shared<mrpt::maps::CPointsMapXYZI>();
        Cloud cloud;
        const int messages = static_cast<int>(seconds * 10.0);
        for (int i = 0; i < points; ++i) {
            const double time = seconds * i / points;
            if (static_cast<int>(cloud.parts.size()) <= time * messages / seconds)
                cloud.parts.push_back(
                    {static_cast<std::size_t>(i), mrpt::Clock::fromDouble(1.7e9 + time)});
            const Eigen::Vector3d moved = velocity * std::max(0.0, time - moves_from);
            const Eigen::Vector2d at(even(random), even(random));
            const Eigen::Vector3d ray = Eigen::Vector3d(at.x(), at.y(), 0.0) - sensor;
            const Eigen::Vector2d on_plate = at - moved.head<2>() +
                                             ray.head<2>() / ray.z() * moved.z() +
                                             0.003 * Eigen::Vector2d(noise(random), noise(random));
            double depth = wall;
            if (edges.inside(on_plate) > 0.0) {
                const double from = (at.x() - 0.5 * target.width()) / (0.5 * target.width());
                depth = moved.z() + bow * (1.0 - from * from);
            }
            const double reach = (depth - sensor.z()) / ray.z();
            const Eigen::Vector3d p = sensor + ray * (reach + 0.01 * noise(random) / ray.norm());
            const Eigen::Vector3f in_lidar = (T * p).cast<float>();
            map->insertPointFast(in_lidar.x(), in_lidar.y(), in_lidar.z());
        }
        cloud.points = map;
        return cloud;
    }
};

}  // namespace petal::testing
