// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace petal::testing {

using RawlogObjects = std::vector<mrpt::serialization::CSerializable::Ptr>;

inline void write_rawlog(const std::filesystem::path& file, const RawlogObjects& objects,
                         int compression = 1) {
    mrpt::io::CFileGZOutputStream stream;
    stream.open(file.string(), compression);
    auto archive = mrpt::serialization::archiveFrom(stream);
    for (const auto& object : objects) archive << *object;
}

/// The objects of a rawlog as MRPT itself reads them.
inline RawlogObjects read_rawlog(const std::filesystem::path& file) {
    RawlogObjects all;
    mrpt::io::CFileGZInputStream stream(file.string());
    auto archive = mrpt::serialization::archiveFrom(stream);
    try {
        while (true) all.push_back(archive.ReadObject());
    } catch (const mrpt::serialization::CExceptionEOF&) {
    }
    return all;
}

/// An object as MRPT writes it.
inline std::string object_bytes(const mrpt::serialization::CSerializable& object) {
    std::vector<std::uint8_t> bytes;
    mrpt::serialization::ObjectToOctetVector(&object, bytes);
    return {bytes.begin(), bytes.end()};
}

inline std::vector<std::string> object_bytes(const RawlogObjects& objects) {
    std::vector<std::string> all;
    for (const auto& object : objects) all.push_back(object_bytes(*object));
    return all;
}

/// The observations among them, those of sensory frames one by one.
inline std::vector<mrpt::obs::CObservation::Ptr> observations_of(const RawlogObjects& objects) {
    std::vector<mrpt::obs::CObservation::Ptr> all;
    for (const auto& object : objects) {
        if (auto one = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object))
            all.push_back(one);
        if (auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))
            all.insert(all.end(), frame->begin(), frame->end());
    }
    return all;
}

}  // namespace petal::testing
