// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <CLI/CLI.hpp>
#include <exception>
#include <functional>
#include <iostream>

#include "petal/error.hpp"

namespace petal {

/// What all commands of petal have in common: the exit codes. 0 done, 1 failed, 2 wrong usage; what
/// `work` returns else.
inline int command_main(CLI::App& app, int argc, char** argv, const std::function<int()>& work) {
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        const int code = work();
        std::cout.flush();
        if (!std::cout) throw Error("cannot write to the standard output; is the disk full?");
        return code;
    } catch (const std::exception& failure) {
        std::cerr << app.get_name() << ": " << failure.what() << "\n";
        return 1;
    }
}

}  // namespace petal
