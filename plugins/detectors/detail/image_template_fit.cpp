// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_template_fit.hpp"

#include <cstddef>

#include "detectors/detail/image_template_solve.hpp"
#include "detectors/detail/median_value.hpp"

namespace petal {

namespace {

/// Neighbouring samples share pixels: they count as half as many independent ones.
constexpr double kSamplesShare = 2.0;
/// Of a hole: sides that scatter more about a first fit are no board's.
constexpr double kFarOff = 0.12;
constexpr double kSettled = 0.05;  ///< of a sigma
constexpr int kMostPasses = 12;
constexpr int kCoarseRounds = 4, kFineRounds = 8;

}  // namespace

FittedBoard TemplateFit::coarse(const TemplatePose& guess) const {
    FittedBoard board;
    board.pose = guess;
    board.plate_grey = plate_grey(guess);
    for (const double in_holes : {0.35, 0.3, 0.2}) {
        const EdgeReach reach{in_holes, 2.5, 14.0, 5, false};
        board.samples = sample_edges(edges_, model_, camera_, board.pose, board.shifts, reach);
        if (!solve_template(model_, limits_, noise_, {1.0, kCoarseRounds, false}, board))
            return board;
        if (board.hole_scatter > kFarOff * model_.hole_size()) return board;
    }
    const EdgeReach last{0.12, 2.0, 4.0, 5, false};
    board.samples = sample_edges(edges_, model_, camera_, board.pose, board.shifts, last);
    count(board, last);
    board.converged = true;
    return board;
}

FittedBoard TemplateFit::fine(const FittedBoard& coarse) const {
    FittedBoard board;
    board.pose = coarse.pose;
    board.shifts = coarse.shifts;
    board.plate_grey = plate_grey(coarse.pose);
    const EdgeReach wide{0.15, 2.0, 5.0, 12, true}, narrow{0.12, 1.5, 3.0, 40, true},
        last{0.12, 1.5, 3.0, 80, true};
    const auto pass = [&](const EdgeReach& reach, bool go_on) {
        board.samples = sample_edges(edges_, model_, camera_, board.pose, board.shifts, reach);
        return solve_template(model_, limits_, noise_, {kSamplesShare, kFineRounds, go_on}, board);
    };
    if (!pass(wide, false)) return board;
    // Where walls show, a shift of the board, smaller holes and brighter walls look much alike, and
    // sides get their weights back slowly on the way from one to the other.
    int passes = 0;
    do {
        if (!pass(narrow, true)) return board;
    } while (board.last_step > kSettled && ++passes < kMostPasses);
    if (!pass(last, true)) return board;
    board.samples = sample_edges(edges_, model_, camera_, board.pose, board.shifts, last);
    count(board, last);
    board.converged = true;
    return board;
}

double TemplateFit::plate_grey(const TemplatePose& pose) const {
    std::vector<double> greys;
    for (std::size_t i = 0; i < model_.plate_points().size(); i += 4) {
        const auto seen = pose.see(model_, camera_, model_.plate_points()[i]);
        if (const auto grey = seen ? edges_.grey(seen->pixel) : std::nullopt)
            greys.push_back(*grey);
    }
    return median_value(greys);
}

}  // namespace petal
