// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "out_folder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "host_errors.hpp"
#include "json_tree.hpp"
#include "petal/output.hpp"

namespace petal::compare {

namespace fs = std::filesystem;

namespace {

constexpr char kLockFile[] = ".lock";

[[noreturn]] void refuse(const fs::path& out, const std::string& why) {
    throw UsageError("--out " + out.string() + " " + why);
}

}  // namespace

OutFolder::OutFolder(const fs::path& out, const Comparison& comparison, const Plan& plan) {
    std::error_code error;
    folder_ = fs::weakly_canonical(fs::absolute(out), error);
    if (error) throw Error("cannot use --out " + out.string() + ": " + error.message());
    check_place(out, plan);
    check_content(out, comparison.name);
    fs::create_directories(folder_, error);
    if (error)
        throw WriteError("cannot make the folder " + folder_.string() + ": " + error.message() +
                         "; give another one with --out");
    lock(out);
}

OutFolder::~OutFolder() {
    if (lock_ < 0) return;
    std::error_code ignored;
    fs::remove(folder_ / kLockFile, ignored);
    ::close(lock_);
}

void OutFolder::check_place(const fs::path& out, const Plan& plan) const {
    std::error_code error;
    if (fs::exists(folder_, error) && !fs::is_directory(folder_, error))
        refuse(out, "is a file; give the name of a folder");
    if (folder_ == fs::current_path(error))
        refuse(out, "is the working folder; give one of its own to the comparison");
    for (const PlannedData& data : plan.data) {
        if (data.folder.empty()) continue;
        const auto ends =
            std::mismatch(data.folder.begin(), data.folder.end(), folder_.begin(), folder_.end());
        if (ends.first == data.folder.end())
            refuse(out, "lies in the data folder " + data.folder.string() +
                            "; a comparison never writes into its data: give another one");
    }
}

void OutFolder::check_content(const fs::path& out, const std::string& name) const {
    std::error_code error;
    if (!fs::exists(folder_, error) || fs::is_empty(folder_, error)) return;
    std::ifstream in(folder_ / "run.json");
    if (!in) {
        if (fs::exists(folder_ / kLockFile, error)) return;  // killed at its very beginning
        refuse(out, "holds files but no run.json, so it is no comparison's; give another folder");
    }
    const auto note = nlohmann::json::parse(in, nullptr, false);
    if (!note.is_object() || !note.contains("petal_compare"))
        refuse(out, "holds a run.json that is no comparison's; give another folder");
    const auto its = note.find("name");
    const std::string other = its != note.end() && its->is_string() ? *its : "";
    if (other != name)
        refuse(out, "holds the comparison '" + printable(other) + "', not '" + printable(name) +
                        "'; give another folder");
}

void OutFolder::lock(const fs::path& out) {
    lock_ = ::open((folder_ / kLockFile).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (lock_ < 0)
        throw WriteError("cannot write into the folder " + folder_.string() + ": " +
                         std::generic_category().message(errno) + "; give another one with --out");
    // Of this process alone: a child that outlives it for a moment does not hold it.
    struct flock whole {};
    whole.l_type = F_WRLCK;
    whole.l_whence = SEEK_SET;
    if (::fcntl(lock_, F_SETLK, &whole) == 0) return;
    ::close(lock_);
    lock_ = -1;
    refuse(out,
           "is in use: another comparison is at work there; wait for it, or give another "
           "folder");
}

void OutFolder::write(const fs::path& name, const std::string& text) const {
    PendingFile file(folder_ / name);
    write_file(file.path(), text);
    file.commit();
}

}  // namespace petal::compare
