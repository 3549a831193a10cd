// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "child_pool.hpp"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <exception>
#include <iostream>
#include <system_error>
#include <thread>

#include "petal/error.hpp"

namespace petal::compare {

namespace {

constexpr std::chrono::milliseconds kLook{10};

/// What the child is, from fork() to its end.
[[noreturn]] void be_child(pid_t parent, const std::function<int(std::size_t)>& work,
                           std::size_t job) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);  // it ended before the call
    std::signal(SIGINT, SIG_IGN);           // the parent decides
    std::signal(SIGTERM, SIG_DFL);
    int code = 1;
    try {
        code = work(job);
    } catch (const std::exception& failure) {
        std::cerr << "petal: " << failure.what() << "\n";
    }
    std::cerr.flush();
    // Not exit(): what plugins destroy at the end is the parent's affair.
    ::_exit(code);
}

}  // namespace

std::string to_string(const ChildEnd& end) {
    if (end.signal != 0)
        return "signal " + std::to_string(end.signal) + " (" + ::strsignal(end.signal) + ")";
    return "ended the program with exit code " + std::to_string(end.exit_code);
}

ChildPool::~ChildPool() {
    for (const auto& [pid, job] : jobs_) ::kill(pid, SIGKILL);
    for (const auto& [pid, job] : jobs_)
        while (::waitpid(pid, nullptr, 0) < 0 && errno == EINTR) continue;
}

void ChildPool::start(std::size_t job) {
    const pid_t parent = ::getpid();
    std::cout.flush();
    std::cerr.flush();
    const pid_t pid = ::fork();
    if (pid < 0)
        throw Error("cannot start a process: " + std::generic_category().message(errno) +
                    "; try fewer of them with --jobs");
    if (pid == 0) be_child(parent, work_, job);
    jobs_[pid] = job;
}

std::optional<ChildEnd> ChildPool::wait(double seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (true) {
        for (auto at = jobs_.begin(); at != jobs_.end(); ++at) {
            int status = 0;
            if (::waitpid(at->first, &status, WNOHANG) != at->first) continue;
            ChildEnd ended;
            ended.job = at->second;
            if (WIFSIGNALED(status)) ended.signal = WTERMSIG(status);
            if (WIFEXITED(status)) ended.exit_code = WEXITSTATUS(status);
            jobs_.erase(at);
            return ended;
        }
        if (jobs_.empty() || std::chrono::steady_clock::now() >= end) return std::nullopt;
        std::this_thread::sleep_for(kLook);
    }
}

}  // namespace petal::compare
