// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "simulation/world/random.hpp"
#include "simulation/world/texture.hpp"

namespace petal::simulation {

/// Windows in a grid on a wall of any texture: panes of glass in frames. Glass is dark, and sends
/// little back to a LiDAR, for both mirror what lies elsewhere.
class WindowTexture final : public Texture {
   public:
    struct Layout {
        Eigen::Vector2d pitch = {2.4, 3.2};  ///< m, from window to window
        Eigen::Vector2d size = {1.2, 1.7};   ///< m, with the frame
        double frame = 0.08;                 ///< m wide
        int panes = 2;  ///< side by side, and on top of each other, within one frame
    };
    WindowTexture(std::shared_ptr<const Texture> wall, const Look& frame, const Look& glass,
                  const Layout& layout, std::uint64_t seed)
        : wall_(std::move(wall)),
          frame_(frame),
          glass_(glass),
          layout_(layout),
          seed_(mix(seed, 0)) {}
    Look at(const Eigen::Vector2d& place) const override;

   private:
    std::shared_ptr<const Texture> wall_;
    Look frame_, glass_;
    Layout layout_;
    std::uint64_t seed_;
};

}  // namespace petal::simulation
