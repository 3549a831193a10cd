// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace petal {

std::string number_text(double value) {
    std::array<char, 32> text{};
    char* const end = text.data() + text.size();
    const bool whole = std::abs(value) < 1e9 && value == std::trunc(value);
    const auto written = whole ? std::to_chars(text.data(), end, static_cast<long>(value))
                               : std::to_chars(text.data(), end, value);
    return std::string(text.data(), written.ptr);
}

}  // namespace petal
