// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationStereoImages.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <exception>

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

// MRPT's const methods below fill mutable caches without a lock. Once filled they only read.
void warm(const mrpt::maps::CPointsMap& points) {
    points.boundingBox();
    points.getLargestDistanceFromOrigin();
}

void warm(const mrpt::poses::CPose3D& pose) {
    pose.yaw();
}

void warm(const mrpt::img::CImage& image, const std::string& label) {
    if (!image.isExternallyStored()) return;
    try {
        image.forceLoad();
    } catch (const std::exception& e) {
        throw Error("image of camera '" + label + "' cannot be loaded from '" +
                    image.getExternalStorageFile() + "': " + e.what());
    }
}

// Not by setSensorPose(): there are classes that hold several poses, and set all of them to one, or
// a quaternion, which would be rounded.
void warm(const mrpt::obs::CObservation& observation) {
    using namespace mrpt::obs;
    const std::string& label = observation.sensorLabel;
    if (const auto* cloud = dynamic_cast<const CObservationPointCloud*>(&observation)) {
        warm(cloud->sensorPose);
        if (cloud->pointcloud) warm(*cloud->pointcloud);
    } else if (const auto* image = dynamic_cast<const CObservationImage*>(&observation)) {
        warm(image->cameraPose);
        warm(image->image, label);
    } else if (const auto* stereo = dynamic_cast<const CObservationStereoImages*>(&observation)) {
        for (const auto* each : {&stereo->imageLeft, &stereo->imageRight, &stereo->imageDisparity})
            warm(*each, label);
    } else if (const auto* range = dynamic_cast<const CObservation3DRangeScan*>(&observation)) {
        warm(range->sensorPose);
        warm(range->relativePoseIntensityWRTDepth);
        warm(range->intensityImage, label);
        warm(range->confidenceImage, label);
    } else if (const auto* scan = dynamic_cast<const CObservation2DRangeScan*>(&observation)) {
        warm(scan->sensorPose);
    } else if (const auto* spin = dynamic_cast<const CObservationVelodyneScan*>(&observation)) {
        warm(spin->sensorPose);
    } else if (const auto* rows = dynamic_cast<const CObservationRotatingScan*>(&observation)) {
        warm(rows->sensorPose);
    } else if (const auto* gps = dynamic_cast<const CObservationGPS*>(&observation)) {
        warm(gps->sensorPose);
    } else if (const auto* imu = dynamic_cast<const CObservationIMU*>(&observation)) {
        warm(imu->sensorPose);
    }
}

std::size_t heap(const std::string& text) {
    return text.capacity();
}

template <class T>
std::size_t heap(const std::vector<T>& values) {
    return values.capacity() * sizeof(T);
}

std::size_t heap(const std::vector<std::string>& texts) {
    std::size_t sum = texts.capacity() * sizeof(std::string);
    for (const std::string& text : texts) sum += heap(text);
    return sum;
}

std::size_t heap(const Eigen::MatrixXd& matrix) {
    return static_cast<std::size_t>(matrix.size()) * sizeof(double);
}

std::size_t heap(const std::map<std::string, double>& values) {
    std::size_t sum = 0;
    for (const auto& [name, value] : values) sum += sizeof(name) + sizeof(value) + heap(name);
    return sum;
}

std::size_t heap(const mrpt::maps::CPointsMap& points) {
    return sizeof(points) + points.size() * 4 * sizeof(float);  // x y z intensity
}

std::size_t heap(const mrpt::img::CImage& image) {
    return image.isEmpty() ? 0 : image.getHeight() * image.getRowStride();
}

/// Of the classes that hold much.
std::size_t heap(const mrpt::obs::CObservation& observation) {
    using namespace mrpt::obs;
    std::size_t sum = sizeof(observation) + heap(observation.sensorLabel);
    if (const auto* cloud = dynamic_cast<const CObservationPointCloud*>(&observation))
        return sum + (cloud->pointcloud ? heap(*cloud->pointcloud) : 0);
    if (const auto* image = dynamic_cast<const CObservationImage*>(&observation))
        return sum + heap(image->image);
    if (const auto* stereo = dynamic_cast<const CObservationStereoImages*>(&observation))
        return sum + heap(stereo->imageLeft) + heap(stereo->imageRight) +
               heap(stereo->imageDisparity);
    if (const auto* range = dynamic_cast<const CObservation3DRangeScan*>(&observation))
        return sum + heap(range->intensityImage) + heap(range->confidenceImage) +
               static_cast<std::size_t>(range->rangeImage.size()) * sizeof(std::uint16_t) +
               heap(range->points3D_x) + heap(range->points3D_y) + heap(range->points3D_z);
    if (const auto* spin = dynamic_cast<const CObservationVelodyneScan*>(&observation))
        return sum + heap(spin->scan_packets) + spin->point_cloud.size() * 4 * sizeof(float);
    if (const auto* scan = dynamic_cast<const CObservation2DRangeScan*>(&observation))
        return sum + scan->getScanSize() * (sizeof(float) + sizeof(char));
    return sum;
}

}  // namespace

void PacketTraits<Cloud>::seal(Cloud& cloud) {
    if (!cloud.points)
        throw Error("the cloud of '" + cloud.sensor_label +
                    "' has no points map; an empty cloud has a map without points");
    warm(*cloud.points);
    warm(cloud.sensor_pose);
}

std::size_t PacketTraits<Cloud>::bytes(const Cloud& cloud) {
    return sizeof(cloud) + heap(*cloud.points) + heap(cloud.sensor_label) + heap(cloud.parts) +
           heap(cloud.scene_index);
}

void PacketTraits<Images>::seal(Images& images) {
    for (const auto* list : {&images.cameras, &images.others})
        for (const CameraImage& camera : *list) {
            warm(camera.image, camera.label);
            warm(camera.sensor_pose);
        }
}

std::size_t PacketTraits<Images>::bytes(const Images& images) {
    std::size_t sum = sizeof(images) + heap(images.cameras) + heap(images.others);
    for (const auto* list : {&images.cameras, &images.others})
        for (const CameraImage& camera : *list) sum += heap(camera.label) + heap(camera.image);
    return sum;
}

void PacketTraits<Planes>::seal(Planes& planes) {
    for (Plane& plane : planes.planes) PacketTraits<Cloud>::seal(plane.inliers);
}

std::size_t PacketTraits<Planes>::bytes(const Planes& planes) {
    std::size_t sum = sizeof(planes) + heap(planes.planes);
    for (const Plane& plane : planes.planes)
        sum += PacketTraits<Cloud>::bytes(plane.inliers) - sizeof(Cloud);
    return sum;
}

// The rest holds no MRPT type that caches: Eigen, strings, numbers, TCamera.
void PacketTraits<LidarBoards>::seal(LidarBoards&) {}

std::size_t PacketTraits<LidarBoards>::bytes(const LidarBoards& boards) {
    std::size_t sum =
        sizeof(boards) + heap(boards.lidar) + heap(boards.boards) + heap(boards.findings);
    for (const LidarBoard& board : boards.boards)
        sum += heap(board.target) + heap(board.corners) + heap(board.quality);
    return sum;
}

void PacketTraits<ImageBoards>::seal(ImageBoards&) {}

std::size_t PacketTraits<ImageBoards>::bytes(const ImageBoards& boards) {
    std::size_t sum =
        sizeof(boards) + heap(boards.cameras) + heap(boards.boards) + heap(boards.findings);
    for (const CameraInfo& camera : boards.cameras) sum += heap(camera.label);
    for (const ImageBoard& board : boards.boards)
        sum += heap(board.target) + heap(board.camera) + heap(board.corners) +
               heap(board.covariance) + heap(board.joint_covariance) + heap(board.quality);
    return sum;
}

void PacketTraits<Correspondences>::seal(Correspondences&) {}

std::size_t PacketTraits<Correspondences>::bytes(const Correspondences& correspondences) {
    std::size_t sum = sizeof(correspondences) + heap(correspondences.cameras);
    for (const CameraPairs& camera : correspondences.cameras) {
        sum += heap(camera.scene_name) + heap(camera.camera) + heap(camera.lidar) +
               heap(camera.pairs) + heap(camera.initial) + heap(camera.boards) +
               heap(camera.order.reason);
        for (const CameraPairs::BoardPair& board : camera.boards)
            sum += heap(board.corners_board) + heap(board.corners_image) +
                   heap(board.image_covariance);
    }
    return sum;
}

const char* to_string(DecidedBy by) {
    switch (by) {
        case DecidedBy::given:
            return "given";
        case DecidedBy::data:
            return "data";
        case DecidedBy::prior:
            return "prior";
        case DecidedBy::undecided:
            return "undecided";
    }
    return "undecided";
}

void PacketTraits<Extrinsics>::seal(Extrinsics&) {}

std::size_t PacketTraits<Extrinsics>::bytes(const Extrinsics& extrinsics) {
    std::size_t sum = sizeof(extrinsics) + heap(extrinsics.cameras) + heap(extrinsics.reasons);
    for (const CameraExtrinsics& camera : extrinsics.cameras) {
        sum += heap(camera.camera) + heap(camera.lidar) + heap(camera.weakest_direction) +
               heap(camera.residuals) + heap(camera.order.reason);
        if (!camera.diagnosis) continue;
        sum += heap(camera.diagnosis->scenes) + heap(camera.diagnosis->drifts);
        for (const Diagnosis::Scene& scene : camera.diagnosis->scenes) sum += heap(scene.name);
        if (camera.diagnosis->advice) sum += heap(camera.diagnosis->advice->sentence);
    }
    return sum;
}

void PacketTraits<Metrics>::seal(Metrics&) {}

std::size_t PacketTraits<Metrics>::bytes(const Metrics& metrics) {
    std::size_t sum = sizeof(metrics) + heap(metrics.values) + heap(metrics.findings);
    for (const Metric& metric : metrics.values)
        sum += heap(metric.name) + heap(metric.unit) + heap(metric.scene);
    for (const Finding& finding : metrics.findings) sum += heap(finding.reason);
    return sum;
}

void PacketTraits<Truth>::seal(Truth&) {}

std::size_t PacketTraits<Truth>::bytes(const Truth& truth) {
    std::size_t sum = sizeof(truth) + heap(truth.boards) + heap(truth.labels);
    for (const Truth::Board& board : truth.boards)
        sum += heap(board.target) + heap(board.corners_lidar) + heap(board.corners_image);
    return sum;
}

void PacketTraits<Observation>::seal(Observation& observation) {
    if (!observation.observation) throw Error("an Observation packet without an observation");
    mrpt::obs::CObservation& it = *observation.observation;
    try {
        it.load();
    } catch (const std::exception& e) {
        throw Error("observation '" + it.sensorLabel + "' (" + it.GetRuntimeClass()->className +
                    ") has data in another file that cannot be loaded: " + e.what());
    }
    warm(it);
}

std::size_t PacketTraits<Observation>::bytes(const Observation& observation) {
    return sizeof(observation) + heap(*observation.observation);
}

}  // namespace petal
