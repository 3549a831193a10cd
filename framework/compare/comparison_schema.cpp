// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "comparison_reader.hpp"
#include "schema.hpp"

namespace petal::compare {

namespace {

using Json = nlohmann::ordered_json;

Json text_schema(const std::string& description) {
    return {{"type", "string"}, {"minLength", 1}, {"description", description}};
}

Json number_schema(double low, double high, const std::string& description) {
    return {{"type", "number"}, {"minimum", low}, {"maximum", high}, {"description", description}};
}

Json object_of(const std::string& members, const std::string& description) {
    return {{"type", "object"},
            {"propertyNames", {{"pattern", "^[A-Za-z0-9_.+-]{1,64}$"}}},
            {"additionalProperties", {{"$ref", "#/definitions/" + members}}},
            {"description", description}};
}

Json seeds_schema() {
    const Json seed{{"type", "integer"},
                    {"minimum", 0},
                    {"maximum", std::numeric_limits<std::uint64_t>::max()}};
    return {{"anyOf",
             {{{"type", "string"}, {"pattern", "^[0-9]+(\\.\\.[0-9]+)?(,[0-9]+(\\.\\.[0-9]+)?)*$"}},
              {{"type", "array"}, {"items", seed}, {"minItems", 1}, {"uniqueItems", true}}}},
            {"description", "\"1..20\", \"1..5,8\", or a list"}};
}

/// with, patch and set: what a variant and a data item change.
void add_changes(Json& properties) {
    const Json file = text_schema("a patch file, relative to this one");
    properties["with"] = {{"anyOf", {file, {{"type", "array"}, {"items", file}}}},
                          {"description", "patch files, applied in order, first"}};
    properties["patch"] = {{"$ref", "#/definitions/patch"}};
    properties["set"] = {{"type", "object"},
                         {"propertyNames", {{"pattern", "^[^.]+\\.[^.]+$"}}},
                         {"description", "\"STAGE.PARAM\": value; applied after the patch"}};
}

Json closed_object(Json properties, std::vector<std::string> required = {}) {
    Json schema{{"type", "object"}};
    if (!required.empty()) schema["required"] = std::move(required);
    schema["properties"] = std::move(properties);
    schema["additionalProperties"] = false;
    return schema;
}

Json variant_schema() {
    Json properties{{"about", text_schema("what it is")},
                    {"pipeline", text_schema("a pipeline file in place of the base")}};
    add_changes(properties);
    return closed_object(std::move(properties));
}

Json data_item_schema() {
    Json properties{
        {"about", text_schema("what it is")},
        {"folder", text_schema("what ${data} stands for, relative to this file; ${env:NAME} "
                               "expands")}};
    add_changes(properties);
    properties["seeds"] = seeds_schema();
    return closed_object(std::move(properties));
}

Json metric_schema() {
    const Json choices{{"enum", {"lower", "higher", "none"}}, {"description", "which is better"}};
    Json margin{{"type", "number"},
                {"minimum", 0},
                {"description", "differences up to this do not matter, in the metric's unit"}};
    Json schema = closed_object({{"about", text_schema("what it is")},
                                 {"unit", text_schema("for the tables")},
                                 {"better", choices},
                                 {"margin", std::move(margin)},
                                 {"margin_share", number_schema(0, 1,
                                                                "the same, as a share of the "
                                                                "reference's median")}},
                                {"better"});
    schema["not"] = {{"required", {"margin", "margin_share"}}};
    return schema;
}

Json properties_schema() {
    Json metrics{{"type", "object"},
                 {"minProperties", 1},
                 {"additionalProperties", {{"$ref", "#/definitions/metric"}}},
                 {"description",
                  "by their names in result.json's \"metrics\"; a name that begins "
                  "with '/' is a JSON pointer into result.json"}};
    Json sweep{{"type", "object"},
               {"propertyNames", {{"pattern", "^[^.]+\\.[^.]+$"}}},
               {"additionalProperties", {{"type", "array"}, {"minItems", 1}}},
               {"description", "\"STAGE.PARAM\": values; each a variant of the reference"}};
    Json seed{{"type", "integer"},
              {"minimum", 0},
              {"maximum", std::numeric_limits<std::uint64_t>::max()},
              {"default", 1},
              {"description", "of the bootstrap"}};
    Json failure{{"enum", {"error", "not_usable", "weak"}},
                 {"default", "not_usable"},
                 {"description", "the mildest outcome that counts as a failure"}};
    Json all{
        {"petal_compare", {{"const", kComparisonFormat}, {"description", "the format's version"}}},
        {"$schema", text_schema("this schema")},
        {"about", text_schema("what it is for")},
        {"base", text_schema("the pipeline file of all variants, relative to this file")},
        {"patch", {{"$ref", "#/definitions/patch"}}},
        {"variants", object_of("variant", "by their names; {} is the base itself")},
        {"reference",
         text_schema("the variant that the others are compared with; default: the first")},
        {"sweep", std::move(sweep)},
        {"data", object_of("data", "by their names; default: what the pipeline itself reads")},
        {"seeds", seeds_schema()},
        {"metrics", std::move(metrics)},
        {"seed", std::move(seed)},
        {"confidence",
         number_schema(0.5, 0.999, "of the intervals and the verdicts; default 0.95")},
        {"failure", std::move(failure)},
        {"failure_margin", number_schema(0, 1,
                                         "share of pairs that a variant may fail more often "
                                         "and still be called better or equivalent; default 0")}};
    return all;
}

}  // namespace

std::string comparison_schema(const Registry& registry) {
    Json patch = Json::parse(patch_schema(registry));
    Json definitions{
        {"variant", variant_schema()}, {"data", data_item_schema()}, {"metric", metric_schema()}};
    for (auto& [name, definition] : patch["definitions"].items())
        definitions[name] = std::move(definition);
    for (const char* key : {"definitions", "$schema", "title"}) patch.erase(key);
    patch["description"] = "a patch (RFC 7396) of the pipeline";
    definitions["patch"] = std::move(patch);
    Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
                {"title", "petal comparison"},
                {"description",
                 "Made by `petal schema --comparison` from the declarations of the "
                 "stages."},
                {"type", "object"},
                {"properties", properties_schema()},
                {"additionalProperties", false},
                {"required", {"petal_compare", "metrics"}},
                {"definitions", std::move(definitions)}};
    return schema.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace petal::compare
