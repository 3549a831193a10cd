// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "set_option.hpp"

#include <utility>

#include "json_reader.hpp"

namespace petal {
namespace {

/// A text that cannot have been meant as a number, a list, an object or a quoted string.
bool is_bare_word(const std::string& text) {
    const std::size_t start = text.find_first_not_of(" \t");
    if (start == std::string::npos) return false;
    const std::string json_starts = "\"[{-0123456789";
    return json_starts.find(text[start]) == std::string::npos && text != "true" &&
           text != "false" && text != "null";
}

JsonNode object_with(const std::string& key, JsonNode value, const Origin& origin) {
    JsonNode object;
    object.kind = JsonNode::Kind::object;
    object.origin = origin;
    object.put(key, origin, std::move(value));
    return object;
}

}  // namespace

std::optional<JsonNode> read_set_option(const std::string& option, std::size_t file,
                                        ProblemList& problems) {
    const Origin origin{file, 0};
    const std::size_t equals = option.find('=');
    const std::size_t dot = option.find('.');
    if (equals == std::string::npos || dot == std::string::npos || dot == 0 || dot + 1 >= equals ||
        option.find('.', dot + 1) < equals) {
        problems.add(origin, "",
                     "'" + printable(option) +
                         "' sets nothing; expected STAGE.PARAM=JSON, as in solve.iterations=50");
        return std::nullopt;
    }
    const std::string stage = option.substr(0, dot);
    const std::string param = option.substr(dot + 1, equals - dot - 1);
    const std::string text = option.substr(equals + 1);
    const std::string path = path_join(path_join(path_join("stages", stage), "params"), param);
    if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
        problems.add(origin, path, "has no value; expected STAGE.PARAM=JSON");
        return std::nullopt;
    }
    if (is_bare_word(text)) {
        problems.add(origin, path,
                     "'" + printable(text) +
                         "' is no JSON; a string needs its own quotes: --set '" + printable(stage) +
                         "." + printable(param) + "=\"" + printable(text) + "\"'");
        return std::nullopt;
    }
    ProblemList own;
    own.add_file("");
    auto value = read_json(text, 0, path, own);
    for (const Problem& problem : own.sorted()) problems.add(origin, problem.path, problem.message);
    if (!value) return std::nullopt;
    // The command line has no lines: give every part of the value the option's origin.
    const auto relocate = [&](auto&& self, JsonNode& node) -> void {
        node.origin = origin;
        for (JsonNode& element : node.elements) self(self, element);
        for (JsonMember& member : node.members) {
            member.origin = origin;
            self(self, member.value);
        }
    };
    relocate(relocate, *value);
    JsonNode params = object_with(param, std::move(*value), origin);
    JsonNode changed = object_with("params", std::move(params), origin);
    JsonNode stages = object_with(stage, std::move(changed), origin);
    return object_with("stages", std::move(stages), origin);
}

}  // namespace petal
