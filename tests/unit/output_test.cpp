// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/output.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "petal/error.hpp"
#include "run_folder.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string content(const fs::path& file) {
    std::ifstream in(file);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

template <class Work>
std::string error_of(Work work) {
    try {
        work();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

class OutputTest : public ::testing::Test {
   protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "petal-output-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override {
        fs::permissions(folder_, fs::perms::owner_all);
        fs::remove_all(folder_);
    }
    std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    fs::path folder_;
};

TEST_F(OutputTest, AFileAppearsOnlyWhenCommitted) {
    {
        PendingFile file(folder_ / "a.png");
        write_file(file.path(), "half");
        EXPECT_FALSE(fs::exists(folder_ / "a.png"));
        EXPECT_EQ(file.path().extension(), ".png");
    }
    EXPECT_EQ(files(), 0U) << "what was not committed leaves nothing behind";
    PendingFile file(folder_ / "a.png");
    write_file(file.path(), "whole");
    file.commit();
    EXPECT_EQ(content(folder_ / "a.png"), "whole");
    EXPECT_EQ(files(), 1U);
}

TEST_F(OutputTest, CommitReplacesAndNeedsContent) {
    write_file(folder_ / "a", "old");
    PendingFile file(folder_ / "a");
    EXPECT_THAT(error_of([&] { file.commit(); }), HasSubstr("nothing was written"));
    EXPECT_EQ(content(folder_ / "a"), "old");
    write_file(file.path(), "new");
    file.commit();
    EXPECT_EQ(content(folder_ / "a"), "new");
}

TEST_F(OutputTest, AFullDiskIsAnError) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    EXPECT_THAT(error_of([] { write_file("/dev/full", std::string(1 << 20, 'x')); }),
                HasSubstr("is the disk full?"));
}

TEST_F(OutputTest, AMessageNamesTheFileByItsOwnName) {
    PendingFile file(folder_ / "a.b.json");
    EXPECT_EQ(file.path(), PendingFile::temporary_of(folder_ / "a.b.json"));
    fs::create_directory(file.path());
    EXPECT_THAT(error_of([&] { write_file(file.path(), "x"); }),
                AllOf(HasSubstr((folder_ / "a.b.json").string()), Not(HasSubstr(".part"))));
    fs::remove(file.path());
}

TEST_F(OutputTest, AKilledRunsProductsAndTemporariesAreTidied) {
    const fs::path out = prepare_run_folder(folder_ / "out", false, {});
    note_product(out, "result.json");
    note_product(out, "sub/scene.rawlog");
    EXPECT_THAT(content(out / "run.json"), AllOf(HasSubstr("running"), HasSubstr("sub/scene")));
    fs::create_directory(out / "sub");
    write_file(out / "result.json", "whole");
    write_file(out / "sub" / ".scene.part.rawlog", "half");
    write_file(out / "sub" / ".mine.part.txt", "not the run's");
    prepare_run_folder(folder_ / "out", true, {});
    EXPECT_FALSE(fs::exists(out / "result.json"));
    EXPECT_FALSE(fs::exists(out / "sub" / ".scene.part.rawlog"));
    EXPECT_TRUE(fs::exists(out / "sub" / ".mine.part.txt"));
}

TEST_F(OutputTest, ARunThatCannotWriteItsReportStillSaysHowItEnded) {
    const fs::path out = prepare_run_folder(folder_ / "out", false, {});
    note_end(out, "failed", "no room");
    EXPECT_THAT(content(out / "run.json"), AllOf(HasSubstr("failed"), HasSubstr("no room")));
    note_end(out, "cancelled", "too late");
    EXPECT_THAT(content(out / "run.json"), HasSubstr("failed")) << "it says its end already";
    note_product(out, "late.json");
    EXPECT_THAT(content(out / "run.json"), Not(HasSubstr("late.json")));
}

TEST_F(OutputTest, AnUnwritableFolderIsNamed) {
    write_file(folder_ / "file", "x");
    EXPECT_THAT(error_of([&] { PendingFile file(folder_ / "file" / "a.txt"); }),
                HasSubstr((folder_ / "file").string()));
    if (geteuid() == 0) return;  // root may write anywhere
    fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_THAT(error_of([&] { PendingFile file(folder_ / "a.txt"); }), HasSubstr("cannot write"));
}

TEST_F(OutputTest, ARunFolderThatHoldsARunIsRefusedUnlessForced) {
    const fs::path out = folder_ / "out";
    const fs::path made = prepare_run_folder(out, false, {});
    EXPECT_EQ(made, fs::canonical(out));
    EXPECT_THAT(content(out / "run.json"), HasSubstr("running"));
    write_file(out / "run.json", R"({"petal_run": 1, "products": ["result.json", "../out.txt"]})");
    write_file(out / "result.json", "{}");
    write_file(out / ".scene.part.rawlog", "left by a run that was killed");
    write_file(folder_ / "out.txt", "not the run's");
    write_file(out / "mine.txt", "kept");
    EXPECT_THAT(error_of([&] { prepare_run_folder(out, false, {}); }), HasSubstr("--force"));
    prepare_run_folder(out, true, {});
    EXPECT_THAT(content(out / "run.json"), HasSubstr("running"));
    EXPECT_FALSE(fs::exists(out / ".scene.part.rawlog"));
    EXPECT_TRUE(fs::exists(folder_ / "out.txt"));
    EXPECT_FALSE(fs::exists(out / "result.json"));
    EXPECT_TRUE(fs::exists(out / "mine.txt")) << "only the run's own files go";
}

TEST_F(OutputTest, WhatPetalDidNotWriteIsNeverReplaced) {
    const fs::path out = folder_ / "out";
    fs::create_directories(out / "stages");
    write_file(out / "stages" / "precious", "x");
    EXPECT_THAT(error_of([&] { prepare_run_folder(out, true, {}); }), HasSubstr("no run.json"));
    write_file(out / "run.json", R"({"mine": 1})");
    EXPECT_THAT(error_of([&] { prepare_run_folder(out, true, {}); }),
                HasSubstr("petal did not write"));
    EXPECT_TRUE(fs::exists(out / "stages" / "precious"));
}

TEST_F(OutputTest, ARunFolderIsNeitherAFileNorInTheDataNorThePipelines) {
    write_file(folder_ / "file", "x");
    EXPECT_THAT(error_of([&] { prepare_run_folder(folder_ / "file", false, {}); }),
                HasSubstr("is a file"));
    fs::create_directories(folder_ / "data");
    for (const fs::path& inside : {folder_ / "data", folder_ / "data" / "run"})
        EXPECT_THAT(error_of([&] {
                        prepare_run_folder(inside, false, {folder_ / "data", ""});
                    }),
                    HasSubstr("lies in the data folder"));
    EXPECT_THAT(error_of([&] {
                    prepare_run_folder(folder_, false, {"", folder_ / "p.json"});
                }),
                HasSubstr("is the pipeline's folder"));
    EXPECT_THAT(error_of([&] { prepare_run_folder(fs::current_path(), true, {}); }),
                HasSubstr("is the working folder"));
}

}  // namespace
}  // namespace petal
