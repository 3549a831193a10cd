// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/truth.hpp"
#include "petal/testing/stage_harness.hpp"
#include "plugins/sources/temporary_folder.hpp"
#include "real_data.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
using testing::StageHarness;

class FilesStage : public testing::TemporaryFolder {
   protected:
    void SetUp() override {
        TemporaryFolder::SetUp();
        cv::Mat pixels(6, 8, CV_8UC3);
        for (int row = 0; row < 6; ++row)
            for (int column = 0; column < 8; ++column)
                pixels.at<cv::Vec3b>(row, column) = cv::Vec3b(
                    static_cast<unsigned char>(row), static_cast<unsigned char>(column), 200);
        cv::imwrite((folder_ / "image.png").string(), pixels);
        write("k.txt", "intrinsic 10 0 4 0 10 3 0 0 1 distortion 0 0 0 0");
        write("cloud.csv", "1,2,3,0.5\n4,5,6,0.25\n");
    }
    StageHarness stage(const std::string& image, const std::string& intrinsics,
                       const std::string& cloud) const {
        const auto path = [&](const std::string& name) {
            return name.empty() ? name : (folder_ / name).string();
        };
        StageHarness harness = StageHarness::of<FilesSource>();
        harness.set("image", path(image).c_str())
            .set("intrinsics", path(intrinsics).c_str())
            .set("cloud", path(cloud).c_str());
        return harness;
    }
};

TEST_F(FilesStage, MakesOneScene) {
    StageHarness harness = stage("image.png", "k.txt", "cloud.csv");
    harness.fire();
    const Cloud& cloud = harness.out<Cloud>("cloud");
    EXPECT_EQ(cloud.size(), 2U);
    EXPECT_EQ(cloud.points->getPointIntensity(1), 0.25F);
    EXPECT_EQ(cloud.sensor_label, "LIDAR");
    ASSERT_EQ(cloud.parts.size(), 1U);
    const Images& images = harness.out<Images>("images");
    ASSERT_EQ(images.cameras.size(), 1U);
    EXPECT_EQ(images.cameras[0].label, "CAMERA");
    EXPECT_EQ(images.cameras[0].camera.ncols, 8U);
    EXPECT_EQ(images.cameras[0].camera.nrows, 6U);
    EXPECT_EQ(images.cameras[0].image.at<std::uint8_t>(7, 5, 1), 7);
    EXPECT_TRUE(harness.out<Truth>("truth").empty());
    EXPECT_EQ(harness.written("cloud").at(0).frame->name, folder_.filename().string());
    EXPECT_EQ(harness.used_files().size(), 3U);
}

TEST_F(FilesStage, EitherPartMayBeAbsentNotBoth) {
    StageHarness points = stage("", "", "cloud.csv");
    points.fire();
    EXPECT_TRUE(points.out<Images>("images").cameras.empty());
    StageHarness picture = stage("image.png", "k.txt", "");
    picture.fire();
    EXPECT_EQ(picture.out<Cloud>("cloud").size(), 0U);
    EXPECT_TRUE(picture.notes().empty());
    StageHarness nothing = stage("", "", "");
    EXPECT_THAT(refusal([&] { nothing.fire(); }), HasSubstr("both empty"));
    StageHarness alone = stage("image.png", "", "");
    EXPECT_THAT(refusal([&] { alone.fire(); }), HasSubstr("belong together"));
}

TEST_F(FilesStage, AnEmptyCloudIsValidAndNoted) {
    write("empty.csv", "x,y,z\n");
    StageHarness harness = stage("", "", "empty.csv");
    harness.fire();
    EXPECT_EQ(harness.out<Cloud>("cloud").size(), 0U);
    EXPECT_EQ(harness.notes().size(), 1U);
}

TEST_F(FilesStage, AnotherImageSizeEndsTheRun) {
    write("other.yaml",
          "K: [10, 0, 4, 0, 10, 3, 0, 0, 1]\nD: [0, 0, 0, 0]\n"
          "width: 640\nheight: 480\n");
    StageHarness harness = stage("image.png", "other.yaml", "");
    EXPECT_THAT(refusal([&] { harness.fire(); }),
                AllOf(HasSubstr("8 x 6"), HasSubstr("640 x 480")));
}

TEST_F(FilesStage, BadFilesAreTold) {
    write("broken.jpg", "not an image");
    StageHarness broken = stage("broken.jpg", "k.txt", "");
    EXPECT_THAT(refusal([&] { broken.fire(); }), HasSubstr("cannot be decoded"));
    StageHarness missing = stage("none.jpg", "k.txt", "");
    EXPECT_THAT(refusal([&] { missing.fire(); }), HasSubstr("does not exist"));
    StageHarness folder = stage(".", "k.txt", "");
    EXPECT_THAT(refusal([&] { folder.fire(); }), HasSubstr("is a folder"));
}

TEST_F(FilesStage, TakesTheTruthBesideTheFiles) {
    write("truth.json", R"({"T_camera_lidar": [[1,0,0,0.5],[0,1,0,0],[0,0,1,0],[0,0,0,1]]})");
    write("labels.u8", std::string("\x00\x01", 2));
    StageHarness harness = stage("image.png", "k.txt", "cloud.csv");
    harness.fire();
    const Truth& truth = harness.out<Truth>("truth");
    ASSERT_TRUE(truth.T_camera_lidar);
    EXPECT_EQ(truth.T_camera_lidar->translation().x(), 0.5);
    EXPECT_EQ(truth.labels, (std::vector<std::uint8_t>{0, 1}));
}

TEST(RealFiles, TheIndoorScene) {
    PETAL_NEEDS_REAL_DATA();
    const auto folder = testing::real_data() / "sjtu_indoor";
    StageHarness harness = StageHarness::of<FilesSource>();
    harness.set("image", (folder / "image.jpg").c_str())
        .set("intrinsics", (folder / "intrinsics.yaml").c_str())
        .set("cloud", (folder / "lidar_margin_points.csv").c_str());
    harness.fire();
    EXPECT_EQ(harness.out<Cloud>("cloud").size(), 1103U);
    const Images& images = harness.out<Images>("images");
    EXPECT_EQ(images.cameras.at(0).image.getWidth(), 640U);
    EXPECT_EQ(images.cameras.at(0).image.getHeight(), 540U);
    EXPECT_EQ(harness.written("images").at(0).frame->name, "sjtu_indoor");
}

}  // namespace
}  // namespace petal
