// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <string>
#include <vector>

namespace petal::testing {

using Objects = std::vector<mrpt::serialization::CSerializable::Ptr>;

inline mrpt::Clock::time_point at(double seconds) {
    return mrpt::Clock::fromDouble(1.7e9 + seconds);
}

inline mrpt::obs::CObservationPointCloud::Ptr cloud(const std::string& label, double stamp,
                                                    std::size_t points = 1) {
    auto observation = mrpt::obs::CObservationPointCloud::Create();
    observation->sensorLabel = label;
    observation->timestamp = at(stamp);
    auto map = mrpt::maps::CPointsMapXYZI::Create();
    for (std::size_t i = 0; i < points; ++i) {
        map->insertPoint(2.0F, 0.0F, 0.5F * static_cast<float>(i));
        map->setPointIntensity(i, 0.25F);
    }
    observation->pointcloud = map;
    return observation;
}

inline mrpt::obs::CObservationImage::Ptr image(const std::string& label, double stamp) {
    auto observation = mrpt::obs::CObservationImage::Create();
    observation->sensorLabel = label;
    observation->timestamp = at(stamp);
    observation->image.resize(60, 40, mrpt::img::CH_GRAY);
    for (unsigned row = 0; row < 40; ++row)
        for (unsigned column = 0; column < 60; ++column)
            *observation->image.ptr<std::uint8_t>(column, row) =
                static_cast<std::uint8_t>((row * 37 + column * 11) % 256);
    observation->cameraParams.ncols = 60;
    observation->cameraParams.nrows = 40;
    observation->cameraParams.setIntrinsicParamsFromValues(50, 50, 30, 20);
    return observation;
}

/// As they lie in a plain rawlog.
inline std::string bytes_of_objects(const Objects& objects) {
    mrpt::io::CMemoryStream stream;
    auto archive = mrpt::serialization::archiveFrom(stream);
    for (const auto& object : objects) archive << *object;
    return {static_cast<const char*>(stream.getRawBufferData()),
            static_cast<std::size_t>(stream.getTotalBytesCount())};
}

/// One gzip member.
inline std::string gzipped(const std::string& bytes) {
    z_stream stream = {};
    EXPECT_EQ(deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
    std::string out(deflateBound(&stream, bytes.size()) + 64, '\0');
    std::string in = bytes;
    stream.next_in = reinterpret_cast<unsigned char*>(in.data());
    stream.avail_in = static_cast<unsigned>(in.size());
    stream.next_out = reinterpret_cast<unsigned char*>(out.data());
    stream.avail_out = static_cast<unsigned>(out.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

}  // namespace petal::testing
