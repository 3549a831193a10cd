// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Geometry>
#include <memory>

#include "petal/calibration/target.hpp"
#include "simulation/world/texture.hpp"
#include "simulation/world/world.hpp"

namespace petal::simulation {

/// The target as a plate of its thickness: front with holes and prints, back, outer sides, and the
/// walls of the holes, so that both sensors see how thick it is. All of it is Kind::board.
void add_board(World& world, const Target& target, const Eigen::Isometry3d& T_world_board);

/// The front with its prints. Places are in the board's frame, m.
std::shared_ptr<const Texture> board_texture(const Target& target);

/// A flat look-alike: the same front, with what is dark where the target has its holes.
std::shared_ptr<const Texture> look_alike_texture(const Target& target);

}  // namespace petal::simulation
