// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <utility>

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct ReportParams {
    std::filesystem::path file = "report.html";
    int view_points = 200000;
    int picture_width = 1280;
    int picture_points = 20000;
    double residual_scale = 10.0;
};

/// Tells a calibration as a page to read: result.json in words, plots and pictures, in one file.
class Report final : public Stage {
   public:
    using Params = ReportParams;
    static void describe(Spec<Params>& s);
    explicit Report(Params params) : params_(std::move(params)) {}
    void finish(Run& run) override;

   private:
    Params params_;
};

}  // namespace petal
