// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "run_folder.hpp"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <ctime>
#include <system_error>

#include "host_errors.hpp"

namespace petal {

namespace fs = std::filesystem;

namespace {

/// What a run writes at the top of its folder: a run is told by the first of them.
constexpr std::array<const char*, 4> kRunFiles = {"run.json", "result.json", "log.txt", "stages"};

}  // namespace

fs::path default_run_folder(const std::string& pipeline) {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    std::array<char, 32> text{};
    std::strftime(text.data(), text.size(), "%Y%m%dT%H%M%SZ", &utc);
    return fs::path("runs") / (pipeline + "-" + text.data());
}

fs::path prepare_run_folder(const fs::path& out, bool force, const fs::path& data) {
    std::error_code error;
    const fs::path folder = fs::weakly_canonical(fs::absolute(out), error);
    if (error) throw Error("cannot use --out " + out.string() + ": " + error.message());
    if (fs::exists(folder, error) && !fs::is_directory(folder, error))
        throw UsageError("--out " + out.string() + " is a file; give the name of a folder");
    if (!data.empty() && fs::equivalent(folder, data, error))
        throw UsageError("--out " + out.string() +
                         " is the data folder; a run never writes into its data: give another one");
    if (fs::exists(folder / "run.json", error)) {
        if (!force)
            throw UsageError(
                "--out " + out.string() +
                " holds a run already; give another folder, or --force to replace that run");
        for (const char* name : kRunFiles) fs::remove_all(folder / name, error);
    }
    fs::create_directories(folder, error);
    if (error)
        throw Error("cannot make the run folder " + folder.string() + ": " + error.message() +
                    "; give another one with --out");
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        throw Error("cannot write into the run folder " + folder.string() + ": " +
                    std::generic_category().message(errno) + "; give another one with --out");
    return folder;
}

}  // namespace petal
