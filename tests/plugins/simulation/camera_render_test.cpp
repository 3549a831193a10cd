// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>
#include <vector>

#include "petal/calibration/camera_model.hpp"
#include "petal/error.hpp"
#include "plugins/simulation/camera_edges.hpp"
#include "plugins/simulation/camera_worlds.hpp"
#include "simulation/camera/camera_simulation.hpp"
#include "simulation/camera/pixel_rays.hpp"

namespace petal::simulation {
namespace {

using petal::testing::BareRun;

CameraDevice bent_pinhole() {
    CameraDevice camera = plain_camera(1280, 720, 915.0);
    camera.label = "plumb_bob";
    camera.intrinsics.setDistortionPlumbBob(-0.28, 0.09, 1e-3, -7e-4, -0.01);
    return camera;
}

CameraDevice fisheye() {
    CameraDevice camera = plain_camera(1280, 720, 800.0);
    camera.label = "kannala_brandt";
    camera.intrinsics.setDistortionKannalaBrandt(-0.021, 0.006, -0.004, 0.0009);
    return camera;
}

/// As the lens and the sensor of the scenes are.
CameraDevice real_lens(CameraDevice camera) {
    camera.blur_px = 0.6;
    camera.vignetting = 0.25;
    camera.electrons = 8000.0;
    camera.read_noise = 6.0;
    return camera;
}

/// The camera is anywhere in the world; everything else is told in its frame.
Eigen::Isometry3d T_world_camera() {
    return facing({3.0, -2.0, 1.1}, 35.0, -80.0, 12.0);
}

/// Flat and upright, turned, rolled, oblique, and in a corner of the image.
std::vector<Eigen::Isometry3d> board_poses() {
    return {facing({-0.62, -0.33, 2.0}), facing({0.05, -0.4, 2.1}, 32.0, 18.0),
            facing({0.75, -0.42, 2.0}, -10.0, 8.0, 20.0), facing({-0.45, 0.4, 1.8}, 50.0),
            facing({0.5, 0.35, 1.9}, -20.0, -35.0, 45.0)};
}

World boards_before_a_wall(float board, float wall) {
    World world;
    for (const Eigen::Isometry3d& pose : board_poses())
        add_board(world, T_world_camera() * pose, grey(board));
    add_panel(world, T_world_camera() * facing({0.0, 0.0, 4.0}, 5.0), 12.0, 12.0, grey(wall));
    world.build();
    return world;
}

/// Misses of all sides of all holes, of one channel of an image.
EdgeMisses misses_of(const cv::Mat& image, const CameraDevice& camera) {
    const CameraModel model(camera.intrinsics);
    EdgeMisses misses;
    for (const Eigen::Isometry3d& pose : board_poses())
        for (const PlanarSurface::Polygon& hole : four_holes()) {
            std::vector<Eigen::Vector3d> corners;
            for (const Eigen::Vector2d& c : hole)
                corners.push_back(pose * Eigen::Vector3d(c.x(), c.y(), 0.0));
            misses.add_polygon(image, model, corners);
        }
    return misses;
}

struct Contrast {
    CameraDevice camera;
    float board, wall;
};

class RenderedEdges : public ::testing::TestWithParam<Contrast> {};
INSTANTIATE_TEST_SUITE_P(
    Camera, RenderedEdges,
    ::testing::Values(Contrast{bent_pinhole(), 0.85F, 0.1F}, Contrast{bent_pinhole(), 0.15F, 0.7F},
                      Contrast{fisheye(), 0.85F, 0.1F}, Contrast{fisheye(), 0.15F, 0.7F}),
    [](const auto& test) {
        return test.param.camera.label +
               (test.param.board > test.param.wall ? "_dark_in_bright" : "_bright_in_dark");
    });

// Without lens and noise what is left is the sampling: a row of a side is met to about 0.02 px (64
// places in a pixel), and a side has some twenty rows. The corners are extrapolated.
TEST_P(RenderedEdges, LieWhereTheTrueOnesProject) {
    const auto [camera, board, wall] = GetParam();
    const World world = boards_before_a_wall(board, wall);
    const cv::Mat image = render(world, even_light(), camera, T_world_camera(), BareRun());
    const EdgeMisses misses = misses_of(grey_of(image), camera);
    ASSERT_EQ(misses.sides.size(), 80U);
    std::puts(misses.told().c_str());
    EXPECT_LE(misses.mean_side(), 0.004);
    EXPECT_LE(misses.worst_side(), 0.015);
    EXPECT_LE(misses.worst_corner(), 0.04);
}

// Noise of 1.5 of 150 levels makes 0.035 px of a row, 0.007 px of a side and, extrapolated, 0.025
// px of a corner; the worst of 80 lies at three times that.
TEST_P(RenderedEdges, LieThereThroughLensAndNoiseToo) {
    const auto [plain, board, wall] = GetParam();
    const CameraDevice camera = real_lens(plain);
    const World world = boards_before_a_wall(board, wall);
    const cv::Mat radiance = render(world, even_light(), camera, T_world_camera(), BareRun());
    cv::Mat image;
    expose(radiance, camera, 11).convertTo(image, CV_32F);
    const EdgeMisses misses = misses_of(grey_of(image), camera);
    ASSERT_EQ(misses.sides.size(), 80U);
    std::puts(misses.told().c_str());
    EXPECT_LE(misses.mean_side(), 0.015);
    EXPECT_LE(misses.worst_side(), 0.05);
    EXPECT_LE(misses.worst_corner(), 0.1);
}

// The wall of a hole in a 5 mm board at 2 m, turned by 40 deg: 1.5 px wide, and white between
// black. The light of a row tells its width whatever the rows' phases; upright, and rolled by 7
// deg.
TEST(CameraRender, ThinWallsHaveTheirWidth) {
    for (const double roll_deg : {0.0, 7.0}) {
        const CameraDevice camera = plain_camera(160, 120, 915.0);
        const Eigen::Isometry3d pose = facing({0.0, 0.0, 2.0}, 40.0, 0.0, roll_deg);
        World world;
        add_panel(world, facing({0.0, 0.0, 3.0}), 9.0, 9.0, grey(0.0F));
        world.add(std::make_unique<PlanarSurface>(
            pose, PlanarSurface::Shape{centred(0.5, 0.5), {centred(0.1, 0.1)}, {}}, grey(0.0F),
            Kind::board));
        // Walls from z = 0 to 0.005. Turned as it is, the board hides the one at x = 0.05.
        for (const double x : {-0.05, 0.05}) {
            Eigen::Isometry3d wall = pose;
            wall.translate(Eigen::Vector3d(x, -0.05, 0.0));
            wall.rotate(Eigen::AngleAxisd(-0.5 * 3.14159265358979, Eigen::Vector3d::UnitY()));
            world.add(std::make_unique<PlanarSurface>(wall, PlanarSurface::rectangle(0.005, 0.1),
                                                      grey(1.0F), Kind::board));
        }
        world.build();
        const cv::Mat image =
            grey_of(render(world, even_light(), camera, Eigen::Isometry3d::Identity(), BareRun()));
        const CameraModel model(camera.intrinsics);
        const auto width_at = [&](double x, double row) {
            const auto crossing = [&](double z) {
                const Eigen::Vector2d a =
                    model.project(pose * Eigen::Vector3d(x, -0.05, z)).value();
                const Eigen::Vector2d b = model.project(pose * Eigen::Vector3d(x, 0.05, z)).value();
                return a.x() + (b.x() - a.x()) * (row - a.y()) / (b.y() - a.y());
            };
            return std::abs(crossing(0.005) - crossing(0.0));
        };
        double worst = 0.0, sum = 0.0;
        int rows = 0;
        for (int row = 50; row <= 70; ++row, ++rows) {
            const double truth = width_at(-0.05, row);
            ASSERT_GT(truth, 0.8);
            ASSERT_LT(truth, 3.0);
            const double miss = cv::sum(image.row(row))[0] - truth;
            worst = std::max(worst, std::abs(miss));
            sum += miss;
        }
        EXPECT_LE(worst, 0.05) << roll_deg;  // two edges of 0.02 px
        EXPECT_LE(std::abs(sum / rows), 0.01) << roll_deg;
    }
}

class Rays : public ::testing::TestWithParam<CameraDevice> {};
INSTANTIATE_TEST_SUITE_P(
    Camera, Rays, ::testing::Values(plain_camera(640, 480, 350.0), bent_pinhole(), fisheye()),
    [](const auto& test) { return test.param.label == "CAMERA" ? "pinhole" : test.param.label; });

// Interpolated between the pixels' corners: bent by less than 0.0005 px even beyond the image's
// rim.
TEST_P(Rays, ProjectToWhereTheyStarted) {
    const CameraModel model(GetParam().intrinsics);
    constexpr int kMargin = 3;
    const PixelRays rays(model, kMargin, BareRun());
    EXPECT_EQ(rays.columns(), static_cast<int>(model.camera().ncols) + 2 * kMargin);
    double worst = 0.0;
    for (int row = 0; row < rays.rows(); row += 7)
        for (int column = 0; column < rays.columns(); column += 5) {
            ASSERT_TRUE(rays.exists(column, row));
            const double right = 0.1 * (column % 11), down = 0.1 * (row % 11);
            const auto at = model.project(rays.inside(column, row, right, down));
            const Eigen::Vector2d start(column - kMargin - 0.5 + right, row - kMargin - 0.5 + down);
            worst = std::max(worst, (at.value() - start).norm());
        }
    EXPECT_LE(worst, 5e-4);
}

// A strong barrel ends before the image's corners do: they stay black, and nothing throws.
TEST(CameraRender, PixelsBeyondTheModelAreBlack) {
    CameraDevice camera = plain_camera(320, 240, 200.0);
    camera.intrinsics.setDistortionPlumbBob(-0.5, 0.0, 0.0, 0.0, 0.0);
    World world;
    add_panel(world, facing({0.0, 0.0, 1.0}), 99.0, 99.0, grey(0.5F));
    world.build();
    const cv::Mat image =
        render(world, even_light(), camera, Eigen::Isometry3d::Identity(), BareRun());
    const CameraModel model(camera.intrinsics);
    int black = 0;
    for (int row = 0; row < image.rows; row += 3)
        for (int column = 0; column < image.cols; column += 3) {
            // Off the rim by a pixel, where only some of the corners are inside.
            const Eigen::Vector2d out =
                Eigen::Vector2d(column - model.cx(), row - model.cy()).normalized();
            const Eigen::Vector2d p(column, row);
            const bool inside = model.unproject(p + out).has_value();
            if (inside != model.unproject(p - out).has_value()) continue;
            black += inside ? 0 : 1;
            EXPECT_FLOAT_EQ(image.at<cv::Vec3f>(row, column)[1], inside ? 0.5F : 0.0F) << p;
        }
    EXPECT_GT(black, 100);
}

TEST(CameraRender, IsTheSameForAnyNumberOfThreads) {
    const CameraDevice camera = real_lens(plain_camera(480, 270, 343.0));
    const World world = boards_before_a_wall(0.8F, 0.3F);
    const cv::Mat one = render(world, Light{}, camera, T_world_camera(), BareRun(1));
    const cv::Mat four = render(world, Light{}, camera, T_world_camera(), BareRun(4));
    EXPECT_EQ(cv::norm(one, four, cv::NORM_INF), 0.0);
}

TEST(CameraRender, StopsWhenCancelled) {
    World world;
    world.build();
    EXPECT_THROW(render(world, Light{}, plain_camera(64, 48, 50.0), Eigen::Isometry3d::Identity(),
                        BareRun(2, true)),
                 Cancelled);
}

}  // namespace
}  // namespace petal::simulation
