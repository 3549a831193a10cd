// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// The record of a plugin without the function that it promises.
#include "toy.hpp"

extern "C" {
__attribute__((section(".petal.plugin"),
               visibility("default"))) extern const petal::PluginRecord petal_plugin_record;
__attribute__((used)) const petal::PluginRecord petal_plugin_record =
    petal::detail::make_record("no_register", "1.0.0", "", 0);
}
