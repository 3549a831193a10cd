// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "registry.hpp"

#include <utility>

#include "declaration_check.hpp"
#include "host_errors.hpp"
#include "nearest.hpp"

namespace petal {
namespace {

std::string origin(const StageSpec& spec) {
    return spec.library.empty() ? std::string("the program itself") : spec.library;
}

}  // namespace

void Registry::add(StageSpec spec) {
    if (const auto faults = declaration_faults(spec); !faults.empty())
        throw Error("stage '" + spec.type + "' is not declared completely: " + join(faults, "; "));
    if (const StageSpec* other = find(spec.type)) {
        const bool same = other->library == spec.library;
        throw PluginError("stage type '" + spec.type + "' is " +
                          (same ? "registered twice by " + origin(spec)
                                : "in two libraries, " + origin(*other) + " and " + origin(spec)) +
                          "; rename one of them" + (same ? "" : " or take one library away"));
    }
    std::string type = spec.type;
    stages_.emplace(std::move(type), std::move(spec));
}

const StageSpec* Registry::find(const std::string& type) const {
    const auto found = stages_.find(type);
    return found == stages_.end() ? nullptr : &found->second;
}

std::vector<const StageSpec*> Registry::all() const {
    std::vector<const StageSpec*> all;
    all.reserve(stages_.size());
    for (const auto& [type, spec] : stages_) all.push_back(&spec);
    return all;
}

std::vector<std::string> Registry::types() const {
    std::vector<std::string> types;
    types.reserve(stages_.size());
    for (const auto& [type, spec] : stages_) types.push_back(type);
    return types;
}

}  // namespace petal
