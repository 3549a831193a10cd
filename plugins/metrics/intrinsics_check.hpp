// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "metrics/detail/board_edges.hpp"
#include "petal/calibration/boards.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct IntrinsicsCheckParams {
    double centre_share = 0.15;
    double sigmas = 3.0;
    double min_bend_px = 0.3;
    std::vector<std::filesystem::path> targets;
};

/// `metric.intrinsics_check`: whether a camera's intrinsics can be those of its images.
class IntrinsicsCheck final : public Stage {
   public:
    using Params = IntrinsicsCheckParams;
    static void describe(Spec<Params>& s);
    explicit IntrinsicsCheck(Params params) : p_(std::move(params)), targets_(p_.targets) {}
    void run(Run& run) override;

   private:
    /// False where the intrinsics are no camera at all, so that nothing else can be asked.
    bool check_pinhole(const CameraImage& image, Metrics& metrics) const;
    void check_distortion(const CameraImage& image, const std::string& scene,
                          Metrics& metrics) const;
    void check_straightness(const CameraImage& image, const ImageBoards& boards, Run& run,
                            Metrics& metrics);

    Params p_;
    TargetsByName targets_;
};

}  // namespace petal
