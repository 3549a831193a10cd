// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <vector>

#include "metrics/detail/error_figures.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/packet.hpp"
#include "petal/run.hpp"

namespace petal {

/// What the pairs of a scene miss by, all cameras together.
struct SceneErrors {
    FrameInfo frame;                ///< number and name; no stamp
    std::vector<PairError> errors;  ///< of the pairs that could be measured
    std::size_t lost = 0;           ///< pairs that do not project or hold no finite pixel
    std::size_t unsolved = 0;       ///< pairs of cameras without extrinsics
    std::size_t cameras = 0;        ///< solved or not, with pairs or without

    std::size_t pairs() const { return errors.size() + lost + unsolved; }
};

/// Projects the LiDAR point of every pair with its camera's pose and the model that the solver
/// used. Scenes come in the order of CameraPairs::scene; one that no packet tells a camera of is
/// not among them.
std::vector<SceneErrors> pair_errors(const Extrinsics& extrinsics,
                                     const std::vector<Packet<Correspondences>>& packets);

/// A note where pairs could not be measured, or there are none.
void note_unmeasured(Run& run, const std::vector<SceneErrors>& scenes);

}  // namespace petal
