// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

namespace petal {

inline constexpr double kPi = 3.14159265358979323846;
/// Degrees in a radian: to tell an angle, which is kept in radians, in degrees.
inline constexpr double kDegrees = 180.0 / kPi;

}  // namespace petal
