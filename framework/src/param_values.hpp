// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>

#include "petal/spec.hpp"

namespace petal {

/// What is wrong with a value for a parameter: kind, range, choice, each with what was expected.
/// Empty when nothing is. For values that come from code; ParamCheck tells the place for those of a
/// pipeline.
std::string value_problem(const ParamSpec& param, const Value& value);

/// A value as JSON text.
std::string value_text(const Value& value);

}  // namespace petal
