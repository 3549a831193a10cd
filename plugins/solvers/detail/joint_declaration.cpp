// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <string>

#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "solvers/detail/verdict_declaration.hpp"
#include "solvers/joint.hpp"

namespace petal {
namespace {

void declare_noise(Spec<JointParams>& s) {
    s.param("use_distortion", &JointNoiseParams::use_distortion)
        .doc("project with the camera's distortion; off where the pixels are rectified");
    s.param("assumed_board_sigma", &JointNoiseParams::assumed_board_sigma)
        .unit("m")
        .within(1e-5, 1.0)
        .doc("of a LiDAR board's centre, along each axis, where its detector tells no covariance");
    s.param("assumed_board_sigma_deg", &JointNoiseParams::assumed_board_sigma_deg)
        .unit("deg")
        .within(1e-3, 90.0)
        .doc("of its rotation about the centre, likewise");
    s.param("point_sigma", &JointNoiseParams::point_sigma)
        .unit("m")
        .within(0.0, 1.0)
        .doc("of a single LiDAR point along each axis");
    s.param("sigma_px", &JointNoiseParams::sigma_px)
        .unit("px")
        .within(0.001, 100.0)
        .doc("what a pair's covariance of 1 px^2 stands for, as a standard deviation");
    s.param("min_sigma_px", &JointNoiseParams::min_sigma_px)
        .unit("px")
        .within(1e-4, 10.0)
        .doc("no direction of a board's joint image covariance is taken as better than this");
    s.param("board_redundancy", &JointNoiseParams::board_redundancy)
        .unit("1")
        .within(1.0, 16.0)
        .doc(
            "corners that come without a joint covariance count so many times less than "
            "independent ones: the 32 numbers of 16 corners come from about 8 lines");
}

void declare_prior_and_focal(Spec<JointParams>& s) {
    s.param("robust_loss", &JointParams::robust_loss)
        .choices({"none", "huber", "cauchy"})
        .doc("loss on each board's chi-square; it acts beyond the 99 % point");
    s.param("estimate_focal", &JointParams::estimate_focal)
        .doc("estimate a factor on fx and fy too, where the boards' distances allow it");
    s.param("max_focal_sigma", &JointParams::max_focal_sigma)
        .unit("1")
        .within(1e-6, 1.0)
        .doc("the factor is held at 1, and the reasons say so, where its 1 sigma would be larger");
    s.param("prior_translation", &JointParams::prior_translation)
        .unit("m")
        .within(-100.0, 100.0)
        .doc("the LiDAR's origin in the camera frame as measured by hand, [x, y, z]; empty: none");
    s.param("prior_sigma", &JointParams::prior_sigma)
        .unit("m")
        .within(1e-4, 100.0)
        .doc("1 sigma of prior_translation along each axis");
    s.param("prior_camera", &JointParams::prior_camera)
        .doc("the camera that prior_translation is of; empty: the only one");
    s.check([](const JointParams& p) {
        return p.prior_translation.empty() || p.prior_translation.size() == 3
                   ? std::string()
                   : "prior_translation must hold three numbers, or none";
    });
}

void declare_considered_and_advice(Spec<JointParams>& s) {
    s.param("range_offset_sigma", &ConsiderParams::range_offset_sigma)
        .unit("m")
        .within(1e-5, 1.0)
        .doc("how well the LiDAR's constant range offset is known");
    s.param("range_offset_allowance", &JointParams::range_offset_allowance)
        .unit("1")
        .within(0.01, 100.0)
        .doc("the weights allow for an offset of so many times that sigma");
    s.param("focal_sigma", &ConsiderParams::focal_sigma)
        .unit("1")
        .within(0.0, 1.0)
        .doc("how well the focal length is known, as a part of it");
    s.param("principal_point_sigma_px", &ConsiderParams::principal_point_sigma_px)
        .unit("px")
        .within(0.0, 1000.0)
        .doc("how well cx and cy are known, each");
    s.param("advice_min_range", &JointParams::advice_min_range)
        .unit("m")
        .within(0.1, 100.0)
        .doc("the nearest placement that the advice may name");
    s.param("advice_max_range", &JointParams::advice_max_range)
        .unit("m")
        .within(0.1, 100.0)
        .doc("the farthest one, tried in steps of 1 m");
    s.check([](const JointParams& p) {
        return p.advice_min_range <= p.advice_max_range
                   ? std::string()
                   : "advice_min_range must not exceed advice_max_range";
    });
}

}  // namespace

void Joint::describe(Spec<Params>& s) {
    s.summary("All scenes, boards and cameras of a LiDAR in one problem, with a true covariance.");
    s.doc(
        R"(Solves for T_camera_lidar of every camera and T_lidar_board of every board together; a board
that two cameras see is one. Residuals, by Ceres on SE(3), in one thread:

    LiDAR:  L^-1 Log(T_lidar_board M^-1)              6 numbers, M the measured pose, L L' its covariance
    image:  W (u - pi(T_camera_lidar T_lidar_board c))  2N numbers, W'W the pseudo-inverse of their covariance

So the corners of a board are never taken as independent. Their covariance has rank 16, not 32, where they
are cut from eight lines: directions below 1e-6 of the largest variance are left out, no other is taken as
better than `min_sigma_px`. A pose without covariance gets `assumed_board_sigma` and `assumed_board_sigma_deg`
about the board's centre, and the result is at most weak. Single points (published pairs) have both
`point_sigma`, carried into the image, and their own covariance; corners of boards of which nothing else is
known are single points that count 1 / `board_redundancy` each. (`solver.board_matcher` gives corners without a
joint covariance four times their own, so its boards are not multiplied again.)

**Chi-square** is that of the LiDAR's poses and, for every image, what it has at the solution more than at the
pose that fits that image alone: 6 numbers a board and camera; 6 a camera (and one a free focal length) are
taken off. The covariance is scaled by max(1, chi-square / degrees of freedom), never down.

**Robust loss** on a board's chi-square, beyond its 99 % point (16.8 for 6 numbers): of clean boards one in a
hundred is touched at all, so the covariance stays true. `cauchy` touches all of them a little.

**Two sigmas.** `covariance` holds the noise and what a constant range offset of the LiDAR does to the estimate,
and takes the intrinsics as exact; the considered one adds what the focal length and the principal point do, were
they known only so well. The verdict judges the first: 1 px of principal point alone is 0.06 deg, so with the
second nothing could ever be usable.

**Tilt.** Boards that differ by yaw alone, say, cannot show an error in pitch that all of them share (a bias of
a detector, a bent target), however small the noise is: below `usable_tilt_deg` the result is weak.

**Range offset.** All boards may lie too far by one and the same offset. It is a nuisance parameter, free but
for `range_offset_allowance` times `range_offset_sigma`, so the weights know that the boards' common distance is
doubtful; its own value is not told, since no few boards determine it.

**Focal length.** A factor on it is always tested, as one more parameter from the solution: more than 3 sigma
and more than twice `focal_sigma` from 1 makes the result weak and says so.

**Prior.** `prior_translation` is one more residual; it has no part in chi-square. What the covariance would be
without it is told, and a result that is precise only because of it is weak.

**Scenes.** Each is left out in turn and the rest solved again: its shift in units of its own sigma (whose
covariance is the difference of both), and whether what it adds to chi-square lies beyond 99.9 %. **Advice** is
the placement, of several hundred tried, after which the largest principal sigma is smallest.

docs/joint.md derives and measures all this.)");
    s.role("solver");
    s.gathers<Correspondences>("correspondences",
                               "pairs of every scene; scenes are taken by frame number");
    s.writes<Extrinsics>("extrinsics",
                         "T_camera_lidar of each camera, covariance, diagnosis, verdict");
    declare_noise(s);
    declare_prior_and_focal(s);
    declare_considered_and_advice(s);
    declare_verdict(s);
    s.param("usable_tilt_deg", &JointParams::usable_tilt_deg)
        .unit("deg")
        .within(0.0, 90.0)
        .doc("usable from this RMS of how boards are turned against each other, about every axis");
}

}  // namespace petal
