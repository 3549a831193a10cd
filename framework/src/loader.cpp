// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "loader.hpp"

#include <exception>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include "host_errors.hpp"
#include "plugin_opening.hpp"
#include "plugin_search.hpp"

namespace petal {
namespace {

/// A library whose record fits this host.
struct Fitting {
    Candidate candidate;
    PluginRecord record;
};

/// Which ABI of each library of packet types this process uses, by its name. The framework knows no
/// packet type, so the plugins beside libpetal.so (the last folder) tell; where they use none, the
/// first plugin.
std::map<std::string, std::uint32_t> types_in_use(const std::vector<Fitting>& plugins,
                                                  std::size_t own_folder) {
    std::map<std::string, std::uint32_t> in_use;
    for (const bool own : {true, false})
        for (const Fitting& plugin : plugins)
            if ((plugin.candidate.folder == own_folder) == own &&
                plugin.record.types_name[0] != '\0')
                in_use.emplace(plugin.record.types_name, plugin.record.types_abi);
    return in_use;
}

void check_types(const PluginRecord& record, const std::map<std::string, std::uint32_t>& in_use) {
    const auto found = in_use.find(record.types_name);
    if (found == in_use.end() || found->second == record.types_abi) return;
    throw Error("was built against other packet types: ABI of the library '" + found->first +
                "': plugin " + std::to_string(record.types_abi) + ", petal's plugins " +
                std::to_string(found->second) + "; build it again");
}

}  // namespace

PluginSet survey_plugins(const std::vector<std::filesystem::path>& folders) {
    PluginSet set;
    set.searched = folders;
    // All records are read before the first library is opened: they tell which types are in use.
    std::vector<Fitting> plugins;
    for (const Candidate& candidate : find_candidates(folders, set.refused)) {
        try {
            plugins.push_back({candidate, fitting_record(candidate.library)});
        } catch (const Error& error) {
            set.refused.push_back({candidate.library, error.what()});
        }
    }
    const auto in_use = types_in_use(plugins, folders.empty() ? 0 : folders.size() - 1);
    for (const Fitting& plugin : plugins) {
        OpenedPlugin opened;
        try {
            check_types(plugin.record, in_use);
            opened = open_plugin(plugin.candidate.library, plugin.record);
        } catch (const std::exception& error) {
            set.refused.push_back({plugin.candidate.library, error.what()});
            continue;
        }
        for (StageSpec& stage : opened.stages) {
            try {
                set.registry.add(std::move(stage));
            } catch (const PluginError& clash) {
                set.clashes.emplace_back(clash.what());
            }
        }
        set.loaded.push_back(std::move(opened.plugin));
        std::move(opened.thread_limits.begin(), opened.thread_limits.end(),
                  std::back_inserter(set.thread_limits));
    }
    return set;
}

PluginSet load_plugins(const std::vector<std::filesystem::path>& folders) {
    PluginSet set = survey_plugins(folders);
    if (set.clashes.empty()) return set;
    // A type in two libraries is the user's to solve, not ours to choose.
    const std::size_t more = set.clashes.size() - 1;
    throw PluginError(
        set.clashes.front() +
        (more > 0 ? "; 'petal plugins' lists " + std::to_string(more) + " more" : ""));
}

}  // namespace petal
