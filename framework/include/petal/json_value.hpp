// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace petal {

struct JsonNode;

/// A value in a JSON file that people write by hand (a target, a sensor, a scene). It knows where
/// it was written, so every message tells file, line, and its path in the file: `scene a.json:12:
/// boards[1].yaw_deg is 200 deg; expected -180 to 180`.
///
/// Cheap to copy: the document is shared. All that reads throws Error. `//` comments are allowed.
class JsonValue {
   public:
    /// The whole file, an object. `what` begins the messages: "scene", "target".
    /// \throws Error: cannot be read, no JSON, a key twice in one object, no object.
    static JsonValue read(const std::filesystem::path& file, const std::string& what);

    /// `base` with this document laid over it (RFC 7396: members replace, null removes, objects
    /// merge). Messages name whichever file the value came from. \throws Error where a null removes
    /// what is not there: a wrong name.
    JsonValue over(const JsonValue& base) const;

    /// "holes[2]"; empty for the whole document.
    const std::string& path() const { return path_; }
    /// \throws Error always: where it stands, then `problem`, e.g. "must be ...".
    [[noreturn]] void fail(const std::string& problem) const;

    // --- objects
    bool is_object() const;
    /// An object with no other keys than these ("$schema" and "about" are always allowed); an
    /// unknown one is told with the nearest of them.
    void only(const std::vector<std::string>& keys) const;
    bool has(const std::string& key) const;
    /// \throws Error where the key is missing.
    JsonValue at(const std::string& key) const;
    std::optional<JsonValue> find(const std::string& key) const;
    /// In the order of the file; those that were laid over another document come last.
    std::vector<std::string> keys() const;

    // --- lists
    bool is_list() const;
    std::vector<JsonValue> list() const;

    // --- values
    bool is_text() const;
    bool is_number() const;
    double number() const;
    /// In [low, high]; `unit` is told in the message ("m", "deg", "1").
    double number(double low, double high, const char* unit) const;
    int integer(int low, int high) const;
    bool boolean() const;
    std::string text() const;  ///< not empty
    std::string choice(const std::vector<std::string>& choices) const;
    Eigen::Vector2d vector2() const;
    Eigen::Vector3d vector3() const;

   private:
    struct Document;
    JsonValue(std::shared_ptr<const Document> document, const JsonNode* node, std::string path)
        : document_(std::move(document)), node_(node), path_(std::move(path)) {}
    template <std::size_t Size>
    std::array<double, Size> numbers() const;

    std::shared_ptr<const Document> document_;
    const JsonNode* node_;  ///< in document_
    std::string path_;
};

}  // namespace petal
