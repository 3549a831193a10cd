// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>
#include <vector>

namespace petal::compare {

struct SignedRank {
    double p = 1.0;     ///< two-sided
    int direction = 0;  ///< of the larger sum of ranks: -1, 0, 1
};

/// Wilcoxon's signed-rank test that the differences are symmetric about 0.
/// They may be infinite (those are the largest, and equal); zeros are left out (Wilcoxon), ties get
/// the mean of their ranks. Exact for up to 200 differences (all 2^n signs, counted by dynamic
/// programming on doubled ranks), else by the normal approximation with the variance of these very
/// ranks. p is 1 where no difference is left.
SignedRank signed_rank(const std::vector<double>& differences);

/// Two-sided p-value that `a` and `b` come from a fair coin: the exact sign test, here also
/// McNemar's.
double sign_p(std::uint64_t a, std::uint64_t b);

/// Holm's step-down adjustment: p-values to be set against the level of the whole family.
std::vector<double> holm(const std::vector<double>& p_values);

}  // namespace petal::compare
