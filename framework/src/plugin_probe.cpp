// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plugin_probe.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <map>
#include <sstream>
#include <utility>

#include "nearest.hpp"
#include "petal/error.hpp"
#include "plugin_opening.hpp"
#include "plugin_search.hpp"

namespace petal {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kKeptOutput = 2000;  // bytes; enough for an abort's message
/// First byte of the child's answer; without one it ended before it could answer.
constexpr char kOk = 'o';
constexpr char kRefused = 'r';

class Pipe {
   public:
    Pipe() {
        if (::pipe2(ends_.data(), O_CLOEXEC) != 0)
            throw Error(std::string("cannot make a pipe to probe a plugin: ") +
                        std::strerror(errno));
        ::fcntl(ends_[0], F_SETFL, O_NONBLOCK);
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    ~Pipe() {
        ::close(ends_[0]);
        close_writing();
    }
    int reading() const { return ends_[0]; }
    int writing() const { return ends_[1]; }
    void close_writing() {
        if (ends_[1] >= 0) ::close(ends_[1]);
        ends_[1] = -1;
    }
    /// Appends what is there now. At most what a full pipe holds: a child that prints without end
    /// must not keep us here.
    void drain(std::string& to, std::size_t keep) const {
        std::array<char, 65536> block{};
        const ssize_t got = ::read(reading(), block.data(), block.size());
        if (got > 0) to.append(block.data(), static_cast<std::size_t>(got));
        if (to.size() > keep) to.erase(0, to.size() - keep);
    }

   private:
    std::array<int, 2> ends_{};
};

void write_all(int fd, const std::string& text) {
    for (std::size_t done = 0; done < text.size();) {
        const ssize_t wrote = ::write(fd, text.data() + done, text.size() - done);
        if (wrote > 0) {
            done += static_cast<std::size_t>(wrote);
        } else if (errno != EINTR) {
            return;
        }
    }
}

/// The child: loads the library, answers, and ends without running destructors or exit handlers.
[[noreturn]] void run_child(const std::filesystem::path& library, const PluginRecord& record,
                            int answer, int output, pid_t parent) {
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);  // the parent ended before the line above
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    for (const int number : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTERM, SIGINT})
        ::signal(number, SIG_DFL);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    try {
        write_all(answer, kOk + join(open_plugin(library, record).plugin.types, "\n"));
    } catch (const std::exception& error) {
        write_all(answer, kRefused + std::string(error.what()));
    }
    ::_exit(0);
}

/// The child's process group; killed and reaped on every way out.
class Child {
   public:
    explicit Child(pid_t pid) : pid_(pid) {
        ::setpgid(pid, pid);  // both sides do it: whoever comes first
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() {
        ::kill(-pid_, SIGKILL);
        if (!ended_)
            while (::waitpid(pid_, &status_, 0) < 0 && errno == EINTR) continue;
    }
    bool has_ended() {
        if (!ended_) ended_ = ::waitpid(pid_, &status_, WNOHANG) == pid_;
        return ended_;
    }
    int status() const { return status_; }

   private:
    pid_t pid_;
    bool ended_ = false;
    int status_ = 0;
};

std::string how_it_ended(int status) {
    if (WIFSIGNALED(status)) {
        const int number = WTERMSIG(status);
        return "ended its process by signal " + std::to_string(number) + " (" +
               ::strsignal(number) + ")";
    }
    return "ended its process with status " + std::to_string(WEXITSTATUS(status));
}

std::string seconds(std::chrono::milliseconds time) {
    std::string text = std::to_string(time.count() / 1000);
    if (const auto rest = time.count() % 1000; rest != 0)
        text += "." + std::to_string(1000 + rest).substr(1);
    return text + " s";
}

}  // namespace

const char* to_string(ProbeResult::Outcome outcome) {
    switch (outcome) {
        case ProbeResult::Outcome::ok:
            return "ok";
        case ProbeResult::Outcome::refused:
            return "refused";
        case ProbeResult::Outcome::crashed:
            return "crashed";
        case ProbeResult::Outcome::hung:
            return "hung";
    }
    return "unknown";
}

ProbeResult probe(const std::filesystem::path& library, std::chrono::milliseconds limit) {
    using Outcome = ProbeResult::Outcome;
    PluginRecord record{};
    try {
        record = fitting_record(library);
    } catch (const Error& error) {
        return {Outcome::refused, error.what(), {}, {}};
    }
    Pipe answer_pipe;
    Pipe output_pipe;
    const pid_t parent = ::getpid();
    const pid_t pid = ::fork();
    if (pid < 0)
        throw Error(std::string("cannot start a process to probe a plugin: ") +
                    std::strerror(errno));
    if (pid == 0) run_child(library, record, answer_pipe.writing(), output_pipe.writing(), parent);
    Child child(pid);
    answer_pipe.close_writing();
    output_pipe.close_writing();

    std::string answer;
    ProbeResult result;
    const auto deadline = Clock::now() + limit;
    bool ended = false;
    while (!ended && Clock::now() < deadline) {
        // The end of the child is polled for too: a process that it left behind may hold the pipes
        // open.
        std::array<pollfd, 2> fds{
            {{answer_pipe.reading(), POLLIN, 0}, {output_pipe.reading(), POLLIN, 0}}};
        ::poll(fds.data(), fds.size(), 20);
        ended = child.has_ended();
        answer_pipe.drain(answer, std::string::npos);
        output_pipe.drain(result.output, kKeptOutput);
    }
    if (!ended) {
        result.outcome = Outcome::hung;
        result.reason = "did not finish loading within " + seconds(limit);
    } else if (!answer.empty() && answer[0] == kRefused) {
        result.outcome = Outcome::refused;
        result.reason = answer.substr(1);
    } else if (answer.empty() || child.status() != 0) {
        result.outcome = Outcome::crashed;
        result.reason = how_it_ended(child.status()) + " while it was loaded";
    } else {
        std::istringstream types(answer.substr(1));
        for (std::string type; std::getline(types, type);) result.types.push_back(type);
    }
    return result;
}

std::vector<Probed> probe_all(const std::vector<std::filesystem::path>& folders,
                              std::chrono::milliseconds limit) {
    std::vector<Refusal> refused;
    std::vector<Probed> probed;
    std::map<std::string, std::filesystem::path> owners;  // of the types
    for (const Candidate& candidate : find_candidates(folders, refused)) {
        Probed library{candidate.library, probe(candidate.library, limit), {}};
        for (const std::string& type : library.result.types) {
            const auto [owner, is_new] = owners.emplace(type, candidate.library);
            if (!is_new)
                library.clashes.push_back("stage type '" + type + "' is in " +
                                          owner->second.string() + " too; rename one of them or " +
                                          "take one library away");
        }
        probed.push_back(std::move(library));
    }
    for (const Refusal& refusal : refused)
        probed.push_back(
            {refusal.library, {ProbeResult::Outcome::refused, refusal.reason, {}, {}}, {}});
    return probed;
}

}  // namespace petal
