// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// Calls a function that no library has.
#include "toy.hpp"

void petal_test_function_of_nobody();

PETAL_PLUGIN("missing_symbol", "1.0.0", [](petal::Registrar&) { petal_test_function_of_nobody(); });
