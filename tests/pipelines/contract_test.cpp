// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationComment.h>

#include <cmath>
#include <limits>

#include "built_plugins.hpp"
#include "petal/calibration/boards.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/observation.hpp"
#include "petal/calibration/planes.hpp"
#include "petal/calibration/truth.hpp"
#include "petal/testing/contract_suite.hpp"

namespace petal::testing {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

Cloud cloud_of(const std::vector<Eigen::Vector3d>& points) {
    auto map = std::make_shared<mrpt::maps::CPointsMapXYZI>();
    for (const auto& p : points)
        map->insertPointFast(static_cast<float>(p.x()), static_cast<float>(p.y()),
                             static_cast<float>(p.z()));
    Cloud cloud;
    cloud.points = map;
    return cloud;
}

Cloud nan_cloud() {
    std::vector<Eigen::Vector3d> points(50, Eigen::Vector3d(kNaN, 1.0, 2.0));
    points.emplace_back(kInf, 0.0, 0.0);
    return cloud_of(points);
}

Cloud collinear_cloud() {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 200; ++i) points.emplace_back(2.0, 0.01 * i, 0.0);
    return cloud_of(points);
}

Cloud single_point_cloud() {
    return cloud_of(std::vector<Eigen::Vector3d>(300, Eigen::Vector3d(2.0, 0.0, 0.0)));
}

mrpt::img::TCamera camera(unsigned width, unsigned height) {
    mrpt::img::TCamera k;
    k.ncols = width;
    k.nrows = height;
    k.setIntrinsicParamsFromValues(100.0, 100.0, width / 2.0, height / 2.0);
    return k;
}

Images images_of(unsigned width, unsigned height, unsigned k_width, unsigned k_height) {
    CameraImage image;
    image.image = mrpt::img::CImage(width, height, mrpt::img::CH_GRAY);
    image.image.filledRectangle(0, 0, static_cast<int>(width), static_cast<int>(height),
                                mrpt::img::TColor(0, 0, 0));
    image.camera = camera(k_width, k_height);
    return Images{{image}};
}

LidarBoards lidar_boards(double value) {
    LidarBoard board;
    board.target = "four_square_holes_500mm";
    board.corners.assign(16, Eigen::Vector3d::Constant(value));
    return LidarBoards{"LIDAR", {board}};
}

ImageBoards image_boards(double value) {
    ImageBoard board;
    board.target = "four_square_holes_500mm";
    board.camera = "CAMERA";
    board.corners.assign(16, Eigen::Vector2d::Constant(value));
    board.covariance.assign(16, Eigen::Matrix2d::Identity());
    return ImageBoards{{CameraInfo{"CAMERA", camera(64, 48)}}, {board}};
}

Correspondences pairs_of(double value, std::size_t count) {
    CameraPairs pairs;
    pairs.camera = "CAMERA";
    pairs.lidar = "LIDAR";
    pairs.model = camera(64, 48);
    PointPair pair;
    pair.lidar.setConstant(value);
    pair.image.setConstant(value);
    pairs.pairs.assign(count, pair);
    return Correspondences{{pairs}};
}

Planes nan_planes() {
    Plane plane;
    plane.normal.setConstant(kNaN);
    plane.offset = kNaN;
    plane.inliers = nan_cloud();
    return Planes{{plane}};
}

/// Packets of every calibration type that a stage must survive: empty, NaN, too few, of the wrong
/// size.
ContractInputs hostile_packets() {
    ContractInputs inputs;
    inputs.add<Cloud>("empty", [] { return Cloud{}; });
    inputs.add<Cloud>("nan", nan_cloud);
    inputs.add<Cloud>("collinear", collinear_cloud);
    inputs.add<Cloud>("single_point", single_point_cloud);
    inputs.add<Images>("empty", [] { return Images{}; });
    inputs.add<Images>("black", [] { return images_of(64, 48, 64, 48); });
    inputs.add<Images>("tiny", [] { return images_of(1, 1, 1, 1); });
    inputs.add<Images>("other_size", [] { return images_of(64, 48, 640, 480); });
    inputs.add<Planes>("empty", [] { return Planes{}; });
    inputs.add<Planes>("nan", nan_planes);
    inputs.add<LidarBoards>("empty", [] { return LidarBoards{}; });
    inputs.add<LidarBoards>("nan", [] { return lidar_boards(kNaN); });
    inputs.add<LidarBoards>("single_point", [] { return lidar_boards(1.0); });
    inputs.add<ImageBoards>("empty", [] { return ImageBoards{}; });
    inputs.add<ImageBoards>("nan", [] { return image_boards(kNaN); });
    inputs.add<ImageBoards>("single_point", [] { return image_boards(1.0); });
    inputs.add<Correspondences>("empty", [] { return Correspondences{}; });
    inputs.add<Correspondences>("nan", [] { return pairs_of(kNaN, 20); });
    inputs.add<Correspondences>("single_point", [] { return pairs_of(1.0, 20); });
    inputs.add<Correspondences>("few", [] { return pairs_of(1.0, 2); });
    inputs.add<Extrinsics>("empty", [] { return Extrinsics{}; });
    inputs.add<Metrics>("empty", [] { return Metrics{}; });
    inputs.add<Truth>("empty", [] { return Truth{}; });
    inputs.add<Observation>("empty",
                            [] { return Observation{mrpt::obs::CObservationComment::Create()}; });
    return inputs;
}

class StageContract : public ::testing::TestWithParam<std::string> {};

TEST_P(StageContract, IsKept) {
    static const ContractInputs inputs = hostile_packets();
    const StageSpec* stage = built_plugins().registry.find(GetParam());
    ASSERT_NE(stage, nullptr);
    for (const Violation& violation : contract_violations(*stage, inputs))
        ADD_FAILURE() << violation.rule << ": " << violation.what;
}

INSTANTIATE_TEST_SUITE_P(AllStages, StageContract, ::testing::ValuesIn(built_types()), test_name);

TEST(StageContracts, AllPluginsOfTheBuildTreeAreLoaded) {
    for (const Refusal& refusal : built_plugins().refused)
        ADD_FAILURE() << refusal.library << ": " << refusal.reason;
    EXPECT_GE(built_types().size(), 13U);
}

}  // namespace
}  // namespace petal::testing
