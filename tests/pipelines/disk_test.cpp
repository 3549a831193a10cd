// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <sys/mount.h>
#include <unistd.h>

#include "slow_runs.hpp"

namespace petal::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A file that must not grow over a limit stands for a disk that is full: the write fails in the
/// same place.
class DiskTest : public SlowRuns {
   protected:
    void expect_no_space(const std::string& file) const {
        EXPECT_THAT(err(), AllOf(HasSubstr((folder_ / "out" / file).string()),
                                 HasSubstr("is the disk full?"), HasSubstr("--out")));
        EXPECT_EQ(run_json().value("status", ""), "failed") << read_text(folder_ / "out/run.json");
    }
};

TEST_F(DiskTest, AProductThatDoesNotFitIsAnErrorThatNamesIt) {
    for (const char* way : {"output", "stream"}) {
        fs::remove_all(folder_ / "out");
        write_pipeline("", "", std::string(R"("bytes": 50000, "way": ")") + way + "\"");
        EXPECT_EQ(start({}, 20000)->wait(60.0), 1) << err();
        expect_no_space("result.json");
        EXPECT_THAT(files(), ElementsAre("log.txt", "run.json"));
        EXPECT_THAT(run_json()["errors"].dump(), HasSubstr("writer (slow.writer)"));
    }
}

TEST_F(DiskTest, ADebugFileThatDoesNotFitIsAnErrorThatNamesIt) {
    write_pipeline("", "", R"("bytes": 50000, "way": "save", "name": "picture.png")");
    EXPECT_EQ(start({}, 20000)->wait(60.0), 1) << err();
    expect_no_space("stages/writer/picture.png");
    EXPECT_THAT(files(), ElementsAre("log.txt", "run.json"));
}

TEST_F(DiskTest, ALogThatDoesNotFitIsAnErrorThatNamesIt) {
    write_pipeline(R"("frames": 2000)", "", "");  // logs 400 lines of more than 30 bytes
    EXPECT_EQ(start({}, 8000)->wait(60.0), 1) << err();
    expect_no_space("log.txt");
    EXPECT_THAT(files(), ElementsAre("result.json", "run.json"));
}

TEST_F(DiskTest, ARunJsonThatDoesNotFitIsAnErrorThatNamesItAndSaysFailed) {
    write_pipeline("", "", R"("bytes": 10)");
    EXPECT_EQ(start({}, 300)->wait(60.0), 1) << err();
    expect_no_space("run.json");
    EXPECT_THAT(files(), ElementsAre("log.txt", "result.json", "run.json"));
    EXPECT_THAT(run_json()["products"].dump(), HasSubstr("result.json")) << "--force must know it";
}

TEST_F(DiskTest, NoRoomForAnythingLeavesNothing) {
    write_pipeline("", "", "");
    EXPECT_EQ(start({}, 10)->wait(60.0), 1);
    // Standard error is a file here and as limited, so what it says cannot be read.
    EXPECT_THAT(files(), ElementsAre());
}

/// A file system of 64 kB.
class SmallDisk {
   public:
    explicit SmallDisk(fs::path folder) : folder_(std::move(folder)) {
        mounted_ = geteuid() == 0 && ::mount("tmpfs", folder_.c_str(), "tmpfs", 0, "size=64k") == 0;
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;
    ~SmallDisk() {
        if (mounted_) ::umount(folder_.c_str());
    }
    bool mounted() const { return mounted_; }

   private:
    fs::path folder_;
    bool mounted_ = false;
};

// A real disk that is full.
TEST_F(DiskTest, AFullFileSystemIsAnErrorAndLeavesNothingHalfWritten) {
    fs::create_directory(folder_ / "disk");
    const SmallDisk disk(folder_ / "disk");
    if (!disk.mounted())
        GTEST_SKIP() << "a small file system cannot be mounted here (needs root and its rights)";
    fs::create_directory(folder_ / "disk" / "run");
    fs::create_directory_symlink(folder_ / "disk" / "run", folder_ / "out");
    write_pipeline("", "", R"("bytes": 200000)");
    EXPECT_EQ(start()->wait(60.0), 1) << err();
    EXPECT_THAT(err(), AllOf(HasSubstr("result.json"), HasSubstr("No space left on device")));
    EXPECT_EQ(run_json().value("status", ""), "failed");
    EXPECT_THAT(files(), ElementsAre("log.txt", "run.json"));
}

}  // namespace
}  // namespace petal::testing
