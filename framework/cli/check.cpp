// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <iostream>

#include "command.hpp"

namespace petal::cli {

void add_check(CLI::App& app, const GlobalOptions& global, Action& action) {
    auto options = std::make_shared<PipelineOptions>();
    CLI::App* command = app.add_subcommand("check", "all checks of a pipeline that need no data");
    options->add_to(*command);
    command->callback([options, &global, &action] {
        action = [options, &global] {
            const PluginSet plugins = find_plugins(global);
            int exit_code = kDone;
            const auto pipeline = checked(options->request(), plugins, exit_code);
            if (!pipeline) return exit_code;
            if (!debug_ids_known(options->debug, *pipeline)) return static_cast<int>(kWrongUsage);
            if (!global.quiet)
                std::cout << options->pipeline.string() << ": " << pipeline->stages.size()
                          << (pipeline->stages.size() == 1 ? " stage" : " stages")
                          << ", no problem found\n";
            return static_cast<int>(kDone);
        };
    });
}

}  // namespace petal::cli
