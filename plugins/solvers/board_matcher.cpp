// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/board_matcher.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/printed.hpp"
#include "solvers/detail/matched_pairs.hpp"
#include "solvers/detail/matcher_scenes.hpp"
#include "solvers/detail/solve_input.hpp"

namespace petal {
namespace {

/// Boards are counted in the telling of what came of them.
struct BoardCounts {
    std::size_t lidar = 0;
    std::size_t image = 0;
    std::size_t shared = 0;  ///< at most, scene by scene

    std::string text() const {
        return std::to_string(lidar) + " LiDAR boards and " + std::to_string(image) +
               " image boards";
    }
};

BoardCounts count_boards(const MatcherCamera& camera) {
    BoardCounts counts;
    for (const MatcherScene& scene : camera.scenes) {
        counts.lidar += scene.lidar_boards();
        counts.image += scene.image.size();
        counts.shared += std::min(scene.lidar_boards(), scene.image.size());
    }
    return counts;
}

std::string told_name(const MatcherScene& scene) {
    return scene.name.empty() ? std::to_string(scene.number) : "'" + scene.name + "'";
}

/// Of more image boards than may be tried the largest ones, in their order; a note tells.
void keep_largest(Run& run, const std::string& camera, int max_image_boards, MatcherScene& scene) {
    const auto most = static_cast<std::size_t>(max_image_boards);
    if (scene.image.size() <= most) return;
    run.note(
        {"boards that camera '" + camera + "' sees in scene " + told_name(scene),
         std::to_string(scene.image.size()) + " image boards; only the " + std::to_string(most) +
             " largest are tried",
         "max_image_boards " + std::to_string(most),
         "a pattern of dark squares may have been taken for boards: see the detector's overlay"});
    const auto diagonal = [&](int board) {
        const auto& corners = scene.images->boards[static_cast<std::size_t>(board)].corners;
        return (corners.front() - corners.back()).norm();
    };
    std::stable_sort(scene.image.begin(), scene.image.end(),
                     [&](int a, int b) { return diagonal(a) > diagonal(b); });
    scene.image.resize(most);
    std::sort(scene.image.begin(), scene.image.end());
}

/// What the search came nearest to, for the note that nothing matched.
std::string nearest_miss(const BoardCounts& counts, const std::vector<BoardOrder>& found) {
    if (found.empty())
        return counts.text() + ", no pose puts a pair of them in front of the camera";
    const auto nearest =
        std::min_element(found.begin(), found.end(), [](const BoardOrder& a, const BoardOrder& b) {
            return a.worst_gate_ratio < b.worst_gate_ratio;
        });
    return printed(
        "%s; the best hypothesis leaves %.2f px RMS over %zu boards, %.1f times its gate",
        counts.text().c_str(), nearest->rms_px(), nearest->matches.size(),
        nearest->worst_gate_ratio);
}

/// Scenes with fewer matches than both sensors see boards, for a note; empty where there is none.
std::string scenes_with_less(const MatcherCamera& camera, const std::vector<CameraPairs>& pairs) {
    constexpr std::size_t kShown = 8;
    std::string names;
    std::size_t count = 0;
    for (std::size_t i = 0; i < camera.scenes.size(); ++i) {
        const MatcherScene& scene = camera.scenes[i];
        if (pairs[i].boards.size() >= std::min(scene.lidar_boards(), scene.image.size())) continue;
        if (++count <= kShown) names += (names.empty() ? "" : ", ") + told_name(scene);
    }
    return count > kShown ? names + " and " + std::to_string(count - kShown) + " more" : names;
}

std::vector<CameraPairs> match(Run& run, const MatcherCamera& camera,
                               const BoardMatcherParams& params) {
    std::vector<CameraPairs> result;
    for (const MatcherScene& scene : camera.scenes) {
        CameraPairs& pairs = result.emplace_back();
        pairs.scene = scene.number;
        pairs.scene_name = scene.name;
        pairs.camera = camera.camera;
        pairs.lidar = camera.lidar;
        pairs.model = camera.model;
        pairs.order.reason = "nothing matched";
    }
    const BoardCounts counts = count_boards(camera);
    const std::string sought =
        "boards that LiDAR '" + camera.lidar + "' and camera '" + camera.camera + "' both see";
    if (counts.shared == 0) {
        run.note({sought, counts.text() + ", none of them in one scene", "at least one of each",
                  "see the notes of the board detectors"});
        return result;
    }

    const CameraModel model = camera_model(camera.model, params.use_distortion);
    BoardSet boards(model, params);
    for (const MatcherScene& scene : camera.scenes)
        boards.add_scene(scene.lidar, *scene.images, scene.image);
    const BoardOrders orders(boards, [&run] { run.check_cancelled(); });
    const auto found = orders.search();
    const auto choice = choose_order(orders, found, params);
    if (!choice) {
        run.note({sought, nearest_miss(counts, found),
                  printed("gate %.3f m, at least %.1f px", params.gate, params.min_gate_px),
                  "check the target's size, the intrinsics, and whether the boards are the same"});
        return result;
    }
    add_matched_pairs(boards, *choice, params.lidar_sigma, result);

    const std::size_t matched = choice->order.matches.size();
    if (const std::string less = scenes_with_less(camera, result); !less.empty())
        run.note({sought,
                  std::to_string(matched) + " matched of " + counts.text() +
                      "; fewer than both sensors see in scene " + less,
                  "", "a board may be false, or lie where only one sensor sees it"});
    const OrderDecision& order = choice->decision;
    const std::string text = printed(
        "camera '%s': %zu boards in %zu scenes, RMS %.2f px, order by %s: ", camera.camera.c_str(),
        matched, camera.scenes.size(), order.rms_px, to_string(order.by));
    run.log(order.by == DecidedBy::undecided ? LogLevel::warning : LogLevel::info,
            text + order.reason);
    return result;
}

}  // namespace

void BoardMatcher::describe(Spec<Params>& s) {
    s.summary("Which LiDAR board is which image board, and in which rotation, over all scenes.");
    s.doc(
        R"(Takes boards in any order, also such as only one sensor sees, of any number of scenes, and needs no initial
guess. The letter sorts the corners by their relative position and does not say more; but a square board looks the
same in four rotations, and two boards side by side have a twin (rolled by 180 deg and swapped).

**All scenes together.** The rig is one in all scenes, so a pose says for every board of every scene which image board
it is and in which rotation; a LiDAR board can only be an image board of its own scene. Poses are tried, not
combinations of boards: the work grows with the boards, not exponentially. One camera is decided apart from another.

**Hypotheses.** Every (LiDAR board, image board) of one target, with both minima of the planar pose (IPPE), in every
rotation that maps the board's corners onto themselves (four for the square board; mirror images are none); and every
two of these, of one scene or of two, that agree on a pose within two gates each, each weighed by what its image knows
of it, since one board alone can place another many widths off. From each pose all LiDAR boards are projected and
assigned to the image boards of their scene (each to one at most, least sum of squared distances in units of the
board's size, at most 1.5 radii), with the rotation that fits best; the pose is refined on all of them in plain pixels,
and so on until the assignment stays. A pose with a board behind the camera, or showing its back, is dropped. The 160
hypotheses that explain most are followed.

**Order.** An order is the set of matches of all scenes with their rotations; reached from several hypotheses it is
still one, with its poses joined. A board is explained where its RMS is within max(`gate` f / depth, `min_gate_px`).
The orders that explain the most boards are compared; one that explains fewer is no rival, as it leaves a board
unexplained that another order explains. Rivals keep all the boards that they are compared over even beyond the
gate: so the runner-up's RMS is told as it is.

**Decision.** The data decide where the refined runner-up has `min_runner_up_ratio` times the RMS of the best or more,
both taken as at least `noise_floor_px` (else the ratio of two roundings would decide), and a chi-square that is larger
by `min_runner_up_chi2` or more; and where the best order leaves no more than noise. One board alone never decides: its
rotations fit alike by symmetry, and on real data a wrong one fits best as often as not. Otherwise the priors choose
among the orders inside the gate with at most `max_prior_ratio` times the best RMS: `upright` (the camera's up, -y, and
the LiDAR's +z within `upright_tolerance_deg`) and `max_baseline`. If just one satisfies them (or the next has
`min_runner_up_ratio` times its RMS), it is taken, decided by prior. Else the order is undecided, with the best one
given and the reason told. Every scene of a camera carries the one decision.

**Chi-square** counts each board as one measurement of six numbers, its place and rotation in the image against
those of the LiDAR, with the covariance of its corners in the image (the joint one where the detector knows it, else
that of each, times four) and that of its pose in the LiDAR frame (from `lidar_sigma` where it has none). It is taken
at its own minimum, and the runner-up's surplus (the least of all orders within their gates and of the one with the
least RMS) is divided by max(1, chi-square / degrees of freedom) of the best.

**Covariance of the pairs**: that of the image corner plus the LiDAR's noise as the camera sees it, from the board's
pose covariance, or from `lidar_sigma` where a board has none.

See docs/matching.md for what was measured.)");
    s.role("matcher");
    s.gathers<LidarBoards>("lidar", "boards in the LiDAR frame, of every scene");
    s.gathers<ImageBoards>("image", "boards of every camera and scene, raw pixels");
    s.writes<Correspondences>(
        "correspondences",
        "once: pairs of corners for each scene and camera, none where nothing matched");
    s.param("min_runner_up_ratio", &Params::min_runner_up_ratio)
        .unit("1")
        .within(1.0, 100.0)
        .doc("the data decide where the best other order has this many times the RMS or more");
    s.param("min_runner_up_chi2", &Params::min_runner_up_chi2)
        .unit("1")
        .within(0.0, 1000.0)
        .doc("and its chi-square lies this much above or more");
    s.param("noise_floor_px", &Params::noise_floor_px)
        .unit("px")
        .within(0.0, 10.0)
        .doc("RMS below it are taken as this when orders are compared");
    s.param("max_prior_ratio", &Params::max_prior_ratio)
        .unit("1")
        .within(1.0, 100.0)
        .doc("no prior chooses an order with more than this times the best RMS");
    s.param("upright", &Params::upright)
        .doc("prior: the camera's up and the LiDAR's +z point the same way");
    s.param("upright_tolerance_deg", &Params::upright_tolerance_deg)
        .unit("deg")
        .within(0.0, 180.0)
        .doc("how far apart the two may be; above 45 two rotations of a square board can pass");
    s.param("use_max_baseline", &Params::use_max_baseline)
        .doc("prior: the sensors are near each other");
    s.param("max_baseline", &Params::max_baseline)
        .unit("m")
        .within(0.0, 1000.0)
        .doc("largest distance of camera and LiDAR");
    s.param("gate", &Params::gate)
        .unit("m")
        .within(0.0001, 10.0)
        .doc("a board whose corners miss by more than this (RMS, on the board) is not explained");
    s.param("min_gate_px", &Params::min_gate_px)
        .unit("px")
        .within(0.0, 1000.0)
        .doc("the gate in the image is at least this");
    s.param("use_distortion", &Params::use_distortion)
        .doc(
            "project with the camera's distortion; off where the pixels are rectified (the "
            "letter)");
    s.param("max_image_boards", &Params::max_image_boards)
        .within(1, 100)
        .doc(
            "of more boards in one image only the largest are tried; the time grows with the "
            "square");
    s.param("lidar_sigma", &Params::lidar_sigma)
        .unit("m")
        .within(0.0, 1.0)
        .doc("1-sigma of a LiDAR corner along each axis where the board has no covariance");
}

void BoardMatcher::finish(Run& run) {
    // The packets live as long as these.
    const auto lidar = run.all<LidarBoards>("lidar");
    const auto image = run.all<ImageBoards>("image");
    Correspondences correspondences;
    for (MatcherCamera& camera : matcher_cameras(lidar, image)) {
        run.check_cancelled();
        for (MatcherScene& scene : camera.scenes)
            keep_largest(run, camera.camera, p_.max_image_boards, scene);
        for (CameraPairs& pairs : match(run, camera, p_))
            correspondences.cameras.push_back(std::move(pairs));
    }
    std::stable_sort(correspondences.cameras.begin(), correspondences.cameras.end(),
                     [](const auto& a, const auto& b) { return a.scene < b.scene; });
    run.write("correspondences", std::move(correspondences));
}

}  // namespace petal
