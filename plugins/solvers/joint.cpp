// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/joint.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "petal/error.hpp"
#include "petal/printed.hpp"
#include "solvers/detail/joint_report.hpp"

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

    const JointInputs inputs = joint_inputs(run.all<Correspondences>("correspondences"), p_);
    check_prior_camera(inputs, p_);
    if (inputs.solvable.empty() && inputs.too_few.empty())
        unsolved("any camera", "no scene told of a camera", "", "check what feeds the matcher");
    for (const SolveInput& camera : inputs.too_few)
        unsolved("camera '" + camera.camera + "'", std::to_string(camera.pairs.size()) + " pairs",
                 "at least 4 pairs", "see the notes of the detectors and of the matcher");
    for (const JointInput& input : inputs.solvable) {
        run.check_cancelled();
        const auto level = report_joint(input, p_, prior_for(input, p_), extrinsics);
        if (!level) {
            unsolved("camera '" + input.cameras.front().camera + "'",
                     "no pose puts the " + std::to_string(input.cameras.front().pairs.size()) +
                         " pairs in front of the camera",
                     "four pairs that do not lie on one line, pixels inside the camera's model",
                     "check the pairs, the intrinsics and their distortion");
            continue;
        }
        extrinsics.level = std::max(extrinsics.level, *level);
        for (const CameraExtrinsics& camera : extrinsics.cameras)
            run.log(LogLevel::info,
                    "camera '" + camera.camera + "'" +
                        printed(": %zu pairs, chi-square %.1f (%d)", camera.residuals.size(),
                                camera.chi2, camera.degrees_of_freedom));
    }
    run.verdict(extrinsics.level, extrinsics.reasons);
    run.write("extrinsics", std::move(extrinsics));
}

}  // namespace petal
