// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <string>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/truth.hpp"
#include "petal/run.hpp"
#include "simulation/scene/scene_file.hpp"

namespace petal {

struct SimulatedPackets {
    double stamp = 0.0;  ///< s since the epoch: the scene's beginning
    Cloud cloud;
    Images images;
    Truth truth;
};

/// Simulates the sensors of `rig` in a scene. `number` counts the scenes of a run: they lie a
/// minute apart in time. `image_choice`: sharpest, first or last. Random numbers come from
/// run.rng().
SimulatedPackets simulate_packets(const simulation::Scene& scene, const simulation::Rig& rig,
                                  std::size_t number, const std::string& image_choice, Run& run);

}  // namespace petal
