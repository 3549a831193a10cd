// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/rawlog.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <opencv2/core.hpp>

#include "petal/calibration/observation.hpp"
#include "petal/calibration/truth.hpp"
#include "petal/calibration/truth_json.hpp"
#include "petal/error.hpp"
#include "petal/testing/stage_harness.hpp"
#include "rawlog_objects.hpp"

namespace petal {
namespace {

using namespace mrpt::obs;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::StageHarness;
namespace fs = std::filesystem;

mrpt::Clock::time_point at(int ticks) {
    return mrpt::Clock::fromDouble(1.7e9) + mrpt::Clock::duration(ticks);
}

/// 300 points in three messages, the second one empty; awkward numbers among them.
Cloud example_cloud() {
    auto points = std::make_shared<mrpt::maps::CPointsMapXYZI>();
    for (int i = 0; i < 300; ++i) {
        const auto k = static_cast<float>(i);
        points->insertPointFast(k / 7.0F, -k * 1e-6F, 1.0F + k);
        points->setPointIntensity(points->size() - 1, k / 300.0F);
    }
    points->setPointFast(5, std::numeric_limits<float>::quiet_NaN(), 0.0F,
                         std::numeric_limits<float>::infinity());
    Cloud cloud;
    cloud.points = points;
    cloud.sensor_label = "MID70";
    cloud.sensor_pose = mrpt::poses::CPose3D(0.1, -0.2, 0.3, 0.4, -0.5, 0.6);
    cloud.parts = {{0, at(1)}, {100, at(2)}, {100, at(5)}};
    return cloud;
}

Images example_images() {
    Images images;
    for (const int type : {CV_8UC1, CV_8UC3}) {
        cv::Mat pixels(120, 210, type);  // large enough that MRPT compresses what it may
        for (int row = 0; row < pixels.rows; ++row)
            for (std::size_t i = 0; i < static_cast<std::size_t>(pixels.cols) * pixels.elemSize();
                 ++i)
                pixels.ptr(row)[i] =
                    static_cast<unsigned char>((row * 7 + static_cast<int>(i) * 13) % 251);
        CameraImage camera;
        camera.label = type == CV_8UC1 ? "GREY" : "COLOUR";
        camera.image = mrpt::img::CImage(pixels, mrpt::img::DEEP_COPY);
        camera.camera.ncols = 210;
        camera.camera.nrows = 120;
        camera.camera.setIntrinsicParamsFromValues(100.1, 101.2, 103.3, 60.4);
        if (type == CV_8UC1)
            camera.camera.setDistortionKannalaBrandt(0.1, 0.2, 0.3, 0.4);
        else
            camera.camera.setDistortionPlumbBob(0.1, 0.2, 0.3, 0.4, 0.5);
        camera.stamp = at(type == CV_8UC1 ? 3 : 4);
        camera.sensor_pose = mrpt::poses::CPose3D(1.0, 2.0, 3.0, 0.3, 0.2, 0.1);
        images.cameras.push_back(camera);
    }
    return images;
}

std::vector<CObservation::Ptr> read_all(const fs::path& file) {
    return testing::observations_of(testing::read_rawlog(file));
}

/// Bit for bit, so that a NaN is like itself.
bool same_bits(float a, float b) {
    return std::memcmp(&a, &b, sizeof(float)) == 0;
}

TEST(RawlogSinkStage, WritesAndReadsBackWithoutLoss) {
    const Cloud cloud = example_cloud();
    const Images images = example_images();
    StageHarness stage = StageHarness::of<RawlogSink>();
    stage.give<Cloud>("cloud", cloud, "room").give<Images>("images", images, "room");
    stage.fire();
    const auto all = read_all(stage.folder() / "scene.rawlog");
    ASSERT_EQ(all.size(), 5U);
    std::size_t index = 0, clouds = 0, pictures = 0;
    mrpt::Clock::time_point last{};
    for (const auto& each : all) {
        EXPECT_LE(last, each->timestamp);
        last = each->timestamp;
        if (const auto message = std::dynamic_pointer_cast<CObservationPointCloud>(each)) {
            ASSERT_LT(clouds, cloud.parts.size());
            EXPECT_EQ(message->sensorLabel, "MID70");
            EXPECT_EQ(message->timestamp, cloud.parts[clouds++].stamp);
            // MRPT stores a pose as a quaternion: rounding of double.
            EXPECT_NEAR((message->sensorPose - cloud.sensor_pose).norm(), 0.0, 1e-12);
            EXPECT_NEAR(message->sensorPose.yaw(), 0.4, 1e-12);
            const auto points =
                std::dynamic_pointer_cast<mrpt::maps::CPointsMapXYZI>(message->pointcloud);
            ASSERT_TRUE(points);
            for (std::size_t i = 0; i < points->size(); ++i, ++index) {
                EXPECT_TRUE(same_bits(points->getPointsBufferRef_x()[i],
                                      cloud.points->getPointsBufferRef_x()[index]));
                EXPECT_TRUE(same_bits(points->getPointsBufferRef_y()[i],
                                      cloud.points->getPointsBufferRef_y()[index]));
                EXPECT_TRUE(same_bits(points->getPointsBufferRef_z()[i],
                                      cloud.points->getPointsBufferRef_z()[index]));
                EXPECT_TRUE(same_bits(points->getPointIntensity(i),
                                      cloud.points->getPointIntensity(index)));
            }
        } else if (const auto picture = std::dynamic_pointer_cast<CObservationImage>(each)) {
            const CameraImage& from = images.cameras.at(pictures++);
            EXPECT_EQ(picture->sensorLabel, from.label);
            EXPECT_EQ(picture->timestamp, from.stamp);
            EXPECT_TRUE(picture->cameraParams == from.camera);
            EXPECT_EQ(picture->cameraParams.distortion, from.camera.distortion);
            EXPECT_EQ(picture->cameraParams.dist, from.camera.dist);
            EXPECT_NEAR(picture->cameraPose.yaw(), 0.3, 1e-12);
            EXPECT_EQ(cv::norm(picture->image.asCvMatRef(), from.image.asCvMatRef(), cv::NORM_INF),
                      0.0);
        }
    }
    EXPECT_EQ(index, cloud.size());
    EXPECT_EQ(clouds, 3U);
    EXPECT_EQ(pictures, 2U);
}

TEST(RawlogSinkStage, TheOtherImagesOfACameraAreWrittenToo) {
    Images images = example_images();
    images.others = {images.cameras[0], images.cameras[0]};
    images.others[0].stamp = at(0);
    images.others[1].stamp = at(6);
    StageHarness stage = StageHarness::of<RawlogSink>();
    stage.give<Cloud>("cloud", example_cloud(), "room").give<Images>("images", images, "room");
    stage.fire();
    std::vector<mrpt::Clock::time_point> stamps;
    for (const auto& each : read_all(stage.folder() / "scene.rawlog"))
        if (std::dynamic_pointer_cast<CObservationImage>(each)) stamps.push_back(each->timestamp);
    EXPECT_THAT(stamps, ElementsAre(at(0), at(3), at(4), at(6)));
}

TEST(RawlogSinkStage, MrptsOwnProgramOpensIt) {
    if (std::system("command -v rawlog-edit > /dev/null 2>&1") != 0)
        GTEST_SKIP() << "no rawlog-edit: install mrpt-apps";
    StageHarness stage = StageHarness::of<RawlogSink>();
    stage.give<Cloud>("cloud", example_cloud()).give<Images>("images", example_images());
    stage.fire();
    const std::string command = "rawlog-edit --info -i '" +
                                (stage.folder() / "scene.rawlog").string() +
                                "' | grep -q 'Overall number of objects *: 5'";
    EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST(RawlogSinkStage, AFilteredCloudIsOneMessage) {
    Cloud cloud = example_cloud();
    cloud.parts.clear();
    StageHarness stage = StageHarness::of<RawlogSink>();
    stage.give<Cloud>("cloud", cloud);
    stage.fire();
    EXPECT_EQ(read_all(stage.folder() / "scene.rawlog").size(), 1U);
}

TEST(RawlogSinkStage, WritesObservationsAsTheyAre) {
    StageHarness stage = StageHarness::of<RawlogSink>();
    for (int i = 0; i < 3; ++i) {
        auto cloud = CObservationPointCloud::Create();
        cloud->sensorLabel = "L" + std::to_string(i);
        cloud->pointcloud = mrpt::maps::CPointsMapXYZI::Create();
        stage.give<Observation>("observation", Observation{cloud});
    }
    stage.fire();
    const auto all = read_all(stage.folder() / "scene.rawlog");
    ASSERT_EQ(all.size(), 3U);
    EXPECT_EQ(all[2]->sensorLabel, "L2");
}

TEST(RawlogSinkStage, WritesTheLayoutThatWasRead) {
    const auto imu = [](const std::string& label) {
        auto observation = CObservationIMU::Create();
        observation->sensorLabel = label;
        return observation;
    };
    const auto action = CActionCollection::Create();
    Observation first{imu("a")}, last{imu("b")}, alone{imu("c")};
    first.place.before = {action};
    first.place.in_frame = last.place.in_frame = last.place.ends_frame = true;
    alone.place.before = {action, CSensoryFrame::Create()};
    alone.place.after = {action};
    StageHarness stage = StageHarness::of<RawlogSink>();
    for (const Observation& each : {first, last, alone}) stage.give("observation", each);
    stage.fire();
    CSensoryFrame both;
    both.insert(first.observation);
    both.insert(last.observation);
    using testing::object_bytes;
    EXPECT_THAT(object_bytes(testing::read_rawlog(stage.folder() / "scene.rawlog")),
                ElementsAre(object_bytes(*action), object_bytes(both), object_bytes(*action),
                            object_bytes(CSensoryFrame()), object_bytes(*alone.observation),
                            object_bytes(*action)));
    EXPECT_THAT(stage.logs().back(), HasSubstr("3 observations"));
}

// What a filter that knows nothing of places makes of them still comes out whole.
TEST(RawlogSinkStage, AFrameThatIsNotEndedIsWritten) {
    Observation first{CObservationIMU::Create()};
    first.place.in_frame = true;
    StageHarness stage = StageHarness::of<RawlogSink>();
    stage.give("observation", first);
    stage.give("observation", Observation{CObservationIMU::Create()});
    stage.give("observation", first);
    stage.fire();
    const auto all = testing::read_rawlog(stage.folder() / "scene.rawlog");
    ASSERT_EQ(all.size(), 3U);
    EXPECT_TRUE(std::dynamic_pointer_cast<CSensoryFrame>(all[0]));
    EXPECT_TRUE(std::dynamic_pointer_cast<CObservationIMU>(all[1]));
    EXPECT_TRUE(std::dynamic_pointer_cast<CSensoryFrame>(all[2]));
}

TEST(RawlogSinkStage, ObservationsAreOfNoScene) {
    StageHarness stage = StageHarness::of<RawlogSink>();
    stage.set("file", "{scene}.rawlog");
    stage.give("observation", Observation{CObservationIMU::Create()});
    try {
        stage.fire();
        FAIL() << "a file for each observation";
    } catch (const Error& e) {
        EXPECT_THAT(e.what(), HasSubstr("{scene}"));
    }
}

TEST(RawlogSinkStage, TheTruthLiesBeside) {
    Truth truth;
    truth.T_camera_lidar = Eigen::Isometry3d::Identity();
    truth.labels.assign(300, 1);
    StageHarness stage = StageHarness::of<RawlogSink>();
    stage.set("file", "{scene}/scene.rawlog");
    for (const char* name : {"a", "b"})
        stage.give<Cloud>("cloud", example_cloud(), name).give<Truth>("truth", truth, name);
    stage.fire();
    for (const char* name : {"a", "b"}) {
        EXPECT_EQ(read_all(stage.folder() / name / "scene.rawlog").size(), 3U);
        EXPECT_EQ(read_truth(stage.folder() / name, 300).labels, truth.labels);
    }
    stage.set("file", "scene.rawlog");
    try {
        stage.fire();
        FAIL() << "two truths in one file";
    } catch (const Error& e) {
        EXPECT_THAT(e.what(), HasSubstr("{scene}"));
    }
}

TEST(RawlogSinkStage, LabelsMustFitTheCloud) {
    Truth truth;
    truth.labels.assign(7, 0);
    StageHarness stage = StageHarness::of<RawlogSink>();
    stage.give<Cloud>("cloud", example_cloud()).give<Truth>("truth", truth);
    EXPECT_THROW(stage.fire(), Error);
    // Nothing half-written stays.
    EXPECT_FALSE(fs::exists(stage.folder() / "scene.rawlog"));
}

TEST(RawlogSinkStage, WiresMustFitTogether) {
    StageHarness both = StageHarness::of<RawlogSink>();
    auto image = CObservationImage::Create();
    both.give<Cloud>("cloud", example_cloud()).give<Observation>("observation", Observation{image});
    EXPECT_THROW(both.fire(), Error);
    StageHarness outside = StageHarness::of<RawlogSink>();
    outside.set("file", "../scene.rawlog").give<Cloud>("cloud", example_cloud());
    EXPECT_THROW(outside.fire(), Error);
}

TEST(GzipOutputStream, AFullDiskIsTold) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
    GzipOutput stream("/dev/full", 1);
    const std::string bytes(1000, 'x');
    EXPECT_THROW(
        {
            stream.Write(bytes.data(), bytes.size());
            stream.close();  // so few bytes go out only here
        },
        Error);
}

}  // namespace
}  // namespace petal
