// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

#include "loader.hpp"

namespace petal::testing {

/// The stages of the build tree, loaded once.
inline const PluginSet& built_plugins() {
    static const PluginSet set = load_plugins({PETAL_BUILD_DIR "/lib/petal"});
    return set;
}

inline std::vector<std::string> built_types() {
    return built_plugins().registry.types();
}

/// A stage type as the name of a test.
inline std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
    std::string name = info.param;
    for (char& c : name)
        if (c == '.') c = '_';
    return name;
}

}  // namespace petal::testing
