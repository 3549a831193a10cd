// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "schema.hpp"

#include <cstdint>
#include <limits>
#include <utility>

#include "schema_stage.hpp"

namespace petal {
namespace {

using Json = SchemaJson;

/// `type`, or null too where the document is a patch.
Json nullable(const std::string& type, DocumentKind kind) {
    if (kind == DocumentKind::pipeline) return type;
    return Json::array({type, "null"});
}

Json with_description(Json schema, const std::string& text) {
    schema["description"] = text;
    return schema;
}

Json inputs_of_any_stage(DocumentKind kind) {
    Json list{
        {"type", "array"}, {"items", any_wire_schema()}, {"minItems", 1}, {"uniqueItems", true}};
    Json forms = Json::array({any_wire_schema(), std::move(list)});
    if (kind == DocumentKind::patch) forms.push_back({{"type", "null"}});
    return {{"type", nullable("object", kind)},
            {"additionalProperties", {{"anyOf", std::move(forms)}}},
            {"description", "the wires: \"PORT\": \"STAGE.PORT\""}};
}

Json params_of_any_stage(DocumentKind kind) {
    Json schema{{"type", nullable("object", kind)}, {"description", "parameters by their names"}};
    // No parameter is an object; a null of a patch removes one that the pipeline gives.
    Json kinds = Json::array({"boolean", "number", "string", "array"});
    if (kind == DocumentKind::patch) kinds.push_back("null");
    schema["additionalProperties"] = {{"type", std::move(kinds)}};
    return schema;
}

/// A stage of any type, then what its own type asks for.
Json stage_of_any_type(const Registry& registry, DocumentKind kind) {
    Json summaries = Json::array();
    Json by_type = Json::array();
    for (const StageSpec* stage : registry.all()) {
        summaries.push_back(stage->summary);
        by_type.push_back({{"if",
                            {{"properties", {{"type", {{"const", stage->type}}}}},
                             {"required", Json::array({"type"})}}},
                           {"then", {{"$ref", "#/definitions/" + stage->type}}}});
    }
    Json type{{"type", "string"}, {"description", "the stage's type, KIND.NAME"}};
    if (!summaries.empty()) {
        type["enum"] = registry.types();
        type["enumDescriptions"] = std::move(summaries);  // editors show them beside the names
    }
    Json schema{
        {"type", nullable("object", kind)},
        {"properties",
         {{"type", std::move(type)},
          {"about", {{"type", nullable("string", kind)}, {"description", "what it is here for"}}},
          {"in", inputs_of_any_stage(kind)},
          {"params", params_of_any_stage(kind)}}},
        {"additionalProperties", false}};
    if (kind == DocumentKind::pipeline) schema["required"] = Json::array({"type"});
    if (!by_type.empty()) schema["allOf"] = std::move(by_type);
    return schema;
}

Json stages(DocumentKind kind) {
    Json schema{
        {"type", "object"},
        {"propertyNames",
         {{"pattern", std::string("^") + kIdPattern + "$"},
          {"patternErrorMessage",
           "expected a stage id: lower case letters, digits and '_', beginning with a letter"}}},
        {"additionalProperties", {{"$ref", "#/definitions/stage"}}},
        {"description", "the stages by their ids"}};
    if (kind == DocumentKind::pipeline) schema["minProperties"] = 1;
    return schema;
}

Json keys(DocumentKind kind) {
    const Json text{{"type", nullable("string", kind)}};
    Json seed{{"type", nullable("integer", kind)},
              {"minimum", 0},
              {"maximum", std::numeric_limits<std::uint64_t>::max()}};
    if (kind == DocumentKind::pipeline) seed["default"] = 0;
    return {{"petal", {{"const", kPipelineFormat}, {"description", "the format's version"}}},
            {"$schema", text},
            {"about", with_description(text, "what it is for")},
            {"seed", with_description(std::move(seed), "of all randomness")},
            {"stages", stages(kind)}};
}

std::string schema_text(const Registry& registry, DocumentKind kind) {
    const bool patch = kind == DocumentKind::patch;
    Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
                {"title", patch ? "patch of a petal pipeline" : "petal pipeline"},
                {"description", std::string("Made by `petal schema") + (patch ? " --patch" : "") +
                                    "` from the declarations of the stages."},
                {"type", "object"},
                {"properties", keys(kind)},
                {"additionalProperties", false}};
    if (!patch) schema["required"] = Json::array({"petal", "stages"});
    Json definitions{{"stage", stage_of_any_type(registry, kind)}};
    // A type holds a dot, so none is called "stage".
    for (const StageSpec* stage : registry.all())
        definitions[stage->type] = stage_schema(*stage, registry, kind);
    schema["definitions"] = std::move(definitions);
    return schema.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string pipeline_schema(const Registry& registry) {
    return schema_text(registry, DocumentKind::pipeline);
}

std::string patch_schema(const Registry& registry) {
    return schema_text(registry, DocumentKind::patch);
}

}  // namespace petal
