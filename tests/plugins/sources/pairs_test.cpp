// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/pairs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "petal/calibration/correspondences.hpp"
#include "petal/testing/stage_harness.hpp"
#include "plugins/sources/temporary_folder.hpp"
#include "real_data.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
using testing::StageHarness;

class PairsStage : public testing::TemporaryFolder {
   protected:
    void SetUp() override {
        TemporaryFolder::SetUp();
        write("k.yaml",
              "K: [100, 0, 50, 0, 100, 40, 0, 0, 1]\nD: [0, 0, 0, 0]\n"
              "width: 100\nheight: 80\n");
        std::string text = "x,y,z,u,v\n";
        for (int i = 0; i < 6; ++i)
            text += std::to_string(i) + ",2,3," + std::to_string(10 + i) + ",20\n";
        write("pairs.csv", text);
    }
    StageHarness stage() const {
        StageHarness harness = StageHarness::of<PairsSource>();
        harness.set("pairs", (folder_ / "pairs.csv").c_str())
            .set("intrinsics", (folder_ / "k.yaml").c_str());
        return harness;
    }
};

TEST_F(PairsStage, ReadsRowsAsSinglePoints) {
    StageHarness harness = stage();
    harness.fire();
    const auto& camera = harness.out<Correspondences>("correspondences").cameras.at(0);
    ASSERT_EQ(camera.pairs.size(), 6U);
    EXPECT_EQ(camera.pairs[3].lidar, Eigen::Vector3d(3, 2, 3));
    EXPECT_EQ(camera.pairs[3].image, Eigen::Vector2d(13, 20));
    EXPECT_EQ(camera.pairs[3].board, -1);
    EXPECT_EQ(camera.order.by, DecidedBy::given);
    EXPECT_EQ(camera.model.ncols, 100U);
    EXPECT_EQ(harness.used_files().size(), 2U);
}

TEST_F(PairsStage, PicksRowsAndMarksBoards) {
    StageHarness harness = stage();
    harness.set("first", 1)
        .set("leading_points", 1)
        .set("corners_per_board", 4)
        .set("corner_order", "columns");
    harness.fire();
    const auto& pairs = harness.out<Correspondences>("correspondences").cameras.at(0).pairs;
    ASSERT_EQ(pairs.size(), 5U);
    EXPECT_EQ(pairs[0].lidar.x(), 1.0);
    EXPECT_EQ(pairs[0].board, -1);
    // Column by column of a 2 x 2 board: the second listed is the lower left, number 2 row by row.
    EXPECT_EQ(pairs[1].corner, 0);
    EXPECT_EQ(pairs[2].corner, 2);
    EXPECT_EQ(pairs[3].corner, 1);
    EXPECT_EQ(pairs[4].corner, 3);
    EXPECT_EQ(pairs[4].board, 0);
}

TEST_F(PairsStage, NumbersCornersByWhereTheyLieInTheImage) {
    // A slightly rolled 2 x 2 board in the order lower left, upper right, lower right, upper left.
    write("scrambled.csv", "0,0,2,10,41\n0,0,2,41,12\n0,0,2,40,43\n0,0,2,11,10\n");
    StageHarness harness = stage();
    harness.set("pairs", (folder_ / "scrambled.csv").c_str())
        .set("corners_per_board", 4)
        .set("corner_order", "from_image");
    harness.fire();
    const auto& pairs = harness.out<Correspondences>("correspondences").cameras.at(0).pairs;
    ASSERT_EQ(pairs.size(), 4U);
    EXPECT_EQ(pairs[0].corner, 2);
    EXPECT_EQ(pairs[1].corner, 1);
    EXPECT_EQ(pairs[2].corner, 3);
    EXPECT_EQ(pairs[3].corner, 0);
}

TEST_F(PairsStage, NamesWhatIsWrong) {
    StageHarness range = stage();
    range.set("first", 4).set("count", 3);
    EXPECT_THAT(refusal([&] { range.fire(); }), HasSubstr("has 6 rows"));
    StageHarness boards = stage();
    boards.set("corners_per_board", 4);
    EXPECT_THAT(refusal([&] { boards.fire(); }), HasSubstr("no whole number of boards"));
    StageHarness square = stage();
    square.set("corners_per_board", 6).set("corner_order", "columns");
    EXPECT_THAT(refusal([&] { square.fire(); }), HasSubstr("square"));
    StageHarness both = stage();
    both.set("lidar_points", "a").set("image_points", "b");
    EXPECT_THAT(refusal([&] { both.fire(); }), HasSubstr("either pairs"));
    StageHarness size = stage();
    size.set("image_size", Value(std::vector<std::int64_t>{640, 480}));
    EXPECT_THAT(refusal([&] { size.fire(); }), HasSubstr("100 x 80"));
    write("nan.csv", "1,2,3,4,nan\n");
    StageHarness nan = stage();
    nan.set("pairs", (folder_ / "nan.csv").c_str());
    EXPECT_THAT(refusal([&] { nan.fire(); }), HasSubstr("not finite"));
    write("six.csv", "1,2,3,4,5,6.5\n");
    StageHarness six = stage();
    six.set("pairs", (folder_ / "six.csv").c_str());
    EXPECT_THAT(refusal([&] { six.fire(); }), HasSubstr("5 are expected"));
}

TEST_F(PairsStage, TwoFilesMustHaveAsManyRows) {
    StageHarness harness = stage();
    harness.set("pairs", "")
        .set("lidar_points", write("l.txt", "1 2 3\n4 5 6\n").c_str())
        .set("image_points", write("i.txt", "1 2\n").c_str());
    EXPECT_THAT(refusal([&] { harness.fire(); }), HasSubstr("has 2 rows"));
}

TEST_F(PairsStage, IntrinsicsWithoutASizeNeedOne) {
    const auto file = write("k.txt", "intrinsic 100 0 50 0 100 40 0 0 1 distortion 0 0 0 0");
    StageHarness harness = stage();
    harness.set("intrinsics", file.c_str());
    EXPECT_THAT(refusal([&] { harness.fire(); }), HasSubstr("image_size"));
    harness.set("image_size", Value(std::vector<std::int64_t>{100, 80}));
    harness.fire();
    EXPECT_EQ(harness.out<Correspondences>("correspondences").cameras.at(0).model.nrows, 80U);
}

TEST_F(PairsStage, NoRowsAreNoted) {
    write("empty.csv", "x,y,z,u,v\n");
    StageHarness harness = stage();
    harness.set("pairs", (folder_ / "empty.csv").c_str());
    harness.fire();
    EXPECT_TRUE(harness.out<Correspondences>("correspondences").cameras.at(0).pairs.empty());
    EXPECT_EQ(harness.notes().size(), 1U);
}

TEST(RealPairs, TheCampusBoardsAlone) {
    PETAL_NEEDS_REAL_DATA();
    const auto folder = testing::real_data() / "sjtu_campus";
    StageHarness harness = StageHarness::of<PairsSource>();
    harness.set("pairs", "")
        .set("lidar_points", (folder / "published_corners_lidar.txt").c_str())
        .set("image_points", (folder / "published_corners_image.txt").c_str())
        .set("intrinsics", (folder / "intrinsics.txt").c_str())
        .set("image_size", Value(std::vector<std::int64_t>{1280, 720}))
        .set("first", 10)
        .set("corners_per_board", 16)
        .set("corner_order", "columns");
    harness.fire();
    const auto& pairs = harness.out<Correspondences>("correspondences").cameras.at(0).pairs;
    ASSERT_EQ(pairs.size(), 32U);
    // The first board's first corner is its top left; the next listed lies below it.
    EXPECT_EQ(pairs[0].image, Eigen::Vector2d(383.803, 372.409));
    EXPECT_EQ(pairs[1].corner, 4);
    EXPECT_EQ(pairs[31].board, 1);
}

}  // namespace
}  // namespace petal
