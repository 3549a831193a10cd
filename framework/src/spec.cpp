// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/spec.hpp"

#include <algorithm>

namespace petal {
namespace {

template <class Item>
const Item* find_named(const std::vector<Item>& items, const std::string& name) {
    const auto found = std::find_if(items.begin(), items.end(),
                                    [&name](const Item& item) { return item.name == name; });
    return found == items.end() ? nullptr : &*found;
}

}  // namespace

const char* to_string(Kind kind) {
    switch (kind) {
        case Kind::boolean:
            return "bool";
        case Kind::integer:
            return "int";
        case Kind::real:
            return "double";
        case Kind::text:
            return "string";
        case Kind::choice:
            return "choice";
        case Kind::path:
            return "path";
    }
    return "unknown";
}

const ParamSpec* StageSpec::find_param(const std::string& name) const {
    return find_named(params, name);
}

const PortSpec* StageSpec::find_input(const std::string& name) const {
    return find_named(inputs, name);
}

const PortSpec* StageSpec::find_output(const std::string& name) const {
    return find_named(outputs, name);
}

bool StageSpec::gathers() const {
    return std::any_of(inputs.begin(), inputs.end(),
                       [](const PortSpec& port) { return port.gathers; });
}

}  // namespace petal
