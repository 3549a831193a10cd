// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/obs/CObservation.h>

#include <cstddef>

#include "petal/packet.hpp"

namespace petal {

/// One observation of a rawlog, as it came. Never null in a packet.
struct Observation {
    mrpt::obs::CObservation::Ptr observation;
};

template <>
struct PacketTraits<Observation> {
    static constexpr const char* name = "Observation";
    static void seal(Observation& observation);
    static std::size_t bytes(const Observation& observation);
};

}  // namespace petal
