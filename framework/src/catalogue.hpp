// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

#include "petal/spec.hpp"

namespace petal {

/// The stage catalogue in the forms that petal stages prints. All from the declarations alone.

/// One stage a line: type, role, summary.
std::string catalogue_text(const std::vector<const StageSpec*>& stages);
/// The table of the README; links point to `pages`/<type>.md.
std::string catalogue_markdown(const std::vector<const StageSpec*>& stages,
                               const std::string& pages);
/// All declarations, machine-readable.
std::string catalogue_json(const std::vector<const StageSpec*>& stages);

/// One stage in full, for a terminal.
std::string stage_text(const StageSpec& stage);
/// One stage in full: the page docs/stages/<type>.md.
std::string stage_markdown(const StageSpec& stage);

}  // namespace petal
