// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <nlohmann/json.hpp>
#include <variant>

#include "petal/value.hpp"

namespace petal {

/// The value of a parameter as it stands in a pipeline.
inline nlohmann::ordered_json value_json(const Value& value) {
    return std::visit([](const auto& held) { return nlohmann::ordered_json(held); }, value);
}

}  // namespace petal
