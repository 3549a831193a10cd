// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "loader.hpp"

namespace petal {

/// What one library registered.
struct OpenedPlugin {
    LoadedPlugin plugin;
    std::vector<StageSpec> stages;  ///< checked; plugin, plugin_version and library are filled
    std::vector<std::function<void(int)>> thread_limits;
};

/// Reads the record of a library and compares it with this host. \throws Error with the reason of
/// refusal.
PluginRecord fitting_record(const std::filesystem::path& library);

/// Opens a library whose record fits and lets it register: all of its stages, or none. It is never
/// closed. \throws Error with the reason of refusal: a missing symbol, an incomplete declaration,
/// what the library threw. Must not be called for a record that does not fit.
OpenedPlugin open_plugin(const std::filesystem::path& library, const PluginRecord& record);

}  // namespace petal
