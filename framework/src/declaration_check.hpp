// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

#include "petal/spec.hpp"

namespace petal {

/// What a stage's declaration lacks, one sentence each; empty where it is complete. Registry::add
/// tells what is asked for.
std::vector<std::string> declaration_faults(const StageSpec& spec);

}  // namespace petal
