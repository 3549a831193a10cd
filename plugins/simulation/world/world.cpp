// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/world/world.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace petal::simulation {
namespace {

constexpr std::size_t kLeaf = 2;    // surfaces: fewer boxes than that do not pay
constexpr std::size_t kLeast = 16;  // of a node's surfaces at least this part goes to each child
/// Deep enough for millions of surfaces, though every split were as uneven as it may be.
constexpr std::size_t kDepth = 256;

/// 1 over each component of a direction. That of zero is finite, so that a ray in a face of a box,
/// along it, does not make 0 * infinity of its distance to it.
Eigen::Vector3d inverse_of(const Eigen::Vector3d& direction) {
    constexpr double kLargest = 1e300;
    Eigen::Vector3d inverse = direction.cwiseInverse();
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(inverse(axis)) < kLargest)) inverse(axis) = kLargest;
    return inverse;
}

/// Where a ray enters a box; infinity where it misses it within `farthest`.
double entry(const Eigen::AlignedBox3d& box, const Ray& ray, const Eigen::Vector3d& inverse,
             double farthest) {
    double in = 0.0;
    double out = farthest;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (box.min()(axis) - ray.origin(axis)) * inverse(axis);
        const double b = (box.max()(axis) - ray.origin(axis)) * inverse(axis);
        in = std::max(in, std::min(a, b));
        out = std::min(out, std::max(a, b));
    }
    return in <= out ? in : std::numeric_limits<double>::infinity();
}

double area(const Eigen::AlignedBox3d& box) {
    const Eigen::Vector3d size = box.sizes();
    return size.x() * size.y() + size.y() * size.z() + size.z() * size.x();
}

using Surfaces = std::vector<const Surface*>::iterator;

/// Stable: which of two equal ones comes first must not depend on the library.
void sort_along(int axis, Surfaces begin, Surfaces end) {
    std::stable_sort(begin, end, [axis](const Surface* a, const Surface* b) {
        return a->bounds().center()(axis) < b->bounds().center()(axis);
    });
}

/// Where surfaces in order are best parted: rays meet a box as often as its area is large, and then
/// every surface in it is looked at. Sets `cost` and answers the number before the cut.
std::size_t best_cut(Surfaces begin, Surfaces end, double& cost) {
    const auto count = static_cast<std::size_t>(end - begin);
    std::vector<double> behind(count);  // cost of all from here on
    Eigen::AlignedBox3d box;
    for (std::size_t i = count; i-- > 1;) {
        box.extend(begin[static_cast<std::ptrdiff_t>(i)]->bounds());
        behind[i] = area(box) * static_cast<double>(count - i);
    }
    box.setEmpty();
    const std::size_t least = std::max<std::size_t>(1, count / kLeast);
    std::size_t cut = count / 2;
    cost = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < count; ++i) {
        box.extend(begin[static_cast<std::ptrdiff_t>(i) - 1]->bounds());
        const double here = area(box) * static_cast<double>(i) + behind[i];
        if (i < least || count - i < least || !(here < cost)) continue;
        cost = here;
        cut = i;
    }
    return cut;
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
    Eigen::AlignedBox3d box;
    for (std::size_t i = first; i < first + count; ++i) box.extend(order_[i]->bounds());
    nodes_[node].box = box;
    if (count <= kLeaf) {
        nodes_[node].first = first;
        nodes_[node].count = count;
        return;
    }
    const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = begin + static_cast<std::ptrdiff_t>(count);
    int best_axis = 0;
    std::size_t cut = 0;
    double least_cost = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        sort_along(axis, begin, end);
        double cost = 0.0;
        const std::size_t here = best_cut(begin, end, cost);
        if (cut > 0 && !(cost < least_cost)) continue;
        best_axis = axis;
        cut = here;
        least_cost = cost;
    }
    sort_along(best_axis, begin, end);
    const std::size_t children = nodes_.size();
    nodes_.resize(children + 2);
    nodes_[node].first = children;
    split(children, first, cut);
    split(children + 1, first + cut, count - cut);
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
    const Eigen::Vector3d inverse = inverse_of(ray.direction);
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
