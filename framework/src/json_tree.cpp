// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "json_tree.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "nearest.hpp"

namespace petal {
namespace {

constexpr std::size_t kLongestShown = 80;
constexpr std::size_t kLongestTypo = 64;
constexpr std::size_t kMostListed = 12;

bool is_plain_name(std::string_view key) {
    return !key.empty() && key.size() <= kLongestShown &&
           std::all_of(key.begin(), key.end(), [](char c) {
               return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                      c == '_' || c == '-' || c == '$';
           });
}

}  // namespace

std::optional<std::int64_t> JsonNode::as_int64() const {
    constexpr auto kMax = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
    if (kind != Kind::integer) return std::nullopt;
    if (!negative)
        return magnitude <= kMax ? std::optional(static_cast<std::int64_t>(magnitude))
                                 : std::nullopt;
    if (magnitude > kMax + 1) return std::nullopt;
    if (magnitude == kMax + 1) return std::numeric_limits<std::int64_t>::min();
    return -static_cast<std::int64_t>(magnitude);
}

std::optional<std::uint64_t> JsonNode::as_uint64() const {
    if (kind != Kind::integer || (negative && magnitude != 0)) return std::nullopt;
    return magnitude;
}

const JsonMember* JsonNode::find(std::string_view key) const {
    const auto at = std::find_if(members.begin(), members.end(),
                                 [&](const JsonMember& member) { return member.key == key; });
    return at == members.end() ? nullptr : &*at;
}

JsonMember* JsonNode::find(std::string_view key) {
    const auto at = std::find_if(members.begin(), members.end(),
                                 [&](const JsonMember& member) { return member.key == key; });
    return at == members.end() ? nullptr : &*at;
}

const JsonNode::Removed* JsonNode::find_removed(std::string_view key) const {
    const auto at = std::find_if(removed.begin(), removed.end(),
                                 [&](const Removed& entry) { return entry.key == key; });
    return at == removed.end() ? nullptr : &*at;
}

JsonNode& JsonNode::put(const std::string& key, const Origin& key_origin, JsonNode value) {
    removed.erase(std::remove_if(removed.begin(), removed.end(),
                                 [&](const Removed& entry) { return entry.key == key; }),
                  removed.end());
    if (JsonMember* old = find(key)) {
        old->origin = key_origin;
        old->value = std::move(value);
        return old->value;
    }
    members.push_back({key, key_origin, std::move(value)});
    return members.back().value;
}

void JsonNode::erase(std::string_view key) {
    members.erase(std::remove_if(members.begin(), members.end(),
                                 [&](const JsonMember& member) { return member.key == key; }),
                  members.end());
}

std::vector<std::string> JsonNode::keys() const {
    std::vector<std::string> names;
    names.reserve(members.size());
    for (const JsonMember& member : members) names.push_back(member.key);
    return names;
}

std::string describe(const JsonNode& node) {
    switch (node.kind) {
        case JsonNode::Kind::null:
            return "null";
        case JsonNode::Kind::boolean:
            return node.boolean ? "true" : "false";
        case JsonNode::Kind::integer:
        case JsonNode::Kind::real:
            return printable(node.text);
        case JsonNode::Kind::text:
            return "the string '" + printable(node.text) + "'";
        case JsonNode::Kind::array:
            return "a list";
        case JsonNode::Kind::object:
            return "an object";
        case JsonNode::Kind::invalid:
            break;
    }
    return "nothing valid";
}

std::string printable(std::string_view text) {
    constexpr std::array<char, 17> kDigits{"0123456789abcdef"};
    std::string shown;
    bool cut = false;
    if (text.size() > kLongestShown) {
        cut = true;
        std::size_t end = kLongestShown;
        // not inside a character: bytes 10xxxxxx continue one
        while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
        text = text.substr(0, end);
    }
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7F) {
            shown += "\\x";
            shown += kDigits[byte >> 4U];
            shown += kDigits[byte & 0x0FU];
        } else {
            shown += c;
        }
    }
    return cut ? shown + "..." : shown;
}

std::string path_join(const std::string& path, const std::string& key) {
    if (!is_plain_name(key)) return path + "[\"" + printable(key) + "\"]";
    return path.empty() ? key : path + "." + key;
}

std::string path_join(const std::string& path, std::size_t index) {
    return path + "[" + std::to_string(index) + "]";
}

std::string suggestion(const std::string& typo, const std::vector<std::string>& known) {
    if (typo.size() > kLongestTypo) return {};
    const std::string near = nearest(typo, known);
    return near.empty() ? near : "; did you mean '" + printable(near) + "'?";
}

std::string expected_one_of(const std::string& typo, const std::vector<std::string>& known) {
    if (known.empty()) return "; expected none";
    const auto count = std::min(known.size(), kMostListed);
    // Names of the user's own, as ids of stages, may hold anything.
    std::vector<std::string> listed;
    for (std::size_t i = 0; i < count; ++i) listed.push_back(printable(known[i]));
    return (known.size() == 1 ? "; expected " : "; expected one of ") + join(listed) +
           (count < known.size() ? ", ..." : "") + suggestion(typo, known);
}

}  // namespace petal
