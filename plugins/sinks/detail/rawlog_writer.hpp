// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/io/CStream.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <zlib.h>

#include <filesystem>
#include <string>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/observation.hpp"
#include "petal/output.hpp"

namespace petal {

/// A gzip file that MRPT writes to, and that tells when the disk is full. (MRPT's own does not look
/// at what closing the file says, where the last bytes go out.)
class GzipOutput final : public mrpt::io::CStream {
   public:
    /// \throws Error when the file cannot be made. `level` is 0 (not compressed) to 9 (smallest).
    GzipOutput(const std::filesystem::path& file, int level);
    ~GzipOutput() override;
    GzipOutput(const GzipOutput&) = delete;
    GzipOutput& operator=(const GzipOutput&) = delete;

    /// Writes what is left. \throws Error when that fails.
    void close();

    size_t Write(const void* buffer, size_t count) override;

    // Not for this stream; they throw.
    size_t Read(void* buffer, size_t count) override;
    uint64_t Seek(int64_t offset, TSeekOrigin origin) override;
    uint64_t getTotalBytesCount() const override;
    uint64_t getPosition() const override;
    std::string getStreamDescription() const override;

   private:
    std::filesystem::path file_;
    gzFile handle_ = nullptr;
};

/// Writes a rawlog of observations: it appears whole, at commit(), or not at all.
class RawlogWriter {
   public:
    RawlogWriter(const std::filesystem::path& file, int level);

    /// One observation as it is, with what stood around it; what it keeps in other files is put
    /// in. The observations of a sensory frame are written together, with its last one.
    /// \throws Error where that cannot be done, or writing fails.
    void write(const Observation& observation);
    /// A scene: each message of the cloud as a CObservationPointCloud with a CPointsMapXYZI, each
    /// image as a CObservationImage, by their stamps. Either may be null. `stamp` (s) is for a
    /// cloud without messages.
    void write_scene(const Cloud* cloud, const Images* images, double stamp);
    /// An object that is no observation, and no sensory frame with one: an action.
    void write_other(const mrpt::serialization::CSerializable& object);
    void commit();

    std::size_t observations() const { return observations_; }
    const std::filesystem::path& file() const { return pending_.final_path(); }

   private:
    void serialize(const mrpt::serialization::CSerializable& object, const std::string& whose);
    void serialize(const mrpt::obs::CObservation& observation);
    void end_frame();
    void write_image(const CameraImage& camera);

    PendingFile pending_;
    GzipOutput stream_;
    mrpt::obs::CSensoryFrame frame_;  ///< in work
    std::size_t observations_ = 0;
};

}  // namespace petal
