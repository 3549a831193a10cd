// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/printed.hpp"

#include <locale.h>

#include <cstdarg>
#include <cstdio>

namespace petal {

std::string printed(const char* pattern, ...) {
    static const locale_t plain = ::newlocale(LC_ALL_MASK, "C", nullptr);
    const locale_t before = ::uselocale(plain);  // of this thread only
    std::va_list arguments;
    std::va_list again;
    va_start(arguments, pattern);
    va_copy(again, arguments);
    const int size = std::vsnprintf(nullptr, 0, pattern, arguments);
    std::string text(size > 0 ? static_cast<std::size_t>(size) : 0, '\0');
    if (size > 0) std::vsnprintf(text.data(), text.size() + 1, pattern, again);
    va_end(again);
    va_end(arguments);
    ::uselocale(before);
    return text;
}

}  // namespace petal
