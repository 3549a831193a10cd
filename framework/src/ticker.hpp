// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace petal {

/// Calls a function again and again on a thread of its own, first after one period, until it is
/// destroyed. The function must not throw.
class Ticker {
   public:
    Ticker(std::chrono::milliseconds period, std::function<void()> tick);
    Ticker(const Ticker&) = delete;
    Ticker& operator=(const Ticker&) = delete;
    /// Waits for the call in work.
    ~Ticker();

   private:
    std::mutex mutex_;
    std::condition_variable ended_changed_;
    bool ended_ = false;
    std::thread thread_;
};

}  // namespace petal
