// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "catalogue.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <variant>

#include "param_check.hpp"
#include "param_values.hpp"

namespace petal {

using Json = nlohmann::ordered_json;

namespace {

std::string port_kind(const PortSpec& port) {
    std::string text = port.type;
    if (port.gathers) text += ", gathered over all frames";
    if (port.optional) text += ", optional";
    return text;
}

/// A cell of a Markdown table: no bar or line end may break it.
std::string cell(std::string text) {
    std::string safe;
    for (const char c : text) {
        if (c == '|') safe += '\\';
        safe += c == '\n' ? ' ' : c;
    }
    return safe;
}

Json range_json(const ParamSpec& param) {
    Json range = Json::object();
    if (param.min) range["min"] = *param.min;
    if (param.max) range["max"] = *param.max;
    return range;
}

Json stage_json(const StageSpec& stage) {
    Json json{{"type", stage.type},     {"summary", stage.summary},        {"role", stage.role},
              {"plugin", stage.plugin}, {"version", stage.plugin_version}, {"doc", stage.doc}};
    json["inputs"] = Json::array();
    for (const PortSpec& port : stage.inputs)
        json["inputs"].push_back({{"name", port.name},
                                  {"type", port.type},
                                  {"optional", port.optional},
                                  {"gathers", port.gathers},
                                  {"doc", port.doc}});
    json["outputs"] = Json::array();
    for (const PortSpec& port : stage.outputs)
        json["outputs"].push_back({{"name", port.name}, {"type", port.type}, {"doc", port.doc}});
    json["params"] = Json::array();
    for (const ParamSpec& param : stage.params) {
        Json entry{{"name", param.name}, {"kind", to_string(param.kind)},
                   {"list", param.list}, {"default", Json::parse(value_text(param.default_value))},
                   {"unit", param.unit}, {"doc", param.doc}};
        if (param.min || param.max) entry["range"] = range_json(param);
        if (!param.choices.empty()) entry["choices"] = param.choices;
        json["params"].push_back(std::move(entry));
    }
    return json;
}

}  // namespace

std::string catalogue_text(const std::vector<const StageSpec*>& stages) {
    std::size_t widest_type = 0;
    std::size_t widest_role = 0;
    for (const StageSpec* stage : stages) {
        widest_type = std::max(widest_type, stage->type.size());
        widest_role = std::max(widest_role, stage->role.size());
    }
    std::string text;
    for (const StageSpec* stage : stages) {
        text += stage->type + std::string(widest_type - stage->type.size() + 2, ' ');
        text += stage->role + std::string(widest_role - stage->role.size() + 2, ' ');
        text += stage->summary + "\n";
    }
    return text;
}

std::string catalogue_markdown(const std::vector<const StageSpec*>& stages,
                               const std::string& pages) {
    std::string text = "| stage | role | what it does |\n|---|---|---|\n";
    for (const StageSpec* stage : stages)
        text += "| [" + stage->type + "](" + pages + "/" + stage->type + ".md) | " + stage->role +
                " | " + cell(stage->summary) + " |\n";
    return text;
}

std::string catalogue_json(const std::vector<const StageSpec*>& stages) {
    Json list = Json::array();
    for (const StageSpec* stage : stages) list.push_back(stage_json(*stage));
    return list.dump(2) + "\n";
}

std::string stage_text(const StageSpec& stage) {
    std::string text = stage.type + ": " + stage.summary + "\n";
    if (!stage.role.empty()) text += "role: " + stage.role + "\n";
    text += "plugin: " + stage.plugin + " " + stage.plugin_version + " (" + stage.library + ")\n";
    const auto ports = [&text](const char* title, const std::vector<PortSpec>& list) {
        if (list.empty()) return;
        text += std::string("\n") + title + ":\n";
        for (const PortSpec& port : list)
            text += "  " + port.name + " (" + port_kind(port) + "): " + port.doc + "\n";
    };
    ports("reads", stage.inputs);
    ports("writes", stage.outputs);
    if (!stage.params.empty()) text += "\nparameters:\n";
    for (const ParamSpec& param : stage.params) {
        text += "  " + param.name + " = " + value_text(param.default_value) + "  (" +
                expected_value(param, param.list) + ")\n      " + param.doc + "\n";
    }
    if (!stage.doc.empty()) text += "\n" + stage.doc + "\n";
    return text;
}

std::string stage_markdown(const StageSpec& stage) {
    std::string text = "<!-- Generated from the stage's declaration; see CONTRIBUTING.md. -->\n\n";
    text += "# " + stage.type + "\n\n" + stage.summary + "\n\n";
    if (!stage.role.empty())
        text += "Role: `" + stage.role +
                "`: stages of one role replace each other by `type` and `params` alone.\n\n";
    const auto ports = [&text](const char* title, const std::vector<PortSpec>& list) {
        if (list.empty()) return;
        text += std::string("## ") + title + "\n\n| port | type | what |\n|---|---|---|\n";
        for (const PortSpec& port : list)
            text += "| `" + port.name + "` | " + port_kind(port) + " | " + cell(port.doc) + " |\n";
        text += "\n";
    };
    ports("Reads", stage.inputs);
    ports("Writes", stage.outputs);
    if (!stage.params.empty())
        text += "## Parameters\n\n| name | default | takes | what |\n|---|---|---|---|\n";
    for (const ParamSpec& param : stage.params)
        text += "| `" + param.name + "` | `" + cell(value_text(param.default_value)) + "` | " +
                cell(expected_value(param, param.list)) + " | " + cell(param.doc) + " |\n";
    if (!stage.params.empty()) text += "\n";
    if (!stage.doc.empty()) text += "## How it works\n\n" + stage.doc + "\n";
    return text;
}

}  // namespace petal
