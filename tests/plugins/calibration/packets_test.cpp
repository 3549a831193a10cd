// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationBeaconRanges.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationStereoImages.h>
#include <mrpt/serialization/CSerializable.h>

#include <set>
#include <string>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/observation.hpp"
#include "petal/calibration/planes.hpp"
#include "petal/calibration/truth.hpp"
#include "petal/error.hpp"

namespace petal {
namespace {

/// A map that shows whether its lazily computed box is there.
class Peeking : public mrpt::maps::CPointsMapXYZI {
   public:
    bool warm() const { return m_boundingBoxIsUpdated && m_largestDistanceFromOriginIsUpdated; }
};

TEST(Packets, NamesAreUnique) {
    const std::set<std::string> names = {
        PacketTraits<Cloud>::name,       PacketTraits<Images>::name,
        PacketTraits<Planes>::name,      PacketTraits<LidarBoards>::name,
        PacketTraits<ImageBoards>::name, PacketTraits<Correspondences>::name,
        PacketTraits<Extrinsics>::name,  PacketTraits<Metrics>::name,
        PacketTraits<Truth>::name,       PacketTraits<Observation>::name};
    EXPECT_EQ(names.size(), 10U);
}

TEST(Packets, SealingACloudWarmsItsBox) {
    auto points = std::make_shared<Peeking>();
    points->insertPoint(1.0F, 2.0F, 3.0F);
    EXPECT_FALSE(points->warm());
    Cloud cloud;
    cloud.points = points;
    const AnyPacket packet = make_packet(std::move(cloud), {});
    EXPECT_TRUE(points->warm());
    EXPECT_STREQ(packet.type, "Cloud");
}

TEST(Packets, SealingPlanesWarmsTheirInliers) {
    auto points = std::make_shared<Peeking>();
    points->insertPoint(1.0F, 2.0F, 3.0F);
    Planes planes;
    planes.planes.emplace_back();
    planes.planes[0].inliers.points = points;
    PacketTraits<Planes>::seal(planes);
    EXPECT_TRUE(points->warm());
}

TEST(Packets, ACloudWithoutAMapIsRefused) {
    Cloud cloud;
    cloud.points = nullptr;
    EXPECT_THROW(PacketTraits<Cloud>::seal(cloud), Error);
}

TEST(Packets, BytesGrowWithWhatIsHeld) {
    Cloud small;
    auto points = std::make_shared<mrpt::maps::CPointsMapXYZI>();
    for (int i = 0; i < 1000; ++i) points->insertPoint(static_cast<float>(i), 0.0F, 0.0F);
    Cloud large;
    large.points = points;
    // Three coordinates and the intensity of each point, at the least.
    EXPECT_GE(PacketTraits<Cloud>::bytes(large), PacketTraits<Cloud>::bytes(small) + 1000 * 16);

    Images images;
    images.cameras.emplace_back();
    const std::size_t without = PacketTraits<Images>::bytes(images);
    images.cameras[0].image = mrpt::img::CImage(64, 48, mrpt::img::CH_RGB);
    EXPECT_GE(PacketTraits<Images>::bytes(images), without + 64 * 48 * 3);

    Truth truth;
    truth.labels.assign(5000, 0);
    EXPECT_GE(PacketTraits<Truth>::bytes(truth), 5000U);
}

TEST(Packets, AnImageInAMissingFileIsTold) {
    Images images;
    images.cameras.emplace_back();
    images.cameras[0].label = "CAM";
    images.cameras[0].image.setExternalStorage("/nonexistent/picture.png");
    try {
        PacketTraits<Images>::seal(images);
        FAIL() << "sealed";
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("CAM"), std::string::npos);
    }
}

TEST(Packets, AnObservationKeepsItsPoseAndIsNeverNull) {
    auto cloud = mrpt::obs::CObservationPointCloud::Create();
    auto points = std::make_shared<Peeking>();
    points->insertPoint(1.0F, 2.0F, 3.0F);
    cloud->pointcloud = points;
    cloud->sensorPose = mrpt::poses::CPose3D(1.0, 2.0, 3.0, 0.1, 0.2, 0.3);
    const auto before = cloud->sensorPose;
    Observation observation{cloud};
    PacketTraits<Observation>::seal(observation);
    EXPECT_TRUE(points->warm());
    EXPECT_EQ(cloud->sensorPose, before);
    EXPECT_GT(PacketTraits<Observation>::bytes(observation), 16U);
    Observation none;
    EXPECT_THROW(PacketTraits<Observation>::seal(none), Error);
}

// Setting the sensor's pose to what it is would round a quaternion, and give all beacons one place.
TEST(Packets, SealingAnObservationChangesNoByteOfIt) {
    auto stereo = mrpt::obs::CObservationStereoImages::Create();
    stereo->cameraPose =
        mrpt::poses::CPose3DQuat(mrpt::poses::CPose3D(0.1, 0.2, 0.3, 0.4, 0.5, 0.6));
    auto beacons = mrpt::obs::CObservationBeaconRanges::Create();
    for (int i = 0; i < 2; ++i) {
        mrpt::obs::CObservationBeaconRanges::TMeasurement measurement;
        measurement.sensorLocationOnRobot = mrpt::poses::CPoint3D(i, 0.0, 0.0);
        beacons->sensedData.push_back(measurement);
    }
    for (const mrpt::obs::CObservation::Ptr& each :
         {mrpt::obs::CObservation::Ptr(stereo), mrpt::obs::CObservation::Ptr(beacons)}) {
        std::vector<std::uint8_t> before, after;
        mrpt::serialization::ObjectToOctetVector(each.get(), before);
        Observation observation{each};
        PacketTraits<Observation>::seal(observation);
        mrpt::serialization::ObjectToOctetVector(each.get(), after);
        EXPECT_EQ(before, after) << each->GetRuntimeClass()->className;
    }
}

TEST(Packets, DecisionsHaveWords) {
    EXPECT_STREQ(to_string(DecidedBy::given), "given");
    EXPECT_STREQ(to_string(DecidedBy::data), "data");
    EXPECT_STREQ(to_string(DecidedBy::prior), "prior");
    EXPECT_STREQ(to_string(DecidedBy::undecided), "undecided");
}

}  // namespace
}  // namespace petal
