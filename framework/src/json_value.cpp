// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/json_value.hpp"

#include <algorithm>
#include <cmath>

#include "json_reader.hpp"
#include "json_tree.hpp"
#include "merge_patch.hpp"
#include "nearest.hpp"
#include "petal/error.hpp"
#include "petal/printed.hpp"
#include "text_file.hpp"

namespace petal {

struct JsonValue::Document {
    std::string what;
    std::vector<std::string> files;  ///< by Origin::file
    JsonNode root;

    ProblemList problem_list() const {
        ProblemList list;
        for (const std::string& file : files) list.add_file(file);
        return list;
    }
};

namespace {

/// What was found wrong, all of it: one a line.
[[noreturn]] void throw_problems(const std::string& what, const ProblemList& problems) {
    std::string text;
    for (const Problem& problem : problems.sorted())
        text += (text.empty() ? "" : "\n") + what + " " + to_string(problem);
    throw Error(text);
}

/// Origins of another document's tree, whose files begin at `first` in this one.
void shift_origins(JsonNode& node, std::size_t first) {
    node.origin.file += first;
    for (JsonNode& element : node.elements) shift_origins(element, first);
    for (JsonMember& member : node.members) {
        member.origin.file += first;
        shift_origins(member.value, first);
    }
    for (JsonNode::Removed& removed : node.removed) removed.origin.file += first;
}

bool is_numeric(const JsonNode& node) {
    return node.is(NodeKind::integer) || node.is(NodeKind::real);
}

}  // namespace

JsonValue JsonValue::read(const std::filesystem::path& file, const std::string& what) {
    ProblemList problems;
    const std::size_t number = problems.add_file(file.string());
    std::string why;
    const auto text = read_text_file(file, why);
    if (!text) throw Error(what + " " + file.string() + ": " + why);
    auto root = read_json(*text, number, "", problems);
    if (root && problems.empty() && !root->is(NodeKind::object))
        problems.add(root->origin, "", "is " + describe(*root) + "; expected an object, {...}");
    if (!problems.empty()) throw_problems(what, problems);
    const auto document =
        std::make_shared<const Document>(Document{what, {file.string()}, std::move(*root)});
    return {document, &document->root, ""};
}

JsonValue JsonValue::over(const JsonValue& base) const {
    Document merged{document_->what, base.document_->files, base.document_->root};
    JsonNode patch = document_->root;
    shift_origins(patch, merged.files.size());
    merged.files.insert(merged.files.end(), document_->files.begin(), document_->files.end());
    ProblemList problems = merged.problem_list();
    merge_object(merged.root, patch, "", problems);
    if (!problems.empty()) throw_problems(merged.what, problems);
    const auto document = std::make_shared<const Document>(std::move(merged));
    return {document, &document->root, ""};
}

void JsonValue::fail(const std::string& problem) const {
    throw Error(document_->what + " " + document_->problem_list().where(node_->origin) + ": " +
                (path_.empty() ? "" : path_ + " ") + problem);
}

bool JsonValue::is_object() const {
    return node_->is(NodeKind::object);
}

void JsonValue::only(const std::vector<std::string>& keys) const {
    if (!node_->is(NodeKind::object))
        fail("is " + describe(*node_) + "; expected an object, {...}");
    for (const JsonMember& member : node_->members) {
        if (member.key == "$schema" || member.key == "about") continue;
        if (std::find(keys.begin(), keys.end(), member.key) != keys.end()) continue;
        JsonValue(document_, &member.value, path_join(path_, member.key))
            .fail("is not known here" + expected_one_of(member.key, keys));
    }
}

bool JsonValue::has(const std::string& key) const {
    if (!node_->is(NodeKind::object))
        fail("is " + describe(*node_) + "; expected an object, {...}");
    return node_->find(key) != nullptr;
}

JsonValue JsonValue::at(const std::string& key) const {
    if (const auto found = find(key)) return *found;
    fail("lacks the key '" + key + "'");
}

std::optional<JsonValue> JsonValue::find(const std::string& key) const {
    if (!has(key)) return std::nullopt;
    return JsonValue(document_, &node_->find(key)->value, path_join(path_, key));
}

std::vector<std::string> JsonValue::keys() const {
    if (!node_->is(NodeKind::object))
        fail("is " + describe(*node_) + "; expected an object, {...}");
    std::vector<std::string> keys;
    for (const JsonMember& member : node_->members) keys.push_back(member.key);
    return keys;
}

bool JsonValue::is_list() const {
    return node_->is(NodeKind::array);
}

std::vector<JsonValue> JsonValue::list() const {
    if (!is_list()) fail("is " + describe(*node_) + "; expected a list, [...]");
    std::vector<JsonValue> values;
    for (std::size_t i = 0; i < node_->elements.size(); ++i)
        values.push_back({document_, &node_->elements[i], path_join(path_, i)});
    return values;
}

bool JsonValue::is_text() const {
    return node_->is(NodeKind::text);
}

bool JsonValue::is_number() const {
    return is_numeric(*node_);
}

double JsonValue::number() const {
    if (!is_number()) fail("is " + describe(*node_) + "; expected a number");
    if (!std::isfinite(node_->real)) fail("is not a finite number");
    return node_->real;
}

double JsonValue::number(double low, double high, const char* unit) const {
    const double value = number();
    const std::string after = std::string(unit) == "1" ? "" : std::string(" ") + unit;
    if (value < low || value > high)
        fail("is " + node_->text + after + "; expected " + printed("%g", low) + " to " +
             printed("%g", high) + after);
    return value;
}

int JsonValue::integer(int low, int high) const {
    const auto value = node_->is(NodeKind::integer) ? node_->as_int64() : std::nullopt;
    if (!value || *value < low || *value > high)
        fail("is " + describe(*node_) + "; expected a whole number, " + std::to_string(low) +
             " to " + std::to_string(high));
    return static_cast<int>(*value);
}

bool JsonValue::boolean() const {
    if (!node_->is(NodeKind::boolean)) fail("is " + describe(*node_) + "; expected true or false");
    return node_->boolean;
}

std::string JsonValue::text() const {
    if (!is_text() || node_->text.empty())
        fail("is " + describe(*node_) + "; expected a string that is not empty");
    return node_->text;
}

std::string JsonValue::choice(const std::vector<std::string>& choices) const {
    std::string value = text();
    if (std::find(choices.begin(), choices.end(), value) == choices.end())
        fail("is '" + printable(value) + "'" + expected_one_of(value, choices));
    return value;
}

template <std::size_t Size>
std::array<double, Size> JsonValue::numbers() const {
    const std::string expected = "; expected a list of " + std::to_string(Size) + " numbers, " +
                                 (Size == 2 ? "[x, y]" : "[x, y, z]");
    if (!is_list() || node_->elements.size() != Size) fail("is " + describe(*node_) + expected);
    std::array<double, Size> values{};
    for (std::size_t i = 0; i < Size; ++i) {
        if (!is_numeric(node_->elements[i]))
            fail("holds " + describe(node_->elements[i]) + expected);
        values.at(i) = node_->elements[i].real;
    }
    return values;
}

Eigen::Vector2d JsonValue::vector2() const {
    const auto values = numbers<2>();
    return {values[0], values[1]};
}

Eigen::Vector3d JsonValue::vector3() const {
    const auto values = numbers<3>();
    return {values[0], values[1], values[2]};
}

}  // namespace petal
