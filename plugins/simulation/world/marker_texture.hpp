// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

#include "simulation/world/texture.hpp"

namespace petal::simulation {

/// One ArUco marker with its black border, `size` m wide, its upper left corner at the origin.
class MarkerTexture final : public Texture {
   public:
    /// `dictionary` as in target files: "6x6_250". \throws Error for one that OpenCV does not have,
    /// or an id that is not in it.
    MarkerTexture(const std::string& dictionary, int id, double size, const Look& dark,
                  const Look& light);
    Look at(const Eigen::Vector2d& place) const override;

   private:
    int side_ = 0;             ///< cells, with the border
    std::vector<bool> light_;  ///< of each cell, row by row
    double size_;
    Look dark_, bright_;
};

}  // namespace petal::simulation
