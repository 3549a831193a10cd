// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/joint.hpp"

#include <algorithm>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "petal/error.hpp"
#include "petal/printed.hpp"
#include "solvers/detail/joint_report.hpp"
#include "solvers/detail/joint_search.hpp"

namespace petal {
namespace {

/// The prior, where it is for a camera of this input.
std::optional<TranslationPrior> prior_for(const JointInput& input, const JointParams& params) {
    if (params.prior_translation.empty()) return std::nullopt;
    for (std::size_t c = 0; c < input.cameras.size(); ++c)
        if (params.prior_camera.empty() || params.prior_camera == input.cameras[c].camera)
            return TranslationPrior{c,
                                    {params.prior_translation[0], params.prior_translation[1],
                                     params.prior_translation[2]},
                                    params.prior_sigma};
    return std::nullopt;
}

void check_prior_camera(const JointInputs& inputs, const JointParams& params) {
    if (params.prior_translation.empty()) return;
    std::string labels;
    int cameras = 0;
    bool named = false;
    const auto count = [&](const SolveInput& camera) {
        labels += (cameras++ > 0 ? ", '" : "'") + camera.camera + "'";
        named = named || camera.camera == params.prior_camera;
    };
    for (const JointInput& group : inputs.solvable)
        for (const SolveInput& camera : group.cameras) count(camera);
    for (const SolveInput& camera : inputs.too_few) count(camera);
    if (params.prior_camera.empty() ? cameras > 1 : cameras > 0 && !named)
        throw Error((params.prior_camera.empty()
                         ? std::string("prior_translation is of one camera, but there are several")
                         : "prior_camera '" + params.prior_camera + "' is not among the cameras") +
                    "; set prior_camera to one of " + labels);
}

/// The cameras of a group without a solution that stand in its way: those without a pose of their
/// own, or all.
std::vector<SolveInput> without_a_pose(const JointInput& input) {
    std::vector<SolveInput> lost;
    for (const std::size_t c : cameras_without_pose(input)) lost.push_back(input.cameras[c]);
    return lost.empty() ? input.cameras : lost;
}

/// What joint_inputs is asked for to go on with the other cameras of the group.
std::function<bool(const SolveInput&)> wanted_but(const std::vector<SolveInput>& lost,
                                                  const JointInput& input) {
    const auto among = [](const std::vector<SolveInput>& cameras, const SolveInput& one) {
        return std::any_of(cameras.begin(), cameras.end(), [&](const SolveInput& camera) {
            return camera.camera == one.camera && camera.lidar == one.lidar;
        });
    };
    return [&lost, &input, among](const SolveInput& one) {
        return among(input.cameras, one) && !among(lost, one);
    };
}

}  // namespace

void Joint::finish(Run& run) {
    Extrinsics extrinsics;
    extrinsics.level = Level::usable;
    const auto unsolved = [&](const std::string& who, const std::string& seen,
                              const std::string& limit, const std::string& hint) {
        run.note({"a pose of " + who, seen, limit, hint});
        extrinsics.level = Level::not_usable;
        extrinsics.reasons.push_back(who + ": nothing to solve, " + seen);
    };

    const auto packets = run.all<Correspondences>("correspondences");
    const JointInputs inputs = joint_inputs(packets, p_);
    check_prior_camera(inputs, p_);
    if (inputs.solvable.empty() && inputs.too_few.empty())
        unsolved("any camera", "no scene told of a camera", "", "check what feeds the matcher");
    for (const SolveInput& camera : inputs.too_few)
        unsolved("camera '" + camera.camera + "'", std::to_string(camera.pairs.size()) + " pairs",
                 "at least 4 pairs", "see the notes of the detectors and of the matcher");
    std::deque<JointInput> groups(inputs.solvable.begin(), inputs.solvable.end());
    while (!groups.empty()) {
        run.check_cancelled();
        const JointInput input = std::move(groups.front());
        groups.pop_front();
        const std::size_t known = extrinsics.cameras.size();
        const auto level = report_joint(
            input, p_, prior_for(input, p_), [&run] { run.check_cancelled(); }, extrinsics);
        if (!level) {
            const auto lost = without_a_pose(input);
            for (const SolveInput& camera : lost)
                unsolved("camera '" + camera.camera + "'",
                         "no pose puts the " + std::to_string(camera.pairs.size()) +
                             " pairs in front of the camera",
                         "four pairs that do not lie on one line, pixels inside the camera's model",
                         "check the pairs, the intrinsics and their distortion");
            const auto rest = joint_inputs(packets, p_, wanted_but(lost, input)).solvable;
            groups.insert(groups.begin(), rest.begin(), rest.end());
            continue;
        }
        extrinsics.level = std::max(extrinsics.level, *level);
        for (std::size_t c = known; c < extrinsics.cameras.size(); ++c) {
            const CameraExtrinsics& camera = extrinsics.cameras[c];
            run.log(LogLevel::info,
                    "camera '" + camera.camera + "'" +
                        printed(": %zu pairs, chi-square %.1f (%d)", camera.residuals.size(),
                                camera.chi2, camera.degrees_of_freedom));
        }
    }
    run.verdict(extrinsics.level, extrinsics.reasons);
    run.write("extrinsics", std::move(extrinsics));
}

}  // namespace petal
