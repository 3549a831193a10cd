// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "schema_stage.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>

#include "nearest.hpp"
#include "param_check.hpp"
#include "value_json.hpp"

namespace petal {
namespace {

using Json = SchemaJson;

// One `${...}` as expand() takes it, and what else a text may hold.
const char* const kExpansion = R"(\$\{(data|out|env:[A-Za-z_][A-Za-z0-9_]*)\})";

Json text_schema(const std::string& plain) {
    return {{"type", "string"},
            {"pattern", "^(" + plain + R"(|\$(?!\{)|)" + kExpansion + ")*$"},
            {"patternErrorMessage", "expected a text; in it ${data}, ${out} and ${env:NAME} only"}};
}

/// A bound as it was meant: 10, not 10.0; an integer's own where it has one.
Json bound(double value) {
    constexpr double kExact = 9007199254740992.0;  // 2^53: every integer up to it is a double
    if (value == std::trunc(value) && std::abs(value) <= kExact)
        return static_cast<std::int64_t>(value);
    return value;
}

Json number_schema(const ParamSpec& param) {
    using Limits = std::numeric_limits<std::int64_t>;
    const bool integer = param.kind == Kind::integer;
    Json schema{{"type", integer ? "integer" : "number"}};
    // The bounds of 64 bits hold where nothing narrower was declared.
    if (param.min && std::isfinite(*param.min)) {
        schema["minimum"] = bound(*param.min);
    } else if (integer) {
        schema["minimum"] = Limits::min();
    }
    if (param.max && std::isfinite(*param.max)) {
        schema["maximum"] = bound(*param.max);
    } else if (integer) {
        schema["maximum"] = Limits::max();
    }
    return schema;
}

/// One value: of a list, an element.
Json value_schema(const ParamSpec& param) {
    switch (param.kind) {
        case Kind::boolean:
            return {{"type", "boolean"}};
        case Kind::integer:
        case Kind::real:
            return number_schema(param);
        case Kind::choice: {
            // The name of a choice may come from the environment: only the check can tell.
            Json from_environment{{"type", "string"}, {"pattern", kExpansion}};
            return {{"anyOf", {{{"enum", param.choices}}, std::move(from_environment)}}};
        }
        case Kind::text:
            return text_schema("[^$]");
        case Kind::path:
            return text_schema(R"([^$\u0000])");
    }
    return Json::object();
}

Json param_schema(const ParamSpec& param) {
    Json schema = value_schema(param);
    if (param.list) schema = Json{{"type", "array"}, {"items", std::move(schema)}};
    schema["description"] = param.doc + " (" + expected_value(param, param.list) + ")";
    schema["default"] = value_json(param.default_value);
    return schema;
}

Json params_schema(const StageSpec& stage) {
    Json properties = Json::object();
    for (const ParamSpec& param : stage.params) properties[param.name] = param_schema(param);
    return {
        {"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
}

/// Any stage's port that writes this type.
Json wire_schema(const std::string& type, const Registry& registry) {
    std::set<std::string> ports;
    for (const StageSpec* stage : registry.all())
        for (const PortSpec& port : stage->outputs)
            if (port.type == type) ports.insert(port.name);
    Json schema = any_wire_schema();
    if (ports.empty()) return schema;
    const std::string names = join({ports.begin(), ports.end()}, "|");
    schema["pattern"] = std::string("^") + kIdPattern + "\\.(" + names + ")$";
    schema["patternErrorMessage"] = "expected a wire of type " + type + ": STAGE." + names;
    return schema;
}

Json port_schema(const PortSpec& port, const Registry& registry, DocumentKind kind) {
    Json wire = wire_schema(port.type, registry);
    Json forms = Json::array({wire});
    if (port.gathers)
        forms.push_back({{"type", "array"},
                         {"items", std::move(wire)},
                         {"minItems", 1},
                         {"uniqueItems", true}});
    if (kind == DocumentKind::patch) forms.push_back({{"type", "null"}});
    Json schema = forms.size() == 1 ? Json(forms.front()) : Json{{"anyOf", std::move(forms)}};
    schema["description"] = port.doc + " (" + port.type + (port.gathers ? ", gathered" : "") +
                            (port.optional ? ", optional" : "") + ")";
    return schema;
}

Json inputs_schema(const StageSpec& stage, const Registry& registry, DocumentKind kind) {
    Json properties = Json::object();
    Json required = Json::array();
    for (const PortSpec& port : stage.inputs) {
        properties[port.name] = port_schema(port, registry, kind);
        if (!port.optional) required.push_back(port.name);
    }
    Json schema{{"properties", std::move(properties)}};
    if (kind == DocumentKind::patch) {
        // The wires of the stage's old type are removed by null.
        schema["additionalProperties"] = {{"type", "null"}};
        return schema;
    }
    schema["additionalProperties"] = false;
    if (!required.empty()) {
        schema["required"] = std::move(required);
    } else if (!stage.inputs.empty()) {
        schema["minProperties"] = 1;  // without any it would never fire
    }
    return schema;
}

}  // namespace

SchemaJson any_wire_schema() {
    return {{"type", "string"},
            {"pattern", std::string("^") + kIdPattern + "\\.[a-z0-9_]+$"},
            {"patternErrorMessage", "expected a wire: STAGE.PORT"}};
}

SchemaJson stage_schema(const StageSpec& stage, const Registry& registry, DocumentKind kind) {
    Json schema{{"description", stage.summary},
                {"properties",
                 {{"in", inputs_schema(stage, registry, kind)}, {"params", params_schema(stage)}}}};
    if (kind == DocumentKind::pipeline && !stage.inputs.empty())
        schema["required"] = Json::array({"in"});
    return schema;
}

}  // namespace petal
