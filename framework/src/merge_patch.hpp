// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>

#include "json_tree.hpp"

namespace petal {

/// RFC 7396: members of `patch` replace those of `target`, null removes, objects merge. Every value
/// keeps the origin of the text it came from. A null that finds nothing to remove changes nothing,
/// as in the RFC, but is a problem: it is a wrong name.
void merge_object(JsonNode& target, const JsonNode& patch, const std::string& path,
                  ProblemList& problems);

/// Applies a patch to a pipeline; the shape of both has been checked. A stage whose `type` the
/// patch sets loses its old `params`; a stage that is not there needs a `type`. The patch's own
/// `petal` and
/// `$schema` stay its own.
void apply_patch(JsonNode& pipeline, const JsonNode& patch, ProblemList& problems);

}  // namespace petal
