// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "json_tree.hpp"

namespace petal {

/// The format version that this program reads.
constexpr int kPipelineFormat = 1;

/// A whole pipeline, or a patch: in a patch everything may be absent, and null removes.
enum class DocumentKind { pipeline, patch };

/// Checks what needs no knowledge of stages: version, keys, ids, JSON kinds down to the values of
/// `params` and the wires of `in`. What is wrong becomes `invalid`, so that no later check tells of
/// it again; unknown keys go. \returns false where there is no object at all.
bool check_shape(JsonNode& document, DocumentKind kind, ProblemList& problems);

}  // namespace petal
