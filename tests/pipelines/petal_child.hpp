// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace petal::testing {

/// The built program as a child that a test can send signals to.
class PetalChild {
   public:
    struct Options {
        std::filesystem::path folder;  ///< it works there; .stdout and .stderr lie there
        int terminal = -1;             ///< a descriptor for its standard error, instead
        rlim_t largest_file = RLIM_INFINITY;
    };

    PetalChild(const std::vector<std::string>& arguments, const Options& options) {
        pid_ = fork();
        if (pid_ == 0) become(arguments, options);
    }
    PetalChild(const PetalChild&) = delete;
    PetalChild& operator=(const PetalChild&) = delete;
    ~PetalChild() {
        if (pid_ <= 0) return;
        send(SIGKILL);
        wait(60.0);
    }

    void send(int signal) const { ::kill(pid_, signal); }

    /// True once the program has a handler for that signal: it is out of the dynamic linker.
    bool catches(int signal) const {
        std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
        for (std::string key, value; status >> key;)
            if (key == "SigCgt:" && status >> value)
                return (std::stoull(value, nullptr, 16) >> (signal - 1) & 1U) != 0;
        return false;
    }

    /// The exit code; 1000 + n where signal n ended it; -1 where it still runs after `seconds`.
    int wait(double seconds) {
        int status = 0;
        const bool ended = until(seconds, [&] { return waitpid(pid_, &status, WNOHANG) == pid_; });
        if (!ended) return -1;
        pid_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    }

    /// Polls until it holds, for at most `seconds`. Tells whether it did.
    static bool until(double seconds, const std::function<bool()>& holds) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
        while (!holds()) {
            if (std::chrono::steady_clock::now() > end) return false;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return true;
    }

   private:
    [[noreturn]] static void become(const std::vector<std::string>& arguments,
                                    const Options& options) {
        if (chdir(options.folder.c_str()) != 0) _exit(99);
        constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
        dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
        dup2(open(".stdout", kFlags, 0600), STDOUT_FILENO);
        dup2(options.terminal >= 0 ? options.terminal : open(".stderr", kFlags, 0600),
             STDERR_FILENO);
        if (options.largest_file != RLIM_INFINITY) {
            const rlimit limit{options.largest_file, options.largest_file};
            setrlimit(RLIMIT_FSIZE, &limit);
        }
        const std::string program = PETAL_BUILD_DIR "/bin/petal";
        std::vector<std::string> words{program};
        words.insert(words.end(), arguments.begin(), arguments.end());
        std::vector<char*> pointers;
        for (std::string& word : words) pointers.push_back(word.data());
        pointers.push_back(nullptr);
        execv(program.c_str(), pointers.data());
        _exit(98);
    }

    pid_t pid_ = -1;
};

}  // namespace petal::testing
