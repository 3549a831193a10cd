// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// Never comes back.
#include <unistd.h>

#include "toy.hpp"

PETAL_PLUGIN("hangs", "1.0.0", [](petal::Registrar&) {
    for (;;) ::pause();
});
