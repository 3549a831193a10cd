// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace petal::testing {

/// Folder of one bad plugin, as tests/loader/CMakeLists.txt builds it.
inline std::filesystem::path plugin_case(const std::string& name) {
    return std::filesystem::path(PETAL_TEST_PLUGINS) / name;
}
/// The library of a case that has one, named like its folder.
inline std::filesystem::path plugin_file(const std::string& name) {
    return plugin_case(name) / (name + ".so");
}

inline std::string read_bytes(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read " + path.string());
    return std::string(std::istreambuf_iterator<char>(file), {});
}

/// A folder of its own under the system's temporary one; removed with the object.
class TemporaryFolder {
   public:
    TemporaryFolder() {
        std::string name =
            (std::filesystem::temp_directory_path() / "petal_loader_XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
        path_ = std::filesystem::canonical(name);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        std::ofstream(path_ / name, std::ios::binary) << bytes;
        return path_ / name;
    }

   private:
    std::filesystem::path path_;
};

}  // namespace petal::testing
