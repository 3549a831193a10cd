// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "petal/calibration/camera_model.hpp"
#include "plugins/simulation/camera_edges.hpp"
#include "plugins/simulation/camera_worlds.hpp"
#include "simulation/camera/camera_simulation.hpp"

namespace petal::simulation {
namespace {

using petal::testing::BareRun;

/// The camera's frame is the world's: x right, y down, z away.
cv::Mat photo(const World& world, const Light& light, const CameraDevice& camera) {
    return render(world, light, camera, Eigen::Isometry3d::Identity(), BareRun());
}

Light lamp_from(const Eigen::Vector3d& to_lamp) {
    Light light;
    light.to_lamp = to_lamp.normalized();
    return light;
}

World white_wall(double distance) {
    World world;
    add_panel(world, facing({0.0, 0.0, distance}), 99.0, 99.0, grey(1.0F));
    world.build();
    return world;
}

TEST(CameraShading, FollowsLambert) {
    const Eigen::Vector3f albedo(0.8F, 0.4F, 0.2F);  // red, green, blue
    World world;
    add_panel(world, facing({0.0, 0.0, 2.0}), 9.0, 9.0,
              std::make_shared<PlainTexture>(Look{albedo, 0.5F}));
    world.build();
    const CameraDevice camera = plain_camera(32, 24, 40.0);
    // The panel's normal towards the camera is (0, 0, -1).
    struct Case {
        Eigen::Vector3d to_lamp;
        float cosine;
    };
    for (const Case& lamp :
         {Case{{0.0, 0.0, -1.0}, 1.0F}, Case{{0.0, -std::sqrt(3.0), -1.0}, 0.5F},
          Case{{1.0, 0.0, 0.0}, 0.0F}, Case{{0.0, -0.5, 1.0}, 0.0F}}) {  // from behind
        const Light light = lamp_from(lamp.to_lamp);
        const auto pixel = photo(world, light, camera).at<cv::Vec3f>(12, 16);
        const float received = light.ambient + light.lamp * lamp.cosine;
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(pixel[channel], albedo(2 - channel) * received, 1e-6);
    }
}

// A 0.4 m panel 0.8 m before a wall, the lamp from the upper left: its shadow lies to the lower
// right, clear of the panel, and its edges are as exact as those of things.
TEST(CameraShading, ShadowsLieWhereTheLampThrowsThem) {
    const Eigen::Vector3d to_lamp = Eigen::Vector3d(-0.9, -0.5, -1.0).normalized();
    const Eigen::Isometry3d panel = facing({-0.3, -0.2, 2.2}, 10.0, -5.0, 15.0);
    World world;
    // A shadow on a board: elsewhere edges get fewer samples.
    add_panel(world, facing({0.0, 0.0, 3.0}), 99.0, 99.0, grey(0.9F), Kind::board);
    add_panel(world, panel, 0.4, 0.4, grey(0.9F));
    world.build();
    CameraDevice camera = plain_camera(640, 480, 600.0);
    camera.blur_px = 0.6;
    const Light light = lamp_from(to_lamp);
    const cv::Mat image = grey_of(photo(world, light, camera));

    std::vector<Eigen::Vector3d> shadow;
    for (const Eigen::Vector2d& c : centred(0.4, 0.4)) {
        const Eigen::Vector3d corner = panel * Eigen::Vector3d(c.x(), c.y(), 0.0);
        shadow.emplace_back(corner - to_lamp * ((3.0 - corner.z()) / -to_lamp.z()));
    }
    const CameraModel model(camera.intrinsics);
    EdgeMisses misses;
    misses.add_polygon(image, model, shadow);
    EXPECT_LE(misses.worst_side(), 0.02) << misses.told();
    EXPECT_LE(misses.worst_corner(), 0.04) << misses.told();

    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& corner : shadow) middle += corner / 4.0;
    const Eigen::Vector2d at = model.project(middle).value();
    const float dark = image.at<float>(static_cast<int>(at.y()), static_cast<int>(at.x()));
    EXPECT_NEAR(dark, 0.9F * light.ambient, 1e-5);
    const float bright = image.at<float>(470, 10);
    const double lit = light.ambient + light.lamp * -to_lamp.z();
    EXPECT_NEAR(bright, 0.9 * lit, 1e-5);
}

TEST(CameraShading, SkyIsWhereNothingIs) {
    World world;
    add_panel(world, facing({0.0, 2.5, 5.0}), 99.0, 5.0, grey(0.5F));  // the lower half
    world.build();
    Light light = even_light();
    light.sky = {0.1F, 0.2F, 0.3F};
    const cv::Mat image = photo(world, light, plain_camera(40, 40, 40.0));
    EXPECT_EQ(image.at<cv::Vec3f>(5, 20), cv::Vec3f(0.3F, 0.2F, 0.1F));
    EXPECT_EQ(image.at<cv::Vec3f>(35, 20), cv::Vec3f(0.5F, 0.5F, 0.5F));
}

TEST(CameraShading, VignettingTakesItsShareAtTheCorners) {
    CameraDevice camera = plain_camera(201, 151, 150.0);
    camera.vignetting = 0.4;
    camera.blur_px = 0.8;
    const cv::Mat image = grey_of(photo(white_wall(2.0), even_light(), camera));
    const auto cosine4 = [](double x, double y) {
        const double square = 1.0 / (1.0 + (x * x + y * y) / (150.0 * 150.0));
        return square * square;
    };
    const double corner = 1.0 - cosine4(100.0, 75.0);
    for (const int row : {0, 30, 75, 150})
        for (const int column : {0, 50, 100, 180, 200}) {
            const double loss = 0.4 * (1.0 - cosine4(column - 100.0, row - 75.0)) / corner;
            // The blur reaches 1e-4 of the falloff's curvature.
            EXPECT_NEAR(image.at<float>(row, column), 1.0 - loss, 2e-4);
        }
    EXPECT_NEAR(image.at<float>(75, 100), 1.0, 2e-4);
    EXPECT_NEAR(image.at<float>(0, 0), 0.6, 2e-4);
}

// A fisheye's corners see farther off the axis than a pinhole's would: still the share that was
// set.
TEST(CameraShading, VignettingIsTheSameShareForAFisheye) {
    CameraDevice camera = plain_camera(200, 150, 100.0);
    camera.intrinsics.setDistortionKannalaBrandt(-0.02, 0.0, 0.0, 0.0);
    camera.vignetting = 0.3;
    const cv::Mat image = grey_of(photo(white_wall(2.0), even_light(), camera));
    EXPECT_NEAR(image.at<float>(0, 0), 0.7, 1e-4);
    EXPECT_NEAR(image.at<float>(149, 199), 0.7, 1e-4);
}

// A blurred step is the normal distribution function averaged over the pixel, wherever in a pixel
// it lies and however near the image's rim.
TEST(CameraShading, BlurIsThatOfALensBeforeTheSensor) {
    constexpr double kSigma = 0.6;
    for (const double place : {30.0, 30.25, 30.4, 30.5}) {
        World world;
        add_panel(world, facing({0.0, 0.0, 3.0}), 99.0, 99.0, grey(0.0F));
        const double x = (place - 30.0) / 100.0 * 2.0;
        add_panel(world, facing({50.0 + x, 0.0, 2.0}), 100.0, 99.0, grey(1.0F),
                  Kind::board);  // from x on
        world.build();
        CameraDevice camera = plain_camera(61, 41, 100.0);
        camera.blur_px = kSigma;
        const cv::Mat image = grey_of(photo(world, even_light(), camera));
        const auto integral = [&](double t) {  // of the normal distribution function
            return 0.5 * t * std::erfc(-t / kSigma / std::sqrt(2.0)) +
                   kSigma * std::exp(-0.5 * t * t / kSigma / kSigma) / std::sqrt(2.0 * 3.14159265);
        };
        for (const int row : {0, 20, 40})
            for (int column = 25; column < 36; ++column) {
                const double expected =
                    integral(column + 0.5 - place) - integral(column - 0.5 - place);
                // 1/128 px of the edge's place, at 0.6 a pixel; cells of a quarter of a pixel.
                EXPECT_NEAR(image.at<float>(row, column), expected, 0.008)
                    << place << ' ' << column;
            }
    }
}

}  // namespace
}  // namespace petal::simulation
