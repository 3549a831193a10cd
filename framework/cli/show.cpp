// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <iostream>
#include <nlohmann/json.hpp>

#include "command.hpp"

namespace petal::cli {

namespace {

/// The graph and every parameter as text: one block a stage, in the order in which they can run.
void print_text(const Pipeline& pipeline) {
    using Json = nlohmann::ordered_json;
    const Json effective = Json::parse(pipeline.effective_json);
    if (!pipeline.about.empty()) std::cout << pipeline.about << "\n";
    std::cout << "seed " << pipeline.seed << "\n";
    for (const StageNode& node : pipeline.stages) {
        std::cout << "\n"
                  << node.id << "  (" << node.spec->type << ", "
                  << (node.once ? "once, after the last frame" : "each frame") << ")\n";
        for (const auto& [port, wires] : node.inputs)
            for (const Wire& wire : wires)
                std::cout << "  " << port << " <- " << wire.stage << "." << wire.port << "\n";
        for (const PortSpec& port : node.spec->outputs)
            std::cout << "  " << port.name << " -> " << port.type << "\n";
        const Json& params = effective["stages"][node.id]["params"];
        for (const ParamSpec& param : node.spec->params) {
            std::cout << "  " << param.name << " = " << params[param.name].dump();
            if (!param.unit.empty() && param.unit != "1") std::cout << " " << param.unit;
            std::cout << "\n";
        }
    }
}

}  // namespace

void add_show(CLI::App& app, const GlobalOptions& global, Action& action) {
    struct Options : PipelineOptions {
        bool dot = false;
        bool json = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("show", "the effective pipeline with every default, and its graph");
    options->add_to(*command);
    auto* dot = command->add_flag("--dot", options->dot, "the graph in Graphviz's language");
    command->add_flag("--json", options->json, "the effective pipeline, itself a pipeline")
        ->excludes(dot);
    command->callback([options, &global, &action] {
        action = [options, &global] {
            const PluginSet plugins = find_plugins(global);
            int exit_code = kDone;
            const auto pipeline = checked(options->request(), plugins, exit_code);
            if (!pipeline) return exit_code;
            if (options->dot) {
                std::cout << to_dot(*pipeline);
            } else if (options->json) {
                std::cout << pipeline->effective_json;
            } else {
                print_text(*pipeline);
            }
            return static_cast<int>(kDone);
        };
    });
}

}  // namespace petal::cli
