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

struct ColoredCloudParams {
    std::vector<std::string> formats = {"ply", "3Dscene"};
    std::string uncolored = "grey";
    int cell_px = 0;
    double slack = 0.1;
    double slack_share = 0.05;
};

/// `sink.colored_cloud`: clouds in the colours of the photos.
class ColoredCloud final : public Stage {
   public:
    using Params = ColoredCloudParams;
    static void describe(Spec<Params>& s);
    explicit ColoredCloud(Params params) : params_(std::move(params)) {}
    void finish(Run& run) override;

   private:
    Params params_;
};

}  // namespace petal
