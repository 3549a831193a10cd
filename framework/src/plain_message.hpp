// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>

namespace petal {

/// What an exception says, without the banner, source place and call stack that MRPT puts around
/// its own.
std::string plain_message(const std::string& text);

}  // namespace petal
