// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/world/world.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace petal::simulation {
namespace {

constexpr std::size_t kLeaf = 2;  // surfaces: fewer boxes than that do not pay
/// Deep enough for 2^40 surfaces: the tree is split by halves.
constexpr std::size_t kDepth = 64;

/// Where a ray enters a box; infinity where it misses it within `farthest`. A direction of zero
/// gives infinities that compare as they should.
double entry(const Eigen::AlignedBox3d& box, const Ray& ray, const Eigen::Vector3d& inverse,
             double farthest) {
    double in = 0.0;
    double out = farthest;
    for (int axis = 0; axis < 3; ++axis) {
        double a = (box.min()(axis) - ray.origin(axis)) * inverse(axis);
        double b = (box.max()(axis) - ray.origin(axis)) * inverse(axis);
        if (a > b) std::swap(a, b);
        // NaN (a ray inside a face of the box, along it) must not close the interval.
        if (a > in) in = a;
        if (b < out) out = b;
    }
    return in <= out ? in : std::numeric_limits<double>::infinity();
}

}  // namespace

void World::build() {
    order_.clear();
    for (const auto& surface : surfaces_) order_.push_back(surface.get());
    nodes_.clear();
    if (order_.empty()) return;
    nodes_.reserve(2 * order_.size());
    nodes_.emplace_back();
    split(0, 0, order_.size());
}

void World::split(std::size_t node, std::size_t first, std::size_t count) {
    Eigen::AlignedBox3d box, centres;
    for (std::size_t i = first; i < first + count; ++i) {
        box.extend(order_[i]->bounds());
        centres.extend(order_[i]->bounds().center());
    }
    nodes_[node].box = box;
    if (count <= kLeaf) {
        nodes_[node].first = first;
        nodes_[node].count = count;
        return;
    }
    Eigen::Index axis = 0;
    centres.sizes().maxCoeff(&axis);
    const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(first);
    // Stable: which of two equal ones comes first must not depend on the library.
    std::stable_sort(begin, begin + static_cast<std::ptrdiff_t>(count),
                     [axis](const Surface* a, const Surface* b) {
                         return a->bounds().center()(axis) < b->bounds().center()(axis);
                     });
    const std::size_t half = count / 2;
    const std::size_t children = nodes_.size();
    nodes_.resize(children + 2);
    nodes_[node].first = children;
    split(children, first, half);
    split(children + 1, first + half, count - half);
}

/// Visits the surfaces of all leaves that the ray meets before nearest.range, near boxes first,
/// until `visit` answers true.
template <class Visit>
void World::walk(const Ray& ray, const Hit& nearest, Visit&& visit) const {
    if (nodes_.empty()) return;
    struct Entry {
        std::size_t node;
        double range;
    };
    std::array<Entry, kDepth> stack;
    std::size_t size = 0;
    const Eigen::Vector3d inverse = ray.direction.cwiseInverse();
    const double root = entry(nodes_[0].box, ray, inverse, nearest.range);
    if (root <= nearest.range) stack[size++] = {0, root};
    while (size > 0) {
        const Entry at = stack[--size];
        if (at.range > nearest.range) continue;
        const Node& node = nodes_[at.node];
        if (node.count > 0) {
            for (std::size_t i = node.first; i < node.first + node.count; ++i)
                if (visit(*order_[i])) return;
            continue;
        }
        Entry near{node.first, entry(nodes_[node.first].box, ray, inverse, nearest.range)};
        Entry far{node.first + 1, entry(nodes_[node.first + 1].box, ray, inverse, nearest.range)};
        if (near.range > far.range) std::swap(near, far);
        if (far.range <= nearest.range) stack[size++] = far;
        if (near.range <= nearest.range) stack[size++] = near;
    }
}

Hit World::cast(const Ray& ray, double farthest) const {
    Hit hit;
    hit.range = farthest;
    walk(ray, hit, [&](const Surface& surface) {
        surface.cast(ray, hit);
        return false;
    });
    return hit;
}

bool World::blocked(const Ray& ray, double farthest) const {
    Hit hit;
    hit.range = farthest;
    bool any = false;
    walk(ray, hit, [&](const Surface& surface) { return any = surface.cast(ray, hit); });
    return any;
}

}  // namespace petal::simulation
