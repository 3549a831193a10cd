// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "detectors/board_lines.hpp"
#include "detectors/planes_ransac.hpp"
#include "noise.hpp"
#include "petal/calibration/se3.hpp"
#include "petal/testing/stage_harness.hpp"
#include "real_data.hpp"

namespace petal {
namespace {

using testing::StageHarness;
using testing::uniform;

std::vector<Eigen::Vector3d> read_points(const std::string& name) {
    std::ifstream file(testing::real_data() / "sjtu_indoor" / name);
    std::vector<Eigen::Vector3d> points;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream fields(line);
        fields.imbue(std::locale::classic());
        Eigen::Vector3d p;
        fields >> p.x() >> p.y() >> p.z();
        points.push_back(p);
    }
    return points;
}

/// Boards of the indoor scene against the published corners (boards 2 to 4; the first hangs on the
/// wall and is not among the points).
class BoardLinesIndoor : public ::testing::Test {
   protected:
    void SetUp() override {
        PETAL_NEEDS_REAL_DATA();
        points_ = read_points("lidar_margin_points.csv");
        published_ = read_points("published_corner_pairs.csv");
        ASSERT_EQ(points_.size(), 1103u);
        ASSERT_EQ(published_.size(), 64u);
        published_.erase(published_.begin(), published_.begin() + 16);
    }

    static LidarBoards detect(const std::vector<Eigen::Vector3d>& points, std::uint64_t seed,
                              bool spacing = true) {
        auto map = mrpt::maps::CPointsMapXYZI::Create();
        for (const auto& p : points)
            map->insertPoint(static_cast<float>(p.x()), static_cast<float>(p.y()),
                             static_cast<float>(p.z()));
        Cloud cloud;
        cloud.points = map;
        auto planes = StageHarness::of<PlanesRansac>();
        planes.seed(seed).give<Cloud>("cloud", cloud).fire();
        auto boards = StageHarness::of<BoardLines>();
        boards.set("use_target_spacing", Value(spacing)).seed(seed);
        boards.give<Cloud>("cloud", cloud).give<Planes>("planes", planes.out<Planes>("planes"));
        boards.fire();
        return boards.out<LidarBoards>("boards");
    }

    /// Expects each of the three boards once; distances to the published corners, sorted.
    std::vector<double> compare(const LidarBoards& boards,
                                const Eigen::Isometry3d& moved = Eigen::Isometry3d::Identity()) {
        std::vector<double> distances;
        EXPECT_EQ(boards.boards.size(), 3u);
        std::array<int, 3> seen{};
        for (const LidarBoard& board : boards.boards) {
            Eigen::Vector3d centre = Eigen::Vector3d::Zero();
            for (const auto& corner : board.corners) centre += corner / 16.0;
            std::size_t nearest = 3;
            for (std::size_t k = 0; k < 3; ++k) {
                Eigen::Vector3d mean = Eigen::Vector3d::Zero();
                for (std::size_t i = 0; i < 16; ++i) mean += moved * published_[16 * k + i] / 16.0;
                if ((mean - centre).norm() < 0.05) nearest = k;
            }
            EXPECT_LT(nearest, 3u) << "a false board";
            if (nearest == 3) continue;
            ++seen[nearest];
            for (std::size_t i = 0; i < 16; ++i) {
                double best = std::numeric_limits<double>::infinity();
                for (const auto& corner : board.corners)
                    best = std::min(best, (corner - moved * published_[16 * nearest + i]).norm());
                distances.push_back(best);
            }
        }
        for (const int count : seen) EXPECT_EQ(count, 1);
        std::sort(distances.begin(), distances.end());
        if (distances.empty()) distances.push_back(std::numeric_limits<double>::infinity());
        return distances;
    }

    std::vector<Eigen::Vector3d> points_, published_;
};

// The required median is 12 mm; measured 6.9 mm, largest 16.7 mm (published corners scatter by 4
// mm).
TEST_F(BoardLinesIndoor, ThreeBoardsWithEverySeed) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto distances = compare(detect(points_, seed));
        EXPECT_LT(distances[distances.size() / 2], 0.009);
        EXPECT_LT(distances.back(), 0.022);
    }
}

TEST_F(BoardLinesIndoor, PlainLinesGiveHolesOf119To128Millimetres) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const LidarBoards boards = detect(points_, seed, false);
        const auto distances = compare(boards);
        EXPECT_LT(distances[distances.size() / 2], 0.020);
        for (const LidarBoard& board : boards.boards) {
            // Sides measured on this file before: 119 to 128 mm; 4 mm for other lines taken.
            EXPECT_GT(board.quality.at("hole_side_x_mm"), 115.0);
            EXPECT_LT(board.quality.at("hole_side_y_mm"), 132.0);
        }
    }
}

TEST_F(BoardLinesIndoor, ClutterDuplicatesAndMissingPointsDoNotMatter) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Rng rng(seed + 50);
        auto cluttered = points_;
        for (int i = 0; i < 500; ++i)
            cluttered.emplace_back(uniform(rng, 2.3, 3.2), uniform(rng, -2.0, 1.7),
                                   uniform(rng, -0.55, 0.2));
        auto distances = compare(detect(cluttered, seed));
        EXPECT_LT(distances[distances.size() / 2], 0.009);

        std::vector<Eigen::Vector3d> twice = points_;
        twice.insert(twice.end(), points_.begin(), points_.end());
        const double nan = std::numeric_limits<double>::quiet_NaN();
        twice.emplace_back(nan, nan, nan);
        distances = compare(detect(twice, seed));
        EXPECT_LT(distances[distances.size() / 2], 0.009);

        std::vector<Eigen::Vector3d> fewer;
        for (const auto& p : points_)
            if (uniform(rng, 0.0, 1.0) < 0.6) fewer.push_back(p);
        distances = compare(detect(fewer, seed));
        EXPECT_LT(distances[distances.size() / 2], 0.010);
    }
}

// Nothing relies on the axes of the LiDAR: the boards move with the points.
TEST_F(BoardLinesIndoor, ARigidMotionOfTheCloudMovesTheBoards) {
    Rng rng(9);
    for (int run = 0; run < 10; ++run) {
        SCOPED_TRACE("motion " + std::to_string(run));
        Vector6d twist;
        for (int i = 0; i < 6; ++i) twist(i) = uniform(rng, -2.0, 2.0);
        const Eigen::Isometry3d moved = se3_exp(twist);
        std::vector<Eigen::Vector3d> points;
        for (const auto& p : points_) points.push_back(moved * p);
        const auto distances = compare(detect(points, 1), moved);
        EXPECT_LT(distances[distances.size() / 2], 0.009);
    }
}

}  // namespace
}  // namespace petal
