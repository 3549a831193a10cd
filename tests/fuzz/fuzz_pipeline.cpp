// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cstddef>
#include <cstdint>

#include "reader_properties.hpp"

/// The input is the text of a pipeline.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    petal::fuzz::require_idempotent(petal::fuzz::read_and_check({text, {}, {}}));
    return 0;
}
