// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/world/window_texture.hpp"

#include "simulation/world/hash_noise.hpp"
#include "simulation/world/look_mix.hpp"

namespace petal::simulation {

Look WindowTexture::at(const Eigen::Vector2d& place) const {
    const Eigen::Vector2d cell = place.cwiseQuotient(layout_.pitch).array().floor();
    // From the upper left of the window, which sits in the middle of its cell.
    const Eigen::Vector2d p =
        place - cell.cwiseProduct(layout_.pitch) - 0.5 * (layout_.pitch - layout_.size);
    if (p.minCoeff() < 0.0 || (layout_.size - p).minCoeff() < 0.0) return wall_->at(place);
    if (p.minCoeff() < layout_.frame || (layout_.size - p).minCoeff() < layout_.frame)
        return frame_;
    const Eigen::Vector2d pane =
        (layout_.size.array() - 2.0 * layout_.frame) / static_cast<double>(layout_.panes);
    for (int axis = 0; axis < 2; ++axis) {
        const double across = std::fmod(p(axis) - layout_.frame, pane(axis));
        const double bar = 0.25 * layout_.frame;  // half of one between two panes
        const bool at_rim =
            p(axis) - layout_.frame < bar || layout_.size(axis) - layout_.frame - p(axis) < bar;
        if (!at_rim && (across < bar || pane(axis) - across < bar)) return frame_;
    }
    const double lightness =
        hash_noise(static_cast<std::int64_t>(cell.x()), static_cast<std::int64_t>(cell.y()), seed_);
    return scale_look(glass_, 0.5 + lightness);
}

}  // namespace petal::simulation
