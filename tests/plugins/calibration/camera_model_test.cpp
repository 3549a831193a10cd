// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/camera_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <random>
#include <vector>

#include "petal/error.hpp"

namespace petal {
namespace {

mrpt::img::TCamera pinhole() {
    mrpt::img::TCamera camera;
    camera.ncols = 640;
    camera.nrows = 540;
    camera.setIntrinsicParamsFromValues(349.8, 349.1, 315.4, 279.0);
    return camera;
}

mrpt::img::TCamera plumb_bob() {
    auto camera = pinhole();
    camera.setDistortionPlumbBob(-0.28, 0.09, 1e-3, -7e-4, -0.01);
    return camera;
}

mrpt::img::TCamera rational() {
    auto camera = plumb_bob();
    camera.k4(0.11);
    camera.k5(-0.03);
    camera.k6(0.004);
    return camera;
}

mrpt::img::TCamera kannala_brandt() {
    auto camera = pinhole();
    camera.setDistortionKannalaBrandt(-0.021, 0.006, -0.004, 0.0009);
    return camera;
}

class EveryModel : public ::testing::TestWithParam<mrpt::img::TCamera (*)()> {};
INSTANTIATE_TEST_SUITE_P(Camera, EveryModel,
                         ::testing::Values(&pinhole, &plumb_bob, &rational, &kannala_brandt));

/// Points up to about 50 deg off the axis, and on it.
std::vector<Eigen::Vector3d> points() {
    std::mt19937_64 rng(5);
    std::uniform_real_distribution<double> side(-1.0, 1.0), depth(0.5, 6.0);
    std::vector<Eigen::Vector3d> result{{0.0, 0.0, 2.0}, {1e-9, 0.0, 1.0}, {1e-4, -2e-4, 1.0}};
    for (int i = 0; i < 200; ++i) {
        const double z = depth(rng);
        result.emplace_back(side(rng) * z, side(rng) * z, z);
    }
    return result;
}

TEST_P(EveryModel, JacobianAgreesWithCentralDifferences) {
    const CameraModel model(GetParam()());
    for (const auto& p : points()) {
        Eigen::Matrix<double, 2, 3> analytic;
        ASSERT_TRUE(model.project(p, &analytic));
        for (Eigen::Index i = 0; i < 3; ++i) {
            const double h = 1e-6;
            const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(i);
            const auto ahead = model.project(p + step), behind = model.project(p - step);
            ASSERT_TRUE(ahead && behind);
            const Eigen::Vector2d numeric = (*ahead - *behind) / (2.0 * h);
            // Pixels of size 500 rounded to 1e-13 over 2e-6 m: 1e-6 px/m and more is noise.
            EXPECT_LT((analytic.col(i) - numeric).norm(), 1e-5 * (1.0 + numeric.norm()))
                << p.transpose();
        }
    }
}

TEST_P(EveryModel, UnprojectInvertsProject) {
    const CameraModel model(GetParam()());
    for (const auto& p : points()) {
        const auto pixel = model.project(p);
        ASSERT_TRUE(pixel);
        const auto direction = model.unproject(*pixel);
        ASSERT_TRUE(direction) << p.transpose();
        EXPECT_LT((*direction - p / p.z()).norm(), 1e-10);
        const auto ideal = model.undistort(*pixel);
        ASSERT_TRUE(ideal);
        const auto again = model.distort(*ideal);
        ASSERT_TRUE(again);
        EXPECT_LT((*again - *pixel).norm(), 1e-8);
    }
}

TEST_P(EveryModel, AgreesWithOpenCv) {
    const auto camera = GetParam()();
    const CameraModel model(camera);
    const cv::Matx33d k(camera.fx(), 0, camera.cx(), 0, camera.fy(), camera.cy(), 0, 0, 1);
    std::vector<cv::Point3d> objects;
    for (const auto& p : points()) objects.emplace_back(p.x(), p.y(), p.z());
    std::vector<cv::Point2d> pixels;
    const cv::Vec3d zero(0, 0, 0);
    if (camera.distortion == mrpt::img::DistortionModel::kannala_brandt) {
        const std::vector<double> d{camera.k1(), camera.k2(), camera.k3(), camera.k4()};
        cv::fisheye::projectPoints(objects, pixels, zero, zero, k, d);
    } else {
        const std::vector<double> d(camera.dist.begin(), camera.dist.end());
        cv::projectPoints(objects, zero, zero, k, d, pixels);
    }
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const auto pixel = model.project(points()[i]);
        ASSERT_TRUE(pixel);
        // OpenCV's fisheye switches to the pinhole below r = 1e-8; otherwise the formulas are the
        // same.
        EXPECT_NEAR(pixel->x(), pixels[i].x, 1e-6);
        EXPECT_NEAR(pixel->y(), pixels[i].y, 1e-6);
    }
}

TEST_P(EveryModel, NothingBehindTheCameraOrNaN) {
    const CameraModel model(GetParam()());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(model.project({0.0, 0.0, -1.0}));
    EXPECT_FALSE(model.project({0.1, 0.0, 0.0}));
    EXPECT_FALSE(model.project({nan, 0.0, 1.0}));
    EXPECT_FALSE(model.project({0.0, 0.0, nan}));
    EXPECT_FALSE(model.unproject({nan, 10.0}));
}

TEST(CameraModel, NothingBeyondTheMonotonicAngle) {
    auto camera = pinhole();
    camera.setDistortionPlumbBob(-0.3, 0.0, 0.0, 0.0);
    const CameraModel model(camera);
    // r (1 - 0.3 r^2) turns back at r = 1 / sqrt(0.9), where it is 0.7027.
    const double turn = 1.0 / std::sqrt(0.9);
    EXPECT_TRUE(model.project({turn - 1e-6, 0.0, 1.0}));
    EXPECT_FALSE(model.project({turn + 1e-6, 0.0, 1.0}));
    EXPECT_FALSE(model.project({0.0, 5.0, 1.0}));
    EXPECT_TRUE(model.unproject({camera.cx() + 0.70 * camera.fx(), camera.cy()}));
    EXPECT_FALSE(model.unproject({camera.cx() + 0.71 * camera.fx(), camera.cy()}));
}

TEST(CameraModel, NothingBeyondAPole) {
    auto camera = pinhole();
    camera.setDistortionPlumbBob(0.0, 0.0, 0.0, 0.0);
    camera.k4(-1.0);  // r / (1 - r^2)
    const CameraModel model(camera);
    EXPECT_TRUE(model.project({0.9, 0.0, 1.0}));
    EXPECT_FALSE(model.project({1.1, 0.0, 1.0}));
}

TEST(CameraModel, RefusesIntrinsicsThatAreNoCamera) {
    auto camera = pinhole();
    camera.fx(0.0);
    EXPECT_THROW(CameraModel{camera}, Error);
    camera = pinhole();
    camera.ncols = 0;
    EXPECT_THROW(CameraModel{camera}, Error);
    camera = pinhole();
    camera.k1(std::numeric_limits<double>::quiet_NaN());
    EXPECT_THROW(CameraModel{camera}, Error);
    EXPECT_THROW(CameraModel{mrpt::img::TCamera()}, Error);
}

}  // namespace
}  // namespace petal
