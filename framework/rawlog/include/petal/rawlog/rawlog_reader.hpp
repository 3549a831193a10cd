// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/CImage.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/serialization/CSerializable.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include "petal/rawlog/gzip_input.hpp"

namespace petal {

/// Reads the observations of one rawlog as a stream: either layout (observations only; actions and
/// sensory frames), compressed or not. Holds one object at a time.
class RawlogReader {
   public:
    /// \throws Error when there is no such file or it cannot be opened.
    explicit RawlogReader(std::filesystem::path file);

    /// The next observation, those of a sensory frame one by one; null after the last. Actions
    /// are passed over.
    /// \throws Error, saying how much was read whole and where it broke: cut off, damaged, a
    /// class that this MRPT does not know, no rawlog.
    mrpt::obs::CObservation::Ptr next();

    /// The next object as it stands in the file: an observation, a whole sensory frame, or an
    /// action; null after the last. In place of next(), not between its calls.
    /// \throws Error as next().
    mrpt::serialization::CSerializable::Ptr next_object();

    /// Loads what an observation keeps in files of their own: looked for in the rawlog's image
    /// folder (`<stem>_Images`, `<stem>_images`, `Images`), then beside the rawlog. The
    /// observation then holds it.
    /// \throws Error naming the file and where it was looked for.
    void load(mrpt::obs::CObservation& observation);

    const std::filesystem::path& file() const { return file_; }
    std::size_t objects() const { return objects_; }  ///< read whole so far
    /// What it reads from: compressed or not, bytes read.
    const GzipInput& stream() const { return stream_; }
    /// The external files that load() has read.
    const std::vector<std::filesystem::path>& external_files() const { return external_files_; }

   private:
    mrpt::serialization::CSerializable::Ptr read_object();
    void load_image(mrpt::img::CImage& image, const std::string& label);
    [[noreturn]] void fail(const std::string& what) const;
    [[noreturn]] void fail_foreign(const std::string& name) const;
    std::filesystem::path find_external(const std::string& name, const std::string& label) const;

    std::filesystem::path file_;
    GzipInput stream_;
    std::size_t objects_ = 0;
    std::deque<mrpt::obs::CObservation::Ptr> pending_;  ///< of the sensory frame in work
    std::vector<std::filesystem::path> external_files_;
};

}  // namespace petal
