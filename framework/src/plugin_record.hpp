// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>

#include "petal/plugin.hpp"

namespace petal {

/// read_plugin_record() with messages that do not repeat the file's name: for a Refusal, which has
/// it.
PluginRecord read_record(const std::filesystem::path& library);

}  // namespace petal
