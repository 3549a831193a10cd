// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/board_check.hpp"

#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "metrics/detail/other_plate.hpp"
#include "metrics/detail/scene_name.hpp"
#include "petal/calibration/boards.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/planes.hpp"
#include "petal/calibration/target.hpp"
#include "petal/printed.hpp"

namespace petal {
namespace {

constexpr double kOtherSize = 0.03;  // of a plate: nearer to the target's it is the target itself

}  // namespace

void BoardCheck::describe(Spec<Params>& s) {
    s.summary("Whether the boards are what their target file says: flat, and of its measures.");
    s.doc(R"(**Found boards** are measured in the raw points on and around them:

- flatness: the plate's points, 15 mm and more from every edge, in patches of 5 cm; the RMS of the patches' means about the
  plane, less what the points' own noise makes of it; and the bow, the greatest less the least height of a quadratic;
- pitch: each ray beside an edge hit the plate or went past it; for every side of a hole the place where half of them hit. The sides of all
  holes together tell shift, roll, growth (a beam of some width makes holes smaller by the same on all sides) and the
  factor by which the holes stand farther apart than the target's, in x and in y;
- width and height of the outline, less that growth.

A deviation is a finding beyond its limit and beyond `sigmas` of its own sigma. A wrong pitch means a wrong scale: the result is not usable.

**Boards that were not found**: a detector that knows the target's measures finds nothing on a board of others. So where a scene has no board of a target,
the raw points around every plane (wire `planes`) are searched for a plate that stands free, has the target's proportions,
0.6 to 1.6 times its size, and holes where that size puts them; it is told with its size and distance.

| name | what |
|---|---|
| board_check.board_1.flatness_mm, noise_mm | RMS of the surface; 1 sigma of single points |
| board_check.board_1.bow_mm, bow_sigma_mm | of the quadratic |
| board_check.board_1.pitch_x_percent, pitch_y_percent, and their `_sigma_percent` | holes farther apart than the target's |
| board_check.board_1.width_mm, height_mm, and their `_sigma_mm` | of the outline |
| board_check.other_plate_1.width_mm, height_mm | of a plate that is not the target |

**Limits.** An edge without returns from behind it cannot be measured; the figure is then left out. A constant offset of the ranges makes a
board seem larger or smaller by offset / range (0.2 % for 5 mm at 2.5 m). A twist is told by the bow.)");
    s.role("metric");
    s.reads<Cloud>("cloud", "the raw points of a scene");
    s.reads<LidarBoards>("boards", "the boards to measure");
    s.reads<Planes>("planes", "where to look for boards that were not found").optional();
    s.writes<Metrics>("metrics", "measures of the boards, and findings");
    s.param("sigmas", &Params::sigmas)
        .unit("1")
        .within(1.0, 100.0)
        .doc("a deviation is a finding beyond so many of its sigmas");
    s.param("max_bow", &Params::max_bow).unit("m").within(0.0, 1.0).doc("and beyond this: the bow");
    s.param("max_flatness", &Params::max_flatness)
        .unit("m")
        .within(0.0, 1.0)
        .doc("the RMS of the surface");
    s.param("max_pitch_error", &Params::max_pitch_error)
        .unit("1")
        .within(0.0, 1.0)
        .doc("the pitch of the holes against the target's, relative");
    s.param("max_size_error", &Params::max_size_error)
        .unit("m")
        .within(0.0, 1.0)
        .doc("the outline against the target's");
    s.param("targets", &Params::targets)
        .doc("the targets in use: shipped names or files; what the boards name is known besides");
}

bool BoardCheck::beyond(const Measured& measured, double expected, double limit) const {
    const double off = std::abs(measured.value - expected);
    return off > limit && off > p_.sigmas * measured.sigma;
}

void BoardCheck::run(Run& run) {
    Metrics metrics;
    const auto& cloud = run.in<Cloud>("cloud");
    const auto& boards = run.in<LidarBoards>("boards").boards;
    const std::string scene = scene_name(run.frame());
    for (std::size_t i = 0; i < boards.size(); ++i) {
        run.check_cancelled();
        const std::string who = scene + ": board " + std::to_string(i + 1);
        const Target& target = targets_.find(boards[i].target, run);
        const auto shape = board_shape(run, cloud, boards[i].T_lidar_board, target);
        if (!shape) {
            run.note({"the shape of " + who, "too few raw points lie on it", "",
                      "wire the source's raw cloud; is the board where the detector puts it?"});
            continue;
        }
        const std::string name = "board_check.board_" + std::to_string(i + 1) + ".";
        const auto tell = [&](const std::string& what, double value, const char* unit) {
            metrics.values.push_back({name + what, value, unit, scene});
        };
        const auto tell_measured = [&](const std::string& what, const char* unit,
                                       const std::optional<Measured>& measured, double times) {
            if (!measured) return;
            tell(what + "_" + unit, measured->value * times, unit);
            tell(what + "_sigma_" + unit, measured->sigma * times, unit);
        };
        tell("flatness_mm", shape->flatness * 1e3, "mm");
        tell("noise_mm", shape->noise * 1e3, "mm");
        tell_measured("bow", "mm", shape->bow, 1e3);
        tell_measured("pitch_x", "percent", shape->pitch_x, 100.0);
        tell_measured("pitch_y", "percent", shape->pitch_y, 100.0);
        tell_measured("width", "mm", shape->width, 1e3);
        tell_measured("height", "mm", shape->height, 1e3);
        judge(*shape, target, who, metrics);
    }
    look_for_others(run, metrics);
    run.write("metrics", std::move(metrics));
}

void BoardCheck::judge(const BoardShape& shape, const Target& target, const std::string& who,
                       Metrics& metrics) const {
    const auto find = [&](Level level, const std::string& reason) {
        metrics.findings.push_back({level, who + reason});
    };
    if (beyond(shape.bow, 0.0, p_.max_bow)) {
        find(Level::weak, printed(" is bent: a bow of %.1f mm (sigma %.1f); flatten it, or take a "
                                  "stiffer one",
                                  shape.bow.value * 1e3, shape.bow.sigma * 1e3));
    } else if (shape.flatness > p_.max_flatness) {
        find(Level::weak,
             printed(" is not flat: %.1f mm RMS beyond the noise of ranges; flatten it, "
                     "or take a stiffer one",
                     shape.flatness * 1e3));
    }
    const std::string file = "the target file '" + target.name + "'";
    bool wrong_scale = false;
    for (const auto& [axis, pitch] :
         {std::pair<const char*, const std::optional<Measured>&>{"x", shape.pitch_x},
          {"y", shape.pitch_y}}) {
        if (!pitch || !beyond(*pitch, 0.0, p_.max_pitch_error)) continue;
        wrong_scale = true;
        find(Level::not_usable,
             printed(": its holes stand %.1f %% (sigma %.1f) %s each other in %s than ",
                     std::abs(pitch->value) * 100.0, pitch->sigma * 100.0,
                     pitch->value > 0.0 ? "farther from" : "nearer to", axis) +
                 file + " says; measure the board, and give the file that fits");
    }
    if (wrong_scale) return;  // the outline follows
    for (const auto& [what, size, expected] :
         {std::tuple<const char*, const std::optional<Measured>&, double>{"wide", shape.width,
                                                                          target.width()},
          {"high", shape.height, target.height()}})
        if (size && beyond(*size, expected, p_.max_size_error))
            find(Level::weak, printed(" is %.0f mm %s (sigma %.0f), but ", size->value * 1e3, what,
                                      size->sigma * 1e3) +
                                  file +
                                  printed(" says %.0f mm; measure the board", expected * 1e3));
}

void BoardCheck::look_for_others(Run& run, Metrics& metrics) const {
    const auto planes = run.find<Planes>("planes");
    if (!planes) return;
    const auto& boards = run.in<LidarBoards>("boards").boards;
    const std::string scene = scene_name(run.frame());
    int number = 0;
    for (const auto& file : p_.targets) {
        run.check_cancelled();
        const Target target = load_target(file);
        run.used_file(find_target_file(file));
        bool found = false;
        for (const LidarBoard& board : boards) found = found || board.target == target.name;
        if (found) continue;
        for (const OtherPlate& plate : other_plates(run, run.in<Cloud>("cloud"), *planes, target)) {
            if (std::abs(plate.scale - 1.0) < kOtherSize) {
                run.note(
                    {"boards '" + target.name + "' among the planes",
                     printed("a plate of %.2f x %.2f m with its holes stands at %.1f m, yet no "
                             "detector found it",
                             plate.width, plate.height, plate.range),
                     "", "see the notes of the board detector"});
                continue;
            }
            const std::string name = "board_check.other_plate_" + std::to_string(++number) + ".";
            metrics.values.push_back({name + "width_mm", plate.width * 1e3, "mm", scene});
            metrics.values.push_back({name + "height_mm", plate.height * 1e3, "mm", scene});
            metrics.findings.push_back(
                {Level::not_usable,
                 scene +
                     printed(": a plate of %.2f x %.2f m with holes like the target's stands at "
                             "%.1f m: the target file '",
                             plate.width, plate.height, plate.range) +
                     target.name +
                     printed("' says %.2f x %.2f m; measure the board, and give the file that fits",
                             target.width(), target.height())});
        }
    }
}

}  // namespace petal
