// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <utility>

#include "petal/calibration/extrinsics.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct ResultSourceParams {
    std::filesystem::path file = "${data}/result.json";
};

/// `source.result`: the extrinsics of an earlier run.
class ResultSource final : public Stage {
   public:
    using Params = ResultSourceParams;
    static void describe(Spec<Params>& spec);
    explicit ResultSource(Params params) : params_(std::move(params)) {}
    void run(Run& run) override;

   private:
    Params params_;
    bool done_ = false;
};

/// Reads what a calibration's result.json tells of its cameras: labels, T_camera_lidar, covariance
/// and the verdict. Intrinsics and residuals are not in it. \throws Error naming the file, line and
/// key: cannot be read, no JSON, no result, nothing solved, a matrix that is no rigid motion, a
/// covariance that is none, two entries of one camera and LiDAR.
Extrinsics read_result(const std::filesystem::path& file);

}  // namespace petal
