// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "effective_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "pipeline_shape.hpp"
#include "value_json.hpp"

namespace petal {
namespace {

using Json = nlohmann::ordered_json;

Json inputs_json(const DraftStage& stage) {
    Json inputs = Json::object();
    for (const PortSpec& port : stage.spec->inputs) {
        const auto input = std::find_if(stage.inputs.begin(), stage.inputs.end(),
                                        [&](const DraftInput& i) { return i.port == &port; });
        if (input == stage.inputs.end()) continue;
        Json wires = Json::array();
        for (const DraftWire& wire : input->wires) wires.push_back(wire.stage + "." + wire.port);
        inputs[port.name] = wires.size() == 1 ? wires.front() : wires;
    }
    return inputs;
}

Json stage_json(const DraftStage& stage) {
    Json json = Json::object();
    json["type"] = stage.spec->type;
    if (const JsonMember* about = stage.json->find("about")) json["about"] = about->value.text;
    Json inputs = inputs_json(stage);
    if (!inputs.empty()) json["in"] = std::move(inputs);
    Json params = Json::object();
    for (const ParamSpec& param : stage.spec->params)
        params[param.name] = value_json(stage.params.written.at(param.name));
    if (!params.empty()) json["params"] = std::move(params);
    return json;
}

}  // namespace

std::string effective_json(const std::string& about, std::uint64_t seed, const Draft& draft,
                           const std::vector<std::size_t>& order) {
    Json json = Json::object();
    json["petal"] = kPipelineFormat;
    if (!about.empty()) json["about"] = about;
    json["seed"] = seed;
    Json stages = Json::object();
    for (const std::size_t number : order) {
        const DraftStage& stage = draft.stages[number];
        stages[stage.id] = stage_json(stage);
    }
    json["stages"] = std::move(stages);
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace petal
