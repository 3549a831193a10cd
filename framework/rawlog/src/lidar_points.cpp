// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/rawlog/lidar_points.hpp"

#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <cmath>

#include "mrpt_message.hpp"
#include "petal/error.hpp"

namespace petal {
namespace {

using mrpt::maps::CPointsMapXYZI;
using namespace mrpt::obs;

void add(CPointsMapXYZI& points, float x, float y, float z, float intensity) {
    points.insertPointFast(x, y, z);
    points.setPointIntensity(points.size() - 1, intensity);
}

void append(const CObservationPointCloud& cloud, CPointsMapXYZI& points) {
    if (!cloud.pointcloud)
        throw Error("a cloud of sensor '" + cloud.sensorLabel + "' holds no points map");
    const auto& from = *cloud.pointcloud;
    const auto* with_intensity = dynamic_cast<const CPointsMapXYZI*>(&from);
    const auto& xs = from.getPointsBufferRef_x();
    const auto& ys = from.getPointsBufferRef_y();
    const auto& zs = from.getPointsBufferRef_z();
    // Not reserve(): it makes room for exactly so many, and a scene of many messages would be
    // copied at each of them. resize() doubles the room.
    const std::size_t begin = points.size();
    points.resize(begin + from.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
        points.setPointFast(begin + i, xs[i], ys[i], zs[i]);
        points.setPointColor_fast(
            begin + i,
            with_intensity != nullptr ? with_intensity->getPointsBufferRef_intensity()[i] : 0.0F,
            0.0F, 0.0F);
    }
}

void append(CObservation3DRangeScan& scan, CPointsMapXYZI& points) {
    if (scan.hasRangeImage) {
        mrpt::maps::CSimplePointsMap map;
        scan.unprojectInto(map);  // in the sensor's frame, by default
        const auto& xs = map.getPointsBufferRef_x();
        const auto& ys = map.getPointsBufferRef_y();
        const auto& zs = map.getPointsBufferRef_z();
        for (std::size_t i = 0; i < map.size(); ++i) add(points, xs[i], ys[i], zs[i], 0.0F);
    } else if (scan.hasPoints3D) {
        if (scan.points3D_y.size() != scan.points3D_x.size() ||
            scan.points3D_z.size() != scan.points3D_x.size())
            throw Error("sensor '" + scan.sensorLabel +
                        "' has points with unequal numbers of x, y and z; its data are damaged");
        for (std::size_t i = 0; i < scan.points3D_x.size(); ++i)
            add(points, scan.points3D_x[i], scan.points3D_y[i], scan.points3D_z[i], 0.0F);
    }
}

void append(CObservationVelodyneScan& scan, CPointsMapXYZI& points) {
    CObservationVelodyneScan::TGeneratePointCloudParameters all;
    all.minDistance = 0.0F;  // MRPT's default drops the first metre
    scan.generatePointCloud(all);
    const auto& cloud = scan.point_cloud;
    for (std::size_t i = 0; i < cloud.x.size(); ++i)
        add(points, cloud.x[i], cloud.y[i], cloud.z[i],
            static_cast<float>(cloud.intensity[i]) / 255.0F);
}

void append(const CObservation2DRangeScan& scan, CPointsMapXYZI& points) {
    for (std::size_t i = 0; i < scan.getScanSize(); ++i) {
        if (!scan.getScanRangeValidity(i)) continue;
        const float range = scan.getScanRange(i);
        const float angle = scan.getScanAngle(i);
        add(points, range * std::cos(angle), range * std::sin(angle), 0.0F, 0.0F);
    }
}

void append(const CObservationRotatingScan& scan, CPointsMapXYZI& points) {
    // MRPT 2.5 stores no elevation of the rows, so only a flat scan has known directions.
    if (scan.rowCount > 1)
        throw Error("sensor '" + scan.sensorLabel + "' (CObservationRotatingScan) has " +
                    std::to_string(scan.rowCount) +
                    " rows, but MRPT 2.5 keeps no elevation angle of a row; use the scans that it "
                    "was made of, or CObservationPointCloud");
    const std::size_t columns = scan.rowCount == 1 ? scan.columnCount : 0;
    if (scan.rangeImage.rows() < scan.rowCount || scan.rangeImage.cols() < scan.columnCount)
        throw Error("sensor '" + scan.sensorLabel +
                    "' has fewer ranges than its rows and columns; its data are damaged");
    const bool lit = scan.intensityImage.rows() >= scan.rowCount &&
                     scan.intensityImage.cols() >= scan.columnCount;
    const double step = columns > 1 ? scan.azimuthSpan / static_cast<double>(columns - 1) : 0.0;
    for (std::size_t column = 0; column < columns; ++column) {
        const auto raw = scan.rangeImage(0, column);
        if (raw == 0) continue;
        const double angle = scan.startAzimuth + step * static_cast<double>(column);
        const double range = raw * scan.rangeResolution;
        add(points, static_cast<float>(range * std::cos(angle)),
            static_cast<float>(range * std::sin(angle)), 0.0F,
            lit ? static_cast<float>(scan.intensityImage(0, column)) / 255.0F : 0.0F);
    }
}

}  // namespace

bool is_lidar(const CObservation& observation) {
    return dynamic_cast<const CObservationPointCloud*>(&observation) != nullptr ||
           dynamic_cast<const CObservation3DRangeScan*>(&observation) != nullptr ||
           dynamic_cast<const CObservationVelodyneScan*>(&observation) != nullptr ||
           dynamic_cast<const CObservationRotatingScan*>(&observation) != nullptr ||
           dynamic_cast<const CObservation2DRangeScan*>(&observation) != nullptr;
}

bool has_intensity(const CObservation& observation) {
    if (const auto* cloud = dynamic_cast<const CObservationPointCloud*>(&observation))
        return dynamic_cast<const CPointsMapXYZI*>(cloud->pointcloud.get()) != nullptr;
    if (const auto* scan = dynamic_cast<const CObservationRotatingScan*>(&observation))
        return scan->intensityImage.rows() > 0;
    return dynamic_cast<const CObservationVelodyneScan*>(&observation) != nullptr;
}

namespace {

void append_any(CObservation& observation, CPointsMapXYZI& points) {
    if (const auto* cloud = dynamic_cast<const CObservationPointCloud*>(&observation))
        append(*cloud, points);
    else if (auto* range = dynamic_cast<CObservation3DRangeScan*>(&observation))
        append(*range, points);
    else if (auto* velodyne = dynamic_cast<CObservationVelodyneScan*>(&observation))
        append(*velodyne, points);
    else if (const auto* flat = dynamic_cast<const CObservation2DRangeScan*>(&observation))
        append(*flat, points);
    else if (const auto* rotating = dynamic_cast<const CObservationRotatingScan*>(&observation))
        append(*rotating, points);
    else
        throw Error("sensor '" + observation.sensorLabel + "' (" +
                    observation.GetRuntimeClass()->className + ") gives no points");
}

}  // namespace

void append_lidar_points(CObservation& observation, CPointsMapXYZI& points) {
    try {
        append_any(observation, points);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {
        // MRPT: sizes of images and intrinsics that do not agree, and the like.
        throw Error("sensor '" + observation.sensorLabel + "' (" +
                    observation.GetRuntimeClass()->className +
                    "): MRPT makes no points of its data (" + mrpt_message(e.what()) + ")");
    }
    points.mark_as_modified();
}

}  // namespace petal
