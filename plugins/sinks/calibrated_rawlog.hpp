// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct CalibratedRawlogParams {
    std::vector<std::filesystem::path> files = {"${data}/scene.rawlog"};
    std::string reference;
    std::string file = "{stem}_calibrated.rawlog";
    int compression = -1;
};

/// `sink.calibrated_rawlog`: copies of rawlogs with the sensor poses that a calibration found.
class CalibratedRawlog final : public Stage {
   public:
    using Params = CalibratedRawlogParams;
    static void describe(Spec<Params>& spec);
    explicit CalibratedRawlog(Params params) : params_(std::move(params)) {}
    void finish(Run& run) override;

   private:
    Params params_;
};

}  // namespace petal
