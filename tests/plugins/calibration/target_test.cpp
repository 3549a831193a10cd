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
    EXPECT_THAT(refusal("{"), HasSubstr("board.json:1"));
    EXPECT_THAT(refusal("[]"), HasSubstr("expected an object"));
    EXPECT_THAT(refusal(R"({"petal_target": 2})"), HasSubstr("must be 1"));
    EXPECT_THAT(refusal(R"({"petal_target": 1, "colour": "red"})"),
                HasSubstr("colour is not known here"));
    EXPECT_THAT(refusal(R"({"petal_target": 1, "name": "a", "name": "b"})"),
                HasSubstr("duplicate key 'name'"));
    EXPECT_THAT(refusal(R"({"petal_target": 1, "name": "a"})"),
                HasSubstr("lacks the key 'thickness'"));
    EXPECT_THAT(refusal(board(square_, "[]")), HasSubstr("at least one of holes, round_holes"));
    EXPECT_THAT(refusal(board("[[0,0],[1]]", "[]")), HasSubstr("outline"));
    EXPECT_THAT(refusal(board(R"([[0,0],["a",0],[1,1]])", "[]")), HasSubstr("outline[1]"));
    EXPECT_THAT(refusal(board("[[0,0],[0,0.5],[0.5,0.5],[0.5,0]]", "[" + hole_ + "]")),
                HasSubstr("counter-clockwise"));
    EXPECT_THAT(refusal(board(square_, "[[[0.4,0.4],[0.6,0.4],[0.6,0.6],[0.4,0.6]]]")),
                HasSubstr("holes[0] leaves the outline"));
    EXPECT_THAT(
        refusal(board(square_, "[" + hole_ + ", [[0.15,0.15],[0.3,0.15],[0.3,0.3],[0.15,0.3]]]")),
        HasSubstr("holes[1] overlaps holes[0]"));
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

TEST_F(TargetFile, NamesWhatIsWrongWithRoundHolesAndPrints) {
    const auto with = [this](const std::string& rest) {
        return refusal(R"({"petal_target": 1, "name": "b", "thickness": 0.005, "outline": )" +
                       square_ + ", " + rest + "}");
    };
    EXPECT_THAT(with(R"("round_holes": [{"centre": [0.1, 0.1], "radius": 0.11}])"),
                HasSubstr("round_holes[0] leaves the outline"));
    EXPECT_THAT(with(R"("round_holes": [{"centre": [0.1, 0.1], "radios": 0.05}])"),
                HasSubstr("did you mean 'radius'"));
    EXPECT_THAT(with(R"("round_holes": [{"centre": [0.1, 0.1], "radius": 0.05},
                                        {"centre": [0.18, 0.1], "radius": 0.05}])"),
                HasSubstr("round_holes[1] overlaps round_holes[0]"));
    EXPECT_THAT(with(R"("round_holes": [{"centre": [0.3, 0.1], "radius": 0.05},
                                        {"centre": [0.1, 0.1], "radius": 0.05}])"),
                HasSubstr("round_holes[1] comes before its predecessor"));
    EXPECT_THAT(with(R"("holes": [)" + hole_ + R"(], "prints": [{"kind": "checkerboard",
                        "corner": [0.15, 0.15], "square": 0.05, "columns": 3, "rows": 3}])"),
                HasSubstr("prints[0] overlaps holes[0]"));
    EXPECT_THAT(with(R"("prints": [{"kind": "checkerboard", "corner": [0.1, 0.1], "square": 0.1,
                        "columns": 5, "rows": 3}])"),
                HasSubstr("prints[0] leaves the outline"));
    EXPECT_THAT(with(R"("prints": [{"kind": "chessboard"}])"), HasSubstr("checkerboard"));
    EXPECT_THAT(with(R"("prints": [{"kind": "aruco", "dictionary": "6x6_25", "id": 1,
                        "corner": [0, 0], "size": 0.1}])"),
                HasSubstr("6x6_250"));
    EXPECT_THAT(with(R"("prints": [{"kind": "aruco", "dictionary": "4x4_50", "id": 50,
                        "corner": [0, 0], "size": 0.1}])"),
                HasSubstr("0 to 49"));
    // A marker alone is not what any detector of boards looks for.
    EXPECT_THAT(with(R"("prints": [{"kind": "aruco", "dictionary": "4x4_50", "id": 5,
                        "corner": [0, 0], "size": 0.1}])"),
                HasSubstr("something to look for"));
    EXPECT_THAT(with(R"("holes": [)" + hole_ + R"(], "surface": {"colour": [0.1, 0.2, 1.2]})"),
                HasSubstr("surface.colour"));
    EXPECT_THAT(with(R"("holes": [)" + hole_ + R"(], "surface": {"reflectivity": 70})"),
                HasSubstr("expected 0 to 1"));
}

TEST_F(TargetFile, PrintsMayTouchTheRim) {
    const Target target = load_target(write(
        R"({"petal_target": 1, "name": "b", "thickness": 0, "outline": )" + square_ +
        R"(, "prints": [{"kind": "checkerboard", "corner": [0, 0], "square": 0.1, "columns": 5,
                         "rows": 5}]})"));
    EXPECT_EQ(target.corners().size(), 16U);
}

TEST(ShippedTarget, RoundHolesGiveTheirCentres) {
    const Target target = load_target("four_round_holes_aruco");
    EXPECT_EQ(target.round_holes.size(), 4U);
    EXPECT_EQ(target.markers.size(), 4U);
    EXPECT_EQ(target.features(), "4 round holes, 4 markers");
    EXPECT_TRUE(target.lines_x().empty());
    const std::vector<Eigen::Vector2d> centres = {
        {0.45, 0.3}, {0.95, 0.3}, {0.45, 0.7}, {0.95, 0.7}};
    EXPECT_EQ(target.corners(), centres);
}

TEST(ShippedTarget, ACheckerboardGivesItsInnerCorners) {
    const Target target = load_target("checkerboard");
    const auto corners = target.corners();
    ASSERT_EQ(corners.size(), 7U * 5U);
    EXPECT_LT((corners.front() - Eigen::Vector2d(0.12, 0.13)).norm(), 1e-12);
    EXPECT_LT((corners[1] - Eigen::Vector2d(0.18, 0.13)).norm(), 1e-12);
    EXPECT_LT((corners.back() - Eigen::Vector2d(0.48, 0.37)).norm(), 1e-12);
}

TEST(ShippedTarget, PolygonalHolesGoBeforeRoundOnes) {
    Target target = load_target("four_square_holes_1000mm");
    target.round_holes.push_back({{0.5, 0.5}, 0.05});
    EXPECT_EQ(target.corners().size(), 16U);
    EXPECT_EQ(target.features(), "4 polygonal holes, 1 round hole");
}

}  // namespace
}  // namespace petal
