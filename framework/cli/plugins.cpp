// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <iostream>

#include "command.hpp"
#include "plugin_probe.hpp"

namespace petal::cli {

namespace {

constexpr std::size_t kWidth = 100;

std::string padded(const std::string& text, std::size_t width) {
    return text + std::string(width > text.size() ? width - text.size() : 0, ' ');
}

/// Names one after the other, in lines of the terminal's usual width, indented.
std::string wrapped(const std::vector<std::string>& names, std::size_t indent) {
    const std::string margin(indent, ' ');
    std::string text;
    std::string line = margin;
    for (const std::string& name : names) {
        const bool first = line.size() == margin.size();
        if (!first && line.size() + name.size() + 3 > kWidth) {
            text += line + ",\n";
            line = margin + name;
        } else {
            line += (first ? "" : ", ") + name;
        }
    }
    return text + line + "\n";
}

void print_loaded(const std::vector<LoadedPlugin>& plugins) {
    std::cout << "loaded:\n";
    if (plugins.empty()) std::cout << "  none\n";
    std::size_t name = 0;
    std::size_t version = 0;
    for (const LoadedPlugin& plugin : plugins) {
        name = std::max(name, plugin.name.size());
        version = std::max(version, plugin.version.size());
    }
    for (const LoadedPlugin& plugin : plugins)
        std::cout << "  " << padded(plugin.name, name) << "  " << padded(plugin.version, version)
                  << "  " << plugin.library.string() << "\n"
                  << wrapped(plugin.types, name + version + 6);
}

int print(const PluginSet& plugins) {
    std::cout << "searched:\n";
    for (const auto& folder : plugins.searched) {
        std::error_code ignored;
        std::cout << "  " << folder.string()
                  << (std::filesystem::exists(folder, ignored) ? "" : "  (not there)") << "\n";
    }
    print_loaded(plugins.loaded);
    if (!plugins.refused.empty()) std::cout << "refused:\n";
    for (const Refusal& refusal : plugins.refused)
        std::cout << "  " << refusal.library.string() << "\n    " << refusal.reason << "\n";
    if (plugins.clashes.empty()) return kDone;
    std::cout << "nothing can run with these:\n";
    for (const std::string& clash : plugins.clashes) std::cout << "  " << clash << "\n";
    return kMissingPlugin;
}

/// A refused library is skipped and does no harm; one that ends or blocks petal does, and so do two
/// with one type.
int print(const std::vector<Probed>& probed) {
    using Outcome = ProbeResult::Outcome;
    constexpr std::size_t kWidestOutcome = 7;
    int exit_code = kDone;
    for (const Probed& library : probed) {
        const ProbeResult& result = library.result;
        std::cout << padded(to_string(result.outcome), kWidestOutcome) << "  "
                  << library.library.string() << "\n";
        if (!result.types.empty()) std::cout << wrapped(result.types, 4);
        if (!result.reason.empty()) std::cout << "    " << result.reason << "\n";
        if (!result.output.empty()) std::cout << "    printed: " << result.output << "\n";
        for (const std::string& clash : library.clashes) std::cout << "    " << clash << "\n";
        if (result.outcome == Outcome::crashed || result.outcome == Outcome::hung ||
            !library.clashes.empty())
            exit_code = kMissingPlugin;
    }
    if (probed.empty()) std::cout << "no library found\n";
    return exit_code;
}

}  // namespace

void add_plugins(CLI::App& app, const GlobalOptions& global, Action& action) {
    auto probe_each = std::make_shared<bool>(false);
    CLI::App* command = app.add_subcommand("plugins", "which plugins were found, refused, and why");
    command->add_flag("--probe", *probe_each, "load each library in a child process of its own");
    command->callback([probe_each, &global, &action] {
        action = [probe_each, &global] {
            const auto folders = plugin_folders(global.plugin_path);
            return *probe_each ? print(probe_all(folders)) : print(survey_plugins(folders));
        };
    });
}

}  // namespace petal::cli
