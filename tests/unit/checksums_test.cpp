// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "checksums.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "petal/error.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// RFC 7693, appendix A.
constexpr const char* kOfAbc =
    "ba80a53f981c4d0d6a2797b69f12f6e94c212f14685ac4b74b12bb6fdbffa2d1"
    "7d87c5392aab792dc252d5de4533cc9518d38aa8dbf1925ab92386edd4009923";

/// With the work beside the run, and after it.
class ChecksumsOf : public ::testing::TestWithParam<bool> {
   protected:
    ChecksumsOf() {
        std::string name = (fs::temp_directory_path() / "petal_sums_XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
        folder_ = name;
    }
    ~ChecksumsOf() override { fs::remove_all(folder_); }
    fs::path file(const std::string& name, const std::string& content) const {
        std::ofstream(folder_ / name, std::ios::binary) << content;
        return folder_ / name;
    }
    fs::path folder_;
};

TEST_P(ChecksumsOf, EachFileIsItsBlake2b) {
    const fs::path abc = file("abc", "abc");
    const fs::path large = file("large", std::string(1000000, 'x'));
    Checksums sums(nullptr, GetParam());
    for (const fs::path& each : {abc, large, abc}) sums.add(each);
    const auto found = sums.finish();
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found.at(abc).blake2b, kOfAbc);
    EXPECT_EQ(found.at(large).blake2b, blake2b_of(large));
    EXPECT_NE(found.at(large).blake2b, blake2b_of(file("other", std::string(999999, 'x'))));
}

TEST_P(ChecksumsOf, AFileThatIsGoneIsToldAndTheOthersAreThere) {
    const fs::path abc = file("abc", "abc");
    Checksums sums(nullptr, GetParam());
    sums.add(folder_ / "gone");
    sums.add(abc);
    const auto found = sums.finish();
    EXPECT_EQ(found.at(folder_ / "gone").blake2b, "");
    EXPECT_THAT(found.at(folder_ / "gone").missing, HasSubstr((folder_ / "gone").string()));
    EXPECT_EQ(found.at(abc).blake2b, kOfAbc);
}

TEST_P(ChecksumsOf, ACancelledRunHasNoneAndSaysSo) {
    const std::atomic<bool> cancel{true};
    Checksums sums(&cancel, GetParam());
    const fs::path abc = file("abc", "abc");
    sums.add(abc);
    const auto found = sums.finish();
    EXPECT_EQ(found.at(abc).blake2b, "");
    EXPECT_THAT(found.at(abc).missing, HasSubstr("cancelled"));
}

TEST_P(ChecksumsOf, NobodyNeedsToWaitForThem) {
    Checksums sums(nullptr, GetParam());
    sums.add(file("large", std::string(1000000, 'x')));
}

INSTANTIATE_TEST_SUITE_P(Both, ChecksumsOf, ::testing::Bool(), [](const auto& which) {
    return which.param ? "WhileRunning" : "Afterwards";
});

}  // namespace
}  // namespace petal
