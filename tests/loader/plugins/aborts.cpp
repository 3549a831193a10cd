// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// Ends its host while it registers.
#include <cstdio>
#include <cstdlib>

#include "toy.hpp"

PETAL_PLUGIN("aborts", "1.0.0", [](petal::Registrar&) {
    std::fputs("toys everywhere\n", stderr);
    std::abort();
});
