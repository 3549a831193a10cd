// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "unit_store.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>

#include "petal/error.hpp"
#include "petal/output.hpp"
#include "text_file.hpp"

namespace petal::compare {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr char kUnitFile[] = "unit.json";
constexpr char kResultFile[] = "result.json";
constexpr char kPictureFolder[] = "pictures";

std::string unit_json(const UnitRecord& record) {
    Json json{{"petal_unit", 1},
              {"key", record.key},
              {"variant", record.variant},
              {"data", record.data},
              {"seed", record.seed},
              {"status", record.status},
              {"verdict", record.verdict},
              {"reasons", record.reasons},
              {"files", record.files},
              {"executed", record.executed},
              {"shared", record.shared},
              {"wall_s", record.wall_s},
              {"cpu_s", record.cpu_s},
              {"peak_memory_bytes", record.peak_memory_bytes},
              {"stage_wall_s", record.stage_wall_s}};
    json["result"] = record.result.empty() ? Json() : Json(blake2b_of_text(record.result));
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// \throws nlohmann's exceptions where a key is missing or of another kind.
UnitRecord record_of(const Json& json) {
    UnitRecord record;
    json.at("key").get_to(record.key);
    json.at("variant").get_to(record.variant);
    json.at("data").get_to(record.data);
    json.at("seed").get_to(record.seed);
    json.at("status").get_to(record.status);
    json.at("verdict").get_to(record.verdict);
    json.at("reasons").get_to(record.reasons);
    json.at("files").get_to(record.files);
    json.at("executed").get_to(record.executed);
    json.at("shared").get_to(record.shared);
    json.at("wall_s").get_to(record.wall_s);
    json.at("cpu_s").get_to(record.cpu_s);
    json.at("peak_memory_bytes").get_to(record.peak_memory_bytes);
    json.at("stage_wall_s").get_to(record.stage_wall_s);
    return record;
}

std::optional<std::string> read_whole(const fs::path& file, std::string& damage) {
    std::string why;
    auto text = read_text_file(file, why);
    if (!text) damage = file.string() + " " + why;
    return text;
}

bool is_leftover(const fs::path& folder) {
    return folder.filename().string().rfind('.', 0) == 0;
}

void sync_folder(const fs::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    ::fsync(descriptor);
    ::close(descriptor);
}

}  // namespace

bool UnitStore::holds(const std::string& key) const {
    std::error_code ignored;
    return fs::exists(place(key), ignored);
}

std::optional<UnitRecord> UnitStore::load(const std::string& key, std::string& damage) const {
    damage.clear();
    if (!holds(key)) return std::nullopt;
    const auto text = read_whole(place(key) / kUnitFile, damage);
    if (!text) return std::nullopt;
    const fs::path unit_file = place(key) / kUnitFile;
    try {
        const Json json = Json::parse(*text);
        UnitRecord record = record_of(json);
        if (record.key != key) {
            damage = unit_file.string() + " is of another unit, " + record.key;
            return std::nullopt;
        }
        if (json.at("result").is_null()) return record;
        const auto result = read_whole(place(key) / kResultFile, damage);
        if (!result) return std::nullopt;
        if (blake2b_of_text(*result) != json.at("result").get<std::string>()) {
            damage = (place(key) / kResultFile).string() + " is not what the unit wrote";
            return std::nullopt;
        }
        record.result = *result;
        return record;
    } catch (const Json::exception&) {
        damage = unit_file.string() + " is no whole unit.json";
        return std::nullopt;
    }
}

std::vector<fs::path> UnitStore::pictures(const std::string& key) const {
    std::vector<fs::path> files;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(place(key) / kPictureFolder, none))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

std::string UnitStore::changed_file(const UnitRecord& record, FileSums& sums) {
    for (const auto& [file, sum] : record.files)
        if (sums.of_any(file) != sum) return file;
    return {};
}

void UnitStore::store(const UnitRecord& record) const {
    std::error_code error;
    const fs::path beside = folder_ / ("." + record.key + "-" + std::to_string(::getpid()));
    fs::remove_all(beside, error);
    fs::create_directories(beside, error);
    if (error)
        throw WriteError("cannot make the folder " + beside.string() + ": " + error.message() +
                         "; is the disk full? Free some space, or give another folder with --out");
    try {
        const auto write = [&](const fs::path& name, const std::string& text) {
            PendingFile file(beside / name);
            write_file(file.path(), text);
            file.commit();
        };
        if (!record.result.empty()) write(kResultFile, record.result);
        for (const auto& [name, bytes] : record.pictures)
            write(fs::path(kPictureFolder) / name, bytes);
        write(kUnitFile, unit_json(record));
        remove(record.key);
        fs::rename(beside, place(record.key));
    } catch (const fs::filesystem_error& failure) {
        fs::remove_all(beside, error);
        throw WriteError("cannot put " + place(record.key).string() +
                         " in place: " + failure.code().message());
    } catch (...) {
        fs::remove_all(beside, error);
        throw;
    }
    sync_folder(folder_);
}

void UnitStore::remove(const std::string& key) const {
    fs::remove_all(place(key));
}

void UnitStore::remove_leftovers() const {
    std::error_code ignored;
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder_, ignored))
        if (is_leftover(entry.path())) found.push_back(entry.path());
    for (const fs::path& one : found) fs::remove_all(one, ignored);
}

}  // namespace petal::compare
