// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/truth.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "metrics/detail/scene_name.hpp"
#include "metrics/detail/truth_figures.hpp"
#include "petal/calibration/angles.hpp"
#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/truth.hpp"
#include "petal/printed.hpp"

namespace petal {
namespace {

const char* const kLookedFor = "the error of the extrinsics against the truth";

/// Two rigs nearer than this (m, rad) are one: truth.json may have been written with six digits.
constexpr double kSameRig = 1e-5;

void tell(Run& run, const std::string& miss, const std::string& hint) {
    run.note({kLookedFor, miss, "", hint});
}

/// The pose that the truth is of; null, and a note why, where it cannot be told.
const CameraExtrinsics* chosen_pose(Run& run, const Extrinsics& extrinsics,
                                    const TruthMetricParams& params) {
    std::vector<const CameraExtrinsics*> fitting;
    std::string solved;
    for (const CameraExtrinsics& one : extrinsics.cameras) {
        solved += (solved.empty() ? "camera '" : ", camera '") + one.camera + "' to LiDAR '" +
                  one.lidar + "'";
        if ((params.camera.empty() || one.camera == params.camera) &&
            (params.lidar.empty() || one.lidar == params.lidar))
            fitting.push_back(&one);
    }
    if (extrinsics.cameras.empty()) {
        tell(run, "no camera has extrinsics", "see the notes of the matcher and the solver");
    } else if (fitting.empty()) {
        tell(run,
             "the extrinsics that 'camera' and 'lidar' ask for were not solved; solved are " +
                 solved,
             "set 'camera' and 'lidar' to one of these, or leave them empty");
    } else if (fitting.size() > 1) {
        tell(run, "the truth of a scene is one pose, but several were solved: " + solved,
             "set 'camera' (and 'lidar') to the one that the truth is of, and measure the others "
             "by a metric.truth of their own");
    } else if (!fitting.front()->T_camera_lidar.matrix().allFinite()) {
        tell(run, "the pose of camera '" + fitting.front()->camera + "' is not finite",
             "see the notes of the solver");
    } else {
        return fitting.front();
    }
    return nullptr;
}

/// The scenes with a true pose, in the order of their frames; tells of the others.
std::vector<Packet<Truth>> known_scenes(Run& run) {
    auto scenes = run.all<Truth>("truth");
    std::stable_sort(scenes.begin(), scenes.end(),
                     [](const auto& a, const auto& b) { return a.frame.number < b.frame.number; });
    std::vector<Packet<Truth>> known;
    std::vector<std::string> unknown;
    for (const auto& scene : scenes) {
        const auto& pose = scene->T_camera_lidar;
        if (!pose) {
            unknown.push_back(scene_name(scene.frame));
            continue;
        }
        if (!pose->matrix().allFinite())
            throw Error("the true T_camera_lidar of scene '" + scene_name(scene.frame) +
                        "' is not finite; mend its source or its truth.json");
        known.push_back(scene);
    }
    const char* const hint =
        "truth is known of simulated scenes only: source.simulator gives it, sink.rawlog writes it "
        "as truth.json beside the rawlog";
    if (known.empty()) {
        tell(run, "no truth: none of " + std::to_string(scenes.size()) + " scenes has a true pose",
             hint);
    } else if (!unknown.empty()) {
        tell(run,
             "no truth: " + std::to_string(scenes.size() - known.size()) + " of " +
                 std::to_string(scenes.size()) +
                 " scenes have no true pose and do not count: " + listed(unknown),
             hint);
    }
    return known;
}

/// Whether all scenes have one rig; tells where they have not.
bool same_rig(Run& run, const std::vector<Packet<Truth>>& scenes) {
    const Eigen::Isometry3d& first = *scenes.front()->T_camera_lidar;
    double turn = 0.0, shift = 0.0;
    for (const auto& scene : scenes) {
        CameraExtrinsics other;
        other.T_camera_lidar = *scene->T_camera_lidar;
        const PoseError difference = pose_error(other, first);
        turn = std::max(turn, difference.rotation.norm());
        shift = std::max(shift, difference.translation.norm());
    }
    if (turn < kSameRig && shift < kSameRig) return true;
    tell(run,
         printed("the true pose differs between the scenes, by up to %.4f deg and %.5f m from the "
                 "first: no one pose can be right for all, and there are no figures in total",
                 turn * kDegrees, shift),
         "give the solver scenes of one rig (source.simulator: one rig shared by its scenes)");
    return false;
}

}  // namespace

void TruthMetric::describe(Spec<Params>& s) {
    s.summary(
        "How far the extrinsics are from the true pose, where it is known: deg, m, px, sigmas.");
    s.doc(
        R"(Compares T_camera_lidar of one camera with the true one that a simulated scene brings along. Each figure is
told for every scene and (without a scene's name) in total.

| name | what |
|---|---|
| truth.rotation_deg | the angle of R_est R_true^T |
| truth.rotation_x_deg, rotation_y_deg, rotation_z_deg | its rotation vector, about the camera's axes |
| truth.translation_m | the length of t_est - t_true |
| truth.translation_x_m, translation_y_m, translation_z_m | its components along the camera's axes |
| truth.nees | the squared error in sigmas (normalised estimation error squared): xi^T C^-1 xi, with T_true = Exp(xi) T_est and C the solver's covariance of xi = (rho, phi) |
| truth.drift_count | true corners that project under both poses |
| truth.drift_px, drift_max_px | mean and largest distance between the images of a true corner under the two poses, \|pi(T_est p) - pi(T_true p)\|, in raw pixels, with the camera model that the solver used |

The drift is the board drift of equation (16) of the letter with the corner's exact place instead of a
measured one, so it holds no error of a detector. Corners outside the image count as well, as long as the
camera model reaches there. It measures the pose where the boards stand: to see how the pose does elsewhere,
wire the truth of scenes that the solver was not given to `truth` (one more wire); the pose is compared with
those scenes too.

An honest covariance gives truth.nees a mean of 6 over many runs (chi-square with 6 degrees of freedom). One
run tells little: 9 of 10 lie between 1.6 and 12.6, and 1 of 100 lies above 16.8. A mean well above 6 says
that the sigmas are too small, or that an error is systematic; well below 6 that they are too large. It is
left out, with a note, where the covariance is not positive definite.

Real scenes have no truth: without a true pose there are no figures, and a note says so. Scenes without one
do not count beside others that have it. Where the true pose differs between scenes (each scene with a rig
of its own), one estimate cannot be right for all: the scenes are told one by one, there is no total, and a
note says so. Truth holds one pose without a camera's name: where several were solved, `camera` (and
`lidar`) must say which it is of. Corners that do not project (behind the camera, outside its model) are
left out and noted.)");
    s.role("metric");
    s.reads<Extrinsics>("extrinsics", "the pose to measure");
    s.gathers<Truth>("truth", "what is known of every scene; empty for real data");
    s.writes<Metrics>("metrics",
                      "errors in degrees, metres, pixels and sigmas, for each scene and in total");
    s.param("camera", &Params::camera)
        .doc("label of the camera that the truth is of; empty: the only one that was solved");
    s.param("lidar", &Params::lidar)
        .doc("label of the LiDAR that the truth is of; empty: the only one that was solved");
}

void TruthMetric::finish(Run& run) {
    Metrics metrics;
    const std::vector<Packet<Truth>> scenes = known_scenes(run);
    // Without truth it does not matter which pose would have been measured.
    const CameraExtrinsics* pose =
        scenes.empty() ? nullptr : chosen_pose(run, run.in<Extrinsics>("extrinsics"), params_);
    if (pose == nullptr) {
        run.write("metrics", std::move(metrics));
        return;
    }
    const CameraModel model(pose->model);
    CornerDrift total;
    const auto add = [&](const PoseError& error, const CornerDrift& drift,
                         const std::string& name) {
        for (Metric& figure : truth_figures(error, drift, name))
            metrics.values.push_back(std::move(figure));
    };
    for (const auto& scene : scenes) {
        run.check_cancelled();
        const Eigen::Isometry3d& truth = *scene->T_camera_lidar;
        const CornerDrift drift = corner_drift(model, pose->T_camera_lidar, truth, scene->boards);
        add(pose_error(*pose, truth), drift, scene_name(scene.frame));
        total.add(drift);
    }
    const PoseError error = pose_error(*pose, *scenes.front()->T_camera_lidar);
    if (same_rig(run, scenes)) add(error, total, "");
    if (total.lost > 0)
        tell(run,
             std::to_string(total.lost) + " of " + std::to_string(total.lost + total.px.size()) +
                 " true corners do not project under the true or the estimated pose; the drift "
                 "leaves them out",
             "where the rotation is large, the pose is wrong altogether; see the solver's notes");
    if (!error.nees)
        tell(run,
             "the covariance of camera '" + pose->camera +
                 "' is not positive definite: no truth.nees",
             "see the notes of the solver, and whether it estimates a covariance");
    run.write("metrics", std::move(metrics));
}

}  // namespace petal
