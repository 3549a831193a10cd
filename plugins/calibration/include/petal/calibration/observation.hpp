// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/serialization/CSerializable.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "petal/packet.hpp"

namespace petal {

/// Where an observation stood in a rawlog of actions and sensory frames, so that a sink can write
/// that layout again. As it is by default: an observation on its own.
struct RawlogPlace {
    using Objects = std::vector<std::shared_ptr<const mrpt::serialization::CSerializable>>;

    Objects before;           ///< what stood before it and is no observation: actions, empty frames
    Objects after;            ///< the same behind the last observation of all
    bool in_frame = false;    ///< it is part of a sensory frame ...
    bool ends_frame = false;  ///< ... and the last of it
};

/// One observation of a rawlog, as it came. Never null in a packet. It is shared: who changes one
/// makes a new one, e.g. `Observation changed = in; changed.observation = ...`, which keeps its
/// place.
///
/// Sealing loads what lies in other files and fills the caches of the poses, points maps and images
/// of MRPT's usual sensors. Of other classes read the pose by getSensorPose(), which copies it. Do
/// not build a scan's auxiliary points map (`buildAuxPointsMap`): MRPT stores it inside.
struct Observation {
    mrpt::obs::CObservation::Ptr observation;
    RawlogPlace place{};
};

template <>
struct PacketTraits<Observation> {
    static constexpr const char* name = "Observation";
    static void seal(Observation& observation);
    static std::size_t bytes(const Observation& observation);
};

}  // namespace petal
