// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/lidar/lidar_simulation.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "petal/calibration/for_pieces.hpp"
#include "simulation/lidar/echo.hpp"
#include "simulation/lidar/footprint.hpp"
#include "simulation/lidar/pointing.hpp"
#include "simulation/lidar/scan_pattern.hpp"
#include "simulation/world/random.hpp"

namespace petal::simulation {
namespace {

/// The intensity of a white surface met squarely: Livox sends reflectivities of 0 to 100 % of such
/// a one as 0 to 150, and leaves 151 to 255 to retroreflectors.
constexpr double kWhite = 150.0;
constexpr double kBrightest = 255.0;
/// As in labels.u8: how far from every surface a point must lie to be vacant, at least.
constexpr double kVacant = 0.02;  // m
/// How long the motors may have run before the capture.
constexpr double kLongestStart = 1000.0;  // s

std::uint8_t label_of(Kind kind) {
    switch (kind) {
        case Kind::board:
            return 1;
        case Kind::foreground:
            return 3;
        case Kind::background:
            break;
    }
    return 0;
}

/// m from `range` to what the footprint met of a surface; 0 within it.
double distance_to(const Surface* surface, const std::vector<Patch>& patches, double range) {
    double nearest = std::numeric_limits<double>::infinity();
    double farthest = 0.0;
    for (const Patch& patch : patches) {
        if (patch.surface != surface) continue;
        nearest = std::min(nearest, patch.nearest);
        farthest = std::max(farthest, patch.farthest);
    }
    return std::max({nearest - range, range - farthest, 0.0});
}

/// As in labels.u8, of a point that without noise would lie at `range`.
std::uint8_t label(const std::vector<Patch>& patches, double range, double sigma) {
    constexpr std::uint8_t kVacantPoint = 2;
    const Surface* nearest = nullptr;
    double distance = std::numeric_limits<double>::infinity();
    for (const Patch& patch : patches) {
        const double here = distance_to(patch.surface, patches, range);
        if (here >= distance) continue;
        nearest = patch.surface;
        distance = here;
    }
    if (nearest == nullptr || distance > std::max(3.0 * sigma, kVacant)) return kVacantPoint;
    return label_of(nearest->kind());
}

double to_steps(double value, double step) {
    return step > 0.0 ? std::round(value / step) * step : value;
}

/// Fires the pulses of one message.
class Shooter {
   public:
    Shooter(const World& world, const LidarDevice& device, const Motion& motion,
            const ScanPattern& pattern, std::uint64_t seed)
        : device_(device),
          profile_(device.profile),
          motion_(motion),
          pattern_(pattern),
          footprint_(world, device.profile),
          receiver_(device.profile),
          pointing_(device),
          engine_(seed) {}

    void shoot(std::int64_t pulse, LidarMessage& message) {
        const Eigen::Vector3d direction = pattern_.direction(pulse);
        Ray beam{Eigen::Vector3d::Zero(), direction};
        Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
        if (!motion_.still()) {
            const Eigen::Isometry3d pose =
                motion_.at(static_cast<double>(pulse) / profile_.points_per_second);
            beam = {pose.translation(), pose.linear() * direction};
            up = pose.linear().col(2);
        }
        const std::vector<Patch>& patches = footprint_.meet(beam, up);
        const auto echo = receiver_.told(patches);
        if (!echo || uniform(engine_, 0.0, 1.0) < profile_.dropout) return;
        const double true_range = echo->range + receiver_.lateness(*echo);
        const double sigma = profile_.range_noise(echo->energy);
        double range = true_range + device_.range_offset + normal(engine_, sigma);
        const Eigen::Vector3d reported = pointing_.reported(direction, engine_);
        const double intensity = brightness(*echo);
        if (range < profile_.range_min || range > profile_.range_max) return;
        if (profile_.quantised == LidarProfile::Quantised::range)
            range = to_steps(range, profile_.quantisation);
        add(range * reported, intensity, label(patches, true_range, sigma), message);
    }

   private:
    /// The reflectivity that the sensor takes the surface for: it knows the range, and neither the
    /// incidence nor how much of the beam came back. 0 to 1.
    double brightness(const Echo& echo) {
        const double reflectivity = echo.energy * echo.range * echo.range;
        const double noisy = reflectivity * (1.0 + normal(engine_, profile_.intensity_noise));
        return std::round(std::clamp(kWhite * noisy, 0.0, kBrightest)) / kBrightest;
    }

    void add(const Eigen::Vector3d& point, double intensity, std::uint8_t point_label,
             LidarMessage& message) const {
        const double step = profile_.quantised == LidarProfile::Quantised::coordinates
                                ? profile_.quantisation
                                : 0.0;
        message.x.push_back(static_cast<float>(to_steps(point.x(), step)));
        message.y.push_back(static_cast<float>(to_steps(point.y(), step)));
        message.z.push_back(static_cast<float>(to_steps(point.z(), step)));
        message.intensity.push_back(static_cast<float>(intensity));
        message.label.push_back(point_label);
    }

    const LidarDevice& device_;
    const LidarProfile& profile_;
    const Motion& motion_;
    const ScanPattern& pattern_;
    Footprint footprint_;
    Receiver receiver_;
    Pointing pointing_;
    Engine engine_;
};

}  // namespace

std::vector<LidarMessage> simulate_lidar(const World& world, const LidarDevice& device,
                                         const Motion& motion, double duration, std::uint64_t seed,
                                         const Run& run) {
    const LidarProfile& profile = device.profile;
    // Half a nanosecond forgives 0.3 s that is a little less in binary.
    const double pulses = std::floor((duration + 5e-10) * profile.points_per_second);
    const double per_message = profile.points_per_second / profile.messages_per_second;
    std::vector<LidarMessage> messages(
        pulses > 0.0 ? static_cast<std::size_t>(std::ceil(pulses / per_message - 1e-9)) : 0);
    const auto first_of = [&](std::size_t message) {
        return static_cast<std::int64_t>(
            std::min(pulses, std::ceil(static_cast<double>(message) * per_message - 1e-9)));
    };
    // The motors ran before the capture: another seed is another part of the pattern.
    Engine starter(mix(seed, 0));
    const ScanPattern pattern(profile, uniform(starter, 0.0, kLongestStart));
    on_run_threads(run, [&] {
        tbb::parallel_for(std::size_t{0}, messages.size(), [&](std::size_t i) {
            if (run.cancelled()) return;
            LidarMessage& message = messages[i];
            message.stamp = static_cast<double>(i) / profile.messages_per_second;
            Shooter shooter(world, device, motion, pattern, mix(seed, i + 1));
            for (std::int64_t pulse = first_of(i); pulse < first_of(i + 1); ++pulse)
                shooter.shoot(pulse, message);
        });
    });
    run.check_cancelled();
    return messages;
}

}  // namespace petal::simulation
