// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/lidar/echo.hpp"

#include <algorithm>
#include <cmath>

namespace petal::simulation {
namespace {

constexpr double kWidthInSigmas = 2.354820045;  // of a Gaussian at half its height
constexpr double kSettled = 1e-5;               // m
constexpr int kMostSteps = 500;

}  // namespace

Receiver::Receiver(const LidarProfile& profile)
    : sharpness_(kWidthInSigmas * kWidthInSigmas /
                 (2.0 * profile.pulse_width * profile.pulse_width)),
      limit_(profile.detection_energy()),
      late_error_(profile.late_error),
      returned_(profile.returned) {}

/// Mean shift: in one dimension and with a Gaussian it climbs to the next peak without passing it.
Echo Receiver::climb(const std::vector<Patch>& patches, double from) const {
    Echo echo;
    echo.range = from;
    for (int step = 0; step < kMostSteps; ++step) {
        double moment = 0.0;
        echo.energy = 0.0;
        echo.share = 0.0;
        for (const Patch& patch : patches) {
            const double away = patch.range - echo.range;
            const double height = std::exp(-sharpness_ * away * away);
            moment += height * patch.energy * away;
            echo.energy += height * patch.energy;
            echo.share += height * patch.share;
        }
        const double shift = moment / echo.energy;
        echo.range += shift;
        if (std::abs(shift) < kSettled) break;
    }
    return echo;
}

std::vector<Echo> Receiver::echoes(const std::vector<Patch>& patches) const {
    std::vector<Echo> all;
    double begun = 0.0;  // the waveform between here and the last peak leads up to that peak
    for (const Patch& patch : patches) {
        if (!all.empty() && patch.range >= begun && patch.range <= all.back().range) continue;
        const Echo echo = climb(patches, patch.range);
        begun = patch.range;
        const double apart = all.empty() ? 1.0 : std::abs(echo.range - all.back().range);
        if (apart > 100.0 * kSettled) all.push_back(echo);
    }
    return all;
}

std::optional<Echo> Receiver::told(const std::vector<Patch>& patches) const {
    std::optional<Echo> best;
    for (const Echo& echo : echoes(patches)) {
        if (echo.energy < limit_) continue;
        if (returned_ == LidarProfile::Return::first) return echo;
        if (!best || echo.energy > best->energy) best = echo;
    }
    return best;
}

double Receiver::lateness(const Echo& echo) const {
    return late_error_ * -std::log(std::min(echo.share, 1.0));
}

}  // namespace petal::simulation
