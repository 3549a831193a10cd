// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/verdict.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/detail/extrinsics_estimate.hpp"

#include "petal/calibration/angles.hpp"
#include "petal/printed.hpp"

namespace petal {
namespace {

constexpr double kUpperZ = 3.0902;     // one-sided 99.9 %
constexpr double kTwoSidedZ = 3.2905;  // 0.05 % at either end

void lower(Level& level, Level to) {
    level = std::max(level, to);
}

}  // namespace

double chi2_quantile(int degrees_of_freedom, double z) {
    if (degrees_of_freedom <= 0) return 0.0;
    const double k = degrees_of_freedom;
    const double root = 1.0 - 2.0 / (9.0 * k) + z * std::sqrt(2.0 / (9.0 * k));
    return root > 0.0 ? k * root * root * root : 0.0;
}

Level judge(const CameraExtrinsics& camera, const VerdictParams& params,
            std::vector<std::string>& reasons) {
    const std::string who = "camera '" + camera.camera + "': ";
    Level level = Level::usable;

    // Comparisons with NaN are false, so it would pass every limit below.
    if (!camera.T_camera_lidar.matrix().allFinite() || !camera.covariance.allFinite() ||
        !std::isfinite(camera.chi2)) {
        reasons.push_back(who +
                          "the pose, its covariance or its chi-square holds NaN or infinity, so "
                          "nothing is known of it; check the pairs and their covariances");
        return Level::not_usable;
    }

    const PrincipalSigma sigma = principal_sigma(camera);
    const double rotation_deg = sigma.rotation * kDegrees;
    const bool useless =
        sigma.translation > params.not_usable_sigma || rotation_deg > params.not_usable_sigma_deg;
    const bool good =
        sigma.translation <= params.usable_sigma && rotation_deg <= params.usable_sigma_deg;
    if (useless || !good) {
        lower(level, useless ? Level::not_usable : Level::weak);
        reasons.push_back(who +
                          printed("1 sigma is up to %.1f mm and %.3f deg", sigma.translation * 1e3,
                                  rotation_deg) +
                          (useless
                               ? printed(" (not usable above %.0f mm or %.2f deg)",
                                         params.not_usable_sigma * 1e3, params.not_usable_sigma_deg)
                               : printed(" (usable up to %.1f mm and %.2f deg)",
                                         params.usable_sigma * 1e3, params.usable_sigma_deg)) +
                          "; weakest: " + camera.weakest_direction);
    }

    const int freedom = camera.degrees_of_freedom;
    const double most = chi2_quantile(freedom, params.chi2_two_sided ? kTwoSidedZ : kUpperZ);
    const double least = params.chi2_two_sided ? chi2_quantile(freedom, -kTwoSidedZ) : 0.0;
    if (freedom == 0) {
        lower(level, Level::weak);
        reasons.push_back(who + "no degrees of freedom are left, so the residuals prove nothing");
    } else if (camera.chi2 > most || camera.chi2 < least) {
        lower(level, Level::weak);
        reasons.push_back(who +
                          printed("chi-square is %.1f with %.0f degrees of freedom", camera.chi2,
                                  static_cast<double>(freedom)) +
                          printed(", outside its 99.9 %% band %.1f to %.1f: ", least, most) +
                          (camera.chi2 > most
                               ? "the residuals are larger than the pairs' covariances"
                               : "the residuals are smaller than the pairs' covariances"));
    }

    switch (camera.order.by) {
        case DecidedBy::undecided:
            lower(level, Level::not_usable);
            break;
        case DecidedBy::prior:
            lower(level, Level::weak);
            break;
        case DecidedBy::data:
        case DecidedBy::given:
            break;
    }
    if (camera.order.contradicts_priors) {
        lower(level, Level::weak);
        reasons.push_back(who + "the data decided the order, but " + camera.order.reason);
    }
    if (camera.order.by == DecidedBy::undecided || camera.order.by == DecidedBy::prior)
        reasons.push_back(who +
                          (camera.order.by == DecidedBy::prior
                               ? "the order of the corners was decided by the prior"
                               : "the order of the corners is undecided") +
                          (camera.order.reason.empty() ? "" : ": " + camera.order.reason));
    return level;
}

}  // namespace petal
