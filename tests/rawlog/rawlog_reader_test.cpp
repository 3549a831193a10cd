// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/rawlog/rawlog_reader.hpp"

#include <gmock/gmock.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "petal/rawlog/lidar_points.hpp"
#include "plugins/sources/temporary_folder.hpp"
#include "rawlog_bytes.hpp"
#include "real_data.hpp"

namespace petal::testing {
namespace {

using namespace mrpt::obs;
using ::testing::AnyOf;
using ::testing::HasSubstr;

/// What reading a rawlog to its end, or to where it breaks, gave.
struct Reading {
    std::size_t observations = 0;
    std::size_t objects = 0;
    std::string error;  ///< empty at a sound end
};

Reading read(const std::filesystem::path& file) {
    Reading reading;
    try {
        RawlogReader reader(file);
        try {
            while (reader.next()) ++reading.observations;
        } catch (const Error& e) {
            reading.error = e.what();
        }
        reading.objects = reader.objects();
    } catch (const Error& e) {
        reading.error = e.what();
    }
    return reading;
}

class DamagedRawlog : public TemporaryFolder {
   protected:
    Reading reading(const std::string& bytes) const { return read(write("a.rawlog", bytes)); }

    /// Five observations; where each of them begins in the plain bytes, and where the last ends.
    static std::pair<std::string, std::vector<std::size_t>> five() {
        std::string bytes;
        std::vector<std::size_t> begins = {0};
        for (int i = 0; i < 5; ++i) {
            if (i % 2 == 0)
                bytes += bytes_of_objects({cloud("LIDAR", 0.1 * i, 30)});
            else
                bytes += bytes_of_objects({image("CAMERA", 0.1 * i)});
            begins.push_back(bytes.size());
        }
        return {bytes, begins};
    }
};

TEST_F(DamagedRawlog, CutAtFiftyPlacesPlain) {
    const auto [bytes, begins] = five();
    for (std::size_t i = 0; i < 50; ++i) {
        const std::size_t size = bytes.size() * i / 50;
        const Reading cut = reading(bytes.substr(0, size));
        std::size_t whole = 0;
        while (begins[whole + 1] <= size) ++whole;
        EXPECT_EQ(cut.objects, whole) << size;
        // Exactly between two objects nobody can tell.
        if (begins[whole] == size)
            EXPECT_EQ(cut.error, "") << size;
        else
            EXPECT_THAT(cut.error, AllOf(HasSubstr("a.rawlog"),
                                         AnyOf(HasSubstr("the file ends there"),
                                               HasSubstr("is it a rawlog?"), HasSubstr("claims")),
                                         HasSubstr(std::to_string(whole) + " object"),
                                         HasSubstr(std::to_string(begins[whole]) + " bytes")))
                << size;
    }
}

TEST_F(DamagedRawlog, CutAtFiftyPlacesCompressed) {
    const auto [bytes, begins] = five();
    const std::string whole = gzipped(bytes);
    EXPECT_EQ(reading(whole).objects, 5U);
    std::size_t latest = 0;
    for (std::size_t i = 1; i <= 50; ++i) {
        const std::size_t size = whole.size() * i / 51;
        const Reading cut = reading(whole.substr(0, size));
        EXPECT_THAT(cut.error, AllOf(HasSubstr("a.rawlog"), HasSubstr("cut off"),
                                     HasSubstr(std::to_string(cut.objects) + " object")))
            << size;
        EXPECT_GE(cut.objects, latest) << "a longer piece holds no fewer objects";
        latest = cut.objects;
    }
    EXPECT_EQ(reading(whole.substr(0, whole.size() - 1)).objects, 5U);
}

// A byte of a plain file that is data may change unseen: a coordinate is as good as another. What
// must not happen is a crash, another exception, or minutes of work.
TEST_F(DamagedRawlog, ChangedBytesPlain) {
    const auto [bytes, begins] = five();
    std::size_t told = 0;
    for (std::size_t i = 0; i < bytes.size(); i += 13) {
        std::string changed = bytes;
        changed[i] = static_cast<char>(changed[i] ^ 0xFF);
        const Reading damaged = reading(changed);
        if (!damaged.error.empty()) ++told;
        if (damaged.error.empty()) continue;
        EXPECT_THAT(damaged.error, AllOf(HasSubstr("a.rawlog"), HasSubstr("read whole before")));
        EXPECT_LT(begins[damaged.objects], i + 1) << "broken before the change at " << i;
    }
    EXPECT_GT(told, 20U) << "headers, classes, labels and counts";
}

TEST_F(DamagedRawlog, ChangedBytesCompressedAreAlwaysTold) {
    const auto [bytes, begins] = five();
    const std::string whole = gzipped(bytes);
    for (std::size_t i = 10; i < whole.size(); i += 7) {
        std::string changed = whole;
        changed[i] = static_cast<char>(changed[i] ^ 0x10);
        EXPECT_THAT(reading(changed).error,
                    AllOf(HasSubstr("a.rawlog"), HasSubstr("read whole before")))
            << i;
    }
}

TEST_F(DamagedRawlog, TheTrailerAndWhatFollows) {
    const std::string whole = gzipped(five().first);
    std::string crc = whole, length = whole;
    crc[crc.size() - 6] = static_cast<char>(crc[crc.size() - 6] ^ 0x55);
    length[length.size() - 2] = static_cast<char>(length[length.size() - 2] ^ 0x55);
    const std::vector<std::pair<std::string, std::string>> table = {
        {crc, "checksum"},
        {length, "length is not"},
        {whole + "garbage", "is not compressed"},
        {whole + std::string(512, '\0'), "is not compressed"},
        {whole + five().first, "is not compressed"},
        {whole + whole.substr(0, 40), "cut off"}};
    for (const auto& [file, message] : table) {
        const Reading broken = reading(file);
        EXPECT_EQ(broken.objects, 5U);
        EXPECT_THAT(broken.error, AllOf(HasSubstr(message), HasSubstr("5 objects")));
    }
    const Reading twice = reading(whole + whole);
    EXPECT_EQ(twice.error, "") << "two gzip members are legal";
    EXPECT_EQ(twice.objects, 10U);
}

TEST_F(DamagedRawlog, NoRawlogAtAll) {
    const std::string png("\x89PNG\r\n\x1A\n\0\0\0\rIHDR", 16);
    std::string noise;
    for (unsigned i = 0; i < 4000; ++i) noise += static_cast<char>((i * 2654435761U) >> 24U);
    for (const std::string& bytes :
         {png, noise, std::string("a text file\n"), std::string(5000, '\0'), gzipped("a text"),
          std::string("\x1F\x8B is no gzip", 14), std::string(1, '\x93')}) {
        const Reading other = reading(bytes);
        EXPECT_EQ(other.objects, 0U);
        EXPECT_THAT(other.error, AllOf(HasSubstr("a.rawlog"), HasSubstr("0 objects"),
                                       AnyOf(HasSubstr("is it a rawlog?"), HasSubstr("damaged"))));
    }
    for (const std::string& bytes : {std::string(), gzipped("")}) {
        EXPECT_EQ(reading(bytes).error, "") << "no object is no damage";
        EXPECT_EQ(reading(bytes).objects, 0U);
    }
}

TEST_F(DamagedRawlog, WhatANewerMrptWrote) {
    const std::string first = bytes_of_objects({cloud("LIDAR", 0.0)});
    const std::string name = "mrpt::obs::CObservationOfTomorrow";
    const std::string unknown =
        static_cast<char>(0x80U + name.size()) + name + std::string(30, '\0');
    EXPECT_THAT(reading(first + unknown).error,
                AllOf(HasSubstr(name), HasSubstr("not known to this MRPT"), HasSubstr("1 object")));
    // The points map inside an observation.
    std::string inside = first;
    const std::size_t map = inside.find("CPointsMapXYZI");
    inside.replace(map, 14, "CPointsMapXYZT");
    EXPECT_THAT(reading(inside).error,
                AllOf(HasSubstr("CPointsMapXYZT"), HasSubstr("CObservationPointCloud")));
    std::string version = first;
    const std::string own = "mrpt::obs::CObservationPointCloud";
    version[version.find(own) + own.size()] = '\x63';
    EXPECT_THAT(reading(version).error,
                AllOf(HasSubstr(own), HasSubstr("version"), HasSubstr("99"), HasSubstr("newer")));
    // A known class that no rawlog holds.
    EXPECT_THAT(reading(bytes_of_objects({mrpt::maps::CPointsMapXYZI::Create()})).error,
                HasSubstr("neither observation, action nor sensory frame"));
}

TEST_F(DamagedRawlog, BothLayoutsAndAMixture) {
    auto frame = CSensoryFrame::Create();
    frame->insert(cloud("LIDAR", 0.0));
    frame->insert(image("CAMERA", 0.0));
    auto actions = CActionCollection::Create();
    actions->insert(*CActionRobotMovement2D::Create());
    const std::string bytes =
        bytes_of_objects({actions, frame, actions, frame, cloud("LIDAR", 1.0)});
    for (const std::string& file : {bytes, gzipped(bytes)}) {
        EXPECT_EQ(reading(file).observations, 5U);
        EXPECT_EQ(reading(file).objects, 5U);
    }
}

TEST(DamagedScans, FewerRangesThanColumns) {
    CObservationRotatingScan scan;
    scan.rowCount = 1;
    scan.columnCount = 100;
    scan.rangeImage.resize(1, 50);
    mrpt::maps::CPointsMapXYZI points;
    EXPECT_THROW(append_lidar_points(scan, points), Error);
    CObservationPointCloud empty;
    EXPECT_THROW(append_lidar_points(empty, points), Error);
}

TEST(RealRawlogsRead, AllSixToTheirEnd) {
    PETAL_NEEDS_REAL_DATA();
    const std::vector<std::pair<const char*, std::size_t>> table = {
        {"localization_demo", 37}, {"rot_scan_2d", 1},         {"rot_scan_velodyne", 1},
        {"test_rtk_path", 692},    {"test_velodyne_VLP16", 1}, {"tests_rgbd", 1}};
    for (const auto& [name, observations] : table) {
        const Reading whole = read(real_data() / "mrpt_rawlogs" / (std::string(name) + ".rawlog"));
        EXPECT_EQ(whole.error, "") << name;
        EXPECT_EQ(whole.observations, observations) << name;
    }
}

}  // namespace
}  // namespace petal::testing
