// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// Fails after its first stage: that one must go too.
#include "toy.hpp"

PETAL_PLUGIN("throws", "1.0.0", [](petal::Registrar& r) {
    r.add<toys::ToySource>("toys.half");
    r.on_thread_limit([](int) {});
    throw petal::Error("the toy box is empty");
});
