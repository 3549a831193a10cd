// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "plugins/simulation/camera_worlds.hpp"
#include "simulation/camera/camera_simulation.hpp"

namespace petal::simulation {
namespace {

CameraDevice noisy_camera() {
    CameraDevice camera;
    camera.electrons = 4000.0;
    camera.read_noise = 12.0;
    return camera;
}

cv::Mat flat(float radiance) {
    return {300, 400, CV_32FC3, cv::Scalar::all(static_cast<double>(radiance))};
}

struct Statistics {
    double mean, variance;
};

Statistics statistics(const cv::Mat& image) {
    cv::Mat values;
    image.reshape(1).convertTo(values, CV_64F);
    const double mean = cv::mean(values)[0];
    values -= mean;
    return {mean, cv::mean(values.mul(values))[0]};
}

// 360 000 values tell a variance to 0.24 %, and the noise is wide enough (1 to 4 levels) for
// rounding to be uniform. At 0.05 values below zero are ten sigma away.
TEST(CameraNoise, VarianceFollowsShotAndReadNoise) {
    const CameraDevice camera = noisy_camera();
    for (const float radiance : {0.05F, 0.2F, 0.5F, 0.8F}) {
        const Statistics seen = statistics(expose(flat(radiance), camera, 3));
        const double electrons = static_cast<double>(radiance) * camera.electrons;
        const double level = 255.0 / camera.electrons;
        const double expected = level * level * (electrons + 12.0 * 12.0) + 1.0 / 12.0;
        EXPECT_NEAR(seen.mean, electrons * level, 0.03) << radiance;
        EXPECT_NEAR(seen.variance, expected, 0.015 * expected) << radiance;
    }
}

TEST(CameraNoise, ExposureScalesAndLowLightIsNoisier) {
    CameraDevice camera = noisy_camera();
    const Statistics bright = statistics(expose(flat(0.8F), camera, 3));
    camera.exposure = 0.1;
    const Statistics low = statistics(expose(flat(0.8F), camera, 3));
    EXPECT_NEAR(low.mean, 0.1 * bright.mean, 0.05);
    // sqrt(3200) / 3200 against sqrt(320 + 144) / 320.
    EXPECT_GT(std::sqrt(low.variance) / low.mean, 3.0 * std::sqrt(bright.variance) / bright.mean);
}

TEST(CameraNoise, ClipsAtBothEnds) {
    const CameraDevice camera = noisy_camera();
    const cv::Mat over = expose(flat(1.5F), camera, 3);
    EXPECT_EQ(cv::countNonZero(over.reshape(1) == 255), 3 * 300 * 400);
    // Half of the read noise lies below zero, and most of the rest below half a level.
    const cv::Mat dark = expose(flat(0.0F), camera, 3);
    const double share = cv::countNonZero(dark.reshape(1)) / (3.0 * 300.0 * 400.0);
    // A level is 15.7 electrons: beyond half of one lie 25.7 % of 12 electrons' noise.
    EXPECT_NEAR(share, 0.257, 0.01);
}

TEST(CameraNoise, WithoutNoiseLevelsAreRounded) {
    const CameraDevice camera = plain_camera(8, 8, 10.0);
    for (const int level : {0, 1, 77, 254, 255}) {
        const float radiance = (static_cast<float>(level) + 0.3F) / 255.0F;
        const cv::Mat image = expose(flat(radiance), camera, 1);
        EXPECT_EQ(cv::countNonZero(image.reshape(1) == level), 3 * 300 * 400) << level;
    }
}

TEST(CameraNoise, IsIndependentFromValueToValue) {
    cv::Mat noise;
    expose(flat(0.5F), noisy_camera(), 3).reshape(1).convertTo(noise, CV_64F);
    noise -= cv::mean(noise)[0];
    const double variance = cv::mean(noise.mul(noise))[0];
    const auto correlation = [&](int right, int down) {
        const cv::Size size(noise.cols - right, noise.rows - down);
        const cv::Mat a = noise(cv::Rect({0, 0}, size));
        const cv::Mat b = noise(cv::Rect({right, down}, size));
        return cv::mean(a.mul(b))[0] / variance;
    };
    // One sigma of a correlation of 360 000 values is 0.0017. Channels lie side by side.
    for (const auto& [right, down] : {std::pair{1, 0}, {2, 0}, {3, 0}, {0, 1}, {1, 1}, {0, 2}})
        EXPECT_LT(std::abs(correlation(right, down)), 0.008) << right << ' ' << down;
}

TEST(CameraNoise, SameSeedSameBytes) {
    const CameraDevice camera = noisy_camera();
    const cv::Mat light = flat(0.4F);
    cv::Mat one, four;
    tbb::task_arena(1).execute([&] { one = expose(light, camera, 3); });
    tbb::task_arena(4).execute([&] { four = expose(light, camera, 3); });
    EXPECT_EQ(cv::norm(one, four, cv::NORM_INF), 0.0);
    const cv::Mat other = expose(light, camera, 4);
    cv::Mat differs;
    cv::compare(one.reshape(1), other.reshape(1), differs, cv::CMP_NE);
    // The noise is 2.7 levels wide: one value in ten is alike by chance.
    EXPECT_GT(cv::countNonZero(differs), 3 * 300 * 400 * 8 / 10);
}

TEST(CameraNoise, GreyIsTheLumaOfTheThree) {
    CameraDevice camera = plain_camera(8, 8, 10.0);
    const cv::Mat light(4, 6, CV_32FC3, cv::Scalar(0.2, 0.6, 0.4));  // blue, green, red
    const cv::Mat colour = expose(light, camera, 1);
    ASSERT_EQ(colour.type(), CV_8UC3);
    EXPECT_EQ(colour.at<cv::Vec3b>(2, 3), cv::Vec3b(51, 153, 102));
    camera.colour = false;
    const cv::Mat grey_image = expose(light, camera, 1);
    ASSERT_EQ(grey_image.type(), CV_8UC1);
    EXPECT_EQ(grey_image.size(), light.size());
    // 255 * (0.114 * 0.2 + 0.587 * 0.6 + 0.299 * 0.4) = 126.1
    EXPECT_EQ(grey_image.at<unsigned char>(2, 3), 126);
}

}  // namespace
}  // namespace petal::simulation
