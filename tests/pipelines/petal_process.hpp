// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

namespace petal::testing {

namespace fs = std::filesystem;

inline std::string read_text(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// How a run of the program ended.
struct Ended {
    int exit_code = -1;
    std::string out;
    std::string err;
};

/// A folder of its own for each test, and the built program.
class PetalProcess : public ::testing::Test {
   protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "petal-process-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }

    /// Runs a program of the build tree with a shell's words as arguments, in the test's own
    /// folder.
    Ended run_program(const std::string& program, const std::string& arguments) const {
        const fs::path out = folder_ / ".stdout";
        const fs::path err = folder_ / ".stderr";
        const std::string command = "cd '" + folder_.string() + "' && '" PETAL_BUILD_DIR "/bin/" +
                                    program + "' " + arguments + " >'" + out.string() + "' 2>'" +
                                    err.string() + "' </dev/null";
        const int status = std::system(command.c_str());
        Ended ended;
        ended.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        ended.out = read_text(out);
        ended.err = read_text(err);
        return ended;
    }
    Ended petal(const std::string& arguments) const { return run_program("petal", arguments); }

    static std::string pipeline(const std::string& name) {
        return "'" PETAL_SOURCE_DIR "/pipelines/" + name + "'";
    }

    fs::path folder_;
};

}  // namespace petal::testing
