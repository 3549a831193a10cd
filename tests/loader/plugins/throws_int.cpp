// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// Throws what is no std::exception.
#include "toy.hpp"

PETAL_PLUGIN("throws_int", "1.0.0", [](petal::Registrar&) { throw 42; });
