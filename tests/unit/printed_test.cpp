// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/printed.hpp"

#include <gtest/gtest.h>

#include <clocale>

namespace petal {
namespace {

TEST(Printed, IsPrintfsText) {
    EXPECT_EQ(printed("%s: %.2f px, %d of %zu", "camera", 1.005 + 1e-9, 3, std::size_t{4}),
              "camera: 1.01 px, 3 of 4");
    EXPECT_EQ(printed("%s", ""), "");
    EXPECT_EQ(printed("%s", std::string(1000, 'x').c_str()), std::string(1000, 'x'));
}

// scripts/checks/locale.sh runs this one where the process has a decimal comma.
TEST(Printed, HasADecimalPointAndLeavesTheLocaleAlone) {
    const std::string before = std::localeconv()->decimal_point;
    EXPECT_EQ(printed("%.1f", 1.5), "1.5");
    EXPECT_EQ(std::localeconv()->decimal_point, before);
}

}  // namespace
}  // namespace petal
