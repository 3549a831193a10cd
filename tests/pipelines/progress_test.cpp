// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <poll.h>
#include <pty.h>

#include <algorithm>
#include <regex>
#include <sstream>

#include "slow_runs.hpp"

namespace petal::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ProgressOnATerminal : public SlowRuns {
   protected:
    /// All that the program writes to a terminal of so many columns as its standard error.
    std::string on_terminal(unsigned short columns, const std::vector<std::string>& options = {}) {
        int outer = -1;
        int inner = -1;
        winsize size{};
        size.ws_row = 24;
        size.ws_col = columns;
        if (openpty(&outer, &inner, nullptr, nullptr, &size) != 0) return "no pseudo terminal";
        setenv("TERM", "xterm", 1);
        const auto child = start(options, RLIM_INFINITY, inner);
        std::string text;
        int code = -1;
        while (code == -1) {
            code = child->wait(0.01);
            pollfd ready{outer, POLLIN, 0};
            while (poll(&ready, 1, 0) > 0 && (ready.revents & POLLIN) != 0) {
                std::array<char, 4096> block{};
                const ssize_t got = read(outer, block.data(), block.size());
                if (got <= 0) break;
                text.append(block.data(), static_cast<std::size_t>(got));
            }
        }
        EXPECT_EQ(code, 0) << text;
        close(inner);
        close(outer);
        return text;
    }

    /// What a terminal shows in the end, line by line: each part after the last "clear the line".
    static std::vector<std::string> shown(const std::string& text) {
        std::vector<std::string> lines;
        std::istringstream in(text);
        for (std::string line; std::getline(in, line);) {
            const std::size_t clear = line.rfind("\x1b[K");
            line = clear == std::string::npos ? line : line.substr(clear + 3);
            line.erase(std::remove(line.begin(), line.end(), '\r'), line.end());
            lines.push_back(line);
        }
        return lines;
    }
};

TEST_F(ProgressOnATerminal, TellsTheStageFramesRateAndRemainingTime) {
    write_pipeline(R"("frames": 20)", R"("work_ms": 80)", "");
    const std::string text = on_terminal(120);
    const std::regex line(
        R"(work, \d+ frames, \d+(\.\d)? frames/s, \d+ % of 20 ticks, \d+ s left)");
    EXPECT_TRUE(std::regex_search(text, line)) << text;
    // A few times a second, not for each frame: 1.6 s and more of work.
    const auto redrawn = std::count(text.begin(), text.end(), '\x1b');
    EXPECT_GE(redrawn, 4);
}

TEST_F(ProgressOnATerminal, LinesOfTheLogStayWholeAndTheProgressIsGoneInTheEnd) {
    write_pipeline(R"("frames": 20)", R"("work_ms": 50)", "");
    const std::vector<std::string> lines = shown(on_terminal(120));
    std::size_t ticks = 0;
    for (const std::string& line : lines) {
        const bool message = std::regex_match(line, std::regex(R"(\[ticks\] tick \d+)"));
        ticks += message ? 1 : 0;
        EXPECT_TRUE(message || line.empty()) << "neither a whole message nor cleared: " << line;
    }
    EXPECT_EQ(ticks, 4U);
}

TEST_F(ProgressOnATerminal, IsNeverWiderThanTheTerminal) {
    write_pipeline(R"("frames": 10)", R"("work_ms": 60)", "");
    const std::string text = on_terminal(24);
    EXPECT_THAT(text, HasSubstr("frame"));
    for (std::size_t at = text.find("\x1b[K"); at != std::string::npos;
         at = text.find("\x1b[K", at + 1)) {
        const std::size_t end = text.find_first_of("\r\n", at);
        EXPECT_LT(text.substr(at + 3, end - at - 3).size(), 24U);
    }
}

TEST_F(ProgressOnATerminal, QuietShowsNothing) {
    write_pipeline(R"("frames": 10)", R"("work_ms": 60)", "");
    EXPECT_EQ(on_terminal(120, {"--quiet"}), "");
}

TEST_F(ProgressOnATerminal, WithoutATerminalNotOneControlCharacterComes) {
    write_pipeline(R"("frames": 10)", R"("work_ms": 60)", "");
    EXPECT_EQ(start()->wait(60.0), 0);
    const std::string text = err();
    EXPECT_THAT(text, HasSubstr("[ticks] tick 0\n"));
    for (const char c : text + read_text(folder_ / ".stdout"))
        EXPECT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 32) << static_cast<int>(c);
}

}  // namespace
}  // namespace petal::testing
