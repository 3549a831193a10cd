// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/board_matcher.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "petal/calibration/se3.hpp"
#include "petal/error.hpp"
#include "petal/printed.hpp"
#include "solvers/detail/solve_input.hpp"
#include "solvers/detail/verdict.hpp"

namespace petal {
namespace {

void check(const LidarBoards& lidar, const ImageBoards& image) {
    for (std::size_t i = 0; i < lidar.boards.size(); ++i) {
        const LidarBoard& board = lidar.boards[i];
        bool good = board.corners.size() >= 4 && board.T_lidar_board.matrix().allFinite();
        for (const auto& corner : board.corners) good = good && corner.allFinite();
        if (!good)
            throw Error("LiDAR board " + std::to_string(i) + " ('" + board.target +
                        "') has fewer than four corners, or NaN in them; repair its detector");
    }
    for (std::size_t i = 0; i < image.boards.size(); ++i) {
        const ImageBoard& board = image.boards[i];
        bool good = board.corners.size() >= 4 &&
                    (board.covariance.empty() || board.covariance.size() == board.corners.size());
        for (const auto& corner : board.corners) good = good && corner.allFinite();
        if (!good)
            throw Error(
                "image board " + std::to_string(i) + " of camera '" + board.camera +
                "' has fewer than four corners, NaN in them, or a covariance for only some; "
                "repair its detector");
        if (std::none_of(image.cameras.begin(), image.cameras.end(),
                         [&](const CameraInfo& camera) { return camera.label == board.camera; }))
            throw Error("image board " + std::to_string(i) + " names camera '" + board.camera +
                        "', which is not among the cameras; its detector must list it");
    }
}

}  // namespace

void BoardMatcher::describe(Spec<Params>& s) {
    s.summary("Which LiDAR board is which image board, and in which rotation.");
    s.doc(
        R"(Takes boards in any order, also such as only one sensor sees, and needs no initial guess. The letter
sorts the corners by their relative position and does not say more; but a square board looks the same in
four rotations, and two boards side by side have a twin (rolled by 180 deg and swapped).

**Hypotheses.** Every (LiDAR board, image board) of one target, in every rotation that maps the board's corners
onto themselves (four for the square board; mirror images are none), with both minima of the planar pose
(IPPE) kept; and every two such pairs together (SQPNP), since one board alone can place another many widths
off. From each pose all LiDAR boards are projected and assigned to the image boards (each to one at
most, least sum of squared distances in units of the board's size, at most 1.5 radii), with the rotation that
fits best; the pose is refined on all of them in plain pixels, and so on until the assignment stays. A pose
with a board behind the camera, or showing its back, is dropped.

**Order.** An order is the set of matches with their rotations; reached from several hypotheses it is still one,
with its poses joined. A board is explained where its RMS is within max(`gate` f / depth, `min_gate_px`).
The orders that explain the most boards are compared; one that explains fewer is no rival, as it leaves a
board unexplained that another order explains. Rivals keep all the boards that they are compared over even
beyond the gate: so the runner-up's RMS is told as it is.

**Decision.** The data decide where the refined runner-up has `min_runner_up_ratio` times the RMS of the best
or more, both taken as at least `noise_floor_px` (else the ratio of two roundings would decide). One board alone
never decides: its rotations fit alike by symmetry, and on real data a wrong one fits best as often as not.
Otherwise the priors choose among the orders inside the gate with at most `max_prior_ratio` times the best RMS:
`upright` (the camera's up, -y, and the LiDAR's +z within `upright_tolerance_deg`) and `max_baseline`. If just
one satisfies them (or the next has `min_runner_up_ratio` times its RMS), it is taken, decided by prior. Else
the order is undecided, with the best one given and the reason told.

**Covariance of the pairs**: that of the image corner plus the LiDAR's noise as the camera sees it, from the board's
pose covariance, or from `lidar_sigma` where a board has none.

The chi-square of the runner-up is that of plain pixels (1 px) with corners counting a quarter each.
See docs/matching.md for what was measured.)");
    s.role("matcher");
    s.reads<LidarBoards>("lidar", "boards in the LiDAR frame");
    s.reads<ImageBoards>("image", "boards of every camera, raw pixels");
    s.writes<Correspondences>("correspondences",
                              "pairs of corners for each camera, none where nothing matched");
    s.param("min_runner_up_ratio", &Params::min_runner_up_ratio)
        .unit("1")
        .within(1.0, 100.0)
        .doc("the data decide where the best other order has this many times the RMS or more");
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

void BoardMatcher::run(Run& run) {
    const auto& lidar = run.in<LidarBoards>("lidar");
    const auto& image = run.in<ImageBoards>("image");
    check(lidar, image);
    Correspondences correspondences;
    for (const CameraInfo& camera : image.cameras) {
        run.check_cancelled();
        correspondences.cameras.push_back(match(run, lidar, image, camera));
    }
    run.write("correspondences", std::move(correspondences));
}

void BoardMatcher::keep_largest(Run& run, const std::string& camera,
                                std::vector<const ImageBoard*>& seen,
                                std::vector<int>& index) const {
    const auto most = static_cast<std::size_t>(p_.max_image_boards);
    if (seen.size() <= most) return;
    run.note(
        {"boards that camera '" + camera + "' sees",
         std::to_string(seen.size()) + " image boards; only the " + std::to_string(most) +
             " largest are tried",
         "max_image_boards " + std::to_string(most),
         "a pattern of dark squares may have been taken for boards: see the detector's overlay"});
    const auto diagonal = [](const ImageBoard* board) {
        return board->corners.empty() ? 0.0
                                      : (board->corners.front() - board->corners.back()).norm();
    };
    std::vector<std::size_t> order(seen.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return diagonal(seen[a]) > diagonal(seen[b]);
    });
    order.resize(most);
    std::sort(order.begin(), order.end());
    std::vector<const ImageBoard*> kept;
    std::vector<int> kept_index;
    for (const std::size_t i : order) {
        kept.push_back(seen[i]);
        kept_index.push_back(index[i]);
    }
    seen = std::move(kept);
    index = std::move(kept_index);
}

CameraPairs BoardMatcher::match(Run& run, const LidarBoards& lidar, const ImageBoards& image,
                                const CameraInfo& camera) const {
    CameraPairs result;
    result.camera = camera.label;
    result.lidar = lidar.lidar;
    result.model = camera.camera;

    std::vector<const ImageBoard*> seen;
    std::vector<int> index;
    for (std::size_t i = 0; i < image.boards.size(); ++i) {
        if (image.boards[i].camera != camera.label) continue;
        seen.push_back(&image.boards[i]);
        index.push_back(static_cast<int>(i));
    }
    keep_largest(run, camera.label, seen, index);
    const std::string counts = std::to_string(lidar.boards.size()) + " LiDAR boards and " +
                               std::to_string(seen.size()) + " image boards";
    const std::string sought =
        "boards that LiDAR '" + lidar.lidar + "' and camera '" + camera.label + "' both see";
    result.order.reason = "nothing matched";
    if (lidar.boards.empty() || seen.empty()) {
        run.note({sought, counts, "at least one of each", "see the notes of the board detectors"});
        return result;
    }

    const CameraModel model = camera_model(camera.camera, p_.use_distortion);
    const BoardOrders orders(model, lidar.boards, seen, p_, [&run] { run.check_cancelled(); });
    const auto found = orders.search();
    const auto choice = choose_order(orders, found, p_);
    if (!choice) {
        std::string miss = counts + ", no pose puts a pair of them in front of the camera";
        if (!found.empty()) {
            const auto nearest = std::min_element(
                found.begin(), found.end(), [](const BoardOrder& a, const BoardOrder& b) {
                    return a.worst_gate_ratio < b.worst_gate_ratio;
                });
            miss = printed(
                "%s; the best hypothesis leaves %.2f px RMS over %zu boards, %.1f times "
                "its gate",
                counts.c_str(), nearest->rms_px(), nearest->matches.size(),
                nearest->worst_gate_ratio);
        }
        const std::string gate = printed("gate %.3f m, at least %.1f px", p_.gate, p_.min_gate_px);
        run.note({sought, miss, gate,
                  "check the target's size, the intrinsics, and whether the boards are the same"});
        return result;
    }

    result.pairs = orders.pairs(choice->order.matches);
    result.order = choice->decision;
    for (const RefinedPose& pose : choice->order.poses)
        result.initial.push_back(pose.T_camera_lidar);
    for (const BoardMatch& match : choice->order.matches) {
        CameraPairs::BoardPair& pair = result.boards.emplace_back();
        pair.lidar = match.lidar;
        pair.image = index[static_cast<std::size_t>(match.image)];
    }
    add_lidar_noise(model, lidar.boards, *choice, result.pairs);
    doubt_what_is_no_noise(model, *choice, result);

    const std::size_t matched = result.boards.size();
    if (matched < std::min(lidar.boards.size(), seen.size()))
        run.note({sought, std::to_string(matched) + " matched of " + counts, "",
                  "a board may be false, or lie where only one sensor sees it"});
    const std::string text =
        printed("camera '%s': %zu boards, RMS %.2f px, order by %s: ", camera.label.c_str(),
                matched, result.order.rms_px, to_string(result.order.by));
    run.log(result.order.by == DecidedBy::undecided ? LogLevel::warning : LogLevel::info,
            text + result.order.reason);
    return result;
}

void BoardMatcher::doubt_what_is_no_noise(const CameraModel& model, const OrderChoice& choice,
                                          CameraPairs& result) const {
    if (result.order.by != DecidedBy::data) return;
    constexpr double kUpperZ = 3.0902;        // 99.9 %
    constexpr double kBoardRedundancy = 4.0;  // 32 numbers a board come from about 8 lines
    double chi2 = 0.0;
    for (const PointPair& pair : result.pairs) {
        const auto pixel = model.project(choice.order.poses.front().T_camera_lidar * pair.lidar);
        if (!pixel) continue;
        const Eigen::Vector2d error = pair.image - *pixel;
        chi2 += error.dot(pair.covariance.ldlt().solve(error)) / kBoardRedundancy;
    }
    const int freedom =
        static_cast<int>(2.0 * static_cast<double>(result.pairs.size()) / kBoardRedundancy) - 6;
    if (freedom < 1 || chi2 <= chi2_quantile(freedom, kUpperZ)) return;
    const bool prior = (p_.upright || p_.use_max_baseline) && !result.order.contradicts_priors;
    result.order.by = prior ? DecidedBy::prior : DecidedBy::undecided;
    result.order.contradicts_priors = false;
    result.order.reason += printed(
        "; but chi-square %.1f with %d degrees of freedom is more than noise, so a board may be "
        "false or not shared%s",
        chi2, freedom, prior ? "; the priors hold" : "");
}

void BoardMatcher::add_lidar_noise(const CameraModel& model, const std::vector<LidarBoard>& boards,
                                   const OrderChoice& choice, std::vector<PointPair>& pairs) const {
    const Eigen::Isometry3d& pose = choice.order.poses.front().T_camera_lidar;
    for (PointPair& pair : pairs) {
        const auto match = static_cast<std::size_t>(pair.board);
        const LidarBoard& board =
            boards[static_cast<std::size_t>(choice.order.matches[match].lidar)];
        Eigen::Matrix3d noise = p_.lidar_sigma * p_.lidar_sigma * Eigen::Matrix3d::Identity();
        if (board.covariance) {
            Eigen::Matrix<double, 3, 6> by_pose;
            by_pose << Eigen::Matrix3d::Identity(), -skew(pair.lidar);
            noise = by_pose * *board.covariance * by_pose.transpose();
        }
        Eigen::Matrix<double, 2, 3> by_point;
        if (!model.project(pose * pair.lidar, &by_point)) continue;
        const Eigen::Matrix<double, 2, 3> by_lidar = by_point * pose.linear();
        pair.covariance += by_lidar * noise * by_lidar.transpose();
    }
}

}  // namespace petal
