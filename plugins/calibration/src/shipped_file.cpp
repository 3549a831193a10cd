// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/shipped_file.hpp"

#include <dlfcn.h>

#include <set>

#include "petal/error.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;

// Its address tells which library file this code was loaded from.
const char kThisLibrary = 0;

std::vector<fs::path> shipped_folders(const std::string& folder) {
    Dl_info info{};
    if (dladdr(&kThisLibrary, &info) == 0 || info.dli_fname == nullptr) return {};
    std::error_code ignored;
    const fs::path library = fs::canonical(info.dli_fname, ignored);
    if (library.empty()) return {};
    std::vector<fs::path> folders;
    // <prefix>/lib, and Debian's <prefix>/lib/<architecture>.
    for (const char* up : {"..", "../.."}) {
        const fs::path shipped =
            fs::weakly_canonical(library.parent_path() / up / "share" / "petal" / folder, ignored);
        if (fs::is_directory(shipped, ignored)) folders.push_back(shipped);
    }
    return folders;
}

}  // namespace

std::vector<std::string> shipped_names(const std::string& folder) {
    std::set<std::string> names;
    for (const fs::path& shipped : shipped_folders(folder))
        for (const auto& entry : fs::directory_iterator(shipped))
            if (entry.path().extension() == ".json") names.insert(entry.path().stem().string());
    return {names.begin(), names.end()};
}

fs::path find_shipped_file(const std::string& folder, const std::string& what,
                           const fs::path& name_or_path) {
    std::error_code ignored;
    if (!name_or_path.empty() && !name_or_path.has_parent_path() && !name_or_path.has_extension())
        for (const fs::path& shipped : shipped_folders(folder)) {
            fs::path file = shipped / (name_or_path.string() + ".json");
            if (fs::is_regular_file(file, ignored)) return file;
        }
    if (fs::is_directory(name_or_path, ignored))
        throw Error(what + " '" + name_or_path.string() + "' is a folder; name a JSON file in it");
    if (fs::exists(name_or_path, ignored)) return name_or_path;
    std::string known;
    for (const std::string& name : shipped_names(folder))
        known += (known.empty() ? "" : ", ") + name;
    throw Error("no " + what + " '" + name_or_path.string() +
                "': neither a file nor one that petal ships (" +
                (known.empty() ? "none were found beside petal's libraries" : known) + ")");
}

}  // namespace petal
