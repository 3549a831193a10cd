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
    constexpr int kMiddle = kAcross / 2;
    std::array<Line, kAcross> lines;
    lines[kMiddle][1] = sample(kAlong / 2, kMiddle);
    bool whole = true;
    for (const int across : {0, kAcross - 1})
        for (const std::size_t end : {0U, 2U}) {
            Sample& corner = lines[static_cast<std::size_t>(across)][end];
            corner = sample(end == 0 ? 0 : kAlong - 1, across);
            whole = whole && alike(lines[kMiddle][1], corner);
        }
    if (whole) {
        take_whole(lines);
        return patches_;
    }
    lines[0][1] = sample(kAlong / 2, 0);
    lines[kMiddle][0] = sample(0, kMiddle);
    lines[kMiddle][2] = sample(kAlong - 1, kMiddle);
    lines[kAcross - 1][1] = sample(kAlong / 2, kAcross - 1);
    for (int across = 0; across < kAcross; ++across)
        take_line(across, lines[static_cast<std::size_t>(across)]);
    std::sort(patches_.begin(), patches_.end(),
              [](const Patch& a, const Patch& b) { return a.range < b.range; });
    return patches_;
}

void Footprint::take_whole(const std::array<Line, kAcross>& lines) {
    const Sample& centre = lines[kAcross / 2][1];
    if (centre.hit.surface == nullptr) return;
    Patch patch{centre.hit.surface, centre.hit.range, centre.energy, 1.0,
                centre.hit.range,   centre.hit.range};
    for (const int across : {0, kAcross - 1})
        for (const std::size_t end : {0U, 2U}) {
            const Sample& corner = lines[static_cast<std::size_t>(across)][end];
            patch.energy += corner.energy;
            patch.nearest = std::min(patch.nearest, corner.hit.range);
            patch.farthest = std::max(patch.farthest, corner.hit.range);
        }
    patch.energy /= 5.0;
    if (patch.energy > 0.0) patches_.push_back(patch);
}

void Footprint::take_line(int across, const Line& line) {
    for (const Sample& sample : line) add(sample.hit.surface, sample.hit.range, sample.energy);
    fill(across, 0, kAlong / 2, line[0], line[1]);
    fill(across, kAlong / 2, kAlong - 1, line[1], line[2]);
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
