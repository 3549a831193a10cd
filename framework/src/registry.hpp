// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <map>
#include <string>
#include <vector>

#include "petal/spec.hpp"

namespace petal {

/// The stage types that are known, by name. Not thread-safe while stages are added.
class Registry {
   public:
    /// \throws Error when the declaration is incomplete (no summary; a port or parameter without
    /// documentation; a double without unit or range; a default outside its own range or choices;
    /// names that are not lower case letters, digits and `_`, types not of the form kind.name) or
    /// when the type is taken, naming both libraries.
    void add(StageSpec spec);

    const StageSpec* find(const std::string& type) const;
    /// Sorted by type.
    std::vector<const StageSpec*> all() const;
    std::vector<std::string> types() const;

   private:
    std::map<std::string, StageSpec> stages_;
};

}  // namespace petal
