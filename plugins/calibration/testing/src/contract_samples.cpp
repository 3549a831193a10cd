// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/testing/contract_samples.hpp"

#include <mrpt/obs/CObservationComment.h>

#include <cmath>
#include <limits>
#include <vector>

#include "packet_content.hpp"
#include "petal/calibration/boards.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/observation.hpp"
#include "petal/calibration/planes.hpp"
#include "petal/calibration/truth.hpp"

namespace petal::testing {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
const char* const kTarget = "four_square_holes_500mm";

// --- typical: a board of 0.5 m, 2 m in front of a LiDAR whose x points forward, and of a camera in
// the same place.

Eigen::Isometry3d camera_of_lidar() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    return T;
}

/// Upper left front corner of the board; x right, y down, z into the board.
Eigen::Isometry3d board_pose() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    T.translation() << 2.0, 0.25, 0.25;
    return T;
}

bool in_a_hole(double x, double y) {
    const auto inside = [](double c) { return (c > 0.1 && c < 0.2) || (c > 0.3 && c < 0.4); };
    return inside(x) && inside(y);
}

std::vector<Eigen::Vector3d> board_corners() {
    std::vector<Eigen::Vector3d> corners;
    for (const double y : {0.1, 0.2, 0.3, 0.4})
        for (const double x : {0.1, 0.2, 0.3, 0.4})
            corners.push_back(board_pose() * Eigen::Vector3d(x, y, 0.0));
    return corners;
}

mrpt::img::TCamera camera(unsigned width, unsigned height) {
    mrpt::img::TCamera k;
    k.ncols = width;
    k.nrows = height;
    k.setIntrinsicParamsFromValues(width, width, width / 2.0, height / 2.0);
    return k;
}

constexpr unsigned kWidth = 320;
constexpr unsigned kHeight = 240;

Eigen::Vector2d pixel_of(const Eigen::Vector3d& lidar) {
    const Eigen::Vector3d p = camera_of_lidar() * lidar;
    return {kWidth * p.x() / p.z() + kWidth / 2.0, kWidth * p.y() / p.z() + kHeight / 2.0};
}

Cloud cloud_of(const std::vector<Eigen::Vector3d>& points) {
    auto map = std::make_shared<mrpt::maps::CPointsMapXYZI>();
    for (const auto& p : points)
        map->insertPointFast(static_cast<float>(p.x()), static_cast<float>(p.y()),
                             static_cast<float>(p.z()));
    Cloud cloud;
    cloud.points = map;
    return cloud;
}

Cloud board_cloud() {
    std::vector<Eigen::Vector3d> points;
    for (double y = 0.002; y < 0.5; y += 0.008)
        for (double x = 0.002; x < 0.5; x += 0.008)
            points.push_back(board_pose() * Eigen::Vector3d(x, y, in_a_hole(x, y) ? 1.0 : 0.0));
    return cloud_of(points);
}

Images board_images() {
    CameraImage photo;
    photo.image = mrpt::img::CImage(kWidth, kHeight, mrpt::img::CH_GRAY);
    photo.camera = camera(kWidth, kHeight);
    for (unsigned v = 0; v < kHeight; ++v) {
        for (unsigned u = 0; u < kWidth; ++u) {
            const double x = 2.0 * (u - kWidth / 2.0) / kWidth + 0.25;
            const double y = 2.0 * (v - kHeight / 2.0) / kWidth + 0.25;
            const bool white = x > 0 && x < 0.5 && y > 0 && y < 0.5 && !in_a_hole(x, y);
            photo.image.at<std::uint8_t>(u, v) = white ? 230 : 30;
        }
    }
    return Images{{photo}};
}

LidarBoards lidar_boards(const std::vector<Eigen::Vector3d>& corners) {
    LidarBoard board;
    board.target = kTarget;
    board.T_lidar_board = board_pose();
    board.corners = corners;
    board.covariance = 1e-6 * Matrix6d::Identity();
    return LidarBoards{"LIDAR", {board}};
}

ImageBoards image_boards(const std::vector<Eigen::Vector2d>& corners) {
    ImageBoard board;
    board.target = kTarget;
    board.camera = "CAMERA";
    board.corners = corners;
    board.covariance.assign(corners.size(), 0.01 * Eigen::Matrix2d::Identity());
    return ImageBoards{{CameraInfo{"CAMERA", camera(kWidth, kHeight)}}, {board}};
}

std::vector<Eigen::Vector2d> board_pixels() {
    std::vector<Eigen::Vector2d> pixels;
    for (const Eigen::Vector3d& corner : board_corners()) pixels.push_back(pixel_of(corner));
    return pixels;
}

Correspondences pairs_of(const std::vector<Eigen::Vector3d>& lidar,
                         const std::vector<Eigen::Vector2d>& image, int board) {
    CameraPairs pairs;
    pairs.scene_name = "scene";
    pairs.camera = "CAMERA";
    pairs.lidar = "LIDAR";
    pairs.model = camera(kWidth, kHeight);
    for (std::size_t i = 0; i < lidar.size(); ++i) {
        PointPair pair;
        pair.lidar = lidar[i];
        pair.image = image[i];
        pair.board = board;
        pair.corner = board < 0 ? -1 : static_cast<int>(i);
        pairs.pairs.push_back(pair);
    }
    if (board >= 0) {
        pairs.order.by = DecidedBy::given;
        pairs.initial = {camera_of_lidar()};
        CameraPairs::BoardPair& both = pairs.boards.emplace_back();
        both.lidar = both.image = 0;
        both.T_lidar_board = board_pose();
        both.pose_covariance = 1e-6 * Matrix6d::Identity();
        for (const Eigen::Vector3d& corner : lidar)
            both.corners_board.push_back(board_pose().inverse() * corner);
        both.corners_image = image;
        both.image_covariance =
            0.01 * Eigen::MatrixXd::Identity(2 * static_cast<Eigen::Index>(image.size()),
                                             2 * static_cast<Eigen::Index>(image.size()));
    }
    return Correspondences{{pairs}};
}

Correspondences same_pairs(double value, std::size_t count) {
    return pairs_of(std::vector<Eigen::Vector3d>(count, Eigen::Vector3d::Constant(value)),
                    std::vector<Eigen::Vector2d>(count, Eigen::Vector2d::Constant(value)), -1);
}

Planes plane_of(const Eigen::Vector3d& normal, double offset, Cloud inliers) {
    Plane plane;
    plane.normal = normal;
    plane.offset = offset;
    plane.inliers = std::move(inliers);
    return Planes{{plane}};
}

Extrinsics extrinsics_of(const Eigen::Isometry3d& T, double error) {
    CameraExtrinsics solved;
    solved.camera = "CAMERA";
    solved.lidar = "LIDAR";
    solved.model = camera(kWidth, kHeight);
    solved.T_camera_lidar = T;
    solved.covariance = 1e-6 * Matrix6d::Identity();
    for (const Eigen::Vector2d& pixel : board_pixels())
        solved.residuals.push_back(
            {0, 0, static_cast<int>(solved.residuals.size()), pixel, {error, error}});
    return Extrinsics{{solved}, Level::weak, {"one scene only"}};
}

Truth board_truth() {
    Truth truth;
    truth.T_camera_lidar = camera_of_lidar();
    truth.boards.push_back({kTarget, board_pose(), board_corners(), board_pixels()});
    const Cloud cloud = board_cloud();
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        float x = 0.0F, y = 0.0F, z = 0.0F;
        cloud.points->getPoint(i, x, y, z);
        truth.labels.push_back(x < 2.5F ? 1 : 0);  // the board, and what is seen through its holes
    }
    return truth;
}

// --- hostile

Eigen::Isometry3d nan_pose() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation().setConstant(kNaN);
    return T;
}

Cloud nan_cloud() {
    std::vector<Eigen::Vector3d> points(50, Eigen::Vector3d(kNaN, 1.0, 2.0));
    points.emplace_back(kInf, 0.0, 0.0);
    return cloud_of(points);
}

Cloud collinear_cloud() {
    std::vector<Eigen::Vector3d> points;
    points.reserve(200);
    for (int i = 0; i < 200; ++i) points.emplace_back(2.0, 0.01 * i, 0.0);
    return cloud_of(points);
}

Images black_images(unsigned width, unsigned height, unsigned k_width, unsigned k_height) {
    CameraImage image;
    image.image = mrpt::img::CImage(width, height, mrpt::img::CH_GRAY);
    image.image.filledRectangle(0, 0, static_cast<int>(width), static_cast<int>(height),
                                mrpt::img::TColor(0, 0, 0));
    image.camera = camera(k_width, k_height);
    return Images{{image}};
}

template <class Point>
std::vector<Point> sixteen(double value) {
    return std::vector<Point>(16, Point::Constant(value));
}

void add_sensor_data(ContractInputs& inputs) {
    inputs.add<Cloud>("empty", [] { return Cloud{}; });
    inputs.add<Cloud>("typical", board_cloud);
    inputs.add<Cloud>("nan", nan_cloud);
    inputs.add<Cloud>("collinear", collinear_cloud);
    inputs.add<Cloud>("single_point", [] {
        return cloud_of(std::vector<Eigen::Vector3d>(300, Eigen::Vector3d(2.0, 0.0, 0.0)));
    });
    inputs.add<Images>("empty", [] { return Images{}; });
    inputs.add<Images>("typical", board_images);
    inputs.add<Images>("black", [] { return black_images(64, 48, 64, 48); });
    inputs.add<Images>("tiny", [] { return black_images(1, 1, 1, 1); });
    inputs.add<Images>("other_size", [] { return black_images(64, 48, 640, 480); });
    const auto comment = [] { return Observation{mrpt::obs::CObservationComment::Create()}; };
    inputs.add<Observation>("empty", comment);
    inputs.add<Observation>("typical", comment);
}

void add_features(ContractInputs& inputs) {
    inputs.add<Planes>("empty", [] { return Planes{}; });
    inputs.add<Planes>("typical",
                       [] { return plane_of(-Eigen::Vector3d::UnitX(), 2.0, board_cloud()); });
    inputs.add<Planes>("nan",
                       [] { return plane_of(Eigen::Vector3d::Constant(kNaN), kNaN, nan_cloud()); });
    inputs.add<LidarBoards>("empty", [] { return LidarBoards{}; });
    inputs.add<LidarBoards>("typical", [] { return lidar_boards(board_corners()); });
    inputs.add<LidarBoards>("nan", [] { return lidar_boards(sixteen<Eigen::Vector3d>(kNaN)); });
    inputs.add<LidarBoards>("single_point",
                            [] { return lidar_boards(sixteen<Eigen::Vector3d>(1.0)); });
    inputs.add<ImageBoards>("empty", [] { return ImageBoards{}; });
    inputs.add<ImageBoards>("typical", [] { return image_boards(board_pixels()); });
    inputs.add<ImageBoards>("nan", [] { return image_boards(sixteen<Eigen::Vector2d>(kNaN)); });
    inputs.add<ImageBoards>("single_point",
                            [] { return image_boards(sixteen<Eigen::Vector2d>(1.0)); });
}

void add_results(ContractInputs& inputs) {
    inputs.add<Correspondences>("empty", [] { return Correspondences{}; });
    inputs.add<Correspondences>("typical",
                                [] { return pairs_of(board_corners(), board_pixels(), 0); });
    inputs.add<Correspondences>("nan", [] { return same_pairs(kNaN, 20); });
    inputs.add<Correspondences>("single_point", [] { return same_pairs(1.0, 20); });
    inputs.add<Correspondences>("few", [] { return same_pairs(1.0, 2); });
    inputs.add<Extrinsics>("empty", [] { return Extrinsics{}; });
    inputs.add<Extrinsics>("typical", [] { return extrinsics_of(camera_of_lidar(), 0.1); });
    inputs.add<Extrinsics>("nan", [] { return extrinsics_of(nan_pose(), kNaN); });
    inputs.add<Metrics>("empty", [] { return Metrics{}; });
    inputs.add<Metrics>("typical", [] { return Metrics{{{"some.rms_px", 0.5, "px", ""}}}; });
    inputs.add<Metrics>("nan", [] { return Metrics{{{"some.rms_px", kNaN, "px", ""}}}; });
    inputs.add<Truth>("empty", [] { return Truth{}; });
    inputs.add<Truth>("typical", board_truth);
}

}  // namespace

ContractInputs calibration_samples() {
    ContractInputs inputs;
    add_sensor_data(inputs);
    add_features(inputs);
    add_results(inputs);
    add_calibration_contents(inputs);
    return inputs;
}

}  // namespace petal::testing
