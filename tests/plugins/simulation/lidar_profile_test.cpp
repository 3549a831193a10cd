// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/lidar/lidar_profile.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "petal/error.hpp"

namespace petal::simulation {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

constexpr double kSensorDegree = 3.14159265358979323846 / 180.0;

std::string text_of_sensor(const char* name) {
    std::ostringstream text;
    text << std::ifstream(find_lidar_profile(name)).rdbuf();
    return text.str();
}

/// A sensor file that goes with the test.
class SensorFile : public ::testing::Test {
   protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  ("petal_sensor_test_" +
                   std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    /// What is said of the file of a shipped sensor in which `old` reads `changed`.
    std::string refusal(const char* name, const std::string& old, const std::string& changed) {
        std::string text = text_of_sensor(name);
        const std::size_t at = text.find(old);
        if (at == std::string::npos) return "'" + old + "' is not in the file";
        text.replace(at, old.size(), changed);
        const fs::path file = folder_ / "mine.json";
        std::ofstream(file) << text;
        try {
            load_lidar_profile(file);
        } catch (const Error& e) {
            return e.what();
        }
        return "accepted";
    }

    fs::path folder_;
};

TEST(ShippedSensors, TheMid70IsThatOfItsDataSheet) {
    const LidarProfile p = load_lidar_profile("livox_mid70");
    EXPECT_EQ(p.name, "livox_mid70");
    EXPECT_EQ(p.points_per_second, 100000.0);
    EXPECT_EQ(p.messages_per_second, 10.0);
    EXPECT_NEAR(p.footprint_vertical, 0.28 * kSensorDegree, 1e-12);
    EXPECT_NEAR(p.footprint_horizontal, 0.03 * kSensorDegree, 1e-12);
    EXPECT_NEAR(p.rim(), 35.2 * kSensorDegree, 1e-12);
    EXPECT_EQ(p.quantised, LidarProfile::Quantised::coordinates);
    EXPECT_EQ(p.returned, LidarProfile::Return::first);
    EXPECT_NEAR(p.detection_energy(), 0.1 / 8100.0, 1e-12);
    EXPECT_GE(p.angular_noise, 0.02 * kSensorDegree);
    EXPECT_LE(p.angular_noise, 0.05 * kSensorDegree);
}

TEST(ShippedSensors, AllLoad) {
    for (const char* name : {"livox_mid70", "livox_avia", "livox_mid360", "spinning_32"}) {
        const LidarProfile p = load_lidar_profile(name);
        EXPECT_EQ(p.name, name);
        EXPECT_TRUE(fs::is_regular_file(find_lidar_profile(name)));
        // White on 80 % is seen where the sheets say; 10 % at the longest range is not.
        EXPECT_LT(0.1 / (p.range_max * p.range_max), p.detection_energy()) << name;
        EXPECT_LT(p.range_noise_near, p.range_noise_far) << name;
    }
    EXPECT_NEAR(load_lidar_profile("livox_avia").rim(), 38.6 * kSensorDegree, 1e-12);
    EXPECT_NEAR(load_lidar_profile("livox_mid360").rim(), 52.0 * kSensorDegree, 1e-12);
    EXPECT_EQ(load_lidar_profile("spinning_32").pattern.elevations.size(), 32U);
}

TEST(ShippedSensors, RangeNoiseGrowsWithWeakEchoesFromItsNearToItsFarFigure) {
    const LidarProfile p = load_lidar_profile("livox_mid70");
    EXPECT_NEAR(p.range_noise(0.8 / 400.0), 0.02, 1e-12) << "80 % at 20 m";
    EXPECT_NEAR(p.range_noise(0.8), 0.012, 5e-5) << "80 % at 1 m";
    EXPECT_GT(p.range_noise(0.1 / 400.0), 0.02);
}

TEST(ShippedSensors, AnUnknownNameIsToldWithThoseThatAreThere) {
    try {
        load_lidar_profile("mid70");
        FAIL() << "accepted";
    } catch (const Error& e) {
        EXPECT_THAT(e.what(),
                    AllOf(HasSubstr("mid70"), HasSubstr("livox_mid360"), HasSubstr("spinning_32")));
    }
}

TEST_F(SensorFile, AWrongKeyIsToldWithTheRightOne) {
    EXPECT_EQ(refusal("livox_mid70", "Livox", "livox"), "accepted");
    EXPECT_THAT(refusal("livox_mid70", "\"dropout\"", "\"drop_out\""),
                AllOf(HasSubstr("mine.json"), HasSubstr("drop_out"), HasSubstr("dropout")));
    EXPECT_THAT(refusal("livox_mid70", "\"rates_rpm\"", "\"rates\""), HasSubstr("rates_rpm"));
    EXPECT_THAT(refusal("livox_mid360", "\"swing_hz\"", "\"rates_rpm\""), HasSubstr("rates_rpm"));
}

TEST_F(SensorFile, AMissingKeyIsTold) {
    EXPECT_THAT(refusal("livox_mid70", "\"pulse_width\": 0.6,", ""), HasSubstr("pulse_width"));
    EXPECT_THAT(refusal("livox_mid70", "\"near\": 0.012,", ""), HasSubstr("near"));
    EXPECT_THAT(refusal("livox_mid70", "\"kind\": \"prisms\",", ""), HasSubstr("kind"));
}

TEST_F(SensorFile, AWrongValueIsToldWithWhatWasExpected) {
    EXPECT_THAT(refusal("livox_mid70", "\"petal_lidar\": 1", "\"petal_lidar\": 2"),
                AllOf(HasSubstr("petal_lidar"), HasSubstr("must be 1")));
    EXPECT_THAT(refusal("livox_mid70", "\"kind\": \"prisms\"", "\"kind\": \"flower\""),
                AllOf(HasSubstr("pattern.kind"), HasSubstr("nodding")));
    EXPECT_THAT(refusal("livox_mid70", "[7294.1, -4664.3]", "[7294.1]"), HasSubstr("rates_rpm"));
    EXPECT_THAT(refusal("livox_mid70", "[17.6, 17.6]", "[]"), HasSubstr("deflections_deg"));
    EXPECT_THAT(refusal("livox_mid70", "\"pulse_width\": 0.6", "\"pulse_width\": 0"),
                AllOf(HasSubstr("pulse_width"), HasSubstr("m")));
    EXPECT_THAT(refusal("livox_mid70", "\"far\": 0.02", "\"far\": 0.002"), HasSubstr("near"));
    EXPECT_THAT(refusal("livox_mid70", "\"range_max\": 260.0", "\"range_max\": \"260\""),
                HasSubstr("range_max"));
    EXPECT_THAT(refusal("livox_mid70", "\"range_min\": 0.05", "\"range_min\": 100"), "accepted");
    EXPECT_THAT(refusal("livox_mid360", "\"range_max\": 100.0", "\"range_max\": 0.1"),
                HasSubstr("range_min"));
    EXPECT_THAT(
        refusal("livox_mid360", "\"elevation_high_deg\": 52.0", "\"elevation_high_deg\": -8"),
        HasSubstr("elevation_low_deg"));
    EXPECT_THAT(refusal("livox_mid70", "\"points_per_second\": 100000", "\"points_per_second\": 5"),
                HasSubstr("messages_per_second"));
    EXPECT_THAT(refusal("livox_mid70", "\"first\"", "\"last\""), HasSubstr("strongest"));
}

}  // namespace
}  // namespace petal::simulation
