// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/rawlog/claim_check.hpp"

#include <gmock/gmock.h>
#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/maps/CWeightedPointsMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationStereoImages.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <cstring>

#include "petal/rawlog/rawlog_reader.hpp"
#include "plugins/sources/temporary_folder.hpp"
#include "rawlog_bytes.hpp"

namespace petal::testing {
namespace {

using namespace mrpt::obs;
using ::testing::HasSubstr;

struct Case {
    std::string name;
    mrpt::serialization::CSerializable::Ptr object;
    std::string count;  ///< the bytes of a count in it
};

std::string number(std::uint32_t value) {
    std::string bytes(4, '\0');
    std::memcpy(bytes.data(), &value, 4);
    return bytes;
}

template <class Map>
mrpt::serialization::CSerializable::Ptr with_map() {
    auto observation = cloud("LIDAR", 0.0);
    auto map = Map::Create();
    for (int i = 0; i < 201; ++i) map->insertPoint(1.0F, 2.0F, 3.0F);
    observation->pointcloud = map;
    return observation;
}

/// Counts of 201 or more: of points, ranges and pixels, and a label of 203 characters.
std::vector<Case> cases() {
    const std::string label(203, 'L');
    const std::string points = number(201);
    std::vector<Case> all = {
        {"xyzi", with_map<mrpt::maps::CPointsMapXYZI>(), points},
        {"simple", with_map<mrpt::maps::CSimplePointsMap>(), points},
        {"coloured", with_map<mrpt::maps::CColouredPointsMap>(), points},
        {"weighted", with_map<mrpt::maps::CWeightedPointsMap>(), points},
        {"cloud's label", cloud(label, 0.0), number(203)},
        {"image's label", image(label, 0.0), number(203)},
        {"image's pixels", image("CAMERA", 0.0), number(60 * 40)},
    };
    auto colour = image("CAMERA", 0.0);
    colour->image.resize(202, 201, mrpt::img::CH_RGB);
    all.push_back({"colour image", colour, number(static_cast<std::uint32_t>(-201))});
    auto outside = image("CAMERA", 0.0);
    outside->image.setExternalStorage(std::string(203, 'f'));
    all.push_back({"external image", outside, number(203)});
    auto laser = CObservation2DRangeScan::Create();
    laser->resizeScan(201);
    laser->sensorLabel = label;
    all.push_back({"laser's ranges", laser, points});
    all.push_back({"laser's label", laser, number(203)});
    auto depth = CObservation3DRangeScan::Create();
    depth->hasPoints3D = true;
    depth->resizePoints3DVectors(201);
    depth->sensorLabel = label;
    all.push_back({"depth's points", depth, points});
    all.push_back({"depth's label", depth, number(203)});
    auto ranges = CObservation3DRangeScan::Create();
    ranges->hasRangeImage = true;
    ranges->rangeImage_setSize(201, 202);
    ranges->cameraParams.nrows = 201;
    ranges->cameraParams.ncols = 202;
    all.push_back({"depth's rows", ranges, points + number(202)});
    auto layers = CObservation3DRangeScan::Create();
    layers->rangeImageOtherLayers["A"].resize(0, 0);
    layers->rangeImageOtherLayers["B"].resize(2, 3);
    layers->rangeImageOtherLayers["C"].resize(201, 201);
    layers->rangeImageOtherLayers[label].resize(1, 1);
    all.push_back({"layer's rows", layers, points + points});
    all.push_back({"layer's name", layers, number(203)});
    auto classes = CObservation3DRangeScan::Create();
    classes->pixelLabels = std::make_shared<TPixelLabelInfo<1>>();
    classes->pixelLabels->setSize(201, 201);
    all.push_back({"rows of labels of pixels", classes, points + points});
    auto velodyne = CObservationVelodyneScan::Create();
    velodyne->scan_packets.resize(201);
    velodyne->sensorLabel = label;
    all.push_back({"Velodyne's packets", velodyne, points});
    all.push_back({"Velodyne's label", velodyne, number(203)});
    auto stereo = CObservationStereoImages::Create();
    stereo->sensorLabel = label;
    all.push_back({"stereo's label", stereo, number(203)});
    auto odometry = CObservationOdometry::Create();
    odometry->sensorLabel = label;
    all.push_back({"odometry's label", odometry, number(203)});
    auto imu = CObservationIMU::Create();
    imu->sensorLabel = label;
    all.push_back({"IMU's label", imu, number(203)});
    auto comment = CObservationComment::Create();
    comment->text = label;
    all.push_back({"comment", comment, number(203)});
    return all;
}

class ClaimsOfFiles : public TemporaryFolder {
   protected:
    std::string reading(const std::string& bytes) const {
        return refusal([&] {
            RawlogReader reader(write("a.rawlog", bytes));
            while (reader.next()) continue;
        });
    }
};

// A sound object is read, and the same with its count made huge is told, not tried: 0xBF..... times
// 12 bytes are 38 GB. In a sensory frame too.
TEST_F(ClaimsOfFiles, HugeCountsAreToldAndSoundOnesRead) {
    for (const Case& each : cases())
        for (const bool framed : {false, true}) {
            auto object = each.object;
            if (framed) {
                auto frame = CSensoryFrame::Create();
                frame->insert(std::dynamic_pointer_cast<CObservation>(each.object));
                object = frame;
            }
            const std::string bytes = bytes_of_objects({object});
            EXPECT_EQ(reading(bytes), "accepted") << each.name;
            EXPECT_EQ(reading(gzipped(bytes)), "accepted") << each.name;
            const std::size_t found = bytes.find(each.count);
            ASSERT_NE(found, std::string::npos) << each.name;
            std::string changed = bytes;
            // A width and a height are negative already where the pixels follow as they are.
            changed[found + 3] = each.name == "colour image" ? '\x81' : '\x3F';
            for (const std::string& file : {changed, gzipped(changed)})
                EXPECT_THAT(reading(file),
                            AllOf(HasSubstr("it claims"), HasSubstr("0 objects"),
                                  HasSubstr(framed ? "CSensoryFrame" : "CObservation")))
                    << each.name;
        }
}

TEST_F(ClaimsOfFiles, AFrameOfBillionsOfObservationsIsTold) {
    for (const mrpt::serialization::CSerializable::Ptr& object :
         {mrpt::serialization::CSerializable::Ptr(CSensoryFrame::Create()),
          mrpt::serialization::CSerializable::Ptr(CActionCollection::Create())}) {
        std::string bytes = bytes_of_objects({object});
        bytes[bytes.size() - 2] = '\x7F';  // the last byte of the count; the end flag follows
        EXPECT_THAT(reading(bytes), HasSubstr("it claims"));
    }
}

// MRPT ends the process on it: it takes what it reads for a distribution.
TEST_F(ClaimsOfFiles, AMovementWhoseMethodChanged) {
    CActionRobotMovement2D movement;
    auto actions = CActionCollection::Create();
    actions->insert(movement);
    std::string bytes = bytes_of_objects({actions});
    EXPECT_EQ(reading(bytes), "accepted");
    const std::string name = "mrpt::obs::CActionRobotMovement2D";
    const std::size_t method = bytes.find(name) + name.size() + 1;
    ASSERT_EQ(bytes.substr(method, 4), number(0)) << "odometry";
    bytes[method] = '\x01';
    EXPECT_THAT(reading(bytes), AllOf(HasSubstr("method 1"), HasSubstr("CPose2D")));
}

// MRPT makes the particles of a movement while it reads it; they are not in the file.
TEST_F(ClaimsOfFiles, AMovementOfAMillionParticlesIsTold) {
    CActionRobotMovement2D movement;
    movement.motionModelConfiguration.modelSelection = CActionRobotMovement2D::mmThrun;
    movement.motionModelConfiguration.thrunModel.nParticlesCount = 201;
    auto actions = CActionCollection::Create();
    actions->insert(movement);
    std::string bytes = bytes_of_objects({actions});
    EXPECT_EQ(reading(bytes), "accepted");
    bytes[bytes.find(number(201)) + 3] = '\x3F';
    EXPECT_THAT(reading(bytes), HasSubstr("which no single object has"));
}

// A map, by the name that it had once; it is told before its parts are made.
TEST_F(ClaimsOfFiles, AMapOfBillionsOfFramesIsNoPartOfARawlog) {
    const std::string name = "CSensFrameProbSequence";
    const std::string header = static_cast<char>(0x80U + name.size()) + name + '\0';
    EXPECT_THAT(reading(header + number(0x30020000)),
                AllOf(HasSubstr("CSimpleMap"), HasSubstr("neither observation, action nor")));
}

/// Reads as MRPT makes them, of objects that it writes no more.
class Claims : public ::testing::Test {
   protected:
    void begin(const std::string& observation) {
        check_.begin_object();
        header("mrpt::obs::" + observation);
    }
    std::string read(const std::string& bytes) {
        return check_.after_read(bytes.data(), bytes.size(), 1000);
    }
    void header(const std::string& name, char version = 0) {
        expect_sound({std::string(1, static_cast<char>(0x80U + name.size())), name,
                      std::string(1, version)});
    }
    void expect_sound(const std::vector<std::string>& reads) {
        for (const std::string& bytes : reads) EXPECT_EQ(read(bytes), "");
    }

    ClaimCheck check_;
    const std::string byte_ = std::string(1, '\0');
    const std::string huge_ = std::string(4, '\x7F');
};

class RotatingScanClaims : public Claims {
   protected:
    void SetUp() override {
        begin("CObservationRotatingScan");
        header("mrpt::poses::CPose3D");
        expect_sound(std::vector<std::string>(7, std::string(8, '\0')));
        expect_sound({byte_, std::string(8, '\0'), byte_});
    }

    const std::string none_ = std::string(2, '\0');
    const std::string most_ = std::string(2, '\xFF');
};

TEST_F(RotatingScanClaims, RangesOf65535RowsAndColumns) {
    expect_sound({most_});
    EXPECT_THAT(read(most_), HasSubstr("it claims"));
}

TEST_F(RotatingScanClaims, IntensitiesOf65535RowsAndColumnsWithoutRanges) {
    expect_sound({none_, most_, most_});
    EXPECT_THAT(read(most_), HasSubstr("it claims"));
}

TEST_F(RotatingScanClaims, TheNameOfAnotherLayer) {
    expect_sound({none_, none_, none_, none_, std::string(2, '\1')});
    EXPECT_THAT(read(huge_), HasSubstr("it claims"));
}

TEST_F(Claims, RowsOfNoColumns) {
    begin("CObservation3DRangeScan");
    header("mrpt::poses::CPose3D");
    expect_sound(std::vector<std::string>(7, std::string(8, '\0')));
    expect_sound({byte_, byte_, byte_, number(0), huge_});
    EXPECT_THAT(read(number(0)), HasSubstr("it claims"));
}

TEST_F(Claims, AFrameBeforeVersion2HasALabelAndATimeFirst) {
    for (const char version : {'\0', '\1'}) {
        check_.begin_object();
        header("mrpt::obs::CSensoryFrame", version);
        if (version == 0) expect_sound({huge_});
        expect_sound({std::string(8, '\1')});
        EXPECT_THAT(read(huge_), HasSubstr("it claims"));
    }
}

// MRPT 2.5 reads two of its numbers as doubles.
TEST_F(Claims, ParticlesOfAMovementOfVersion3) {
    check_.begin_object();
    header("mrpt::obs::CActionRobotMovement2D", 3);
    expect_sound({number(0)});
    header("mrpt::poses::CPose2D");
    const std::string eight(8, '\x3F');
    expect_sound({eight, eight, eight, byte_, number(1), huge_, huge_, huge_, eight, eight});
    EXPECT_THAT(read(huge_), HasSubstr("it claims"));
}

TEST_F(Claims, ReadingsOfGasSensors) {
    begin("CObservationGasSensors");
    EXPECT_THAT(read(huge_), HasSubstr("it claims"));
}

TEST_F(Claims, DistributionsOfBillionsOfParts) {
    for (const char* name :
         {"CPosePDFParticles", "CPosePDFSOG", "CPose3DPDFParticles", "CPose3DPDFSOG"}) {
        begin("CActionRobotMovement2D");
        header(std::string("mrpt::poses::") + name);
        EXPECT_THAT(read(huge_), HasSubstr("it claims")) << name;
    }
}

// Points, options, and the three colours; no colours of one kind is no bar to a claim of the next.
TEST_F(Claims, TheColoursOfAPointsMapBeforeVersion8) {
    const std::string three = number(3);
    const std::string floats(12, '\x3F');
    for (const std::uint32_t reds : {0U, 3U}) {
        begin("CObservationPointCloud");
        header("mrpt::maps::CColouredPointsMap", 7);
        expect_sound({three, floats, floats, floats, huge_});
        expect_sound(std::vector<std::string>(5, byte_));
        expect_sound({huge_, byte_, huge_, number(reds)});
        if (reds > 0) expect_sound({floats});
        EXPECT_THAT(read(huge_), HasSubstr("it claims")) << reds;
    }
}

// MRPT takes the name of a class up to a NUL in it.
TEST_F(ClaimsOfFiles, ACountAfterAClassNameWithANulIsTold) {
    const std::string name = "mrpt::maps::CPointsMapXYZI";
    std::string bytes = bytes_of_objects({with_map<mrpt::maps::CPointsMapXYZI>()});
    const std::size_t begin = bytes.find(name);
    ASSERT_NE(begin, std::string::npos);
    bytes[begin - 1] = static_cast<char>(bytes[begin - 1] + 3);
    bytes.insert(begin + name.size(), 3, '\0');
    EXPECT_EQ(reading(bytes), "accepted");
    bytes[bytes.find(number(201)) + 3] = '\x3F';
    EXPECT_THAT(reading(bytes), HasSubstr("it claims"));
}

// Length and version of four bytes, no end flag: MRPT still reads it, also inside what is newer.
TEST_F(ClaimsOfFiles, ACountAfterAHeaderFromBefore2008IsTold) {
    const std::string name = "mrpt::maps::CPointsMapXYZI";
    const auto map = mrpt::maps::CPointsMapXYZI::Create();
    map->resize(201);
    std::string bytes = bytes_of_objects({with_map<mrpt::maps::CPointsMapXYZI>()});
    const std::size_t begin = bytes.find(name);
    ASSERT_NE(begin, std::string::npos);
    const std::size_t version = begin + name.size();
    const std::size_t end = begin - 1 + bytes_of_objects({map}).size() - 1;
    ASSERT_EQ(bytes[end], '\x88');
    bytes.erase(end, 1);
    bytes.insert(version + 1, 3, '\0');
    bytes.replace(begin - 1, 1, number(static_cast<std::uint32_t>(name.size())));
    EXPECT_EQ(reading(bytes), "accepted");
    bytes[bytes.find(number(201)) + 3] = '\x3F';
    EXPECT_THAT(reading(bytes), HasSubstr("it claims"));
}

// The end flag of an object, and a time that reads like a name.
TEST_F(RotatingScanClaims, ATimeThatLooksLikeAHeader) {
    begin("CObservationRotatingScan");
    header("mrpt::poses::CPose3D");
    expect_sound(std::vector<std::string>(7, std::string(8, '\0')));
    expect_sound({"\x88", "::CO____", byte_, most_});
    EXPECT_THAT(read(most_), HasSubstr("it claims"));
}

TEST_F(Claims, WhatIsNotKnownIsNotRefused) {
    check_.begin_object();
    header("CObservationOfTomorrow");
    expect_sound({huge_, huge_, huge_});
}

}  // namespace
}  // namespace petal::testing
