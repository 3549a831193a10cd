// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <iostream>

#include "command.hpp"
#include "nearest.hpp"
#include "plugin_probe.hpp"

namespace petal::cli {

namespace {

void print(const PluginSet& plugins) {
    std::cout << "searched:\n";
    for (const auto& folder : plugins.searched) std::cout << "  " << folder.string() << "\n";
    std::cout << "loaded:\n";
    for (const LoadedPlugin& plugin : plugins.loaded)
        std::cout << "  " << plugin.name << " " << plugin.version << "  " << plugin.library.string()
                  << "\n    " << join(plugin.types) << "\n";
    if (plugins.loaded.empty()) std::cout << "  none\n";
    if (plugins.refused.empty()) return;
    std::cout << "refused:\n";
    for (const Refusal& refusal : plugins.refused)
        std::cout << "  " << refusal.library.string() << "\n    " << refusal.reason << "\n";
}

void print(const std::vector<Probed>& probed) {
    for (const Probed& library : probed) {
        std::cout << to_string(library.result.outcome) << "  " << library.library.string() << "\n";
        if (!library.result.reason.empty()) std::cout << "    " << library.result.reason << "\n";
        if (!library.result.output.empty())
            std::cout << "    printed: " << library.result.output << "\n";
    }
    if (probed.empty()) std::cout << "no library found\n";
}

}  // namespace

void add_plugins(CLI::App& app, const GlobalOptions& global, Action& action) {
    auto probe_each = std::make_shared<bool>(false);
    CLI::App* command = app.add_subcommand("plugins", "which plugins were found, refused, and why");
    command->add_flag("--probe", *probe_each, "load each library in a child process of its own");
    command->callback([probe_each, &global, &action] {
        action = [probe_each, &global] {
            if (*probe_each) {
                print(probe_all(plugin_folders(global.plugin_path)));
            } else {
                print(find_plugins(global));
            }
            return static_cast<int>(kDone);
        };
    });
}

}  // namespace petal::cli
