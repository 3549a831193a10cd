// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// Right in itself. CMakeLists.txt builds it with other flags too, which makes it a bad one
// elsewhere.
#include <cstdlib>

#include "toy.hpp"

#ifdef PETAL_TEST_MUST_NOT_OPEN
namespace {
/// Ends the host as soon as somebody opens the library: its record alone must tell that it does not
/// fit.
struct Bomb {
    Bomb() { std::abort(); }
};
const Bomb bomb;
}  // namespace
#endif

#ifndef PETAL_TEST_TYPE
#define PETAL_TEST_TYPE "toys." PETAL_TEST_NAME
#endif

PETAL_PLUGIN(PETAL_TEST_NAME, "1.2.3", [](petal::Registrar& r) {
    r.add<toys::ToySource>(PETAL_TEST_TYPE);
    r.on_thread_limit([](int) {});
});
