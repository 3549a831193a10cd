// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// Ends its host politely while it registers.
#include <unistd.h>

#include "toy.hpp"

PETAL_PLUGIN("exits", "1.0.0", [](petal::Registrar&) { ::_exit(0); });
