// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "param_check.hpp"

#include <algorithm>
#include <exception>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

namespace petal {
namespace {

std::string no_word(Kind kind) {
    switch (kind) {
        case Kind::boolean:
            return "bool";
        case Kind::integer:
            return "integer";
        case Kind::real:
            return "number";
        case Kind::text:
            return "string";
        case Kind::choice:
            return "choice";
        case Kind::path:
            return "path";
    }
    return "";
}

bool has_kind(const JsonNode& node, Kind kind) {
    switch (kind) {
        case Kind::boolean:
            return node.is(NodeKind::boolean);
        case Kind::integer:
            return node.is(NodeKind::integer);
        case Kind::real:
            return node.is(NodeKind::real) || node.is(NodeKind::integer);
        case Kind::text:
        case Kind::choice:
        case Kind::path:
            return node.is(NodeKind::text);
    }
    return false;
}

Value empty_list(Kind kind) {
    switch (kind) {
        case Kind::boolean:
            return std::vector<bool>{};
        case Kind::integer:
            return std::vector<std::int64_t>{};
        case Kind::real:
            return std::vector<double>{};
        default:
            return std::vector<std::string>{};
    }
}

/// Puts `element` at the end of `list`, which holds the same kind.
void append(Value& list, const Value& element) {
    std::visit(
        [&](auto& values) {
            using List = std::decay_t<decltype(values)>;
            if constexpr (!std::is_arithmetic_v<List> && !std::is_same_v<List, std::string>)
                values.push_back(std::get<typename List::value_type>(element));
        },
        list);
}

JsonNode text_node(const std::string& text, const Origin& origin) {
    JsonNode node;
    node.kind = NodeKind::text;
    node.origin = origin;
    node.text = text;
    return node;
}

/// Where a relation between parameters is told: at `params`, or at the value that came last where a
/// patch or --set changed one.
Origin relation_origin(const JsonNode& stage) {
    const JsonMember* params = stage.find("params");
    if (!params) return stage.origin;
    Origin latest = params->origin;
    for (const JsonMember& member : params->value.members)
        if (member.value.origin.file > latest.file) latest = member.value.origin;
    return latest;
}

/// A relation that throws is a mistake of the stage's author; the user is told whose.
std::vector<std::string> violated_relations(const StageSpec& spec, const void* params) {
    if (!spec.check_params) return {};
    const std::string failed = "the check of " + spec.type + " (plugin " + spec.plugin + ") failed";
    try {
        return spec.check_params(params);
    } catch (const std::exception& failure) {
        return {failed + ": " + failure.what()};
    } catch (...) {
        return {failed + ": it threw what is no std::exception"};
    }
}

}  // namespace

ParamCheck::ParamCheck(Expansions expansions, bool need_data, ProblemList& problems)
    : expansions_(std::move(expansions)), tell_data_(need_data), problems_(problems) {}

CheckedParams ParamCheck::check(const StageSpec& spec, const JsonNode& stage,
                                const std::string& path) {
    CheckedParams checked;
    const std::string place = path_join(path, "params");
    const JsonMember* written = stage.find("params");
    if (written && !written->value.is(NodeKind::object)) return checked;  // told already
    bool all_right = true;
    if (written) {
        std::vector<std::string> names;
        for (const ParamSpec& param : spec.params) names.push_back(param.name);
        for (const JsonMember& member : written->value.members) {
            if (spec.find_param(member.key)) continue;
            all_right = false;
            problems_.add(member.origin, path_join(place, member.key),
                          "unknown parameter '" + printable(member.key) + "' of " + spec.type +
                              expected_one_of(member.key, names));
        }
    }
    for (const ParamSpec& param : spec.params) {
        const JsonMember* member = written ? written->value.find(param.name) : nullptr;
        const std::string param_path = path_join(place, param.name);
        const Origin origin = stage.find("type") ? stage.find("type")->value.origin : stage.origin;
        auto value = member ? convert(param, member->value, param_path)
                            : convert_default(param, origin, param_path);
        if (!value) {
            all_right = false;
            continue;
        }
        checked.written.emplace(param.name, std::move(value->written));
        checked.expanded.emplace(param.name, std::move(value->expanded));
    }
    if (!all_right) return checked;
    auto params = spec.make_params();
    for (const ParamSpec& param : spec.params)
        param.set(params.get(), checked.expanded.at(param.name));
    for (const std::string& sentence : violated_relations(spec, params.get())) {
        all_right = false;
        problems_.add(relation_origin(stage), place, sentence);
    }
    if (all_right) checked.params = std::move(params);
    return checked;
}

std::optional<ParamCheck::Converted> ParamCheck::convert(const ParamSpec& param,
                                                         const JsonNode& node,
                                                         const std::string& path) {
    if (node.is(NodeKind::invalid)) return std::nullopt;
    if (param.list) return convert_list(param, node, path);
    return convert_one(param, node, path);
}

std::optional<ParamCheck::Converted> ParamCheck::convert_default(const ParamSpec& param,
                                                                 const Origin& origin,
                                                                 const std::string& path) {
    // Texts alone can hold something to expand; the registry has checked the rest.
    if (const auto* text = std::get_if<std::string>(&param.default_value))
        return convert_one(param, text_node(*text, origin), path);
    if (const auto* texts = std::get_if<std::vector<std::string>>(&param.default_value)) {
        JsonNode list;
        list.kind = NodeKind::array;
        list.origin = origin;
        for (const std::string& text : *texts) list.elements.push_back(text_node(text, origin));
        return convert_list(param, list, path);
    }
    return Converted{param.default_value, param.default_value};
}

std::optional<ParamCheck::Converted> ParamCheck::convert_list(const ParamSpec& param,
                                                              const JsonNode& node,
                                                              const std::string& path) {
    if (!node.is(NodeKind::array)) {
        problems_.add(node.origin, path,
                      describe(node) + " is no list; expected " + expected_value(param, true));
        return std::nullopt;
    }
    Converted all{empty_list(param.kind), empty_list(param.kind)};
    bool all_right = true;
    for (std::size_t i = 0; i < node.elements.size(); ++i) {
        const auto one = convert_one(param, node.elements[i], path_join(path, i));
        if (one) {
            append(all.written, one->written);
            append(all.expanded, one->expanded);
        }
        all_right = all_right && one;
    }
    if (!all_right) return std::nullopt;
    return all;
}

std::optional<ParamCheck::Converted> ParamCheck::convert_one(const ParamSpec& param,
                                                             const JsonNode& node,
                                                             const std::string& path) {
    if (node.is(NodeKind::invalid)) return std::nullopt;
    if (!has_kind(node, param.kind)) {
        problems_.add(node.origin, path,
                      describe(node) + " is no " + no_word(param.kind) + "; expected " +
                          expected_value(param, false));
        return std::nullopt;
    }
    if (param.kind == Kind::boolean) return Converted{node.boolean, node.boolean};
    if (node.is(NodeKind::text)) return convert_text(param, node.text, node.origin, path);
    const auto integer = node.as_int64();
    if (param.kind == Kind::integer && !integer) {
        problems_.add(node.origin, path,
                      printable(node.text) + " does not fit 64 bits; expected a smaller number");
        return std::nullopt;
    }
    if ((param.min && node.real < *param.min) || (param.max && node.real > *param.max)) {
        const bool beyond_int = node.real < std::numeric_limits<int>::min() ||
                                node.real > std::numeric_limits<int>::max();
        problems_.add(node.origin, path,
                      printable(node.text) + " is out of range; expected " +
                          expected_value(param, false, beyond_int));
        return std::nullopt;
    }
    if (param.kind == Kind::integer) return Converted{*integer, *integer};
    return Converted{node.real, node.real};
}

std::optional<ParamCheck::Converted> ParamCheck::convert_text(const ParamSpec& param,
                                                              const std::string& text,
                                                              const Origin& origin,
                                                              const std::string& path) {
    const Expanded expanded = expand(text, expansions_);
    if (!expanded.fault.empty()) {
        problems_.add(origin, path, expanded.fault);
        return std::nullopt;
    }
    if (expanded.asks_data && tell_data_) {
        tell_data_ = false;
        problems_.add(origin, path,
                      "'" + printable(text) + "' needs the data folder; expected --data DIR");
        return std::nullopt;
    }
    if (param.kind == Kind::choice && std::find(param.choices.begin(), param.choices.end(),
                                                expanded.text) == param.choices.end()) {
        problems_.add(origin, path,
                      "unknown choice '" + printable(expanded.text) + "'" +
                          expected_one_of(expanded.text, param.choices));
        return std::nullopt;
    }
    if (param.kind == Kind::path && expanded.text.find('\0') != std::string::npos) {
        problems_.add(origin, path, "a path cannot hold the character \\u0000; expected a path");
        return std::nullopt;
    }
    return Converted{text, expanded.text};
}

}  // namespace petal
