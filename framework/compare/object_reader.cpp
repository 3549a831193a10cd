// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "object_reader.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "number_text.hpp"
#include "seed_range.hpp"

namespace petal::compare {

namespace {

JsonNode object_around(const std::string& key, JsonNode value, const Origin& origin) {
    JsonNode object;
    object.kind = NodeKind::object;
    object.origin = origin;
    object.put(key, origin, std::move(value));
    return object;
}

}  // namespace

ObjectReader::ObjectReader(const JsonNode& node, std::string path, const std::string& file,
                           ProblemList& problems)
    : node_(node), path_(std::move(path)), file_(file), problems_(problems) {
    if (!node.is(NodeKind::object) && !node.is(NodeKind::invalid))
        problems_.add(node.origin, path_, describe(node) + " is no object; expected { ... }");
}

const JsonMember* ObjectReader::find(const std::string& key) {
    asked_.push_back(key);
    const JsonMember* member = node_.find(key);
    return member && !member->value.is(NodeKind::invalid) ? member : nullptr;
}

void ObjectReader::problem(const Origin& origin, const std::string& key,
                           const std::string& message) {
    problems_.add(origin, path_of(key), message);
}

std::optional<std::string> ObjectReader::text(const std::string& key) {
    const JsonMember* member = find(key);
    if (!member) return std::nullopt;
    if (member->value.is(NodeKind::text) && !member->value.text.empty()) return member->value.text;
    problem(member->value.origin, key,
            describe(member->value) + " is no text; expected a string that is not empty");
    return std::nullopt;
}

std::optional<std::string> ObjectReader::choice(const std::string& key,
                                                const std::vector<std::string>& choices) {
    auto value = text(key);
    if (!value || std::count(choices.begin(), choices.end(), *value) > 0) return value;
    problem(node_.find(key)->value.origin, key,
            "'" + printable(*value) + "' is unknown" + expected_one_of(*value, choices));
    return std::nullopt;
}

std::optional<double> ObjectReader::number(const std::string& key, double low, double high) {
    const JsonMember* member = find(key);
    if (!member) return std::nullopt;
    const JsonNode& value = member->value;
    const bool is_number = value.is(NodeKind::integer) || value.is(NodeKind::real);
    if (is_number && value.real >= low && value.real <= high) return value.real;
    problem(value.origin, key,
            describe(value) + (is_number ? " is out of range" : " is no number") + "; expected " +
                number_text(low) + (std::isinf(high) ? " or more" : " to " + number_text(high)));
    return std::nullopt;
}

std::optional<std::uint64_t> ObjectReader::whole_number(const std::string& key) {
    const JsonMember* member = find(key);
    if (!member) return std::nullopt;
    const auto value = member->value.as_uint64();
    if (!value)
        problem(member->value.origin, key,
                describe(member->value) + " is no seed; expected an integer from 0");
    return value;
}

std::optional<std::vector<std::uint64_t>> ObjectReader::seeds(const std::string& key) {
    const JsonMember* member = find(key);
    if (!member) return std::nullopt;
    const JsonNode& value = member->value;
    std::string why;
    if (value.is(NodeKind::text)) {
        auto read = read_seeds(value.text, why);
        if (why.empty()) return read;
    } else if (value.is(NodeKind::array) && !value.elements.empty()) {
        std::vector<std::uint64_t> list;
        for (const JsonNode& element : value.elements) {
            const auto seed = element.as_uint64();
            if (!seed) why = describe(element) + " is no seed; expected an integer from 0";
            list.push_back(seed.value_or(0));
        }
        if (why.empty() && std::set<std::uint64_t>(list.begin(), list.end()).size() != list.size())
            why = "a seed stands there twice; expected each once";
        if (why.empty()) return list;
    } else {
        why = describe(value) + " names no seeds; expected \"1..20\" or a list of integers";
    }
    problem(value.origin, key, why);
    return std::nullopt;
}

const JsonNode* ObjectReader::object(const std::string& key) {
    const JsonMember* member = find(key);
    if (!member) return nullptr;
    if (member->value.is(NodeKind::object)) return &member->value;
    problem(member->value.origin, key,
            describe(member->value) + " is no object; expected { \"NAME\": ... }");
    return nullptr;
}

std::vector<PipelineChange> ObjectReader::changes(const std::filesystem::path& folder) {
    std::vector<PipelineChange> all;
    const auto add_file = [&](const JsonNode& node, const std::string& key) {
        if (node.is(NodeKind::text) && !node.text.empty()) {
            all.push_back(
                PipelineChange::of_file((folder / node.text).lexically_normal().string()));
        } else {
            problem(node.origin, key, describe(node) + " is no file; expected a patch file's name");
        }
    };
    if (const JsonMember* with = find("with")) {
        if (with->value.is(NodeKind::array)) {
            for (const JsonNode& element : with->value.elements) add_file(element, "with");
        } else {
            add_file(with->value, "with");
        }
    }
    if (const JsonNode* patch = object("patch"))
        all.push_back(PipelineChange::of_patch(file_, *patch));
    if (const JsonNode* set = object("set"))
        for (const JsonMember& member : set->members)
            if (auto patch = set_patch(member.key, member.origin, member.value,
                                       path_join(path_of("set"), member.key), problems_))
                all.push_back(PipelineChange::of_patch(file_, std::move(*patch)));
    return all;
}

void ObjectReader::unknown_keys(const std::string& where) {
    for (const std::string& key : node_.keys()) {
        if (std::count(asked_.begin(), asked_.end(), key) > 0) continue;
        problem(node_.find(key)->origin, key,
                "unknown key '" + printable(key) + "' in " + where + expected_one_of(key, asked_));
    }
}

std::optional<JsonNode> set_patch(const std::string& name, const Origin& origin,
                                  const JsonNode& value, const std::string& path,
                                  ProblemList& problems) {
    const std::size_t dot = name.find('.');
    if (dot == std::string::npos || dot == 0 || dot + 1 == name.size() ||
        name.find('.', dot + 1) != std::string::npos) {
        problems.add(origin, path,
                     "'" + printable(name) +
                         "' names no parameter; expected STAGE.PARAM, as in solve.iterations");
        return std::nullopt;
    }
    JsonNode params = object_around(name.substr(dot + 1), value, origin);
    JsonNode stage = object_around("params", std::move(params), origin);
    return object_around("stages", object_around(name.substr(0, dot), std::move(stage), origin),
                         origin);
}

std::string compact_json(const JsonNode& node) {
    std::string inner;
    switch (node.kind) {
        case NodeKind::boolean:
            return node.boolean ? "true" : "false";
        case NodeKind::integer:
        case NodeKind::real:
            return node.text;
        case NodeKind::text:
            return nlohmann::json(node.text).dump(-1, ' ', false,
                                                  nlohmann::json::error_handler_t::replace);
        case NodeKind::array:
            for (const JsonNode& element : node.elements)
                inner += (inner.empty() ? "" : ",") + compact_json(element);
            return "[" + inner + "]";
        case NodeKind::object:
            for (const JsonMember& member : node.members)
                inner += (inner.empty() ? "\"" : ",\"") + printable(member.key) +
                         "\":" + compact_json(member.value);
            return "{" + inner + "}";
        case NodeKind::null:
        case NodeKind::invalid:
            break;
    }
    return "null";
}

}  // namespace petal::compare
