// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "scene.hpp"

namespace petal::synthetic {

/// The camera's grey photo of the scene: bright boards before a darker, uneven background, blurred
/// by the lens and noisy.
cv::Mat take_photo(const Scene& scene, std::uint64_t seed);

}  // namespace petal::synthetic
