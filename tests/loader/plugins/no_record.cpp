// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// A shared library, but no plugin.
extern "C" int petal_test_nothing() {
    return 0;
}
