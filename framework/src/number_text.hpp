// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>

namespace petal {

/// The shortest text that reads back as the same number, whatever the locale; whole numbers of up
/// to nine digits without an exponent.
std::string number_text(double value);

}  // namespace petal
