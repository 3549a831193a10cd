// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plain_message.hpp"

#include <algorithm>

namespace petal {

std::string plain_message(const std::string& text) {
    const std::size_t banner = text.find("==== MRPT exception ====");
    if (banner == std::string::npos) return text;
    const std::string label = "Message:";
    const std::size_t found = text.find(label, banner);
    if (found == std::string::npos) return "MRPT failed without a message";
    const std::size_t begin = found + label.size();
    const std::size_t end = std::min(text.find("Location:", begin), text.find("Call stack", begin));
    std::string message = text.substr(begin, end == std::string::npos ? end : end - begin);
    const char* const blanks = " \n\t\r";
    message.erase(message.find_last_not_of(blanks) + 1);
    message.erase(0, message.find_first_not_of(blanks));
    return "MRPT: " + message;
}

}  // namespace petal
