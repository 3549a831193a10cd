// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "problem_list.hpp"

namespace petal {

struct JsonMember;

/// A JSON value that knows where it was written. nlohmann's own values keep neither positions nor
/// duplicate keys, and read 3 and 3.0 alike.
struct JsonNode {
    /// `invalid`: what stood here was wrong and has been told; the checks pass over it.
    enum class Kind { invalid, null, boolean, integer, real, text, array, object };
    /// A member that a patch took away: later problems can then name the patch.
    struct Removed {
        std::string key;
        Origin origin;
    };

    Kind kind = Kind::invalid;
    Origin origin;
    bool boolean = false;
    bool negative = false;        ///< of an integer
    std::uint64_t magnitude = 0;  ///< of an integer, without its sign
    double real = 0.0;            ///< of a real or an integer
    std::string text;             ///< of a text; of a number, as it was written
    std::vector<JsonNode> elements;
    std::vector<JsonMember> members;  ///< in the order of the file
    std::vector<Removed> removed;

    bool is(Kind wanted) const { return kind == wanted; }
    /// Empty where the integer does not fit.
    std::optional<std::int64_t> as_int64() const;
    std::optional<std::uint64_t> as_uint64() const;

    /// Null where there is no such member.
    const JsonMember* find(std::string_view key) const;
    JsonMember* find(std::string_view key);
    const Removed* find_removed(std::string_view key) const;
    /// Puts a value at `key`: in the old one's place, else at the end.
    JsonNode& put(const std::string& key, const Origin& key_origin, JsonNode value);
    void erase(std::string_view key);
    std::vector<std::string> keys() const;
};

using NodeKind = JsonNode::Kind;

struct JsonMember {
    std::string key;
    Origin origin;  ///< of the key
    JsonNode value;
};

/// What a node is, for messages: "3.7", "the string 'abc'", "a list", "null".
std::string describe(const JsonNode& node);

/// Text of the user's made fit for a message: control characters escaped, cut where it is long.
std::string printable(std::string_view text);

/// `path` with one more key; a key that is no plain name stands in brackets: a["b c"].
std::string path_join(const std::string& path, const std::string& key);
std::string path_join(const std::string& path, std::size_t index);

/// "; expected one of a, b, c; did you mean 'b'?": at most 12 names are listed.
std::string expected_one_of(const std::string& typo, const std::vector<std::string>& known);

/// did_you_mean() for text of any length: nothing for what is too long to be a typo of a name.
std::string suggestion(const std::string& typo, const std::vector<std::string>& known);

}  // namespace petal
