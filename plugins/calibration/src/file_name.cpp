// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/file_name.hpp"

namespace petal {

std::string file_name(const std::string& label) {
    constexpr const char* digits = "0123456789ABCDEF";
    std::string name;
    for (const char c : label) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                           (c >= '0' && c <= '9') || c == '-' || c == '_' ||
                           (c == '.' && !name.empty());
        if (plain) {
            name += c;
        } else {
            const auto byte = static_cast<unsigned char>(c);
            name += '%';
            name += digits[byte / 16];
            name += digits[byte % 16];
        }
    }
    return name;
}

}  // namespace petal
