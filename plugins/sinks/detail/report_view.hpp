// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "petal/run.hpp"
#include "sinks/detail/scene_view.hpp"

namespace petal {

/// Where each scene (by frame number) stands in the list "scenes" of result.json.
using ScenePlaces = std::map<std::uint64_t, std::size_t>;

/// The points of each scene's cloud (by frame number) that the 3D view shows, ascending: drawn by
/// lot, `max_points` over all scenes at most.
using ViewPoints = std::map<std::uint64_t, std::vector<std::size_t>>;
ViewPoints view_points(Rng& rng, const std::map<std::uint64_t, SceneView>& scenes,
                       std::size_t max_points);

/// What the report's 3D view shows beside result.json: of each scene with a cloud the points drawn,
/// those that a camera sees first, with its colour (the first camera that sees it; the others by
/// intensity, grey). Base64 of little-endian 16 bit
/// integers x y z, point = low + step * integer (m, LiDAR frame), and of bytes r g b. And of each
/// camera the directions of the photo's corners (x, y, 1) from the upper left, clockwise.
nlohmann::ordered_json report_view(const Run& run, const Extrinsics& extrinsics,
                                   const std::map<std::uint64_t, SceneView>& scenes,
                                   const ScenePlaces& places, const ViewPoints& points);

}  // namespace petal
