// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/rawlog/gzip_input.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "plugins/sources/temporary_folder.hpp"
#include "rawlog_bytes.hpp"

namespace petal::testing {
namespace {

using ::testing::HasSubstr;

class GzipInputFile : public TemporaryFolder {
   protected:
    /// All that can be read, in steps of `step` bytes, and why it ended.
    std::pair<std::string, std::string> read(const std::string& bytes, std::size_t step) const {
        GzipInput input(write("file", bytes));
        std::string all;
        std::string buffer(step, '\0');
        while (!input.at_end()) {
            const std::uint64_t promised = input.can_follow();
            const std::size_t got = input.Read(buffer.data(), step);
            EXPECT_LE(got, promised);
            all.append(buffer, 0, got);
            if (got < step) break;
        }
        EXPECT_EQ(input.getPosition(), all.size());
        return {all, all.size() % step == 0 || input.failure() != "the file ends there"
                         ? input.failure()
                         : std::string()};
    }
    /// Longer than every buffer inside, not periodic, and well compressed in parts.
    static std::string content() {
        std::string text;
        for (unsigned i = 0; i < 60000; ++i) {
            text += std::to_string(i * 2654435761U % 1000);
            if (i % 20000 == 0) text += std::string(300000, 'z');
        }
        return text;
    }
};

TEST_F(GzipInputFile, GivesTheSameBytesPlainAndCompressedInAnySteps) {
    const std::string text = content();
    for (const std::string& bytes : {text, gzipped(text)})
        for (const std::size_t step : {std::size_t{7}, std::size_t{131072}, std::size_t{400000}}) {
            const auto [all, failure] = read(bytes, step);
            EXPECT_EQ(all, text);
            EXPECT_EQ(failure, "");
        }
}

TEST_F(GzipInputFile, MembersInARowAreOneStream) {
    const std::string text = content();
    const std::string half = text.substr(0, text.size() / 3);
    const auto [all, failure] =
        read(gzipped(half) + gzipped("") + gzipped(text.substr(half.size())), 1000);
    EXPECT_EQ(all, text);
    EXPECT_EQ(failure, "");
}

TEST_F(GzipInputFile, WhatFollowsTheLastMemberIsTold) {
    const std::string whole = gzipped("0123456789");
    for (const std::string& rest : {std::string("x"), std::string(600, '\0'), std::string("plain")})
        EXPECT_THAT(read(whole + rest, 5).second, HasSubstr("is not compressed"));
    EXPECT_THAT(read(whole + gzipped("abc").substr(0, 1), 5).second, HasSubstr("cut off"));
    EXPECT_THAT(read(whole + gzipped("abc").substr(0, 9), 5).second, HasSubstr("cut off"));
}

TEST_F(GzipInputFile, EveryCutOfACompressedFileIsTold) {
    const std::string whole = gzipped("0123456789 0123456789 0123456789");
    for (std::size_t size = 2; size < whole.size(); ++size)
        EXPECT_THAT(read(whole.substr(0, size), 5).second, HasSubstr("cut off")) << size;
}

TEST_F(GzipInputFile, EveryChangedByteOfDataOrTrailerIsTold) {
    const std::string text = "0123456789 0123456789 abcdefghij";
    const std::string whole = gzipped(text);
    // Before byte 10 lies the header: time, system and the like may be anything.
    for (std::size_t i = 10; i < whole.size(); ++i)
        for (const int bit : {0, 3, 7}) {
            std::string changed = whole;
            changed[i] = static_cast<char>(changed[i] ^ (1 << bit));
            const auto [all, failure] = read(changed, 5);
            EXPECT_TRUE(!failure.empty() || all == text) << i << " " << bit;
        }
    std::string crc = whole;
    crc[crc.size() - 8] = static_cast<char>(crc[crc.size() - 8] ^ 1);
    EXPECT_THAT(read(crc, 5).second, HasSubstr("checksum"));
    std::string length = whole;
    length[length.size() - 1] = static_cast<char>(length[length.size() - 1] ^ 1);
    EXPECT_THAT(read(length, 5).second, HasSubstr("length"));
}

TEST_F(GzipInputFile, NothingIsASoundEnd) {
    for (const std::string& bytes : {std::string(), gzipped("")}) {
        GzipInput input(write("nothing", bytes));
        EXPECT_TRUE(input.at_end());
        EXPECT_EQ(input.failure(), "");
        EXPECT_EQ(input.compressed(), !bytes.empty());
    }
}

TEST_F(GzipInputFile, APipeIsRefusedAndNotWaitedFor) {
    const std::string pipe = (folder_ / "pipe").string();
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_THAT(refusal([&] { GzipInput input(pipe); }), HasSubstr("pipe"));
    EXPECT_THAT(refusal([&] { GzipInput input(folder_); }), HasSubstr("is a folder"));
    EXPECT_THAT(refusal([&] { GzipInput input(folder_ / "none"); }), HasSubstr("does not exist"));
}

}  // namespace
}  // namespace petal::testing
