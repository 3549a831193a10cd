// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>

#include "petal/spec.hpp"
#include "solvers/detail/verdict.hpp"

namespace petal {

/// Declares the parameters of VerdictParams, which `Params` is derived from.
template <class Params>
void declare_verdict(Spec<Params>& s) {
    s.param("usable_sigma", &VerdictParams::usable_sigma)
        .unit("m")
        .within(0.0, 10.0)
        .doc("usable up to this largest principal 1-sigma of the translation");
    s.param("usable_sigma_deg", &VerdictParams::usable_sigma_deg)
        .unit("deg")
        .within(0.0, 180.0)
        .doc("usable up to this largest principal 1-sigma of the rotation");
    s.param("not_usable_sigma", &VerdictParams::not_usable_sigma)
        .unit("m")
        .within(0.0, 1000.0)
        .doc("not usable above this largest principal 1-sigma of the translation");
    s.param("not_usable_sigma_deg", &VerdictParams::not_usable_sigma_deg)
        .unit("deg")
        .within(0.0, 180.0)
        .doc("not usable above this largest principal 1-sigma of the rotation");
    s.param("chi2_two_sided", &VerdictParams::chi2_two_sided)
        .doc("a chi-square below its 99.9 % band makes the result weak too, not only one above");
    s.check([](const Params& p) {
        return p.usable_sigma <= p.not_usable_sigma && p.usable_sigma_deg <= p.not_usable_sigma_deg
                   ? std::string()
                   : "usable_sigma and usable_sigma_deg must not exceed not_usable_sigma and "
                     "not_usable_sigma_deg";
    });
}

}  // namespace petal
