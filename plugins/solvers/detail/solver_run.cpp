// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/solver_run.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/se3.hpp"
#include "petal/error.hpp"
#include "petal/printed.hpp"

namespace petal {
namespace {

constexpr std::size_t kFewestPairs = 4;  // three leave up to four poses

/// A sentence where another minimum fits nearly as well; empty where none does.
std::string other_pose(const std::vector<RefinedPose>& poses, double min_ratio) {
    if (poses.size() < 2) return "";
    const double ratio = poses[1].rms_px / std::max(poses[0].rms_px, 1e-9);
    if (ratio >= min_ratio) return "";
    const Eigen::Isometry3d between = poses[1].T_camera_lidar * poses[0].T_camera_lidar.inverse();
    return printed(
        "another pose, %.1f deg and %.2f m away, fits the same pairs with %.2f times the RMS",
        rotation_angle(between.linear()) * kDegrees,
        (poses[1].T_camera_lidar.translation() - poses[0].T_camera_lidar.translation()).norm(),
        ratio);
}

/// Where a prior chose among poses that fit alike, the solver must not choose again by residuals:
/// the pose nearest to the matcher's comes first.
void keep_choice_of_prior(const SolveInput& input, std::vector<RefinedPose>& poses) {
    if (input.order.by != DecidedBy::prior || input.initial.empty()) return;
    const Eigen::Isometry3d& chosen = input.initial.front();
    const auto nearest =
        std::min_element(poses.begin(), poses.end(), [&](const auto& a, const auto& b) {
            const auto angle = [&](const RefinedPose& pose) {
                return rotation_angle(pose.T_camera_lidar.linear().transpose() * chosen.linear());
            };
            return angle(a) < angle(b);
        });
    std::rotate(poses.begin(), nearest, std::next(nearest));
}

}  // namespace

void run_solver(Run& run, const SolverParams& params, const RobustLoss& loss,
                const PoseSearch& search) {
    Extrinsics extrinsics;
    extrinsics.level = Level::usable;
    const auto unsolved = [&](const std::string& who, const std::string& seen,
                              const std::string& limit, const std::string& hint) {
        run.note({"a pose of " + who, seen, limit, hint});
        extrinsics.level = Level::not_usable;
        extrinsics.reasons.push_back(who + ": nothing to solve, " + seen);
    };

    const auto inputs = gather(run.all<Correspondences>("correspondences"));
    if (inputs.empty())
        unsolved("any camera", "no scene told of a camera", "", "check what feeds the matcher");
    for (const SolveInput& input : inputs) {
        run.check_cancelled();
        const std::string who = "camera '" + input.camera + "'";
        if (input.pairs.size() < kFewestPairs) {
            unsolved(who, std::to_string(input.pairs.size()) + " pairs",
                     "at least " + std::to_string(kFewestPairs) + " pairs",
                     "see the notes of the detectors and of the matcher");
            continue;
        }
        const ReprojectionProblem problem(camera_model(input.model, params.use_distortion),
                                          input.pairs, params.weighting == "covariance", loss);
        auto poses = search(input, problem);
        if (poses.empty()) {
            unsolved(who,
                     "no pose puts the " + std::to_string(input.pairs.size()) +
                         " pairs in front of the camera",
                     "four pairs that do not lie on one line, pixels inside the camera's model",
                     "check the pairs, the intrinsics and their distortion");
            continue;
        }
        keep_choice_of_prior(input, poses);
        CameraExtrinsics camera = estimate(input, problem, poses.front().T_camera_lidar, params);
        const double rotation_per_m = params.usable_sigma > 0.0 && params.usable_sigma_deg > 0.0
                                          ? params.usable_sigma_deg / kDegrees / params.usable_sigma
                                          : 0.2;
        camera.weakest_direction = describe_weakest(column_covariance(camera), rotation_per_m);
        Level level = judge(camera, params, extrinsics.reasons);
        if (const auto sentence = other_pose(poses, params.min_other_pose_ratio);
            !sentence.empty()) {
            level = std::max(level, Level::weak);
            extrinsics.reasons.push_back(who + ": " + sentence);
        }
        extrinsics.level = std::max(extrinsics.level, level);
        run.log(LogLevel::info,
                who + printed(": %zu pairs, RMS %.3f px, chi-square %.1f (%d)", input.pairs.size(),
                              poses.front().rms_px, camera.chi2, camera.degrees_of_freedom));
        extrinsics.cameras.push_back(std::move(camera));
    }
    run.verdict(extrinsics.level, extrinsics.reasons);
    run.write("extrinsics", std::move(extrinsics));
}

}  // namespace petal
