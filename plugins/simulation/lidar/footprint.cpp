// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/lidar/footprint.hpp"

#include <algorithm>
#include <cmath>

namespace petal::simulation {
namespace {

/// Parts of a surface at ranges nearer than this are one patch: a fifth of the sigma of a 4 ns
/// pulse.
constexpr double kPatch = 0.05;      // m
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
    take_lines();
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

Footprint::Line Footprint::line(int across) const {
    return {sample(0, across), sample(kAlong / 2, across), sample(kAlong - 1, across)};
}

void Footprint::take_lines() {
    constexpr int kLast = kAcross - 1;
    const Line first = line(0), last = line(kLast);
    std::array<double, kAcross> weights{};
    weights[0] = weights[kLast] = 1.0;
    split_lines(0, kLast, first, last, weights);
    take_line(0, first, weights[0]);
    take_line(kLast, last, weights[kLast]);
}

/// Takes the lines between two; what is between two that are alike counts for those.
void Footprint::split_lines(int low, int high, const Line& at_low, const Line& at_high,
                            std::array<double, kAcross>& weights) {
    if (high - low < 2) return;
    const bool same = alike(at_low[0], at_high[0]) && alike(at_low[1], at_high[1]) &&
                      alike(at_low[2], at_high[2]);
    if (same) {
        const double half = 0.5 * (high - low - 1);
        weights[static_cast<std::size_t>(low)] += half;
        weights[static_cast<std::size_t>(high)] += half;
        return;
    }
    const int middle = (low + high) / 2;
    const Line at_middle = line(middle);
    double& weight = weights[static_cast<std::size_t>(middle)];
    weight = 1.0;
    split_lines(low, middle, at_low, at_middle, weights);
    split_lines(middle, high, at_middle, at_high, weights);
    take_line(middle, at_middle, weight);
}

void Footprint::take_line(int across, const Line& line, double weight) {
    for (const Sample& one : line) add(one.hit.surface, one.hit.range, one.energy, weight);
    split(across, 0, kAlong / 2, line[0], line[1], weight);
    split(across, kAlong / 2, kAlong - 1, line[1], line[2], weight);
}

/// Takes the rays between two of a line.
void Footprint::split(int across, int low, int high, const Sample& at_low, const Sample& at_high,
                      double weight) {
    if (high - low < 2) return;
    if (!alike(at_low, at_high)) {
        const int middle = (low + high) / 2;
        const Sample at_middle = sample(middle, across);
        add(at_middle.hit.surface, at_middle.hit.range, at_middle.energy, weight);
        split(across, low, middle, at_low, at_middle, weight);
        split(across, middle, high, at_middle, at_high, weight);
        return;
    }
    if (at_low.hit.surface == nullptr) return;
    // In as many parts as it takes for each to be a patch.
    const double deep = at_high.hit.range - at_low.hit.range;
    const int between = high - low - 1;
    const int parts =
        static_cast<int>(std::min<double>(between, std::ceil(2.0 * std::abs(deep) / kPatch + 0.5)));
    for (int part = 0; part < parts; ++part) {
        const double way = (part + 0.5) / parts;
        add((way < 0.5 ? at_low : at_high).hit.surface, at_low.hit.range + way * deep,
            at_low.energy + way * (at_high.energy - at_low.energy), weight * between / parts);
    }
}

void Footprint::add(const Surface* surface, double range, double whole_energy, double cells) {
    if (surface == nullptr || !(whole_energy > 0.0)) return;
    const double share = cells / (kAlong * kAcross);
    const double energy = whole_energy * share;
    for (Patch& patch : patches_) {
        const double nearest = std::min(patch.nearest, range);
        const double farthest = std::max(patch.farthest, range);
        if (patch.surface != surface || farthest - nearest > kPatch) continue;
        patch.energy += energy;
        patch.share += share;
        patch.range += (range - patch.range) * energy / patch.energy;
        patch.nearest = nearest;
        patch.farthest = farthest;
        return;
    }
    patches_.push_back({surface, range, energy, share, range, range});
}

}  // namespace petal::simulation
