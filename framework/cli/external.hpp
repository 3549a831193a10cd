// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

namespace petal::cli {

/// The programs `petal-NAME` that lie beside this one: its further sub-commands, which may know of
/// calibration what the framework does not. Their names, in alphabetical order. Never from PATH or
/// the working folder.
std::vector<std::string> external_commands();

/// Runs `petal-NAME` in place of this process, with the arguments behind NAME, where argv[1] is one
/// of external_commands(). Returns where it is not. \throws Error when it cannot be started.
void run_external(int argc, char** argv);

}  // namespace petal::cli
