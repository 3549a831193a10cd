// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "petal/calibration/truth.hpp"

namespace petal {

/// Reads `folder`/truth.json, and labels.u8 where it lies beside it. An empty Truth where there
/// is no truth.json. Keys that petal does not know are passed over: simulators may tell more.
/// \throws Error naming the file and the key: no JSON, wrong shapes, labels that are not one a
/// point of `points` (where given), a label above 3.
Truth read_truth(const std::filesystem::path& folder, std::optional<std::size_t> points = {});

/// Writes all but the labels as JSON, and how many points have each label.
/// \throws Error where a number is not finite, or the file cannot be written.
void write_truth_json(const Truth& truth, const std::filesystem::path& file);

/// Writes the labels, one byte a point. \throws Error where the file cannot be written.
void write_truth_labels(const Truth& truth, const std::filesystem::path& file);

}  // namespace petal
