// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <iostream>

#include "catalogue.hpp"
#include "command.hpp"
#include "nearest.hpp"

namespace petal::cli {

namespace {

struct Options {
    std::string name;
    std::string role;
    bool json = false;
    bool markdown = false;
};

std::vector<const StageSpec*> of_role(const Registry& registry, const std::string& role) {
    std::vector<const StageSpec*> stages;
    for (const StageSpec* stage : registry.all())
        if (role.empty() || stage->role == role) stages.push_back(stage);
    return stages;
}

int print_one(const Registry& registry, const Options& options) {
    const StageSpec* stage = registry.find(options.name);
    if (stage == nullptr) {
        std::cerr << "petal stages: no stage type '" << options.name << "'"
                  << did_you_mean(options.name, registry.types()) << "\n";
        return kWrongUsage;
    }
    if (options.json) {
        std::cout << catalogue_json({stage});
    } else {
        std::cout << (options.markdown ? stage_markdown(*stage) : stage_text(*stage));
    }
    return kDone;
}

int print_all(const Registry& registry, const Options& options) {
    const auto stages = of_role(registry, options.role);
    if (stages.empty() && !options.role.empty()) {
        std::vector<std::string> roles;
        for (const StageSpec* stage : registry.all())
            if (!stage->role.empty()) roles.push_back(stage->role);
        std::cerr << "petal stages: no stage has the role '" << options.role << "'"
                  << did_you_mean(options.role, roles) << "\n";
        return kWrongUsage;
    }
    if (options.json) {
        std::cout << catalogue_json(stages);
    } else {
        std::cout << (options.markdown ? catalogue_markdown(stages, "docs/stages")
                                       : catalogue_text(stages));
    }
    return kDone;
}

}  // namespace

void add_stages(CLI::App& app, const GlobalOptions& global, Action& action) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("stages", "the catalogue of stages; one stage in full");
    command->add_option("NAME", options->name, "a stage type");
    command->add_option("--role", options->role, "only stages of that role");
    auto* json = command->add_flag("--json", options->json, "machine-readable");
    command->add_flag("--markdown", options->markdown, "as in the README and docs/stages")
        ->excludes(json);
    command->callback([options, &global, &action] {
        action = [options, &global] {
            const PluginSet plugins = find_plugins(global);
            return options->name.empty() ? print_all(plugins.registry, *options)
                                         : print_one(plugins.registry, *options);
        };
    });
}

}  // namespace petal::cli
