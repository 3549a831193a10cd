// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/rawlog/rawlog_read_ahead.hpp"

#include <gmock/gmock.h>

#include "petal/error.hpp"
#include "petal/rawlog/lidar_points.hpp"
#include "plugins/sources/temporary_folder.hpp"
#include "rawlog_bytes.hpp"

namespace petal::testing {
namespace {

using ::testing::HasSubstr;

class ReadAhead : public TemporaryFolder {
   protected:
    static std::string twenty_clouds() {
        Objects objects;
        for (int i = 0; i < 20; ++i) objects.push_back(cloud("LIDAR", 0.1 * i, 300));
        return bytes_of_objects(objects);
    }
};

TEST_F(ReadAhead, GivesWhatTheReaderGivesInItsOrder) {
    const auto file = write("a.rawlog", gzipped(twenty_clouds()));
    for (const std::size_t ahead : {0U, 1U, 4U, 100U}) {
        RawlogReadAhead reader(file, ahead);
        for (int i = 0; i < 20; ++i) {
            const auto observation = reader.next();
            ASSERT_NE(observation, nullptr) << i;
            EXPECT_EQ(observation->timestamp, at(0.1 * i)) << ahead;
        }
        EXPECT_EQ(reader.next(), nullptr);
        EXPECT_EQ(reader.next(), nullptr) << "the end stays the end";
    }
}

TEST_F(ReadAhead, DamageComesAfterAllThatWasReadWhole) {
    const std::string bytes = twenty_clouds();
    const auto file = write("a.rawlog", bytes.substr(0, bytes.size() - 1));
    for (const std::size_t ahead : {0U, 3U, 100U}) {
        RawlogReadAhead reader(file, ahead);
        for (int i = 0; i < 19; ++i) ASSERT_NE(reader.next(), nullptr) << i;
        try {
            reader.next();
            FAIL() << "the last object is cut off";
        } catch (const Error& e) {
            EXPECT_THAT(e.what(), HasSubstr("19 objects"));
        }
    }
}

TEST_F(ReadAhead, NobodyNeedsToReadToTheEnd) {
    const auto file = write("a.rawlog", twenty_clouds());
    for (int asked = 0; asked < 6; ++asked) {
        RawlogReadAhead reader(file, 2);
        for (int i = 0; i < asked; ++i) EXPECT_NE(reader.next(), nullptr);
    }
}

TEST(LidarPoints, ManyMessagesAreNotCopiedAtEachOfThem) {
    mrpt::maps::CPointsMapXYZI points;
    const void* place = nullptr;
    int moves = 0;
    for (int i = 0; i < 1000; ++i) {
        append_lidar_points(*cloud("LIDAR", 0.0, 10), points);
        if (place != points.getPointsBufferRef_x().data()) ++moves;
        place = points.getPointsBufferRef_x().data();
    }
    ASSERT_EQ(points.size(), 10000U);
    EXPECT_EQ(points.getPointsBufferRef_z()[9999], 4.5F);
    EXPECT_EQ(points.getPointIntensity(9999), 0.25F);
    // Room grows by a factor of 1.5 or 2 from some 10 to 10,000 points.
    EXPECT_LE(moves, 20);
}

}  // namespace
}  // namespace petal::testing
