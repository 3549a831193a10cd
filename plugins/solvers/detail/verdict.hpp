// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

#include "petal/calibration/extrinsics.hpp"
#include "petal/run.hpp"

namespace petal {

/// Up to where a result is what.
struct VerdictParams {
    double usable_sigma = 0.005;        ///< m
    double usable_sigma_deg = 0.06;     ///< deg
    double not_usable_sigma = 0.5;      ///< m
    double not_usable_sigma_deg = 5.0;  ///< deg
    bool chi2_two_sided = false;        ///< residuals too small for their covariances count too
};

/// A chi-square quantile by Wilson and Hilferty's cube root, at `z` standard deviations of the
/// normal distribution. Its error at the 99.9 % point is 2.3 % for 2 degrees of freedom, and falls
/// with more.
double chi2_quantile(int degrees_of_freedom, double z);

/// The level of one camera; the reasons (why not better) are added.
Level judge(const CameraExtrinsics& camera, const VerdictParams& params,
            std::vector<std::string>& reasons);

}  // namespace petal
