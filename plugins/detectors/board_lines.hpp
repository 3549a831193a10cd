// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>

#include "detectors/detail/board_line_finder.hpp"
#include "petal/calibration/boards.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/planes.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct BoardLinesParams : BoardFinderParams {
    std::string target = "four_square_holes_500mm";
    double plane_threshold = 0.05;
};

/// Boards in planes of margin points, from the lines of their holes' sides: equations (4)(5) and
/// lines 13 to 21 of Algorithm 1 of the letter.
class BoardLines final : public Stage {
   public:
    using Params = BoardLinesParams;
    static void describe(Spec<Params>& s);
    explicit BoardLines(Params p) : p_(std::move(p)) {}
    void run(Run& run) override;

   private:
    Params p_;
};

}  // namespace petal
