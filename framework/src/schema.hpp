// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>

#include "registry.hpp"

namespace petal {

/// The JSON schema (draft 7, which every editor knows) of pipeline files, from the declarations of
/// the stages: keys, types, ports, parameters with kinds, ranges, choices, defaults and what they
/// mean. Sorted by type, so the same stages give the same bytes.
///
/// It accepts what the check accepts. What a schema cannot say is left to the check: that a wire
/// leads to a stage that is there and makes no cycle, one rate on the inputs of a stage, relations
/// between parameters, duplicate keys, and that 3.0 is no integer.
std::string pipeline_schema(const Registry& registry);

/// The same for patches: nothing is required, null removes. The parameters of a stage are known
/// only where the patch sets its type.
std::string patch_schema(const Registry& registry);

}  // namespace petal
