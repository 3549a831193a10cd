// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/obs/CObservation.h>

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <filesystem>
#include <mutex>
#include <thread>

#include "petal/rawlog/rawlog_reader.hpp"

namespace petal {

/// A RawlogReader whose next observations are read by a thread of its own while the caller works on
/// the last. The order, and where an error comes, are the reader's.
class RawlogReadAhead {
   public:
    /// \param ahead observations that may wait; with 0 there is no thread.
    /// \throws Error as RawlogReader.
    explicit RawlogReadAhead(std::filesystem::path file, std::size_t ahead);
    ~RawlogReadAhead();
    RawlogReadAhead(const RawlogReadAhead&) = delete;
    RawlogReadAhead& operator=(const RawlogReadAhead&) = delete;

    /// As RawlogReader::next().
    mrpt::obs::CObservation::Ptr next();
    /// As RawlogReader::load(): it touches nothing that reading does.
    void load(mrpt::obs::CObservation& observation) { reader_.load(observation); }
    const std::vector<std::filesystem::path>& external_files() const {
        return reader_.external_files();
    }
    const std::filesystem::path& file() const { return reader_.file(); }

   private:
    void read();

    RawlogReader reader_;
    const std::size_t ahead_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<mrpt::obs::CObservation::Ptr> waiting_;
    std::exception_ptr failure_;  ///< of the reader; comes after what waits
    bool ended_ = false;          ///< the thread reads no more
    bool stop_ = false;           ///< nobody asks for more
    std::thread thread_;
};

}  // namespace petal
