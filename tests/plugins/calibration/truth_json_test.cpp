// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/truth_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "petal/error.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

class TruthFolder : public ::testing::Test {
   protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  (std::string("petal_truth_test_") +
                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    static Truth example() {
        Truth truth;
        truth.T_camera_lidar = Eigen::Isometry3d::Identity();
        truth.T_camera_lidar->rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()));
        truth.T_camera_lidar->translation() << 0.1, -0.2, 1.0 / 3.0;
        Truth::Board board;
        board.target = "four_square_holes_500mm";
        board.T_lidar_board.translation() << 2.0, 0.1, 0.2;
        board.corners_lidar = {{1.0, 2.0, 3.0}, {1.5, 2.5, 1.0 / 7.0}};
        board.corners_image = {{10.25, 20.5}, {30.125, 1.0 / 3.0}};
        truth.boards.push_back(board);
        truth.labels = {0, 1, 2, 3, 1, 1};
        return truth;
    }
    std::string refusal(const std::string& text) const {
        std::ofstream(folder_ / "truth.json") << text;
        try {
            read_truth(folder_);
        } catch (const Error& e) {
            return e.what();
        }
        return "accepted";
    }

    fs::path folder_;
};

TEST_F(TruthFolder, WithoutAFileIsEmpty) {
    EXPECT_TRUE(read_truth(folder_).empty());
}

TEST_F(TruthFolder, ComesBackToTheLastBit) {
    const Truth truth = example();
    write_truth_json(truth, folder_ / "truth.json");
    write_truth_labels(truth, folder_ / "labels.u8");
    const Truth again = read_truth(folder_, 6);
    ASSERT_TRUE(again.T_camera_lidar);
    EXPECT_EQ(again.T_camera_lidar->matrix(), truth.T_camera_lidar->matrix());
    ASSERT_EQ(again.boards.size(), 1U);
    EXPECT_EQ(again.boards[0].target, truth.boards[0].target);
    EXPECT_EQ(again.boards[0].T_lidar_board.matrix(), truth.boards[0].T_lidar_board.matrix());
    EXPECT_EQ(again.boards[0].corners_lidar, truth.boards[0].corners_lidar);
    EXPECT_EQ(again.boards[0].corners_image, truth.boards[0].corners_image);
    EXPECT_EQ(again.labels, truth.labels);
}

TEST_F(TruthFolder, LabelsMustFitThePoints) {
    write_truth_json(example(), folder_ / "truth.json");
    write_truth_labels(example(), folder_ / "labels.u8");
    EXPECT_THROW(read_truth(folder_, 7), Error);
    std::ofstream(folder_ / "labels.u8") << '\x04';
    EXPECT_THROW(read_truth(folder_), Error);
}

TEST_F(TruthFolder, NamesWhatIsWrong) {
    EXPECT_THAT(refusal("{"), HasSubstr("no JSON"));
    EXPECT_THAT(refusal("[]"), HasSubstr("object"));
    EXPECT_THAT(refusal(R"({"T_camera_lidar": [[1]]})"), HasSubstr("4 x 4"));
    EXPECT_THAT(refusal(R"({"T_camera_lidar": [[2,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]})"),
                HasSubstr("no rigid transform"));
    EXPECT_THAT(refusal(R"({"boards": [{}]})"), HasSubstr("boards[0].target"));
}

TEST_F(TruthFolder, NumbersMustBeFinite) {
    Truth truth = example();
    truth.boards[0].corners_image[0].x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(write_truth_json(truth, folder_ / "truth.json"), Error);
}

}  // namespace
}  // namespace petal
