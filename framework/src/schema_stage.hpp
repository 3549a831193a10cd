// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "pipeline_shape.hpp"
#include "registry.hpp"

namespace petal {

using SchemaJson = nlohmann::ordered_json;

/// The form of a stage's id; a wire begins with one.
constexpr const char* kIdPattern = "[a-z][a-z0-9_]*";

/// The schema of a wire of any type: "STAGE.PORT".
SchemaJson any_wire_schema();

/// The schema of `in` and `params` of one stage type, where its `type` is known.
SchemaJson stage_schema(const StageSpec& stage, const Registry& registry, DocumentKind kind);

}  // namespace petal
