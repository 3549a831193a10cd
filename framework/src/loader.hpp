// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "petal/plugin.hpp"
#include "registry.hpp"

namespace petal {

/// A library that was found and not loaded.
struct Refusal {
    std::filesystem::path library;
    std::string reason;  ///< names the fields that differ, with both values
};

struct LoadedPlugin {
    std::filesystem::path library;
    std::string name;
    std::string version;
    std::vector<std::string> types;
};

/// What a search for plugins gave. Libraries are never closed (MRPT keeps raw pointers into them).
struct PluginSet {
    Registry registry;
    std::vector<LoadedPlugin> loaded;
    std::vector<Refusal> refused;
    std::vector<std::string> clashes;             ///< types in two libraries, a sentence each
    std::vector<std::filesystem::path> searched;  ///< folders, in order
    std::vector<std::function<void(int)>> thread_limits;
};

/// Folders in order: `first` (--plugin-path), those of PETAL_PLUGIN_PATH, then the installed or
/// built place (lib/petal beside libpetal.so). Never the working folder or LD_LIBRARY_PATH; an
/// empty or relative element of PETAL_PLUGIN_PATH is refused. A folder that does not exist is an
/// error for `first` only.
std::vector<std::filesystem::path> plugin_folders(const std::vector<std::filesystem::path>& first);

/// Loads every plugin of the folders (sorted by file name in each; a library found twice is loaded
/// once). A bad library is skipped and remembered. \throws PluginError on two libraries with one
/// stage type.
PluginSet load_plugins(const std::vector<std::filesystem::path>& folders);

/// The same, to tell what is there: of two libraries with one type both are in `loaded`, and the
/// first has the type.
PluginSet survey_plugins(const std::vector<std::filesystem::path>& folders);

/// Reads the record of a library from the file, without opening the library.
/// \throws Error: no library, no record, record cut.
PluginRecord read_plugin_record(const std::filesystem::path& library);

/// Empty when the record fits this host; else what differs, field by field.
std::string mismatch(const PluginRecord& record, const BuildKey& host);

}  // namespace petal
