// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/rawlog/rawlog_read_ahead.hpp"

#include <utility>

namespace petal {

RawlogReadAhead::RawlogReadAhead(std::filesystem::path file, std::size_t ahead)
    : reader_(std::move(file)), ahead_(ahead) {
    if (ahead_ > 0) thread_ = std::thread([this] { read(); });
}

RawlogReadAhead::~RawlogReadAhead() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void RawlogReadAhead::read() {
    bool more = true;
    while (more) {
        mrpt::obs::CObservation::Ptr observation;
        std::exception_ptr failure;
        try {
            observation = reader_.next();
        } catch (...) {
            failure = std::current_exception();
        }
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return stop_ || waiting_.size() < ahead_; });
        more = observation && !stop_;
        failure_ = failure;
        ended_ = !more;
        if (observation) waiting_.push_back(std::move(observation));
        lock.unlock();
        changed_.notify_all();
    }
}

mrpt::obs::CObservation::Ptr RawlogReadAhead::next() {
    if (ahead_ == 0) return reader_.next();
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return ended_ || !waiting_.empty(); });
    if (waiting_.empty()) {
        if (failure_) std::rethrow_exception(failure_);
        return nullptr;
    }
    mrpt::obs::CObservation::Ptr observation = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    changed_.notify_all();
    return observation;
}

}  // namespace petal
