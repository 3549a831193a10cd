// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/file_name.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

namespace petal {
namespace {

TEST(FileName, PlainLabelsStayAsTheyAre) {
    for (const char* label : {"CAMERA", "cam_0", "front-left.raw", "scene_12"})
        EXPECT_EQ(file_name(label), label);
}

TEST(FileName, NothingLeadsElsewhere) {
    EXPECT_EQ(file_name("/cam/front"), "%2Fcam%2Ffront");
    EXPECT_EQ(file_name("../../esc"), "%2E.%2F..%2Fesc");
    EXPECT_EQ(file_name("."), "%2E");
    EXPECT_EQ(file_name("cam 0\n"), "cam%200%0A");
    EXPECT_EQ(file_name("vorn\xC3\xA9"), "vorn%C3%A9");
    for (const char* label : {"/a", "..", "a\\b", "C:/x", "a/../b"})
        EXPECT_EQ(std::filesystem::path(file_name(label)).filename(), file_name(label));
}

TEST(FileName, TwoLabelsDoNotMeet) {
    const std::set<std::string> labels = {"/a/b", "_a_b", "a_b",    "a/b", "a%2Fb", "a%b", "a b",
                                          "..",   "%2E.", "%2E%2E", ".",   "",      "A_B"};
    std::set<std::string> names;
    for (const std::string& label : labels) names.insert(file_name(label));
    EXPECT_EQ(names.size(), labels.size());
}

}  // namespace
}  // namespace petal
