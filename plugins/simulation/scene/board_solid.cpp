// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/scene/board_solid.hpp"

#include <utility>
#include <vector>

#include "petal/calibration/polygon.hpp"
#include "simulation/scene/materials.hpp"
#include "simulation/world/marker_texture.hpp"
#include "simulation/world/overlay_texture.hpp"
#include "simulation/world/surfaces.hpp"

namespace petal::simulation {
namespace {

Look light_look(const Target& target) {
    return {target.surface.colour.cast<float>(), static_cast<float>(target.surface.reflectivity)};
}

Look dark_look(const Target& target) {
    return {target.surface.dark_colour.cast<float>(),
            static_cast<float>(target.surface.dark_reflectivity)};
}

Eigen::AlignedBox2d box_at(const Eigen::Vector2d& corner, double width, double height) {
    return {corner, Eigen::Vector2d(corner + Eigen::Vector2d(width, height))};
}

/// Dark where a hole would be.
class LookAlikeTexture final : public Texture {
   public:
    LookAlikeTexture(SharedTexture front, const Look& dark, Target target)
        : front_(std::move(front)), dark_(dark), target_(std::move(target)) {}
    Look at(const Eigen::Vector2d& place) const override {
        for (const auto& hole : target_.holes)
            if (inside_polygon(hole, place)) return dark_;
        for (const Target::RoundHole& hole : target_.round_holes)
            if ((place - hole.centre).norm() < hole.radius) return dark_;
        return front_->at(place);
    }

   private:
    SharedTexture front_;
    Look dark_;
    Target target_;
};

/// The walls along a polygon of the front, from front to back.
void add_walls(World& world, const std::vector<Eigen::Vector2d>& polygon, double thickness,
               const Eigen::Isometry3d& T_world_board, const SharedTexture& texture) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d& from = polygon[i];
        const Eigen::Vector2d along = polygon[(i + 1) % polygon.size()] - from;
        const double length = along.norm();
        if (!(length > 0.0)) continue;
        Eigen::Isometry3d T_board_wall = Eigen::Isometry3d::Identity();
        T_board_wall.linear().col(0) << along / length, 0.0;
        T_board_wall.linear().col(1) = Eigen::Vector3d::UnitZ();
        T_board_wall.linear().col(2) =
            T_board_wall.linear().col(0).cross(T_board_wall.linear().col(1)).eval();
        T_board_wall.translation() << from, 0.0;
        world.add(std::make_unique<PlanarSurface>(T_world_board * T_board_wall,
                                                  PlanarSurface::rectangle(length, thickness),
                                                  texture, Kind::board));
    }
}

}  // namespace

SharedTexture board_texture(const Target& target) {
    const Look light = light_look(target), dark = dark_look(target);
    auto plain = std::make_shared<PlainTexture>(light);
    std::vector<OverlayTexture::Part> prints;
    for (const Target::Checkerboard& board : target.checkerboards)
        prints.push_back(
            {box_at(board.corner, board.columns * board.square, board.rows * board.square),
             std::make_shared<CheckerTexture>(dark, light, board.square)});
    for (const Target::Marker& marker : target.markers)
        prints.push_back({box_at(marker.corner, marker.size, marker.size),
                          std::make_shared<MarkerTexture>(marker.dictionary, marker.id, marker.size,
                                                          dark, light)});
    if (prints.empty()) return plain;
    return std::make_shared<OverlayTexture>(std::move(plain), std::move(prints));
}

SharedTexture look_alike_texture(const Target& target) {
    return std::make_shared<LookAlikeTexture>(board_texture(target), dark_look(target), target);
}

void add_board(World& world, const Target& target, const Eigen::Isometry3d& T_world_board) {
    PlanarSurface::Shape face{target.outline, target.holes, {}};
    for (const Target::RoundHole& hole : target.round_holes)
        face.round_holes.push_back({hole.centre, hole.radius});
    world.add(
        std::make_unique<PlanarSurface>(T_world_board, face, board_texture(target), Kind::board));
    if (!(target.thickness > 0.0)) return;

    const auto plain = std::make_shared<PlainTexture>(light_look(target));
    Eigen::Isometry3d T_world_back = T_world_board;
    T_world_back.translate(Eigen::Vector3d(0.0, 0.0, target.thickness));
    world.add(std::make_unique<PlanarSurface>(T_world_back, std::move(face), plain, Kind::board));
    add_walls(world, target.outline, target.thickness, T_world_board, plain);
    for (const auto& hole : target.holes)
        add_walls(world, hole, target.thickness, T_world_board, plain);
    for (const Target::RoundHole& hole : target.round_holes) {
        Eigen::Isometry3d T_world_hole = T_world_board;
        T_world_hole.translate(Eigen::Vector3d(hole.centre.x(), hole.centre.y(), 0.0));
        world.add(std::make_unique<CylinderSurface>(T_world_hole, hole.radius, target.thickness,
                                                    plain, Kind::board));
    }
}

}  // namespace petal::simulation
