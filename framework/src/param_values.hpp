// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>

#include "petal/spec.hpp"

namespace petal {

/// What is wrong with a value for a parameter: kind, range (with its unit), choice. Empty when nothing is.
std::string value_problem(const ParamSpec& param, const Value& value);

}  // namespace petal
