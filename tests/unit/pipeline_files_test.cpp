// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "pipeline_fakes.hpp"

namespace petal::pipeline_fakes {
namespace {

using ::testing::ElementsAre;

class PipelineFiles : public ::testing::Test {
   protected:
    PipelineFiles() {
        // One for each test: they may run at the same time.
        std::string name = ::testing::TempDir() + "petal_pipeline_XXXXXX";
        if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
        folder_ = name;
    }
    ~PipelineFiles() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }
    std::filesystem::path folder_;
};

TEST_F(PipelineFiles, are_read_with_their_patches) {
    PipelineRequest request;
    request.file = write("my pipeline.json", pipeline({kScene, kFilter}));
    request.patches = {write("v.json", R"({"stages": {"clean": {"params": {"radius": 0.3}}}})")};
    const CheckedPipeline checked = read_pipeline(request, registry());
    ASSERT_TRUE(checked.pipeline);
    EXPECT_EQ(checked.pipeline->name, "my pipeline");
    EXPECT_EQ(std::get<double>(checked.pipeline->find("clean")->values.at("radius")), 0.3);
}

TEST_F(PipelineFiles, that_cannot_be_read_are_told_together) {
    PipelineRequest request;
    request.file = folder_ / "absent.json";
    request.patches = {folder_, write("empty.json", ""),
                       write("large.json", std::string((std::size_t{4} << 20U) + 1, ' ')),
                       write("good.json", "{}")};
    const CheckedPipeline checked = read_pipeline(request, registry());
    EXPECT_FALSE(checked.pipeline);
    std::vector<std::string> texts;
    for (const Problem& problem : checked.problems) texts.push_back(to_string(problem));
    const std::string at = folder_.string();
    EXPECT_THAT(texts,
                ElementsAre(at + "/absent.json: no such file; expected a JSON file",
                            at + ": is a folder; expected a JSON file",
                            at + "/empty.json:1: is empty; expected JSON",
                            at + "/large.json: is larger than 4 MiB; expected a pipeline or a "
                                 "patch"));
}

/// What is wrong with a file that is no pipeline.
std::string problem(const std::filesystem::path& file) {
    PipelineRequest request;
    request.file = file;
    const CheckedPipeline checked = read_pipeline(request, registry());
    return checked.problems.size() == 1 ? to_string(checked.problems[0]) : "not one problem";
}

TEST_F(PipelineFiles, of_other_kinds_are_told) {
    EXPECT_EQ(problem(folder_), folder_.string() + ": is a folder; expected a JSON file");
    EXPECT_EQ(problem(""), "no such file; expected a JSON file");
    EXPECT_EQ(problem("/dev/zero"),
              "/dev/zero: is larger than 4 MiB; expected a pipeline or a patch");
    EXPECT_EQ(problem("/dev/null"), "/dev/null:1: is empty; expected JSON");
    const auto link = folder_ / "link.json";
    std::filesystem::create_symlink(folder_ / "gone.json", link);
    EXPECT_EQ(problem(link), link.string() + ": no such file; expected a JSON file");
    const auto loop = folder_ / "loop.json";
    std::filesystem::create_symlink(loop, loop);
    EXPECT_EQ(problem(loop), loop.string() +
                                 ": cannot be reached (Too many levels of symbolic links); "
                                 "expected a readable JSON file");
    const auto below = write("file.json", "{}") / "below.json";
    EXPECT_EQ(problem(below), below.string() + ": no such file; expected a JSON file");
}

TEST_F(PipelineFiles, that_may_not_be_read_are_told) {
    if (::geteuid() == 0) GTEST_SKIP() << "root may read every file";
    const auto locked = write("locked.json", "{}");
    std::filesystem::permissions(locked, std::filesystem::perms::none);
    EXPECT_EQ(problem(locked), locked.string() +
                                   ": cannot be opened (Permission denied); expected a readable "
                                   "JSON file");
}

}  // namespace
}  // namespace petal::pipeline_fakes
