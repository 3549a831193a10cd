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
#include "petal/output.hpp"

namespace petal {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

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

Json read_note(const fs::path& folder) {
    std::ifstream in(folder / "run.json");
    return Json::parse(in, nullptr, false);
}

bool is_running(const Json& note) {
    return note.is_object() && note.contains("petal_run") && note.value("status", "") == "running";
}

/// The products that a run.json lists: relative and inside the folder, whatever it says.
std::vector<fs::path> products_of(const Json& note) {
    std::vector<fs::path> products;
    if (!note.is_object() || !note.contains("products")) return products;
    for (const auto& product : note["products"]) {
        if (!product.is_string()) continue;
        const fs::path name = fs::path(product.get<std::string>()).lexically_normal();
        if (name.is_absolute() || name.empty() || *name.begin() == "..") continue;
        products.push_back(name);
    }
    return products;
}

bool is_temporary(const fs::path& file) {
    const std::string name = file.filename().string();
    return name[0] == '.' && name.find(".part") != std::string::npos;
}

/// Overwrites run.json with a text that is no longer: that needs no space on a full disk.
void shrink_note(const fs::path& folder, const std::string& text) {
    const int file = ::open((folder / "run.json").c_str(), O_WRONLY | O_CLOEXEC);
    if (file < 0) return;
    const auto size = static_cast<ssize_t>(text.size());
    if (::pwrite(file, text.data(), text.size(), 0) == size)
        static_cast<void>(!::ftruncate(file, size));
    ::close(file);
}

/// Removes what the run of that run.json wrote, and nothing else.
void remove_run(const fs::path& out, const fs::path& folder) {
    const Json run = read_note(folder);
    if (!run.is_object() || !run.contains("petal_run"))
        refuse(out, "holds a run.json that petal did not write; give another folder");
    std::vector<fs::path> old = {"log.txt", "stages"};
    for (const fs::path& product : products_of(run)) old.push_back(product);
    remove_temporaries(folder);  // left by a run that was killed
    std::error_code error;
    old.emplace_back("run.json");  // last: until then the folder is known to hold a run
    for (const fs::path& name : old) {
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
        throw Error("cannot write into the run folder " + folder.string() +
                    "; is the disk full? Free some space, or give another folder with --out");
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
    fs::path folder = fs::weakly_canonical(fs::absolute(out), error);
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

void note_product(const fs::path& folder, const fs::path& product) {
    Json note = read_note(folder);
    if (!is_running(note)) return;
    note["products"].push_back(product.string());
    PendingFile file(folder / "run.json");
    write_file(file.path(), note.dump() + "\n");
    file.commit();
}

void note_end(const fs::path& folder, const std::string& status,
              const std::string& error) noexcept {
    try {
        Json note = read_note(folder);
        if (!is_running(note)) return;
        note["status"] = status;
        const std::string without_error = note.dump() + "\n";
        try {
            note["errors"] = Json::array({error});
            PendingFile file(folder / "run.json");
            write_file(file.path(), note.dump() + "\n");
            file.commit();
        } catch (const std::exception&) {
            if (without_error.size() <= fs::file_size(folder / "run.json"))
                shrink_note(folder, without_error);
        }
    } catch (const std::exception&) {
        // It still says "running", which is not taken for a whole run either.
    }
}

void remove_temporaries(const fs::path& folder) noexcept {
    try {
        std::error_code ignored;
        std::vector<fs::path> found;
        for (const auto& entry : fs::directory_iterator(folder, ignored))
            if (is_temporary(entry.path())) found.push_back(entry.path());
        for (const auto& entry : fs::recursive_directory_iterator(folder / "stages", ignored))
            if (is_temporary(entry.path())) found.push_back(entry.path());
        for (const fs::path& product : products_of(read_note(folder)))
            found.push_back(PendingFile::temporary_of(folder / product));
        for (const fs::path& file : found) fs::remove(file, ignored);
    } catch (const std::exception&) {
        // They are recognised as temporaries by their names.
    }
}

}  // namespace petal
