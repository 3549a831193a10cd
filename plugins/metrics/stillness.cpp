// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/stillness.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "metrics/detail/image_shift.hpp"
#include "metrics/detail/scene_name.hpp"
#include "petal/printed.hpp"

namespace petal {
namespace {

const char* const kSought = "motion of the boards during the capture";

/// "0.0-2.0 s".
std::string span(const TimeSplits& splits, std::size_t begin, std::size_t end) {
    return printed("%.1f-%.1f s", splits.length * static_cast<double>(begin),
                   splits.length * static_cast<double>(end));
}

void add_metric(Metrics& metrics, const Run& run, const std::string& name, double value,
                const std::string& unit) {
    metrics.values.push_back({"stillness." + name, value, unit, scene_name(run.frame())});
}

}  // namespace

void StillnessMetric::describe(Spec<Params>& s) {
    s.summary("Whether the boards stood still during the capture: splits of it compared, in mm.");
    s.doc(
        R"(**Points.** The capture is cut into splits of at least `split` seconds by the stamps of the LiDAR's messages. In
each the board's pose is measured from the raw points on and around it, against the whole capture:

- offset and two tilts: a plane, by robust least squares, through the points on the plate;
- shift along x and y and roll: where the plate ends. Each ray beside an edge of the outline or of a hole hit the plate or
  went past it. For every edge the whole capture tells how the share of hits falls across it (a logistic law with a
  place and a slope of its own, so whatever moves an edge outward or inward is in it), and the split's own shift
  and roll are those that make its hits and misses likeliest.

The largest motion of the board's middle or of a corner between two splits is told with its sigma. It is a finding
(weak) where it is more than `min_motion` and more than `sigmas` of its own sigma, the latter raised with the number
of comparisons, so that a still board is taken for a moving one about once in 400 captures, however many splits there are. The longest run
of splits among which nothing moved is told: `still_from_s`, `still_until_s`.

**Images.** Each image board is found again, up to 40 px away, in the first, the middle and the last image of its camera, as a whole
by correlation and then its corners by their gradients; the median shift of the corners is told in pixels and, by the board's known
size, in mm. The same limits apply. An image in which fewer than 4 corners are found again is a finding (weak) too: the board moved
farther, turned, or something hides it.

| name | what |
|---|---|
| stillness.board_1.motion_mm, sigma_mm | largest motion between two splits, board 1 of the LiDAR's |
| stillness.board_1.still_from_s, still_until_s | the longest still part of the capture |
| stillness.image_board_1.shift_px, shift_mm, sigma_mm | largest shift between two images |

**Limits.** Vibration faster than a split is not seen: it widens edges and planes alike in every split. What moves is not told: the
board or the sensors. A shift is not seen where nothing lies behind the board's edges that sends light back; offset and tilts still are
(a note tells). A board that turns about the middle of its corners moves no median of them in the image. Without stamps of messages, in captures
shorter than two splits, or with one image of a camera, nothing is compared, and a note says so.)");
    s.role("metric");
    s.reads<Cloud>("cloud", "the raw points of a scene, with the messages that they came in");
    s.reads<LidarBoards>("boards", "the boards to look at");
    s.reads<Images>("images", "all images of the scene").optional();
    s.reads<ImageBoards>("image_boards", "the boards to find again in them").optional();
    s.writes<Metrics>("metrics", "motions in mm with their sigma, and findings");
    s.param("split", &Params::split)
        .unit("s")
        .within(0.1, 3600.0)
        .doc("the shortest split of the capture");
    s.param("max_splits", &Params::max_splits).within(2, 100).doc("longer captures: longer splits");
    s.param("sigmas", &Params::sigmas)
        .unit("1")
        .within(1.0, 10.0)
        .doc("motion is a finding above so many sigmas (of one comparison)");
    s.param("min_motion", &Params::min_motion).unit("m").within(0.0, 1.0).doc("and above this");
    s.param("targets", &Params::targets)
        .doc("target files of boards that petal does not ship; the boards name them");
}

void StillnessMetric::run(Run& run) {
    Metrics metrics;
    look_at_points(run, metrics);
    look_at_images(run, metrics);
    run.write("metrics", std::move(metrics));
}

void StillnessMetric::look_at_points(Run& run, Metrics& metrics) {
    const auto& cloud = run.in<Cloud>("cloud");
    const auto& boards = run.in<LidarBoards>("boards").boards;
    if (boards.empty()) {
        run.note({kSought, "the LiDAR has no board", "", "see the notes of the board detector"});
        return;
    }
    std::string why;
    const TimeSplits splits =
        time_splits(cloud, p_.split, static_cast<std::size_t>(p_.max_splits), why);
    if (splits.size() < 2) {
        run.note({kSought, why, printed("split %.1f s", p_.split),
                  "give the raw cloud of the source, of a capture of 10 s or more"});
        return;
    }
    run.log(LogLevel::info, std::to_string(splits.size()) +
                                printed(" splits of %.1f s; vibration faster than that is not seen",
                                        splits.length));
    for (std::size_t i = 0; i < boards.size(); ++i) {
        run.check_cancelled();
        const std::string name = "board_" + std::to_string(i + 1);
        const std::string who = scene_name(run.frame()) + ": board " + std::to_string(i + 1);
        const Target& target = targets_.find(boards[i].target, run);
        const auto poses = split_poses(run, cloud, splits, boards[i], target);
        const auto motion = board_motion(poses, 0.5 * target.width(), 0.5 * target.height(),
                                         p_.sigmas, p_.min_motion);
        if (!motion) {
            run.note({"motion of " + who, "fewer than two splits hold points enough on the board",
                      "", "a longer capture; is the cloud the raw one?"});
            continue;
        }
        if (std::none_of(poses.begin(), poses.end(),
                         [](const auto& pose) { return pose && pose->sideways; }))
            run.note({"motion of " + who + " along its face",
                      "too few rays pass beside its edges and come back", "",
                      "put something behind the board; only offset and tilts were compared"});
        add_metric(metrics, run, name + ".motion_mm", motion->length * 1e3, "mm");
        add_metric(metrics, run, name + ".sigma_mm", motion->sigma * 1e3, "mm");
        const double from = splits.length * static_cast<double>(motion->still_begin);
        const double until = splits.length * static_cast<double>(motion->still_end);
        add_metric(metrics, run, name + ".still_from_s", from, "s");
        add_metric(metrics, run, name + ".still_until_s", until, "s");
        if (!motion->moved) continue;
        metrics.findings.push_back(
            {Level::weak, who +
                              printed(" moved %.1f mm (sigma %.1f) between ", motion->length * 1e3,
                                      motion->sigma * 1e3) +
                              span(splits, motion->from, motion->from + 1) + " and " +
                              span(splits, motion->to, motion->to + 1) + ", or the LiDAR did; " +
                              (motion->still_end - motion->still_begin > 1
                                   ? "no motion is seen in " +
                                         span(splits, motion->still_begin, motion->still_end)
                                   : std::string("no two splits agree")) +
                              "; fasten both and record again"});
    }
}

void StillnessMetric::look_at_images(Run& run, Metrics& metrics) {
    const auto images = run.find<Images>("images");
    const auto boards = run.find<ImageBoards>("image_boards");
    if (!images || !boards) return;
    std::set<std::string> told;
    for (std::size_t i = 0; i < boards->boards.size(); ++i) {
        run.check_cancelled();
        const ImageBoard& board = boards->boards[i];
        const auto spread = spread_images(*images, board.camera);
        if (spread.size() < 2) {
            if (told.insert(board.camera).second)
                run.note({"motion between images of camera '" + board.camera + "'",
                          "the scene has " + std::to_string(spread.size()) + " of them",
                          "at least 2", "record the first and the last moment of the capture"});
            continue;
        }
        const double radius = corner_radius(targets_.find(board.target, run).corners());
        const CameraImage* reference = board_image(*images, board.camera);
        const ImageShifts found =
            reference ? image_shifts(spread, *reference, board, radius) : ImageShifts();
        const std::string who =
            "image board " + std::to_string(i + 1) + " of camera '" + board.camera + "'";
        for (const ImageShifts::Lost& lost : found.lost)
            metrics.findings.push_back(
                {Level::weak,
                 scene_name(run.frame()) + ": " + who +
                     printed(": too few corners (%zu of %zu) are found again in the ", lost.corners,
                             board.corners.size()) +
                     lost.image + printed(" image, %.1f s", lost.seconds) +
                     " from that which it was measured in; it moved, the camera did, or something "
                     "hides it: look at that image, fasten both and record again"});
        const auto& shifts = found.shifts;
        const auto largest =
            std::max_element(shifts.begin(), shifts.end(),
                             [](const auto& a, const auto& b) { return a.metres < b.metres; });
        if (largest == shifts.end()) {
            if (found.lost.empty())
                run.note({who + " in the other images",
                          "fewer than 4 of its corners are found again", "", "look at the images"});
            continue;
        }
        const std::string name = "image_board_" + std::to_string(i + 1);
        add_metric(metrics, run, name + ".shift_px", largest->px.norm(), "px");
        add_metric(metrics, run, name + ".shift_mm", largest->metres * 1e3, "mm");
        add_metric(metrics, run, name + ".sigma_mm", largest->sigma_metres * 1e3, "mm");
        if (largest->metres <= p_.min_motion ||
            largest->metres <= p_.sigmas * largest->sigma_metres)
            continue;
        metrics.findings.push_back(
            {Level::weak,
             scene_name(run.frame()) + ": " + who + " moved " +
                 printed("%.1f mm (sigma %.1f), %.2f px, between the ", largest->metres * 1e3,
                         largest->sigma_metres * 1e3, largest->px.norm()) +
                 largest->from + " and the " + largest->to +
                 printed(" image, %.1f s apart", largest->seconds) +
                 ", or the camera did; fasten both and record again"});
    }
}

}  // namespace petal
