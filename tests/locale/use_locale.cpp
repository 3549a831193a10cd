// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <locale>
#include <stdexcept>

// Preloaded into petal and the tests (scripts/checks/locale.sh): the process then uses the
// environment's locale, as a host with a user interface does. Ends the process where that locale is
// not there or has no decimal comma: the check would prove nothing.
namespace {

const bool used = [] {
    try {
        if (std::setlocale(LC_ALL, "") != nullptr) std::locale::global(std::locale(""));
    } catch (const std::runtime_error&) {
    }
    if (*std::localeconv()->decimal_point == ',') return true;
    std::fputs("no locale with a decimal comma; see LC_ALL and LOCPATH\n", stderr);
    std::_Exit(99);
}();

}  // namespace
