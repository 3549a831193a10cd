// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// Built against headers of another framework ABI: the record says so, and opening it would end the
// host.
#include <cstdlib>

#include "toy.hpp"

namespace {
constexpr petal::PluginRecord record_of_tomorrow() {
    auto record = petal::detail::make_record("other_abi", "1.0.0", "", 0);
    record.framework_abi += 1;
    record.size += 8;  // its layout differs too
    return record;
}
struct Bomb {
    Bomb() { std::abort(); }
};
const Bomb bomb;
}  // namespace

extern "C" {
__attribute__((section(".petal.plugin"),
               visibility("default"))) extern const petal::PluginRecord petal_plugin_record;
__attribute__((used)) const petal::PluginRecord petal_plugin_record = record_of_tomorrow();
}
