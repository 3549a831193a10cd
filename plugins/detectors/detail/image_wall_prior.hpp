// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

namespace petal {

/// What is known of a plate's walls before a photo of it is seen. A wall is as bright as the front
/// times this, 1 sigma: it has the same colour, but the light falls on it from elsewhere (1.5 times
/// where the light comes from above and the board is pitched towards it).
constexpr double kWallBrightness = 0.9;
constexpr double kWallBrightnessSigma = 0.5;
/// px: holes look smaller or larger by this, 1 sigma, walls or not, as tone curve and blur have it.
constexpr double kInsetSigmaPx = 0.15;

/// How far an edge moves over a wall's width, 0 to 1 where the wall is between plate and what lies
/// behind in brightness: (wall - behind) / (plate - behind).
struct WallShare {
    double mean = 0.0, sigma = 0.0;
};

/// Before anything is measured of the walls, at an edge of contrast (plate - behind) / plate.
inline WallShare expected_wall_share(double contrast) {
    return {1.0 - (1.0 - kWallBrightness) / contrast, kWallBrightnessSigma / contrast};
}

}  // namespace petal
