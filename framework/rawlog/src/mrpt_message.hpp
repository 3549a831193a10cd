// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>

namespace petal {

/// What an exception of MRPT says, without its banner and call stack.
inline std::string mrpt_message(const std::string& message) {
    const std::size_t begin = message.find("Message:");
    std::string text = begin == std::string::npos ? message : message.substr(begin + 8);
    text = text.substr(0, text.find('\n'));
    const std::size_t from = text.find_first_not_of(' ');
    return from == std::string::npos ? std::string("unknown error") : text.substr(from);
}

}  // namespace petal
