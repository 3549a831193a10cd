// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_plane.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace petal {
namespace {

constexpr int kParts = 5;  ///< in each direction: points of one may share an error
constexpr std::size_t kLeastPoints = 30;
constexpr double kPlaneLeastCommon = 0.0002;  ///< m
constexpr double kPlanePlaneFreedoms = 3.0;
constexpr double kLeastSine = 0.1;  ///< of the ray to the middle: 6 deg

struct Part {
    double count = 0.0, sum = 0.0, squares = 0.0;
    Eigen::Vector2d place = Eigen::Vector2d::Zero();
};

}  // namespace

bool turn_into_plate(const PlateShape& shape, const RayBundle& rays, double margin,
                     Eigen::Isometry3d& T_lidar_middle) {
    // Ranges err along the ray, so the plane is fitted to heights over where rays cross it: an
    // orthogonal fit to the points would turn an oblique plate towards the sensor, by sigma^2 sin
    // cos over the variance of their places (0.14 deg for 12 mm, 22 deg and a board of 0.5 m).
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    std::size_t count = 0;
    const Eigen::Isometry3d to_board = T_lidar_middle.inverse() * rays.T_lidar_plane;
    const Eigen::Vector3d into = rays.T_lidar_plane.linear().col(2);
    const Eigen::Vector3d origin = rays.T_lidar_plane.translation();
    for (const PlaneRay& ray : rays.rays) {
        if (rays.told(ray) != Told::hit) continue;
        const Eigen::Vector3d q = to_board * Eigen::Vector3d(ray.place.x(), ray.place.y(), 0.0);
        if (shape.beyond(q.head<2>(), margin) <= 0) continue;
        const Eigen::Vector3d at(1.0, ray.place.x(), ray.place.y());
        normal += at * at.transpose();
        right += at * into.dot(ray.point - origin);
        ++count;
    }
    if (count < kLeastPoints) return false;
    const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
    if (solver.info() != Eigen::Success || !solver.isPositive()) return false;
    const Eigen::Vector3d heights = solver.solve(right);
    const Eigen::Vector3d away =
        rays.T_lidar_plane.linear() * Eigen::Vector3d(-heights(1), -heights(2), 1.0).normalized();
    if (!away.allFinite()) return false;
    const double offset = away.dot(rays.T_lidar_plane * Eigen::Vector3d(0.0, 0.0, heights(0)));
    const Eigen::Vector3d middle = T_lidar_middle.translation();
    const double reach = away.dot(middle);
    if (!(reach > kLeastSine * middle.norm())) return false;
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond::FromTwoVectors(T_lidar_middle.linear().col(2), away);
    T_lidar_middle.linear() =
        (turn * Eigen::Quaterniond(T_lidar_middle.linear())).normalized().toRotationMatrix();
    T_lidar_middle.translation() = middle * (offset / reach);
    return true;
}

PlaneOfPlate measure_plate(const PlateShape& shape, const RayBundle& rays, double margin) {
    PlaneOfPlate plate;
    std::array<Part, kParts * kParts> parts;
    const Eigen::Vector3d into = rays.T_lidar_plane.linear().col(2);
    const Eigen::Vector3d origin = rays.T_lidar_plane.translation();
    const auto part_of = [](double at, double size) {
        return static_cast<std::size_t>(
            std::clamp(static_cast<int>((at / size + 0.5) * kParts), 0, kParts - 1));
    };
    double squares = 0.0;
    for (const PlaneRay& ray : rays.rays) {
        if (rays.told(ray) != Told::hit || shape.beyond(ray.place, margin) <= 0) continue;
        const double off = into.dot(ray.point - origin);
        Part& part = parts[part_of(ray.place.y(), shape.height()) * kParts +
                           part_of(ray.place.x(), shape.width())];
        part.count += 1.0;
        part.sum += off;
        part.squares += off * off;
        part.place += ray.place;
        squares += off * off;
        ++plate.points;
    }
    if (plate.points == 0) return plate;
    plate.rms = std::sqrt(squares / static_cast<double>(plate.points));
    double used = 0.0, between = 0.0, within = 0.0, noise = 0.0;
    for (const Part& part : parts) {
        if (part.count < 2.0) continue;
        const double mean = part.sum / part.count;
        used += 1.0;
        between += mean * mean;
        within += part.squares - part.count * mean * mean;
        noise += 1.0 / part.count;
    }
    if (used <= kPlanePlaneFreedoms) return plate;
    const double point = within / std::max(static_cast<double>(plate.points) - used, 1.0);
    const double excess = between / (used - kPlanePlaneFreedoms) - point * noise / used;
    plate.flatness = std::sqrt(std::max(excess, 0.0));
    plate.common = std::max(plate.flatness, kPlaneLeastCommon);
    for (const Part& part : parts) {
        if (part.count < 2.0) continue;
        const Eigen::Vector2d place = part.place / part.count;
        // z of a fixed point changes by -(rho + phi x v).
        const Eigen::Vector3d jacobian(-1.0, -place.y(), place.x());
        plate.information +=
            jacobian * jacobian.transpose() / (plate.common * plate.common + point / part.count);
    }
    return plate;
}

}  // namespace petal
