// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "petal/build_key.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

/// Raised whenever a header in petal/ changes what a compiled plugin relies on.
constexpr std::uint32_t kFrameworkAbi = 2;

/// Lies in the ELF section `.petal.plugin` of every plugin and is read from the file before the
/// library is opened (opening it would run its static constructors).
struct PluginRecord {
    char magic[8];  ///< "PETALPLG"
    std::uint32_t size;
    std::uint32_t framework_abi;
    std::uint32_t types_abi;  ///< 0 where the plugin uses no shared packet types
    BuildKey build;
    char types_name[32];  ///< the library of packet types, e.g. "calibration"
    char name[64];
    char version[32];
};

/// What a plugin's registering function is given.
class Registrar {
   public:
    virtual ~Registrar() = default;

    /// Adds stage class S under `type`, e.g. "filter.radius_outlier".
    /// \throws Error when its declaration is incomplete or the type is taken.
    template <class S>
    void add(std::string type) {
        add_spec(describe_stage<S>(std::move(type)));
    }
    /// Called before a run with the number of threads it may use: for libraries with pools of their
    /// own.
    virtual void on_thread_limit(std::function<void(int threads)> apply) = 0;

   protected:
    virtual void add_spec(StageSpec spec) = 0;
};

namespace detail {
template <std::size_t N, std::size_t M>
constexpr void copy_text(char (&to)[N], const char (&from)[M]) {
    static_assert(M <= N, "the plugin's name or version is too long");
    for (std::size_t i = 0; i < M; ++i) to[i] = from[i];
}
template <std::size_t N, std::size_t M, std::size_t K>
constexpr PluginRecord make_record(const char (&name)[N], const char (&version)[M],
                                   const char (&types_name)[K], std::uint32_t types_abi) {
    PluginRecord record{{'P', 'E', 'T', 'A', 'L', 'P', 'L', 'G'},
                        sizeof(PluginRecord),
                        kFrameworkAbi,
                        types_abi,
                        build_key(),
                        {},
                        {},
                        {}};
    copy_text(record.types_name, types_name);
    copy_text(record.name, name);
    copy_text(record.version, version);
    return record;
}
}  // namespace detail

}  // namespace petal

// A library of packet types sets both for whoever links it (PETAL_TYPES_NAME, PETAL_TYPES_ABI).
#ifndef PETAL_TYPES_NAME
#define PETAL_TYPES_NAME ""
#define PETAL_TYPES_ABI 0
#endif

/// Once in a library: PETAL_PLUGIN("filters", "0.1.0", [](petal::Registrar& r) { ... });
#define PETAL_PLUGIN(NAME, VERSION, ...)                                                           \
    extern "C" {                                                                                   \
    __attribute__((section(".petal.plugin"),                                                       \
                   visibility("default"))) extern const ::petal::PluginRecord petal_plugin_record; \
    __attribute__((used)) const ::petal::PluginRecord petal_plugin_record =                        \
        ::petal::detail::make_record(NAME, VERSION, PETAL_TYPES_NAME, PETAL_TYPES_ABI);            \
    __attribute__((visibility("default"))) void petal_plugin_register(                             \
        ::petal::Registrar& registrar);                                                            \
    void petal_plugin_register(::petal::Registrar& registrar) {                                    \
        (__VA_ARGS__)(registrar);                                                                  \
    }                                                                                              \
    }                                                                                              \
    static_assert(true, "a semicolon ends PETAL_PLUGIN")
