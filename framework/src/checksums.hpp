// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace petal {

/// The checksum of a file, or why there is none.
struct Checksum {
    std::string blake2b;  ///< 512 bits in hexadecimal, as the program `b2sum` prints it
    std::string missing;  ///< empty: there is one
};

/// \throws Error naming the file; Cancelled when `cancel` (may be null) is set meanwhile.
std::string blake2b_of(const std::filesystem::path& file,
                       const std::atomic<bool>* cancel = nullptr);

/// The same of a text.
std::string blake2b_of_text(std::string_view text);

/// Checksums of a run's data, on a thread of their own: data may be large, and the run need not
/// wait for what does not concern it.
class Checksums {
   public:
    /// `cancel` may be null. With `while_running` false the work begins in finish(): for a run that
    /// may use one thread only.
    Checksums(const std::atomic<bool>* cancel, bool while_running);
    ~Checksums();
    Checksums(const Checksums&) = delete;
    Checksums& operator=(const Checksums&) = delete;

    /// From any thread. A file counts once.
    void add(const std::filesystem::path& file);
    /// Waits for the rest, or until it is cancelled. Call it once, when nobody adds any more.
    std::map<std::filesystem::path, Checksum> finish();

   private:
    void work();

    const std::atomic<bool>* cancel_;
    std::mutex mutex_;
    std::condition_variable more_;
    std::deque<std::filesystem::path> waiting_;
    std::map<std::filesystem::path, Checksum> sums_;  ///< empty ones: not computed yet
    bool no_more_ = false;
    std::atomic<bool> abandoned_{false};
    std::thread thread_;
};

}  // namespace petal
