// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/agreement_verdict.hpp"

#include <utility>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/extrinsics_sigma.hpp"
#include "petal/printed.hpp"

namespace petal {
namespace {

constexpr double kContradiction = 3.0902;  // normal deviate, one-sided 99.9 %

}  // namespace

Level judge_known(const Extrinsics& known, std::vector<std::string>& reasons) {
    if (known.level == Level::usable) return Level::usable;
    std::string reason = std::string("the result itself was ") +
                         (known.level == Level::weak ? "weak" : "not usable");
    for (std::size_t i = 0; i < known.reasons.size(); ++i)
        reason += (i == 0 ? ": " : "; ") + known.reasons[i];
    reasons.push_back(std::move(reason));
    return known.level;
}

Level judge_agreement(const CameraExtrinsics& camera, double px, const DriftSum::Result& drift,
                      const AgreementParams& params, std::vector<std::string>& reasons) {
    Level level = Level::usable;
    const auto weak = [&](std::string reason) {
        level = Level::weak;
        reasons.push_back(std::move(reason));
    };
    const PrincipalSigma sigma = principal_sigma(camera);
    if (sigma.translation > params.usable_sigma ||
        sigma.rotation * kDegrees > params.usable_sigma_deg)
        weak(
            printed("the result's 1 sigma is up to %.1f mm and %.3f deg (usable up to %.1f mm and "
                    "%.2f deg), so that much would agree with it",
                    sigma.translation * 1e3, sigma.rotation * kDegrees, params.usable_sigma * 1e3,
                    params.usable_sigma_deg));
    if (px <= params.max_px) return level;
    const bool apart = drift.sigmas > params.sigmas;
    const bool contradict = drift.left_sigmas > kContradiction;
    if (apart)
        weak(
            printed("the new data do not agree with the result: boards lie %.2f px (RMS) from "
                    "where it puts them, %.1f sigma of the result and the data together; as if "
                    "turned by %.2f deg; a sensor has moved, or the data are of another rig: "
                    "calibrate anew",
                    px, drift.sigmas, drift.drift.tail<3>().norm() * kDegrees));
    if (contradict)
        weak(
            printed("the boards contradict each other: no single pose explains them (they lie "
                    "%.2f px (RMS) from where the result puts them; chi-square %.0f of %d degrees "
                    "of freedom beside a common drift); a board or a sensor moved between or "
                    "during the scenes, a board was found wrongly, or the intrinsics are not this "
                    "camera's",
                    px, drift.left_chi2, drift.left_freedoms));
    if (!apart && !contradict)
        weak(
            printed("agrees only because the result or the new data are vague: boards lie %.1f px "
                    "(RMS) from where it puts them (limit %.1f), within %.1f sigma; give nearer "
                    "boards, or more of them",
                    px, params.max_px, params.sigmas));
    return level;
}

}  // namespace petal
