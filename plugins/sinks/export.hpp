// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <utility>
#include <vector>

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct ExportParams {
    std::vector<std::string> formats = {"ros1",       "ros2",   "autoware", "kalibr",
                                        "fast_livo2", "opencv", "mrpt"};
    std::string parent = "lidar";
    std::string camera_frame = "{camera}_optical_frame";
    std::string lidar_frame = "{lidar}";
};

/// `sink.export`: the extrinsics in the formats of other programs.
class Export final : public Stage {
   public:
    using Params = ExportParams;
    static void describe(Spec<Params>& s);
    explicit Export(Params params) : params_(std::move(params)) {}
    void finish(Run& run) override;

   private:
    Params params_;
};

}  // namespace petal
