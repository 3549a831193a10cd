// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/lidar/lidar_simulation.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "plugins/simulation/camera_worlds.hpp"
#include "plugins/simulation/lidar_worlds.hpp"

namespace petal::simulation {
namespace {

using petal::testing::BareRun;

constexpr double kLidarDegree = 3.14159265358979323846 / 180.0;

std::vector<LidarMessage> shoot(const World& world, const LidarDevice& device, double duration,
                                std::uint64_t seed = 7, int threads = 2) {
    return simulate_lidar(world, device, Motion{}, duration, seed, BareRun(threads));
}

std::size_t count_of(const std::vector<LidarMessage>& messages, std::uint8_t label) {
    std::size_t count = 0;
    for (const LidarMessage& m : messages)
        count += static_cast<std::size_t>(std::count(m.label.begin(), m.label.end(), label));
    return count;
}

struct Spread {
    double mean = 0.0, sigma = 0.0;
    double count = 0.0;
};

Spread spread_of(const std::vector<double>& values) {
    Spread s;
    s.count = static_cast<double>(values.size());
    for (const double v : values) s.mean += v / s.count;
    for (const double v : values) s.sigma += (v - s.mean) * (v - s.mean) / s.count;
    s.sigma = std::sqrt(s.sigma);
    return s;
}

TEST(LidarSimulation, SendsMessagesOfATenthOfASecond) {
    World world;
    add_wall(world, 5.0, 100.0, 0.5F);
    world.build();
    const auto messages = shoot(world, exact_lidar("livox_mid70"), 0.25);
    ASSERT_EQ(messages.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        const LidarMessage& m = messages[i];
        EXPECT_NEAR(m.stamp, 0.1 * static_cast<double>(i), 1e-12);
        EXPECT_EQ(m.x.size(), i < 2 ? 10000U : 5000U);
        for (const std::size_t size : {m.y.size(), m.z.size(), m.intensity.size(), m.label.size()})
            EXPECT_EQ(size, m.x.size());
    }
    EXPECT_TRUE(shoot(world, exact_lidar("livox_mid70"), 0.0).empty());
    EXPECT_EQ(shoot(world, exact_lidar("livox_avia"), 0.3).size(), 3U) << "0.3 is not 3 times 0.1";
}

TEST(LidarSimulation, NothingComesBackFromTheSky) {
    World empty;
    empty.build();
    const auto nothing = shoot(empty, exact_lidar("livox_mid360"), 0.1);
    ASSERT_EQ(nothing.size(), 1U);
    EXPECT_TRUE(nothing[0].x.empty());

    World ground;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Eigen::Vector3d(-20.0, -20.0, -1.0);
    ground.add(std::make_unique<PlanarSurface>(pose, PlanarSurface::rectangle(40.0, 40.0),
                                               reflecting(0.3F), Kind::background));
    ground.build();
    const Eigen::Matrix3Xd points = points_of(shoot(ground, exact_lidar("spinning_32"), 0.1));
    // 14 of the 32 rings look down by 3 to 16 deg and meet it within 19.1 m; at 2 deg it would
    // be 28.6 m, beyond the square's corners.
    EXPECT_EQ(points.cols(), 60000 * 14 / 32);
    EXPECT_NEAR(points.row(2).minCoeff(), -1.0, 1e-3);
    EXPECT_NEAR(points.row(2).maxCoeff(), -1.0, 1e-3);
}

TEST(LidarSimulation, APlaneIsOffByTheOffsetAndTheNoise) {
    World world;
    add_wall(world, 5.0, 100.0, 0.8F);
    world.build();
    LidarDevice device;
    device.profile = load_lidar_profile("livox_mid70");
    device.range_offset = 0.004;
    const Eigen::Matrix3Xd points = points_of(shoot(world, device, 0.5));
    std::vector<double> residuals;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const double range = points.col(i).norm();
        const double slant = points(0, i) / range;
        if (slant > std::cos(5.0 * kLidarDegree)) residuals.push_back(range - 5.0 / slant);
    }
    const Spread spread = spread_of(residuals);
    ASSERT_GT(spread.count, 1000.0);
    const double noise = device.profile.range_noise(0.8 / 25.0);
    // Four sigma of a mean and of a standard deviation of so many.
    EXPECT_NEAR(spread.mean, 0.004, 4.0 * noise / std::sqrt(spread.count));
    EXPECT_NEAR(spread.sigma, noise, 4.0 * noise / std::sqrt(2.0 * spread.count) + 1e-4);
}

TEST(LidarSimulation, TheDirectionIsOffByTheAngularNoise) {
    World world;
    add_wall(world, 5.0, 100.0, 0.8F);
    world.build();
    LidarDevice device = exact_lidar("livox_mid70");
    const Eigen::Matrix3Xd exact = points_of(shoot(world, device, 0.2));
    device.profile.angular_noise = 0.03 * kLidarDegree;
    const Eigen::Matrix3Xd noisy = points_of(shoot(world, device, 0.2));
    ASSERT_EQ(exact.cols(), noisy.cols());
    std::vector<double> up, aside;
    for (Eigen::Index i = 0; i < exact.cols(); ++i) {
        EXPECT_NEAR(exact.col(i).norm(), noisy.col(i).norm(), 1e-5);  // of floats
        const Eigen::Vector3d d = exact.col(i).normalized();
        const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(d).normalized();
        const Eigen::Vector3d change = noisy.col(i).normalized() - d;
        aside.push_back(left.dot(change) / kLidarDegree);
        up.push_back(d.cross(left).dot(change) / kLidarDegree);
    }
    // Of 20000: 0.5 % is one sigma of a standard deviation.
    EXPECT_NEAR(spread_of(up).sigma, 0.03, 0.0007);
    EXPECT_NEAR(spread_of(aside).sigma, 0.03, 0.0007);
    EXPECT_NEAR(spread_of(up).mean, 0.0, 0.001);
    EXPECT_NEAR(spread_of(aside).mean, 0.0, 0.001);
}

TEST(LidarSimulation, ADirectionErrorGrowsWithTheAngleOffTheAxis) {
    World world;
    add_wall(world, 5.0, 100.0, 0.8F);
    world.build();
    LidarDevice device = exact_lidar("livox_mid70");
    const Eigen::Matrix3Xd exact = points_of(shoot(world, device, 0.1));
    device.direction_error_deg = 0.5;
    const Eigen::Matrix3Xd wrong = points_of(shoot(world, device, 0.1));
    ASSERT_EQ(exact.cols(), wrong.cols());
    const auto angle_deg = [](const Eigen::Vector3d& p) {
        return std::atan2(p.tail<2>().norm(), p.x()) / kLidarDegree;
    };
    for (Eigen::Index i = 0; i < exact.cols(); ++i)
        EXPECT_NEAR(angle_deg(wrong.col(i)), angle_deg(exact.col(i)) * (1.0 + 0.5 / 35.2), 1e-4);
}

TEST(LidarSimulation, LabelsFollowTheGeometry) {
    constexpr double kBoard = 5.0, kWall = 5.5;
    World world;
    add_four_holes(world, kBoard, 0.8F);
    add_wall(world, kWall, 60.0, 0.5F);
    world.build();
    LidarDevice device = exact_lidar("livox_mid70");
    const auto messages = shoot(world, device, 2.0);
    const double board = static_cast<double>(count_of(messages, 1));
    const double vacant = static_cast<double>(count_of(messages, 2));
    EXPECT_EQ(count_of(messages, 3), 0U);
    // Edges of 3.6 m, half of them lying: a band of 24 mm (the beam's height) along these, of 2.6
    // mm along the others; of that, the part in which the blend is over 2 cm from both. The board
    // has 0.21 m2.
    EXPECT_GT(vacant / board, 0.02);
    EXPECT_LT(vacant / board, 0.25);
    for (const LidarMessage& m : messages)
        for (std::size_t i = 0; i < m.x.size(); ++i) {
            const Eigen::Vector3d p(m.x[i], m.y[i], m.z[i]);
            // Along the beam; 1 mm for what the surfaces slant within a footprint.
            const double along = p.norm() / p.x();
            const double to_board = std::abs(p.x() - kBoard) * along;
            const double to_wall = std::abs(p.x() - kWall) * along;
            if (m.label[i] == 0) {
                EXPECT_LE(to_wall, 0.021);
            }
            if (m.label[i] == 1) {
                EXPECT_LE(to_board, 0.021);
                // Half a footprint outside of the board's rim at most.
                EXPECT_LE(std::abs(p.y()), 0.25 + 0.0015);
                EXPECT_LE(std::abs(p.z()), 0.25 + 0.0125);
            }
            if (m.label[i] != 2) continue;
            EXPECT_GE(to_wall, 0.019);
            EXPECT_GE(to_board, 0.019);
            EXPECT_GT(p.x(), kBoard);
            EXPECT_LT(p.x(), kWall);
        }
    // A beam without a width meets one surface.
    device.profile.footprint_vertical = device.profile.footprint_horizontal = 0.0;
    EXPECT_EQ(count_of(shoot(world, device, 0.5), 2), 0U);
}

TEST(LidarSimulation, OtherForegroundHasALabelOfItsOwn) {
    World world;
    add_wall(world, 5.0, 0.5, 0.8F, Kind::foreground);
    add_wall(world, 20.0, 100.0, 0.5F);
    world.build();
    const auto messages = shoot(world, exact_lidar("livox_mid70"), 0.2);
    EXPECT_GT(count_of(messages, 3), 100U);
    EXPECT_GT(count_of(messages, 0), 10000U);
    EXPECT_EQ(count_of(messages, 1) + count_of(messages, 2), 0U) << "15 m do not blend";
}

TEST(LidarSimulation, CoordinatesOrRangesComeInSteps) {
    World world;
    add_wall(world, 5.0, 100.0, 0.5F);
    world.build();
    LidarDevice livox, spinning;
    livox.profile = load_lidar_profile("livox_mid70");
    spinning.profile = load_lidar_profile("spinning_32");
    const auto off_step = [](double value, double step) {
        return std::abs(value - std::round(value / step) * step);
    };
    const Eigen::Matrix3Xd points = points_of(shoot(world, livox, 0.1));
    for (const double value : points.reshaped()) ASSERT_LT(off_step(value, 0.001), 1e-6);
    const Eigen::Matrix3Xd turning = points_of(shoot(world, spinning, 0.1));
    ASSERT_GT(turning.cols(), 1000);
    double worst = 0.0;
    for (Eigen::Index i = 0; i < turning.cols(); ++i) {
        const double range = turning.col(i).norm();
        if (range < 20.0) worst = std::max(worst, off_step(range, 0.002));  // floats: 2e-6 m
    }
    EXPECT_LT(worst, 1e-5);
}

TEST(LidarSimulation, IntensityIsTheReflectivityMetSquarely) {
    const auto mean_intensity = [](double range, double tilt_deg, float reflectivity) {
        World world;
        Eigen::Isometry3d pose = before_lidar({0.0, 25.0, 25.0});
        pose.prerotate(Eigen::AngleAxisd(tilt_deg * kLidarDegree, Eigen::Vector3d::UnitZ()));
        pose.pretranslate(Eigen::Vector3d(range, 0.0, 0.0));
        world.add(std::make_unique<PlanarSurface>(pose, PlanarSurface::rectangle(50.0, 50.0),
                                                  reflecting(reflectivity), Kind::background));
        world.build();
        LidarDevice device;
        device.profile = load_lidar_profile("livox_mid70");
        double sum = 0.0, count = 0.0;
        for (const LidarMessage& m : shoot(world, device, 0.2))
            for (std::size_t i = 0; i < m.x.size(); ++i) {
                const double level = m.intensity[i] * 255.0;
                EXPECT_NEAR(level, std::round(level), 1e-4);
                if (std::hypot(m.y[i], m.z[i]) > 0.05 * range) continue;
                sum += m.intensity[i];
                count += 1.0;
            }
        EXPECT_GT(count, 100.0);
        return sum / count;
    };
    // Means of hundreds with a noise of 5 %: within 1 %, and a step of 1/255 is spread by the
    // noise.
    EXPECT_NEAR(mean_intensity(5.0, 0.0, 0.8F), 0.8 * 150.0 / 255.0, 0.005);
    EXPECT_NEAR(mean_intensity(15.0, 0.0, 0.8F), 0.8 * 150.0 / 255.0, 0.005);
    EXPECT_NEAR(mean_intensity(5.0, 60.0, 0.8F), 0.4 * 150.0 / 255.0, 0.005);
    EXPECT_NEAR(mean_intensity(5.0, 0.0, 0.1F), 0.1 * 150.0 / 255.0, 0.003);
}

TEST(LidarSimulation, SeesAsFarAsTheReflectivityAllows) {
    const auto seen = [](double range, float reflectivity) {
        World world;
        add_wall(world, range, 1000.0, reflectivity);
        world.build();
        std::size_t count = 0;
        for (const LidarMessage& m : shoot(world, exact_lidar("livox_mid70"), 0.1))
            for (std::size_t i = 0; i < m.x.size(); ++i)
                if (std::hypot(m.y[i], m.z[i]) < 0.05 * range) ++count;
        return count;
    };
    EXPECT_GT(seen(89.0, 0.1F), 100U);
    EXPECT_EQ(seen(91.0, 0.1F), 0U);
    EXPECT_GT(seen(200.0, 0.8F), 100U);
    EXPECT_EQ(seen(0.04, 0.8F), 0U) << "nearer than range_min";
}

TEST(LidarSimulation, LosesTheShareOfDropouts) {
    World world;
    add_wall(world, 5.0, 100.0, 0.5F);
    world.build();
    LidarDevice device = exact_lidar("livox_mid70");
    device.profile.dropout = 0.1;
    // 20000 draws: one sigma is 42.
    EXPECT_NEAR(static_cast<double>(points_of(shoot(world, device, 0.2)).cols()), 18000.0, 200.0);
}

TEST(LidarSimulation, TheSameSeedGivesTheSameBytesOnAnyNumberOfThreads) {
    World world;
    add_four_holes(world, 5.0, 0.8F);
    add_wall(world, 5.5, 60.0, 0.5F);
    world.build();
    LidarDevice device;
    device.profile = load_lidar_profile("livox_mid70");
    // As the runner does: oneTBB takes no more threads than there are cores unless told.
    const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 4);
    const auto one = shoot(world, device, 0.5, 7, 1);
    const auto four = shoot(world, device, 0.5, 7, 4);
    const auto other = shoot(world, device, 0.5, 8, 4);
    ASSERT_EQ(one.size(), four.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].x, four[i].x);
        EXPECT_EQ(one[i].y, four[i].y);
        EXPECT_EQ(one[i].z, four[i].z);
        EXPECT_EQ(one[i].intensity, four[i].intensity);
        EXPECT_EQ(one[i].label, four[i].label);
        EXPECT_NE(one[i].x, other[i].x);
    }
}

TEST(LidarSimulation, PulsesStartFromWhereTheRigIsThen) {
    World world;
    add_wall(world, 5.0, 100.0, 0.5F);
    world.build();
    Motion motion;
    motion.velocity = {1.0, 0.0, 0.0};
    const auto messages =
        simulate_lidar(world, exact_lidar("livox_mid70"), motion, 1.0, 7, BareRun());
    for (const LidarMessage& m : messages) {
        EXPECT_NEAR(m.x.front(), 5.0 - m.stamp, 1e-3);
        EXPECT_NEAR(m.x.back(), 4.9 - m.stamp, 1e-3);
    }
    Motion turning;
    turning.angular_velocity = {0.0, 0.0, 0.5};
    turning.begins = 0.5;
    const auto turned =
        simulate_lidar(world, exact_lidar("livox_mid70"), turning, 1.0, 7, BareRun());
    // The wall's normal in the sensor's frame turns the other way.
    const LidarMessage& last = turned.back();
    const double angle = 0.5 * 0.5;
    const std::size_t end = last.x.size() - 1;
    EXPECT_NEAR(std::cos(angle) * last.x[end] - std::sin(angle) * last.y[end], 5.0, 1e-3);
    EXPECT_NEAR(turned.front().x[100], 5.0, 1e-3) << "still before";
}

TEST(LidarSimulation, ACancelledRunEnds) {
    World world;
    world.build();
    EXPECT_THROW(
        simulate_lidar(world, exact_lidar("livox_mid70"), Motion{}, 1.0, 7, BareRun(2, true)),
        Cancelled);
}

}  // namespace
}  // namespace petal::simulation
