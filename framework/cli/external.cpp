// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "external.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "petal/error.hpp"

namespace petal::cli {
namespace {

namespace fs = std::filesystem;
constexpr const char* kPrefix = "petal-";

fs::path own_folder() {
    std::error_code failed;
    return fs::canonical("/proc/self/exe", failed).parent_path();
}

}  // namespace

std::vector<std::string> external_commands() {
    std::vector<std::string> names;
    std::error_code failed;
    for (const auto& entry : fs::directory_iterator(own_folder(), failed)) {
        const std::string name = entry.path().filename().string();
        if (name.rfind(kPrefix, 0) == 0 && access(entry.path().c_str(), X_OK) == 0)
            names.push_back(name.substr(std::strlen(kPrefix)));
    }
    std::sort(names.begin(), names.end());
    return names;
}

void run_external(int argc, char** argv) {
    if (argc < 2) return;
    const std::vector<std::string> names = external_commands();
    if (std::find(names.begin(), names.end(), argv[1]) == names.end()) return;
    const std::string program = (own_folder() / (std::string(kPrefix) + argv[1])).string();
    execv(program.c_str(), argv + 1);  // comes back only where it failed
    throw Error("cannot start " + program + ": " + std::strerror(errno));
}

}  // namespace petal::cli
