// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

#include "petal/calibration/extrinsics.hpp"
#include "petal/run.hpp"
#include "sinks/detail/result_json.hpp"

namespace petal {

/// A level with the reasons why it is not better.
struct Judgement {
    Level level = Level::usable;
    std::vector<std::string> reasons;
};

/// What metrics and board detectors found, each reason once. Those of detectors name their scene
/// where there are several, and make the result weak.
Judgement found_by_checks(const ResultInput& input);

/// Lowers the verdict of the input's extrinsics (a changed copy of them) by what checks found,
/// which is returned.
Judgement judge(ResultInput& input);

/// Lowers the level to that of the findings, and adds their reasons behind its own.
void lower(Extrinsics& extrinsics, const Judgement& found);

}  // namespace petal
