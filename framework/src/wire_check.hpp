// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "draft.hpp"

namespace petal {

/// Reads the `in` of every stage: syntax, stages and ports that exist, one type at both ends,
/// several wires on gathering ports only, required inputs wired. Fills DraftStage::inputs. `stages`
/// is their JSON.
void check_wires(Draft& draft, const JsonNode& stages, ProblemList& problems);

}  // namespace petal
