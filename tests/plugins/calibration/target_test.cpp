// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/target.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "petal/error.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// A target file that goes with the test.
class TargetFile : public ::testing::Test {
   protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  ("petal_target_test_" +
                   std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path write(const std::string& text) const {
        const fs::path file = folder_ / "board.json";
        std::ofstream(file) << text;
        return file;
    }
    std::string refusal(const std::string& text) const {
        try {
            load_target(write(text));
        } catch (const Error& e) {
            return e.what();
        }
        return "accepted";
    }
    static std::string board(const std::string& outline, const std::string& holes) {
        return R"({"petal_target": 1, "name": "b", "thickness": 0.005, "outline": )" + outline +
               R"(, "holes": )" + holes + "}";
    }

    const std::string square_ = "[[0,0],[0.5,0],[0.5,0.5],[0,0.5]]";
    const std::string hole_ = "[[0.1,0.1],[0.2,0.1],[0.2,0.2],[0.1,0.2]]";
    fs::path folder_;
};

TEST(ShippedTarget, HasTheBoardOfTheLetter) {
    const Target target = load_target("four_square_holes_500mm");
    EXPECT_EQ(target.name, "four_square_holes_500mm");
    EXPECT_DOUBLE_EQ(target.thickness, 0.005);
    EXPECT_DOUBLE_EQ(target.width(), 0.5);
    EXPECT_DOUBLE_EQ(target.height(), 0.5);
    EXPECT_EQ(target.holes.size(), 4U);
    EXPECT_EQ(target.lines_x(), (std::vector<double>{0.1, 0.2, 0.3, 0.4}));
    EXPECT_EQ(target.lines_y(), (std::vector<double>{0.1, 0.2, 0.3, 0.4}));
}

TEST(ShippedTarget, CornersRunRowByRowFromTheTopLeft) {
    const auto corners = load_target("four_square_holes_500mm").corners();
    ASSERT_EQ(corners.size(), 16U);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        EXPECT_DOUBLE_EQ(corners[i].x(), 0.1 * static_cast<double>(i % 4 + 1));
        EXPECT_DOUBLE_EQ(corners[i].y(), 0.1 * static_cast<double>(i / 4 + 1));
    }
}

TEST(ShippedTarget, IsTheFileInTheProject) {
    const fs::path source =
        fs::path(PETAL_SOURCE_DIR) / "datasets/targets/four_square_holes_500mm.json";
    EXPECT_EQ(load_target(source).corners(), load_target("four_square_holes_500mm").corners());
    EXPECT_TRUE(fs::is_regular_file(find_target_file("four_square_holes_500mm")));
}

TEST(ShippedTarget, AnUnknownNameListsTheKnown) {
    try {
        load_target("four_round_holes");
        FAIL() << "accepted";
    } catch (const Error& e) {
        EXPECT_THAT(e.what(), HasSubstr("four_round_holes"));
        EXPECT_THAT(e.what(), HasSubstr("four_square_holes_500mm"));
    }
}

TEST_F(TargetFile, ReadsAnotherBoard) {
    const Target target =
        load_target(write(board("[[0,0],[1.0,0],[1.0,0.6],[0,0.6]]", "[" + hole_ + "]")));
    EXPECT_DOUBLE_EQ(target.width(), 1.0);
    EXPECT_DOUBLE_EQ(target.height(), 0.6);
    EXPECT_EQ(target.corners().size(), 4U);
}

TEST_F(TargetFile, NamesWhatIsWrong) {
    EXPECT_THAT(refusal("{"), HasSubstr("is not JSON"));
    EXPECT_THAT(refusal("[]"), HasSubstr("object"));
    EXPECT_THAT(refusal(R"({"petal_target": 2})"), HasSubstr("must be 1"));
    EXPECT_THAT(refusal(R"({"petal_target": 1, "colour": "red"})"),
                HasSubstr("unknown key 'colour'"));
    EXPECT_THAT(refusal(R"({"petal_target": 1, "name": "a", "name": "b"})"), HasSubstr("twice"));
    EXPECT_THAT(refusal(R"({"petal_target": 1, "name": "a"})"),
                HasSubstr("'thickness' is missing"));
    EXPECT_THAT(refusal(board(square_, "[]")), HasSubstr("at least one"));
    EXPECT_THAT(refusal(board("[[0,0],[1]]", "[]")), HasSubstr("outline"));
    EXPECT_THAT(refusal(board(R"([[0,0],["a",0],[1,1]])", "[]")), HasSubstr("outline[1]"));
    EXPECT_THAT(refusal(board("[[0,0],[0,0.5],[0.5,0.5],[0.5,0]]", "[" + hole_ + "]")),
                HasSubstr("counter-clockwise"));
    EXPECT_THAT(refusal(board(square_, "[[[0.4,0.4],[0.6,0.4],[0.6,0.6],[0.4,0.6]]]")),
                HasSubstr("leaves the outline"));
    EXPECT_THAT(
        refusal(board(square_, "[" + hole_ + ", [[0.15,0.15],[0.3,0.15],[0.3,0.3],[0.15,0.3]]]")),
        HasSubstr("overlaps"));
    EXPECT_THAT(
        refusal(board(square_, "[[[0.3,0.3],[0.4,0.3],[0.4,0.4],[0.3,0.4]], " + hole_ + "]")),
        HasSubstr("row by row"));
}

TEST_F(TargetFile, MillimetresAreNoBoard) {
    EXPECT_THAT(refusal(board("[[0,0],[500,0],[500,500],[0,500]]",
                              "[[[100,100],[200,100],[200,200],[100,200]]]")),
                HasSubstr("Lengths are metres"));
    EXPECT_THAT(refusal(board("[[0,0],[0.04,0],[0.04,0.04],[0,0.04]]",
                              "[[[0.01,0.01],[0.02,0.01],[0.02,0.02],[0.01,0.02]]]")),
                HasSubstr("0.05 to 5 m"));
}

TEST_F(TargetFile, AFolderIsNoTarget) {
    EXPECT_THROW(load_target(folder_), Error);
}

}  // namespace
}  // namespace petal
