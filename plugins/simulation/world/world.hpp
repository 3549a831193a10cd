// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "simulation/world/surface.hpp"

namespace petal::simulation {

/// All surfaces of a scene. Filled once, then read by any number of threads.
///
/// Rays are cast through a tree of bounding boxes, in double precision throughout: the same ray
/// gives the same bits on every machine.
class World {
   public:
    void add(std::unique_ptr<Surface> surface) { surfaces_.push_back(std::move(surface)); }
    /// To be called after the last add() and before the first cast().
    void build();

    /// The first surface on the ray within `farthest` m; hit.surface is null where there is none.
    Hit cast(const Ray& ray, double farthest) const;
    /// Whether anything lies on the ray within `farthest` m: for shadows.
    bool blocked(const Ray& ray, double farthest) const;

    std::size_t size() const { return surfaces_.size(); }

   private:
    struct Node {
        Eigen::AlignedBox3d box;
        std::size_t first = 0;  ///< of its surfaces in order_, or of its two children in nodes_
        std::size_t count = 0;  ///< surfaces; 0: an inner node
    };
    void split(std::size_t node, std::size_t first, std::size_t count);
    template <class Visit>
    void walk(const Ray& ray, const Hit& nearest, Visit&& visit) const;

    std::vector<std::unique_ptr<Surface>> surfaces_;
    std::vector<const Surface*> order_;
    std::vector<Node> nodes_;
};

}  // namespace petal::simulation
