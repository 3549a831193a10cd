// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/scene/solids.hpp"

#include "simulation/scene/placement.hpp"
#include "simulation/world/surfaces.hpp"

namespace petal::simulation {

Eigen::Isometry3d upright(const Eigen::Vector3d& place, double yaw) {
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    frame.translate(place);
    frame.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
    return frame;
}

void SolidBuilder::panel(const Eigen::Isometry3d& T_world_panel, double width, double height,
                         const SharedTexture& texture) const {
    world_.add(std::make_unique<PlanarSurface>(
        T_world_panel, PlanarSurface::rectangle(width, height), texture, kind_));
}

void SolidBuilder::box(const Eigen::Isometry3d& T_world_box, const Eigen::Vector3d& size,
                       const SharedTexture& texture) const {
    const double quarter = std::acos(0.0);
    for (int side = 0; side < 4; ++side) {
        const double depth = side % 2 == 0 ? size.x() : size.y();
        const double width = side % 2 == 0 ? size.y() : size.x();
        Eigen::Isometry3d T_box_side = Eigen::Isometry3d::Identity();
        T_box_side.rotate(Eigen::AngleAxisd(side * quarter, Eigen::Vector3d::UnitZ()));
        T_box_side.translate(Eigen::Vector3d(-0.5 * depth, 0.5 * width, size.z()));
        T_box_side.rotate(looking_ahead());
        panel(T_world_box * T_box_side, width, size.z(), texture);
    }
    for (const double z : {0.0, size.z()}) {
        Eigen::Isometry3d T_box_face = Eigen::Isometry3d::Identity();
        T_box_face.translate(Eigen::Vector3d(-0.5 * size.x(), -0.5 * size.y(), z));
        panel(T_world_box * T_box_face, size.x(), size.y(), texture);
    }
}

void SolidBuilder::bar(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius,
                       const SharedTexture& texture) const {
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    frame.translate(from);
    frame.rotate(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), to - from));
    world_.add(
        std::make_unique<CylinderSurface>(frame, radius, (to - from).norm(), texture, kind_));
}

}  // namespace petal::simulation
