// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/rawlog.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/truth.hpp"
#include "petal/testing/stage_harness.hpp"
#include "plugins/sources/temporary_folder.hpp"
#include "real_data.hpp"

namespace petal {
namespace {

using namespace mrpt::obs;
using ::testing::HasSubstr;
using testing::StageHarness;

mrpt::Clock::time_point at(double seconds) {
    return mrpt::Clock::fromDouble(1.7e9 + seconds);
}

CObservationPointCloud::Ptr cloud(const std::string& label, double stamp, float x) {
    auto observation = CObservationPointCloud::Create();
    observation->sensorLabel = label;
    observation->timestamp = at(stamp);
    auto points = mrpt::maps::CPointsMapXYZI::Create();
    points->insertPoint(x, 0.0F, 0.0F);
    points->setPointIntensity(0, 0.5F);
    observation->pointcloud = points;
    observation->sensorPose = mrpt::poses::CPose3D(1.0, 2.0, 3.0, 0.1, 0.2, 0.3);
    return observation;
}

/// A checkerboard, the more blurred the larger `blur` is.
CObservationImage::Ptr image(const std::string& label, double stamp, int blur) {
    cv::Mat pixels(40, 60, CV_8UC1);
    for (int row = 0; row < pixels.rows; ++row)
        for (int column = 0; column < pixels.cols; ++column)
            pixels.at<unsigned char>(row, column) = (row / 5 + column / 5) % 2 == 0 ? 20 : 230;
    if (blur > 0) cv::GaussianBlur(pixels, pixels, {}, blur);
    auto observation = CObservationImage::Create();
    observation->sensorLabel = label;
    observation->timestamp = at(stamp);
    observation->image = mrpt::img::CImage(pixels, mrpt::img::DEEP_COPY);
    observation->cameraParams.ncols = 60;
    observation->cameraParams.nrows = 40;
    observation->cameraParams.setIntrinsicParamsFromValues(50, 50, 30, 20);
    return observation;
}

class RawlogStage : public testing::TemporaryFolder {
   protected:
    std::filesystem::path rawlog(
        const std::string& name,
        const std::vector<mrpt::serialization::CSerializable::Ptr>& objects,
        int compression = 1) const {
        std::filesystem::create_directories((folder_ / name).parent_path());
        mrpt::io::CFileGZOutputStream stream;
        stream.open((folder_ / name).string(), compression);
        auto archive = mrpt::serialization::archiveFrom(stream);
        for (const auto& object : objects) archive << *object;
        return folder_ / name;
    }
    static StageHarness stage(const std::vector<std::filesystem::path>& files) {
        std::vector<std::string> names;
        for (const auto& file : files) names.push_back(file.string());
        StageHarness harness = StageHarness::of<RawlogSource>();
        harness.set("files", Value(names));
        return harness;
    }
    static std::string refused(const std::vector<std::filesystem::path>& files) {
        return refusal([&] { stage(files).fire(); });
    }
};

TEST_F(RawlogStage, AccumulatesTheMessagesOfTheOnlyLidar) {
    StageHarness harness = stage(
        {rawlog("a.rawlog", {cloud("L", 0.0, 1.0F), image("C", 0.1, 0), cloud("L", 0.2, 2.0F)})});
    harness.fire();
    const Cloud& points = harness.out<Cloud>("cloud");
    EXPECT_EQ(points.sensor_label, "L");
    ASSERT_EQ(points.size(), 2U);
    ASSERT_EQ(points.parts.size(), 2U);
    EXPECT_EQ(points.parts[1].begin, 1U);
    EXPECT_EQ(points.parts[1].stamp, at(0.2));
    EXPECT_EQ(points.points->getPointIntensity(1), 0.5F);
    // In the sensor's own frame: its pose is recorded, not applied.
    EXPECT_EQ(points.points->getPointsBufferRef_x()[1], 2.0F);
    EXPECT_NEAR(points.sensor_pose.z(), 3.0, 1e-12);
    const Images& images = harness.out<Images>("images");
    ASSERT_EQ(images.cameras.size(), 1U);
    EXPECT_EQ(images.cameras[0].stamp, at(0.1));
    EXPECT_EQ(harness.written("cloud").at(0).frame->name, "a");
    // Stamps have ticks of 100 ns; a double of 1.7e9 s resolves 240 ns.
    EXPECT_NEAR(harness.written("cloud").at(0).frame->stamp, 1.7e9, 1e-6);
    EXPECT_TRUE(harness.out<Truth>("truth").empty());
}

TEST_F(RawlogStage, ReadsSensoryFramesAndPlainFiles) {
    auto frame = CSensoryFrame::Create();
    frame->insert(cloud("L", 0.0, 1.0F));
    frame->insert(image("C", 0.0, 0));
    for (const int compression : {0, 9}) {
        StageHarness harness = stage({rawlog(
            "a.rawlog", {CActionCollection::Create(), frame, CActionCollection::Create(), frame},
            compression)});
        harness.fire();
        EXPECT_EQ(harness.out<Cloud>("cloud").size(), 2U);
        EXPECT_EQ(harness.out<Images>("images").cameras.size(), 1U);
    }
}

TEST_F(RawlogStage, TakesTheSharpestImageUnlessToldOtherwise) {
    const auto file =
        rawlog("a.rawlog", {image("C", 0.0, 3), image("C", 1.0, 0), image("C", 2.0, 2)});
    const auto taken = [&](const char* choice) {
        StageHarness harness = stage({file});
        harness.set("image_choice", choice);
        harness.fire();
        return harness.out<Images>("images").cameras.at(0).stamp;
    };
    EXPECT_EQ(taken("sharpest"), at(1.0));
    EXPECT_EQ(taken("first"), at(0.0));
    EXPECT_EQ(taken("last"), at(2.0));
}

TEST_F(RawlogStage, KeepsTheFirstAMiddleAndTheLastImageBesideTheChosenOne) {
    std::vector<mrpt::serialization::CSerializable::Ptr> objects = {cloud("L", 0.0, 1.0F)};
    for (int i = 0; i <= 20; ++i) objects.push_back(image("C", 0.1 * i, 0));
    StageHarness harness = stage({rawlog("a.rawlog", objects)});
    harness.set("image_choice", "first");
    harness.fire();
    const Images& images = harness.out<Images>("images");
    ASSERT_EQ(images.cameras.size(), 1U);
    EXPECT_EQ(images.cameras[0].stamp, at(0.0));
    ASSERT_EQ(images.others.size(), 2U) << "the first is the chosen one";
    // Every fourth is left of 21: that nearest to the middle is at 0.8 or 1.2 s.
    EXPECT_NEAR(mrpt::Clock::toDouble(images.others[0].stamp), mrpt::Clock::toDouble(at(1.0)),
                0.21);
    EXPECT_EQ(images.others[1].stamp, at(2.0));
}

TEST_F(RawlogStage, SensorsAreChosenByLabelOrPattern) {
    const auto file =
        rawlog("a.rawlog", {cloud("LIDAR_left", 0.0, 1.0F), cloud("LIDAR_right", 0.0, 2.0F),
                            image("CAM1", 0.0, 0), image("CAM2", 0.0, 0)});
    EXPECT_THAT(refused({file}), AllOf(HasSubstr("several LiDARs"), HasSubstr("LIDAR_left"),
                                       HasSubstr("CAM2"), HasSubstr("CObservationPointCloud")));
    StageHarness harness = stage({file});
    harness.set("lidar", "*_right").set("cameras", Value(std::vector<std::string>{"CAM2"}));
    harness.fire();
    EXPECT_EQ(harness.out<Cloud>("cloud").sensor_label, "LIDAR_right");
    EXPECT_EQ(harness.out<Images>("images").cameras.at(0).label, "CAM2");
    harness.set("lidar", "LIDAR_up");
    EXPECT_THAT(refusal([&] { harness.fire(); }),
                AllOf(HasSubstr("LIDAR_up"), HasSubstr("LIDAR_left")));
    harness.set("lidar", "LIDAR*");
    EXPECT_THAT(refusal([&] { harness.fire(); }), HasSubstr("fits several"));
    harness.set("lidar", "*_left").set("cameras", Value(std::vector<std::string>{"CAM3"}));
    EXPECT_THAT(refusal([&] { harness.fire(); }), HasSubstr("CAM3"));
}

TEST_F(RawlogStage, WithoutALidarTheCloudIsEmptyAndNoted) {
    StageHarness harness = stage({rawlog("a.rawlog", {image("C", 0.0, 0)})});
    harness.fire();
    EXPECT_EQ(harness.out<Cloud>("cloud").size(), 0U);
    ASSERT_EQ(harness.notes().size(), 1U);
    EXPECT_THAT(harness.notes()[0].nearest_miss, HasSubstr("'C'"));
    EXPECT_THAT(refused({rawlog("b.rawlog", {CActionCollection::Create()})}),
                HasSubstr("neither a LiDAR nor a camera"));
}

TEST_F(RawlogStage, FilesAreScenesAndGapsSplitThem) {
    const auto one = rawlog("one/scene.rawlog", {cloud("L", 0.0, 1.0F)});
    const auto two = rawlog("two/scene.rawlog",
                            {cloud("L", 0.0, 1.0F), cloud("L", 9.0, 2.0F), cloud("L", 9.5, 3.0F)});
    StageHarness files = stage({one, two});
    files.fire();
    ASSERT_EQ(files.all<Cloud>("cloud").size(), 2U);
    EXPECT_EQ(files.all<Cloud>("cloud")[0].frame.name, "one");
    EXPECT_EQ(files.all<Cloud>("cloud")[1].value->size(), 3U);
    StageHarness split = stage({two});
    split.set("split", "gap").set("gap", 5.0);
    split.fire();
    const auto scenes = split.all<Cloud>("cloud");
    ASSERT_EQ(scenes.size(), 2U);
    EXPECT_EQ(scenes[0].value->size(), 1U);
    EXPECT_EQ(scenes[1].value->size(), 2U);
    EXPECT_EQ(scenes[0].frame.name, "two_1");
    EXPECT_EQ(scenes[1].frame.name, "two_2");
}

TEST_F(RawlogStage, OtherPointsClasses) {
    auto scan = CObservation2DRangeScan::Create();
    scan->sensorLabel = "LASER";
    scan->aperture = static_cast<float>(M_PI);
    scan->resizeScan(3);
    for (std::size_t i = 0; i < 3; ++i) {
        scan->setScanRange(i, 2.0F);
        scan->setScanRangeValidity(i, i != 1);
    }
    StageHarness flat = stage({rawlog("flat.rawlog", {scan})});
    flat.fire();
    const Cloud& points = flat.out<Cloud>("cloud");
    ASSERT_EQ(points.size(), 2U);
    EXPECT_NEAR(points.points->getPointsBufferRef_y()[0], -2.0, 1e-6);  // float
    EXPECT_NEAR(points.points->getPointsBufferRef_y()[1], 2.0, 1e-6);

    auto simple = cloud("L", 0.0, 1.0F);
    auto map = mrpt::maps::CSimplePointsMap::Create();
    map->insertPoint(4.0F, 5.0F, 6.0F);
    simple->pointcloud = map;
    StageHarness plain = stage({rawlog("simple.rawlog", {simple})});
    plain.fire();
    EXPECT_EQ(plain.out<Cloud>("cloud").points->getPointsBufferRef_z()[0], 6.0F);
}

TEST_F(RawlogStage, ABrokenFileIsToldWithThePlace) {
    const auto whole = rawlog("a.rawlog", {cloud("L", 0.0, 1.0F), image("C", 0.0, 0)});
    const std::string bytes = bytes_of(whole);
    EXPECT_THAT(
        refused({write("cut.rawlog", bytes.substr(0, bytes.size() - 100))}),
        AllOf(HasSubstr("CObservationImage"), HasSubstr("cut off"), HasSubstr("1 objects")));
    // All objects are there; only the trailer with the checksum is not.
    EXPECT_THAT(refused({write("trailer.rawlog", bytes.substr(0, bytes.size() - 4))}),
                HasSubstr("cut off"));
    std::string wrong = bytes;
    wrong[wrong.size() - 6] = static_cast<char>(wrong[wrong.size() - 6] ^ 0x55);
    EXPECT_THAT(refused({write("crc.rawlog", wrong)}), HasSubstr("damaged"));

    const std::string plain =
        bytes_of(rawlog("b.rawlog", {cloud("L", 0.0, 1.0F), image("C", 0.0, 0)}, 0));
    ASSERT_NE(plain.find("CObservationImage"), std::string::npos);
}

TEST_F(RawlogStage, AFileThatIsNoRawlogIsTold) {
    EXPECT_THAT(refused({write("text.rawlog", "hello, this is a text file")}),
                HasSubstr("is it a rawlog?"));
    EXPECT_THAT(refused({write("empty.rawlog", "")}), HasSubstr("there are: none"));
    EXPECT_THAT(refused({folder_ / "none.rawlog"}), HasSubstr("does not exist"));
    EXPECT_THAT(refused({folder_}), HasSubstr("is a folder"));
    // An object of a class that no MRPT 2.5 has: its header, then nothing.
    const std::string name = "mrpt::maps::CPointsMapXYZIRT";
    EXPECT_THAT(refused({write("new.rawlog", static_cast<char>(0x80U + name.size()) + name +
                                                 std::string(20, '\0'))}),
                AllOf(HasSubstr(name), HasSubstr("not known")));
}

TEST_F(RawlogStage, LoadsImagesKeptBesideTheRawlog) {
    auto external = image("C", 0.0, 0);
    ASSERT_TRUE(external->image.saveToFile((folder_ / "picture.png").string()));
    external->image.setExternalStorage("picture.png");
    const auto file = rawlog("a.rawlog", {external});
    StageHarness beside = stage({file});
    beside.fire();
    EXPECT_EQ(beside.out<Images>("images").cameras.at(0).image.getWidth(), 60U);
    EXPECT_EQ(beside.used_files().size(), 2U);
    std::filesystem::create_directories(folder_ / "a_Images");
    std::filesystem::rename(folder_ / "picture.png", folder_ / "a_Images" / "picture.png");
    stage({file}).fire();
    std::filesystem::remove_all(folder_ / "a_Images");
    EXPECT_THAT(refused({file}), AllOf(HasSubstr("picture.png"), HasSubstr("a_Images")));
}

TEST_F(RawlogStage, AnotherImageSizeThanTheIntrinsicsEndsTheRun) {
    auto other = image("C", 0.0, 0);
    other->cameraParams.ncols = 640;
    EXPECT_THAT(refused({rawlog("a.rawlog", {other})}),
                AllOf(HasSubstr("60 x 40"), HasSubstr("640 x 40")));
}

TEST(RealRawlogs, OfTheMrptAuthors) {
    PETAL_NEEDS_REAL_DATA();
    const auto points = [](const char* name) {
        StageHarness harness = StageHarness::of<RawlogSource>();
        const auto file = testing::real_data() / "mrpt_rawlogs" / name;
        harness.set("files", Value(std::vector<std::string>{file.string()}));
        harness.fire();
        return harness.out<Cloud>("cloud").size();
    };
    // Actions and sensory frames; flat rotating scan; Velodyne; RGB-D.
    EXPECT_EQ(points("localization_demo.rawlog"), 13280U);
    EXPECT_EQ(points("rot_scan_2d.rawlog"), 359U);
    EXPECT_EQ(points("test_velodyne_VLP16.rawlog"), 11305U);
    EXPECT_EQ(points("tests_rgbd.rawlog"), 273225U);
    EXPECT_THROW(points("rot_scan_velodyne.rawlog"), Error);  // no elevation angles in MRPT 2.5
    EXPECT_THROW(points("test_rtk_path.rawlog"), Error);      // GPS only
}

}  // namespace
}  // namespace petal
