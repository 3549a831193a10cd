// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "schema.hpp"

#include <iostream>

#include "command.hpp"
#include "comparison_reader.hpp"
#include "petal/output.hpp"

namespace petal::cli {

void add_schema(CLI::App& app, const GlobalOptions& global, Action& action) {
    struct Options {
        bool patch = false;
        bool comparison = false;
        std::string out;
    };
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "schema", "the JSON schema of pipelines of these stages, for editors and validators");
    auto* patch = command->add_flag("--patch", options->patch, "of patches (--with) instead");
    command->add_flag("--comparison", options->comparison, "of comparison files instead")
        ->excludes(patch);
    command->add_option("--out", options->out, "file to write it to, instead of printing it");
    command->callback([options, &global, &action] {
        action = [options, &global] {
            const PluginSet plugins = find_plugins(global);
            const std::string text = options->comparison
                                         ? compare::comparison_schema(plugins.registry)
                                     : options->patch ? patch_schema(plugins.registry)
                                                      : pipeline_schema(plugins.registry);
            if (options->out.empty()) {
                std::cout << text;
            } else {
                PendingFile file(options->out);
                write_file(file.path(), text);
                file.commit();
            }
            return static_cast<int>(kDone);
        };
    });
}

}  // namespace petal::cli
