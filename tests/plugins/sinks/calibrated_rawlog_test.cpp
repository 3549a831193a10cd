// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/calibrated_rawlog.hpp"

#include <gmock/gmock.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <fstream>

#include "petal/calibration/extrinsics.hpp"
#include "petal/testing/stage_harness.hpp"
#include "rawlog_objects.hpp"

namespace petal {
namespace {

using mrpt::obs::CObservation;
using mrpt::poses::CPose3D;
using ::testing::HasSubstr;
using testing::RawlogObjects;
using testing::StageHarness;
namespace fs = std::filesystem;

const CPose3D kLidarOnVehicle(1.0, -0.5, 1.5, 0.3, -0.2, 0.1);

CObservation::Ptr recorded_cloud(double stamp) {
    auto cloud = mrpt::obs::CObservationPointCloud::Create();
    cloud->sensorLabel = "LIDAR";
    cloud->sensorPose = kLidarOnVehicle;
    cloud->timestamp = mrpt::Clock::fromDouble(stamp);
    auto points = mrpt::maps::CPointsMapXYZI::Create();
    points->insertPoint(1.0F, 2.0F, 3.0F);
    cloud->pointcloud = points;
    return cloud;
}

CObservation::Ptr recorded_photo(const std::string& label) {
    auto photo = mrpt::obs::CObservationImage::Create();
    photo->sensorLabel = label;
    photo->cameraPose = CPose3D(9.0, 9.0, 9.0, 0.0, 0.0, 0.0);
    photo->image = mrpt::img::CImage(8, 6, mrpt::img::CH_GRAY);
    photo->cameraParams.fx(100.0);
    photo->cameraParams.fy(110.0);
    return photo;
}

CObservation::Ptr recorded_imu() {
    auto imu = mrpt::obs::CObservationIMU::Create();
    imu->sensorLabel = "IMU";
    imu->sensorPose = CPose3D(0.1, 0.2, 0.3, 0.0, 0.0, 0.0);
    return imu;
}

CameraExtrinsics calibrated_pair(const std::string& camera) {
    CameraExtrinsics pair;
    pair.camera = camera;
    pair.lidar = "LIDAR";
    pair.T_camera_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    pair.T_camera_lidar.translation() << 0.04, -0.11, -0.03;
    return pair;
}

Eigen::Matrix4d matrix_of(const CPose3D& pose) {
    return pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen();
}

Eigen::Matrix4d matrix_of(const CObservation& observation) {
    CPose3D pose;
    observation.getSensorPose(pose);
    return matrix_of(pose);
}

class CalibratedRawlogTest : public ::testing::Test {
   protected:
    CalibratedRawlogTest() {
        extrinsics_.cameras = {calibrated_pair("CAMERA")};
        extrinsics_.level = Level::usable;
    }

    /// The copy of that rawlog.
    RawlogObjects copied(const RawlogObjects& objects, int compression = 1) {
        const fs::path from = stage_.folder() / "log.rawlog";
        testing::write_rawlog(from, objects, compression);
        stage_.set("files", std::vector<std::string>{from.string()});
        stage_.give<Extrinsics>("extrinsics", extrinsics_).fire();
        return testing::read_rawlog(stage_.folder() / "log_calibrated.rawlog");
    }

    StageHarness stage_ = StageHarness::of<CalibratedRawlog>();
    Extrinsics extrinsics_;
};

TEST_F(CalibratedRawlogTest, TheCameraGetsItsPoseByTheLidars) {
    // The camera's comes first, before any pose of the LiDAR is known.
    const RawlogObjects from{recorded_photo("CAMERA"), recorded_cloud(1.0), recorded_imu()};
    const auto before = testing::object_bytes(from);
    const RawlogObjects to = copied(from);
    ASSERT_EQ(to.size(), 3u);
    const auto observations = testing::observations_of(to);
    // p_vehicle = pose(LiDAR) T_lidar_camera p_camera; MRPT keeps a pose as a quaternion.
    const Eigen::Matrix4d expected =
        matrix_of(kLidarOnVehicle) * extrinsics_.cameras[0].T_camera_lidar.inverse().matrix();
    EXPECT_LT((matrix_of(*observations[0]) - expected).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_EQ(testing::object_bytes(*to[1]), before[1]);
    EXPECT_EQ(testing::object_bytes(*to[2]), before[2]);
    EXPECT_EQ(stage_.verdict(), Level::usable);
}

TEST_F(CalibratedRawlogTest, TheCameraMayBeTheReference) {
    extrinsics_.cameras.push_back(calibrated_pair("RIGHT"));
    stage_.set("reference", "RIGHT");
    const auto observations = testing::observations_of(
        copied({recorded_cloud(1.0), recorded_photo("RIGHT"), recorded_photo("CAMERA")}));
    const Eigen::Matrix4d right = matrix_of(CPose3D(9.0, 9.0, 9.0, 0.0, 0.0, 0.0));
    const Eigen::Matrix4d lidar = right * extrinsics_.cameras[1].T_camera_lidar.matrix();
    EXPECT_LT((matrix_of(*observations[0]) - lidar).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((matrix_of(*observations[1]) - right).cwiseAbs().maxCoeff(), 1e-12);
    // Both cameras have the same pose in the LiDAR's frame here, so on the vehicle too.
    EXPECT_LT((matrix_of(*observations[2]) - right).cwiseAbs().maxCoeff(), 1e-9);
}

TEST_F(CalibratedRawlogTest, ActionsAndSensoryFramesStay) {
    auto frame = mrpt::obs::CSensoryFrame::Create();
    frame->insert(recorded_cloud(1.0));
    frame->insert(recorded_photo("CAMERA"));
    const auto action = mrpt::obs::CActionCollection::Create();
    const auto empty = mrpt::obs::CSensoryFrame::Create();
    const RawlogObjects to = copied({action, frame, action, empty, action}, 0);
    ASSERT_EQ(to.size(), 5u);
    const auto whole = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(to[1]);
    ASSERT_TRUE(whole);
    ASSERT_EQ(whole->size(), 2u);
    EXPECT_LT(
        (matrix_of(*testing::observations_of(to)[1]) -
         matrix_of(kLidarOnVehicle) * extrinsics_.cameras[0].T_camera_lidar.inverse().matrix())
            .cwiseAbs()
            .maxCoeff(),
        1e-9);
    for (const std::size_t i : {0u, 2u, 4u})
        EXPECT_TRUE(std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(to[i]));
    EXPECT_TRUE(std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(to[3])->size() == 0);
}

TEST_F(CalibratedRawlogTest, CompressedAsTheInputWas) {
    // Zeros, which gzip makes small and a stored file keeps.
    auto big = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(recorded_photo("CAMERA"));
    big->image = mrpt::img::CImage(300, 200, mrpt::img::CH_GRAY);
    big->image.filledRectangle(0, 0, 299, 199, mrpt::img::TColor(0, 0, 0));
    const fs::path plain = stage_.folder() / "log.rawlog";
    {
        mrpt::io::CFileOutputStream stream(plain.string());
        auto archive = mrpt::serialization::archiveFrom(stream);
        archive << *recorded_cloud(1.0) << *big;
    }
    stage_.set("files", std::vector<std::string>{plain.string()});
    stage_.give<Extrinsics>("extrinsics", extrinsics_).fire();
    EXPECT_GT(fs::file_size(stage_.folder() / "log_calibrated.rawlog"), 60000u);
    stage_.set("file", "again.rawlog").set("compression", 9).fire();
    EXPECT_LT(fs::file_size(stage_.folder() / "again.rawlog"), 6000u);
}

TEST_F(CalibratedRawlogTest, AnEstimatedFocalLengthGoesAlong) {
    extrinsics_.cameras[0].diagnosis.emplace();
    extrinsics_.cameras[0].diagnosis->focal = Diagnosis::FocalScale{1.02, 1e-4, true};
    const auto observations =
        testing::observations_of(copied({recorded_cloud(1.0), recorded_photo("CAMERA")}));
    const auto photo = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(observations[1]);
    EXPECT_DOUBLE_EQ(photo->cameraParams.fx(), 102.0);
    EXPECT_DOUBLE_EQ(photo->cameraParams.fy(), 1.02 * 110.0);
}

TEST_F(CalibratedRawlogTest, ASensorThatIsNotThereIsTold) {
    copied({recorded_cloud(1.0)});
    ASSERT_EQ(stage_.notes().size(), 1u);
    EXPECT_THAT(stage_.notes()[0].looked_for, HasSubstr("'CAMERA'"));
}

TEST_F(CalibratedRawlogTest, WithoutAReferenceThereIsNoPose) {
    try {
        copied({recorded_photo("CAMERA"), recorded_imu()});
        FAIL();
    } catch (const Error& error) {
        EXPECT_THAT(error.what(),
                    HasSubstr("reference sensor 'LIDAR'; there are: 'CAMERA', 'IMU'"));
    }
    EXPECT_FALSE(fs::exists(stage_.folder() / "log_calibrated.rawlog"));
}

TEST_F(CalibratedRawlogTest, AReferenceThatMovesIsRefused) {
    const auto moved = recorded_cloud(2.0);
    moved->setSensorPose(CPose3D(0, 0, 0, 0, 0, 0));
    try {
        copied({recorded_cloud(1.0), moved});
        FAIL();
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("'LIDAR' changes within"));
    }
    EXPECT_FALSE(fs::exists(stage_.folder() / "log_calibrated.rawlog"));
}

TEST_F(CalibratedRawlogTest, AReferenceOutsideTheResultIsRefused) {
    stage_.set("reference", "RADAR");
    try {
        copied({recorded_cloud(1.0)});
        FAIL();
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("the result has 'CAMERA' and 'LIDAR'"));
    }
}

}  // namespace
}  // namespace petal
