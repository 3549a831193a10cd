// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace petal::testing {

/// The folder of real data: PETAL_REAL_DATA, else ../shared/data beside the project. Empty where
/// absent.
inline std::filesystem::path real_data() {
    namespace fs = std::filesystem;
    if (const char* set = std::getenv("PETAL_REAL_DATA")) return set;
    const fs::path beside = fs::path(PETAL_SOURCE_DIR) / ".." / "shared" / "data";
    return fs::exists(beside) ? fs::canonical(beside) : fs::path();
}

}  // namespace petal::testing

/// Skips the test, visibly, where the real data are not there.
#define PETAL_NEEDS_REAL_DATA()                \
    if (::petal::testing::real_data().empty()) \
    GTEST_SKIP() << "no real data: set PETAL_REAL_DATA, or put them in ../shared/data"
