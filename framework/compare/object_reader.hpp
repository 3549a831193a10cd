// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "json_tree.hpp"
#include "pipeline_reader.hpp"

namespace petal::compare {

/// Members of one object of a comparison file, each read once, with every mistake told where it
/// stands. After the last, unknown_keys() tells those that nobody asked for.
class ObjectReader {
   public:
    /// A node that is no object is told, and read as an empty one.
    ObjectReader(const JsonNode& node, std::string path, const std::string& file,
                 ProblemList& problems);

    const JsonMember* find(const std::string& key);
    /// Nothing where the key is absent or wrong.
    std::optional<std::string> text(const std::string& key);
    std::optional<std::string> choice(const std::string& key,
                                      const std::vector<std::string>& choices);
    std::optional<double> number(const std::string& key, double low, double high);
    std::optional<std::uint64_t> whole_number(const std::string& key);
    /// "1..20", or a list of numbers.
    std::optional<std::vector<std::uint64_t>> seeds(const std::string& key);
    /// Members of the object at `key`, or null.
    const JsonNode* object(const std::string& key);
    /// The changes of "with", "patch" and "set", in this order. `folder` is what files are relative
    /// to.
    std::vector<PipelineChange> changes(const std::filesystem::path& folder);

    void unknown_keys(const std::string& where);
    void problem(const Origin& origin, const std::string& key, const std::string& message);
    std::string path_of(const std::string& key) const { return path_join(path_, key); }

   private:
    const JsonNode& node_;
    std::string path_;
    const std::string& file_;
    ProblemList& problems_;
    std::vector<std::string> asked_;
};

/// STAGE.PARAM and its value as a patch; a problem where `name` is none.
std::optional<JsonNode> set_patch(const std::string& name, const Origin& origin,
                                  const JsonNode& value, const std::string& path,
                                  ProblemList& problems);

/// JSON on one line without spaces.
std::string compact_json(const JsonNode& node);

}  // namespace petal::compare
