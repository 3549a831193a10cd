// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/lidar/echo.hpp"

#include <algorithm>
#include <cmath>

namespace petal::simulation {
namespace {

constexpr double kWidthInSigmas = 2.354820045;  // of a Gaussian at half its height
constexpr double kSettled = 1e-5;               // m
constexpr double kSamePeak = 1e-3;              // m
constexpr double kNothing = 25.0;               // e^-25 of a pulse
constexpr int kMostSteps = 200;

}  // namespace

Receiver::Receiver(const LidarProfile& profile)
    : sharpness_(kWidthInSigmas * kWidthInSigmas /
                 (2.0 * profile.pulse_width * profile.pulse_width)),
      limit_(profile.detection_energy()),
      late_error_(profile.late_error),
      returned_(profile.returned) {}

/// Mean shift: in one dimension and with a Gaussian it climbs to the next peak without passing it.
/// Where the waveform bends as at a peak, Newton's step is the longer one and is taken as long as
/// it is short beside the pulse.
Echo Receiver::climb(const std::vector<Patch>& patches, double from) const {
    const double short_step = 0.2 / std::sqrt(2.0 * sharpness_);
    const double reach = std::sqrt(kNothing / sharpness_);
    Echo echo;
    echo.range = from;
    for (int step = 0; step < kMostSteps; ++step) {
        double moment = 0.0, bend = 0.0;
        echo.energy = 0.0;
        echo.share = 0.0;
        for (const Patch& patch : patches) {
            const double away = patch.range - echo.range;
            if (away < -reach) continue;
            if (away > reach) break;
            const double exponent = sharpness_ * away * away;
            const double height = std::exp(-exponent);
            moment += height * patch.energy * away;
            bend += height * patch.energy * (1.0 - 2.0 * exponent);
            echo.energy += height * patch.energy;
            echo.share += height * patch.share;
        }
        const bool near_peak = bend > 0.0 && std::abs(moment) < short_step * bend;
        const double shift = moment / (near_peak ? bend : echo.energy);
        echo.range += shift;
        if (std::abs(shift) < kSettled) break;
    }
    return echo;
}

template <class Visit>
void Receiver::visit(const std::vector<Patch>& patches, Visit&& visit) const {
    // The waveform between where a climb began and its peak leads up to that peak.
    double begun = 0.0;
    double peak = -1.0;
    for (const Patch& patch : patches) {
        if (patch.range >= begun && patch.range <= peak) continue;
        const Echo echo = climb(patches, patch.range);
        begun = patch.range;
        if (std::abs(echo.range - peak) < kSamePeak) continue;
        peak = echo.range;
        if (visit(echo)) return;
    }
}

std::vector<Echo> Receiver::echoes(const std::vector<Patch>& patches) const {
    std::vector<Echo> all;
    visit(patches, [&](const Echo& echo) {
        all.push_back(echo);
        return false;
    });
    return all;
}

std::optional<Echo> Receiver::told(const std::vector<Patch>& patches) const {
    std::optional<Echo> best;
    double all = 0.0;
    for (const Patch& patch : patches) all += patch.energy;
    if (all < limit_) return best;  // far ground at a grazing angle: many patches, and no echo
    visit(patches, [&](const Echo& echo) {
        if (echo.energy < limit_ || (best && echo.energy <= best->energy)) return false;
        best = echo;
        return returned_ == LidarProfile::Return::first;
    });
    return best;
}

double Receiver::lateness(const Echo& echo) const {
    return late_error_ * -std::log(std::min(echo.share, 1.0));
}

}  // namespace petal::simulation
