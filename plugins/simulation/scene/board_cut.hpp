// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/calibration/target.hpp"
#include "simulation/world/random.hpp"

namespace petal::simulation {

/// The target as a saw would make it: every straight side of outline and holes moved by a normally
/// distributed error of `sigma` (m) into or out of the plate, every round hole moved, and larger or
/// smaller, by such errors. Prints stay where they are.
Target cut_board(const Target& target, double sigma, Engine& engine);

}  // namespace petal::simulation
