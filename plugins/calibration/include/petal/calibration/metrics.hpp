// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "petal/packet.hpp"
#include "petal/run.hpp"

namespace petal {

/// A figure with its unit. `name` is the key in result.json and ends in the unit where that is not
/// SI: "reprojection.rms_px".
struct Metric {
    std::string name;
    double value = 0.0;
    std::string unit;   ///< "m", "deg", "px", "1"
    std::string scene;  ///< empty for the total
};

/// What a check found: a result may be of no higher level, and this is why.
struct Finding {
    Level level = Level::weak;
    std::string reason;  ///< plain words, naming scene, board or camera
};

struct Metrics {
    std::vector<Metric> values;
    std::vector<Finding> findings = {};  ///< sink.result lowers the verdict by them
};

template <>
struct PacketTraits<Metrics> {
    static constexpr const char* name = "Metrics";
    static void seal(Metrics& metrics);
    static std::size_t bytes(const Metrics& metrics);
};

}  // namespace petal
