// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// Damaged rawlogs through the program: the right exit code, a message that says what was read and
// where it broke, and nothing half written. (What the reader makes of cuts and changed bytes at
// many places is in tests/rawlog.)

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include "petal_process.hpp"
#include "rawlog/rawlog_bytes.hpp"

namespace petal::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

class DamagedRawlogs : public PetalProcess {
   protected:
    void SetUp() override {
        PetalProcess::SetUp();
        write("pipeline.json",
              R"({"petal": 1, "stages": {
                  "scene": {"type": "source.rawlog", "params": {"files": ["${data}/scene.rawlog"]}},
                  "rawlog": {"type": "sink.rawlog", "in": {"cloud": "scene.cloud",
                             "images": "scene.images"}, "params": {"file": "copy.rawlog"}}}})");
        fs::create_directory(folder_ / "data");
    }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
    }
    Ended run() const { return petal("run pipeline.json --data data --out out --force"); }
    /// Files of the run folder that are no account of the run.
    std::vector<std::string> products() const {
        std::vector<std::string> names;
        if (!fs::exists(folder_ / "out")) return names;
        for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out"))
            if (entry.is_regular_file() && entry.path().filename() != "run.json" &&
                entry.path().filename() != "log.txt" &&
                entry.path().string().find("/stages/") == std::string::npos)
                names.push_back(entry.path().filename().string());
        return names;
    }
};

TEST_F(DamagedRawlogs, EachEndsWithOneAndSaysWhereItBroke) {
    const std::string plain = bytes_of_objects({cloud("LIDAR", 0.0, 20), image("CAMERA", 0.1)});
    const std::string whole = gzipped(plain);
    const std::string points = bytes_of_objects({cloud("LIDAR", 0.0, 20)});
    std::string crc = whole;
    crc[crc.size() - 7] = static_cast<char>(crc[crc.size() - 7] ^ 1);
    std::string count = plain;
    count[plain.find(std::string("\x14\0\0\0", 4)) + 3] = '\x40';
    std::string version = plain;
    const std::string name = "mrpt::obs::CObservationImage";
    version[version.find(name) + name.size()] = '\x70';
    const std::string newer = "mrpt::obs::CObservationOfTomorrow";
    auto outside = image("CAMERA", 0.0);
    outside->image.setExternalStorage("nowhere.png");
    struct Row {
        std::string what, bytes, message, whole;
    };
    const std::vector<Row> table = {
        {"cut, compressed", whole.substr(0, whole.size() / 2), "cut off", "objects ("},
        {"cut in the trailer", whole.substr(0, whole.size() - 3), "cut off", "2 objects ("},
        {"cut, plain", plain.substr(0, points.size() + 200), "CObservationImage", "1 objects ("},
        {"checksum", crc, "checksum", "2 objects ("},
        {"garbage after", whole + "garbage", "is not compressed", "2 objects ("},
        {"a count of a billion", count, "it claims", "0 objects ("},
        {"no rawlog: text", "hello\n", "is it a rawlog?", "0 objects ("},
        {"no rawlog: PNG", "\x89PNG\r\n\x1A\n", "is it a rawlog?", "0 objects ("},
        {"newer class", points + static_cast<char>(0x80U + newer.size()) + newer + "\1\2\3\4",
         newer, "1 objects ("},
        {"newer version", version, "newer MRPT", "1 objects ("},
        {"external image", bytes_of_objects({outside}), "nowhere.png", ""},
        {"empty", "", "neither a LiDAR nor a camera", ""},
        {"gzip of nothing", gzipped(""), "neither a LiDAR nor a camera", ""},
    };
    for (const Row& row : table) {
        write("data/scene.rawlog", row.bytes);
        const Ended ended = run();
        EXPECT_EQ(ended.exit_code, 1) << row.what << ended.err;
        EXPECT_THAT(ended.err,
                    AllOf(HasSubstr("scene.rawlog"), HasSubstr(row.message), HasSubstr(row.whole)))
            << row.what;
        EXPECT_THAT(products(), IsEmpty()) << row.what;
        const Ended inspected = petal("inspect data/scene.rawlog");
        EXPECT_EQ(inspected.exit_code, 1) << row.what;
        EXPECT_THAT(inspected.err, HasSubstr("scene.rawlog")) << row.what;
        if (row.message.rfind("neither", 0) != 0) {
            EXPECT_THAT(inspected.err, HasSubstr(row.message)) << row.what;
        }
    }
    write("data/scene.rawlog", gzipped(points) + gzipped(bytes_of_objects({image("CAMERA", 0.1)})));
    EXPECT_EQ(run().exit_code, 0) << "two gzip members are a whole file";
    EXPECT_THAT(products(), ::testing::ElementsAre("copy.rawlog"));
}

TEST_F(DamagedRawlogs, WhatIsNoFileThatCanBeRead) {
    EXPECT_THAT(run().err, HasSubstr("does not exist"));
    fs::create_directory(folder_ / "data" / "scene.rawlog");
    const Ended folder = run();
    EXPECT_EQ(folder.exit_code, 1);
    EXPECT_THAT(folder.err, HasSubstr("is a folder"));
    fs::remove(folder_ / "data" / "scene.rawlog");
    ASSERT_EQ(mkfifo((folder_ / "data" / "scene.rawlog").c_str(), 0600), 0);
    const Ended pipe = petal("inspect data/scene.rawlog");
    EXPECT_EQ(pipe.exit_code, 1);
    EXPECT_THAT(pipe.err, HasSubstr("is a pipe"));
    fs::remove(folder_ / "data" / "scene.rawlog");
    if (geteuid() == 0) GTEST_SKIP() << "root reads every file";
    write("data/scene.rawlog", "x");
    fs::permissions(folder_ / "data" / "scene.rawlog", fs::perms::none);
    EXPECT_THAT(run().err, HasSubstr("permissions"));
}

TEST_F(DamagedRawlogs, NoLidarOrNoImageIsNoDamage) {
    write("data/scene.rawlog", bytes_of_objects({image("CAMERA", 0.1)}));
    EXPECT_EQ(run().exit_code, 0);
    EXPECT_THAT(read_text(folder_ / "out" / "run.json"), HasSubstr("no LiDAR"));
    write("data/scene.rawlog", bytes_of_objects({cloud("LIDAR", 0.1)}));
    EXPECT_EQ(run().exit_code, 0);
}

}  // namespace
}  // namespace petal::testing
