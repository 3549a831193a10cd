// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "simulation/lidar/lidar_profile.hpp"
#include "simulation/world/surface.hpp"

namespace petal::simulation {

/// A part of a pulse's footprint that meets one surface at nearly one range.
struct Patch {
    const Surface* surface = nullptr;
    double range = 0.0;   ///< m, mean over the patch by energy
    double energy = 0.0;  ///< of a white surface met squarely at 1 m by the whole footprint: 1
    double share = 0.0;   ///< of the footprint
    double nearest = 0.0, farthest = 0.0;  ///< m
};

/// One echo of a pulse.
struct Echo {
    double range = 0.0;   ///< m, where the received waveform peaks, without the late error
    double energy = 0.0;  ///< height of the peak: that of a patch alone is the patch's energy
    double share = 0.0;   ///< of the footprint that the peak is made of
};

/// What a receiver makes of a pulse that came back from several surfaces.
///
/// Each patch sends back a Gaussian pulse. The waveform is their sum, and echoes are its peaks. Two
/// surfaces that are nearer than the pulse is wide give one peak, at a range between theirs;
/// farther apart each gives its own.
class Receiver {
   public:
    explicit Receiver(const LidarProfile& profile);

    /// All peaks, nearest first, however weak. `patches` must be ordered by range.
    std::vector<Echo> echoes(const std::vector<Patch>& patches) const;
    /// The one that the sensor tells: the first or the strongest of those that are above its limit.
    std::optional<Echo> told(const std::vector<Patch>& patches) const;
    /// m by which an echo comes late: a receiver sees the pulse once it rises over a threshold, so
    /// a weaker one later; what the receiver cannot correct is late_error for each factor e of
    /// energy that the echo lacks to that of a whole footprint.
    double lateness(const Echo& echo) const;

   private:
    Echo climb(const std::vector<Patch>& patches, double from) const;
    /// The peaks, nearest first, until `visit` answers true.
    template <class Visit>
    void visit(const std::vector<Patch>& patches, Visit&& visit) const;

    double sharpness_;  ///< 1 / (2 sigma^2), 1/m^2
    double limit_;
    double late_error_;
    LidarProfile::Return returned_;
};

}  // namespace petal::simulation
