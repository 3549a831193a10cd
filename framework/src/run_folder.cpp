// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "run_folder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "host_errors.hpp"

namespace petal {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const fs::path& out, const std::string& why) {
    throw UsageError("--out " + out.string() + " " + why);
}

bool lies_in(const fs::path& inner, const fs::path& outer) {
    const auto ends = std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end());
    return ends.first == outer.end();
}

void check_place(const fs::path& out, const fs::path& folder, const RunInputs& inputs) {
    std::error_code error;
    if (fs::exists(folder, error) && !fs::is_directory(folder, error))
        refuse(out, "is a file; give the name of a folder");
    if (!inputs.data.empty() && lies_in(folder, fs::canonical(inputs.data, error)))
        refuse(out, "lies in the data folder; a run never writes into its data: give another one");
    if (!inputs.pipeline.empty() &&
        folder == fs::canonical(fs::absolute(inputs.pipeline).parent_path(), error))
        refuse(out, "is the pipeline's folder; give one of its own to the run");
    if (folder == fs::current_path(error))
        refuse(out, "is the working folder; give one of its own to the run");
}

/// Removes what the run of that run.json wrote, and nothing else.
void remove_run(const fs::path& out, const fs::path& folder) {
    std::ifstream in(folder / "run.json");
    const auto run = nlohmann::json::parse(in, nullptr, false);
    if (!run.is_object() || !run.contains("petal_run"))
        refuse(out, "holds a run.json that petal did not write; give another folder");
    std::vector<fs::path> old = {"log.txt", "stages"};
    for (const auto& product : run.value("products", nlohmann::json::array()))
        if (product.is_string()) old.emplace_back(product.get<std::string>());
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename().string();  // left by a run that was killed
        if (name[0] == '.' && name.find(".part") != std::string::npos) old.emplace_back(name);
    }
    old.emplace_back("run.json");  // last: until then the folder is known to hold a run
    for (const fs::path& name : old) {
        if (name.is_absolute() || *name.lexically_normal().begin() == "..") continue;
        fs::remove_all(folder / name, error);
        if (error)
            throw Error("cannot remove " + (folder / name).string() + ": " + error.message() +
                        "; give another folder with --out");
    }
}

/// Makes run.json, or says that there is one already. Exclusive: two runs cannot both have the
/// folder.
bool claim(const fs::path& folder) {
    const int file =
        ::open((folder / "run.json").c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0) {
        if (errno == EEXIST) return false;
        throw Error("cannot write into the run folder " + folder.string() + ": " +
                    std::generic_category().message(errno) + "; give another one with --out");
    }
    static constexpr char kRunning[] = "{\"petal_run\": 1, \"status\": \"running\"}\n";
    const bool written = ::write(file, kRunning, sizeof(kRunning) - 1) == sizeof(kRunning) - 1;
    ::close(file);
    if (!written) {
        std::error_code ignored;
        fs::remove(folder / "run.json", ignored);
        throw Error("cannot write into the run folder " + folder.string() + "; is the disk full?");
    }
    return true;
}

}  // namespace

fs::path default_run_folder(const std::string& pipeline) {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    std::array<char, 32> text{};
    std::strftime(text.data(), text.size(), "%Y%m%dT%H%M%SZ", &utc);
    const fs::path first = fs::path("runs") / (pipeline + "-" + text.data());
    fs::path folder = first;
    std::error_code error;
    for (int i = 2; fs::exists(folder, error); ++i)
        folder = first.string() + "-" + std::to_string(i);
    return folder;
}

fs::path prepare_run_folder(const fs::path& out, bool force, const RunInputs& inputs) {
    std::error_code error;
    const fs::path folder = fs::weakly_canonical(fs::absolute(out), error);
    if (error) throw Error("cannot use --out " + out.string() + ": " + error.message());
    check_place(out, folder, inputs);
    if (fs::exists(folder / "run.json", error)) {
        if (!force)
            refuse(out, "holds a run already; give another folder, or --force to replace that run");
        remove_run(out, folder);
    }
    for (const char* name : {"result.json", "log.txt", "stages"})
        if (fs::exists(folder / name, error))
            refuse(out,
                   std::string("holds ") + name +
                       " but no run.json, so it is not known to be a run's; give another folder");
    fs::create_directories(folder, error);
    if (error)
        throw Error("cannot make the run folder " + folder.string() + ": " + error.message() +
                    "; give another one with --out");
    if (!claim(folder)) refuse(out, "was taken by another run just now; give another folder");
    return folder;
}

}  // namespace petal
