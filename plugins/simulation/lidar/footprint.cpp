// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/lidar/footprint.hpp"

#include <algorithm>
#include <cmath>

namespace petal::simulation {
namespace {

/// Parts of a surface at ranges nearer than this are one patch: a small part of any pulse's width.
constexpr double kPatch = 0.02;      // m
constexpr double kSamePlane = 1e-6;  // m, and of normals (1)

}  // namespace

Footprint::Footprint(const World& world, const LidarProfile& profile)
    : world_(world),
      range_max_(profile.range_max),
      upright_(profile.footprint_vertical >= profile.footprint_horizontal),
      long_side_(std::max(profile.footprint_vertical, profile.footprint_horizontal)),
      short_side_(std::min(profile.footprint_vertical, profile.footprint_horizontal)) {}

void Footprint::aim(const Ray& beam, const Eigen::Vector3d& up) {
    beam_ = beam;
    Eigen::Vector3d left = up.cross(beam.direction);
    if (!(left.squaredNorm() > kSamePlane)) left = beam.direction.unitOrthogonal();
    left.normalize();
    const Eigen::Vector3d above = beam.direction.cross(left);
    step_along_ = long_side_ / kAlong * (upright_ ? above : left);
    step_across_ = short_side_ / kAcross * (upright_ ? left : above);
    patches_.clear();
}

Footprint::Sample Footprint::sample(int along, int across) const {
    Ray ray = beam_;
    ray.direction += (along - kAlong / 2) * step_along_ + (across - kAcross / 2) * step_across_;
    ray.direction.normalize();
    Sample sample;
    sample.hit = world_.cast(ray, range_max_);
    const Hit& hit = sample.hit;
    if (hit.surface == nullptr) return sample;
    sample.point = ray.origin + hit.range * ray.direction;
    sample.energy = static_cast<double>(hit.surface->look(hit.place).reflectivity) *
                    std::max(0.0, -hit.normal.dot(ray.direction)) / (hit.range * hit.range);
    return sample;
}

/// Whether all between two rays can be taken to meet what they meet. Neighbours in one plane, such
/// as the tiles of a wall, count as one surface.
bool Footprint::alike(const Sample& a, const Sample& b) {
    if (a.hit.surface == b.hit.surface) return true;
    if (a.hit.surface == nullptr || b.hit.surface == nullptr) return false;
    return a.hit.surface->kind() == b.hit.surface->kind() &&
           (a.hit.normal - b.hit.normal).squaredNorm() < kSamePlane * kSamePlane &&
           std::abs(a.hit.normal.dot(b.point - a.point)) < kSamePlane;
}

const std::vector<Patch>& Footprint::meet(const Ray& beam, const Eigen::Vector3d& up) {
    aim(beam, up);
    const Sample centre = sample(kAlong / 2, kAcross / 2);
    // One diagonal, then the other: no slant of an edge is seen worse than another.
    falling_ = !falling_;
    const int start = falling_ ? kAcross - 1 : 0;
    const Sample low = sample(0, start);
    if (alike(centre, low)) {
        const Sample high = sample(kAlong - 1, kAcross - 1 - start);
        if (alike(centre, high)) {
            take_whole(centre, low, high);
            return patches_;
        }
    }
    for (int across = 0; across < kAcross; ++across) take_line(across);
    std::sort(patches_.begin(), patches_.end(),
              [](const Patch& a, const Patch& b) { return a.range < b.range; });
    return patches_;
}

void Footprint::take_whole(const Sample& centre, const Sample& low, const Sample& high) {
    const double energy = (centre.energy + low.energy + high.energy) / 3.0;
    if (centre.hit.surface == nullptr || !(energy > 0.0)) return;
    const auto [nearest, farthest] = std::minmax({centre.hit.range, low.hit.range, high.hit.range});
    patches_.push_back({centre.hit.surface, centre.hit.range, energy, 1.0, nearest, farthest});
}

void Footprint::take_line(int across) {
    const Sample low = sample(0, across);
    const Sample middle = sample(kAlong / 2, across);
    const Sample high = sample(kAlong - 1, across);
    for (const Sample& one : {low, middle, high}) add(one.hit.surface, one.hit.range, one.energy);
    fill(across, 0, kAlong / 2, low, middle);
    fill(across, kAlong / 2, kAlong - 1, middle, high);
}

/// Adds the rays between two of a line.
void Footprint::fill(int across, int low, int high, const Sample& at_low, const Sample& at_high) {
    if (high - low < 2) return;
    if (alike(at_low, at_high)) {
        if (at_low.hit.surface == nullptr) return;
        for (int along = low + 1; along < high; ++along) {
            const double way = static_cast<double>(along - low) / (high - low);
            add((way < 0.5 ? at_low : at_high).hit.surface,
                at_low.hit.range + way * (at_high.hit.range - at_low.hit.range),
                at_low.energy + way * (at_high.energy - at_low.energy));
        }
        return;
    }
    const int middle = (low + high) / 2;
    const Sample at_middle = sample(middle, across);
    add(at_middle.hit.surface, at_middle.hit.range, at_middle.energy);
    fill(across, low, middle, at_low, at_middle);
    fill(across, middle, high, at_middle, at_high);
}

void Footprint::add(const Surface* surface, double range, double whole_energy) {
    if (surface == nullptr || !(whole_energy > 0.0)) return;
    constexpr double kShare = 1.0 / (kAlong * kAcross);
    const double energy = whole_energy * kShare;
    for (Patch& patch : patches_) {
        const double nearest = std::min(patch.nearest, range);
        const double farthest = std::max(patch.farthest, range);
        if (patch.surface != surface || farthest - nearest > kPatch) continue;
        patch.energy += energy;
        patch.share += kShare;
        patch.range += (range - patch.range) * energy / patch.energy;
        patch.nearest = nearest;
        patch.farthest = farthest;
        return;
    }
    patches_.push_back({surface, range, energy, kShare, range, range});
}

}  // namespace petal::simulation
