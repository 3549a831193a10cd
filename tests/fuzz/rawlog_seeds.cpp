// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// Writes the seeds of fuzz_rawlog into a folder: small rawlogs of every class that petal reads
// points or images from, plain, compressed, and in the layout of actions and sensory frames.

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationStereoImages.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <iostream>
#include <map>
#include <string>
#include <vector>

using namespace mrpt::obs;

namespace {

template <class T>
std::shared_ptr<T> observation(const char* label) {
    auto made = std::make_shared<T>();
    made->sensorLabel = label;
    made->timestamp = mrpt::Clock::fromDouble(1.7e9);
    return made;
}

template <class Map>
CObservation::Ptr cloud() {
    auto made = observation<CObservationPointCloud>("LIDAR");
    made->pointcloud = std::make_shared<Map>();
    for (int i = 0; i < 3; ++i) made->pointcloud->insertPoint(1.0F, 2.0F, static_cast<float>(i));
    return made;
}

CObservation::Ptr image(mrpt::img::TImageChannels channels, const char* external) {
    auto made = observation<CObservationImage>("CAMERA");
    made->image.resize(6, 4, channels);
    made->image.filledRectangle(0, 0, 5, 3, mrpt::img::TColor(90, 120, 200));
    if (external != nullptr) made->image.setExternalStorage(external);
    return made;
}

std::map<std::string, CObservation::Ptr> observations() {
    auto flat = observation<CObservation2DRangeScan>("LASER");
    flat->resizeScan(4);
    for (std::size_t i = 0; i < 4; ++i) {
        flat->setScanRange(i, 2.0F);
        flat->setScanRangeValidity(i, true);
    }
    auto depth = observation<CObservation3DRangeScan>("DEPTH");
    depth->hasRangeImage = true;
    depth->rangeImage_setSize(3, 4);
    depth->rangeImage.fill(1000);
    depth->cameraParams.ncols = 4;
    depth->cameraParams.nrows = 3;
    depth->cameraParams.setIntrinsicParamsFromValues(4, 4, 2, 1.5);
    auto points = observation<CObservation3DRangeScan>("DEPTH_POINTS");
    points->hasPoints3D = true;
    points->resizePoints3DVectors(3);
    auto rotating = observation<CObservationRotatingScan>("ROTATING");
    rotating->fromScan2D(*flat);
    rotating->sensorLabel = "ROTATING";
    auto velodyne = observation<CObservationVelodyneScan>("VELODYNE");
    velodyne->scan_packets.resize(1);
    velodyne->calibration = VelodyneCalibration::LoadDefaultCalibration("VLP16");
    auto comment = observation<CObservationComment>("");
    comment->text = "by petal";
    return {{"xyzi", cloud<mrpt::maps::CPointsMapXYZI>()},
            {"simple", cloud<mrpt::maps::CSimplePointsMap>()},
            {"coloured", cloud<mrpt::maps::CColouredPointsMap>()},
            {"grey", image(mrpt::img::CH_GRAY, nullptr)},
            {"colour", image(mrpt::img::CH_RGB, nullptr)},
            {"external", image(mrpt::img::CH_GRAY, "none.png")},
            {"stereo", observation<CObservationStereoImages>("STEREO")},
            {"laser", flat},
            {"depth", depth},
            {"depth_points", points},
            {"rotating", rotating},
            {"velodyne", velodyne},
            {"imu", observation<CObservationIMU>("IMU")},
            {"odometry", observation<CObservationOdometry>("ODOMETRY")},
            {"gps", observation<CObservationGPS>("GPS")},
            {"comment", comment}};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: rawlog_seeds FOLDER\n";
        return 2;
    }
    const std::string folder = argv[1];
    const auto all = observations();
    for (const auto& [name, each] : all) {
        mrpt::io::CFileOutputStream file(folder + "/" + name);
        auto archive = mrpt::serialization::archiveFrom(file);
        archive << *each;
    }
    mrpt::io::CFileGZOutputStream file;
    file.open(folder + "/frames.gz", 9);
    auto archive = mrpt::serialization::archiveFrom(file);
    CActionRobotMovement2D movement;
    CActionCollection actions;
    actions.insert(movement);
    CSensoryFrame frame;
    for (const char* name : {"laser", "xyzi", "grey"}) frame.insert(all.at(name));
    for (int i = 0; i < 2; ++i) archive << actions << frame;
    return 0;
}
