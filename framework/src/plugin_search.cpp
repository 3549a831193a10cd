// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plugin_search.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "host_errors.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;

/// <folder of libpetal.so>/petal: so in the build tree, and so where petal is installed.
fs::path own_folder() {
    static const char anchor = 0;  // an address inside libpetal.so
    Dl_info info{};
    if (dladdr(&anchor, &info) == 0 || info.dli_fname == nullptr)
        throw Error(
            "cannot tell where libpetal.so lies, so the plugins beside it are not found; name "
            "their folder with --plugin-path");
    std::error_code failed;
    const fs::path library = fs::canonical(info.dli_fname, failed);
    if (failed)
        throw Error(std::string("cannot resolve the place of libpetal.so, '") + info.dli_fname +
                    "': " + failed.message());
    return library.parent_path() / "petal";
}

std::vector<fs::path> environment_folders() {
    const char* const text = std::getenv("PETAL_PLUGIN_PATH");
    std::vector<fs::path> folders;
    if (text == nullptr || *text == '\0') return folders;
    const std::string list = text;
    for (std::size_t begin = 0; begin <= list.size();) {
        const std::size_t end = std::min(list.find(':', begin), list.size());
        const fs::path folder = list.substr(begin, end - begin);
        // A relative folder would load code from wherever the user happens to stand.
        if (!folder.is_absolute())
            throw UsageError(
                folder.empty() ? "PETAL_PLUGIN_PATH has an empty element; take the surplus ':' out"
                               : "PETAL_PLUGIN_PATH holds the relative folder '" + folder.string() +
                                     "'; write its absolute path");
        folders.push_back(folder);
        begin = end + 1;
    }
    return folders;
}

/// The same folder by two names is searched once.
void add_folder(std::vector<fs::path>& folders, const fs::path& folder) {
    std::error_code failed;
    fs::path whole = fs::weakly_canonical(folder, failed);
    if (failed)
        whole = folder.lexically_normal();  // find_candidates will tell what is wrong with it
    if (!whole.has_filename()) whole = whole.parent_path();
    if (std::find(folders.begin(), folders.end(), whole) == folders.end())
        folders.push_back(std::move(whole));
}

}  // namespace

std::vector<fs::path> plugin_folders(const std::vector<fs::path>& first) {
    std::vector<fs::path> folders;
    for (const fs::path& folder : first) {
        std::error_code failed;
        if (!fs::exists(folder, failed))
            throw UsageError("the plugin folder '" + folder.string() +
                             "' (--plugin-path) does not exist");
        if (!fs::is_directory(folder, failed))
            throw UsageError("'" + folder.string() +
                             "' (--plugin-path) is not a folder; name the folder that "
                             "holds the plugin");
        add_folder(folders, fs::absolute(folder));
    }
    for (const fs::path& folder : environment_folders()) add_folder(folders, folder);
    // The own place keeps its rank as the last one, which tells what the packet types' ABI is.
    const fs::path own = own_folder();
    folders.erase(std::remove(folders.begin(), folders.end(), own), folders.end());
    folders.push_back(own);
    return folders;
}

std::vector<Candidate> find_candidates(const std::vector<fs::path>& folders,
                                       std::vector<Refusal>& refused) {
    std::vector<Candidate> candidates;
    std::set<fs::path> known;
    for (std::size_t i = 0; i < folders.size(); ++i) {
        std::error_code failed;
        if (fs::status(folders[i], failed).type() == fs::file_type::not_found) continue;
        std::vector<fs::path> files;
        fs::directory_iterator entry(folders[i], failed);
        while (!failed && entry != fs::directory_iterator()) {
            if (entry->path().extension() == ".so") files.push_back(entry->path());
            entry.increment(failed);
        }
        if (failed)
            refused.push_back({folders[i], "the folder cannot be read: " + failed.message()});
        std::sort(files.begin(), files.end());
        for (const fs::path& file : files) {
            std::error_code broken;
            const fs::path library = fs::canonical(file, broken);
            if (broken) {
                refused.push_back({file, "cannot be resolved: " + broken.message()});
                continue;
            }
            if (fs::is_directory(library, broken) || !known.insert(library).second) continue;
            if (!fs::is_regular_file(library, broken)) {  // reading a pipe would wait for ever
                refused.push_back({file, "is no regular file"});
                continue;
            }
            candidates.push_back({library, i});
        }
    }
    return candidates;
}

}  // namespace petal
