// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/planes_ransac.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "noise.hpp"
#include "petal/calibration/plane_fit.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
using testing::StageHarness;

/// Noise of one seed.
class Noise {
   public:
    explicit Noise(std::uint64_t seed) : rng_(seed) {}
    double uniform(double low, double high) { return testing::uniform(rng_, low, high); }
    double normal(double sigma) { return testing::normal(rng_, sigma); }

   private:
    Rng rng_;
};

class Points {
   public:
    void add(const Eigen::Vector3d& p) {
        map_->insertPoint(static_cast<float>(p.x()), static_cast<float>(p.y()),
                          static_cast<float>(p.z()));
    }
    /// `count` points of a square patch of 0.5 m around `centre`, `sigma` off it.
    void add_patch(const Eigen::Vector3d& centre, const Eigen::Vector3d& normal, int count,
                   double sigma, Noise& noise) {
        const Eigen::Isometry3d frame = plane_frame(normal, centre);
        for (int i = 0; i < count; ++i)
            add(frame * Eigen::Vector3d(noise.uniform(-0.25, 0.25), noise.uniform(-0.25, 0.25),
                                        noise.normal(sigma)));
    }
    Cloud cloud() const {
        Cloud cloud;
        cloud.points = map_;
        cloud.sensor_label = "MID70";
        return cloud;
    }

   private:
    mrpt::maps::CPointsMapXYZI::Ptr map_ = mrpt::maps::CPointsMapXYZI::Create();
};

const Eigen::Vector3d kNormal = Eigen::Vector3d(-1.0, 0.2, 0.1).normalized();

TEST(PlanesRansac, FindsTwoPatchesAndTheirEquations) {
    Noise noise(1);
    Points points;
    points.add_patch({3.0, 0.8, 0.0}, kNormal, 300, 0.005, noise);
    points.add_patch({2.4, -0.8, 0.1}, -Eigen::Vector3d::UnitX(), 200, 0.005, noise);
    for (int i = 0; i < 100; ++i)
        points.add({noise.uniform(2.0, 4.0), noise.uniform(-2.0, 2.0), noise.uniform(-1.0, 1.0)});
    auto stage = StageHarness::of<PlanesRansac>();
    stage.give<Cloud>("cloud", points.cloud());
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        stage.seed(seed).fire();
        const auto& planes = stage.out<Planes>("planes").planes;
        ASSERT_EQ(planes.size(), 2u) << "seed " << seed;
        EXPECT_NEAR(static_cast<double>(planes[0].inliers.size()), 300.0, 10.0);
        // 5 mm over a patch of 0.5 m / sqrt(12) and 300 points: 2 mrad; four sigma, and clutter.
        EXPECT_LT(std::acos(std::min(1.0, planes[0].normal.dot(kNormal))), 0.012);
        EXPECT_GT(planes[0].offset, 0.0) << "the normal points to the sensor";
        EXPECT_NEAR(planes[1].offset, 2.4, 0.004) << "5 mm / sqrt(200), times ten";
        EXPECT_EQ(planes[0].inliers.sensor_label, "MID70");
        EXPECT_EQ(planes[0].inliers.scene_index.size(), planes[0].inliers.size());
        EXPECT_NEAR(planes[0].rms, 0.005, 0.002);
    }
}

TEST(PlanesRansac, TwoBoardsSideBySideInDepthAreTwoPatches) {
    // One plane through both would be within 4 cm of every point, but a ball of 0.5 m holds only
    // one.
    Noise noise(2);
    Points points;
    points.add_patch({2.40, 0.75, 0.0}, -Eigen::Vector3d::UnitX(), 200, 0.003, noise);
    points.add_patch({2.46, -0.75, 0.0}, -Eigen::Vector3d::UnitX(), 200, 0.003, noise);
    auto stage = StageHarness::of<PlanesRansac>();
    stage.give<Cloud>("cloud", points.cloud()).fire();
    const auto& planes = stage.out<Planes>("planes").planes;
    ASSERT_EQ(planes.size(), 2u);
    for (const Plane& plane : planes)
        EXPECT_GT(-plane.normal.x(), std::cos(0.01)) << "no tilt from one board to the other";
}

TEST(PlanesRansac, TheCovarianceIsThatOfTheErrors) {
    // Normalised errors squared of 200 patches: the mean of chi-square with 3 degrees is 3; its
    // standard error is sqrt(6 / 200) = 0.17. Four of them, and 10 % for the point variance that is
    // estimated too.
    Noise noise(3);
    const Eigen::Vector3d centre(3.0, 0.5, -0.2);
    const Eigen::Isometry3d frame = plane_frame(kNormal, centre);
    double sum = 0.0;
    for (int run = 0; run < 200; ++run) {
        PlaneFitter fitter;
        for (int i = 0; i < 60; ++i)
            fitter.add(frame * Eigen::Vector3d(noise.uniform(-0.25, 0.25),
                                               noise.uniform(-0.25, 0.25), noise.normal(0.01)));
        const auto fit = fitter.fit();
        ASSERT_TRUE(fit);
        // In coordinates of rank 3: tilt about both axes, distance of the centre.
        Eigen::Matrix<double, 3, 4> project;
        project << frame.linear().col(0).transpose(), 0.0, frame.linear().col(1).transpose(), 0.0,
            centre.transpose(), 1.0;
        const Eigen::Vector3d error = project * (Eigen::Vector4d() << fit->normal - kNormal,
                                                 fit->offset + kNormal.dot(centre))
                                                    .finished();
        const Eigen::Matrix3d covariance = project * fit->covariance * project.transpose();
        sum += error.dot(covariance.inverse() * error);
    }
    EXPECT_NEAR(sum / 200.0, 3.0, 1.0);
}

TEST(PlanesRansac, SkipsAndCountsPointsThatAreNotFinite) {
    Noise noise(4);
    Points points;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    points.add({nan, 0.0, 0.0});
    points.add_patch({3.0, 0.0, 0.0}, kNormal, 100, 0.002, noise);
    points.add({3.0, inf, 0.0});
    auto stage = StageHarness::of<PlanesRansac>();
    stage.give<Cloud>("cloud", points.cloud()).fire();
    ASSERT_EQ(stage.out<Planes>("planes").planes.size(), 1u);
    EXPECT_EQ(stage.out<Planes>("planes").planes[0].inliers.size(), 100u);
    EXPECT_THAT(::testing::PrintToString(stage.logs()), HasSubstr("skipped 2 of 102"));
}

TEST(PlanesRansac, AnEmptyCloudGivesNoPlaneAndANote) {
    auto stage = StageHarness::of<PlanesRansac>();
    stage.give<Cloud>("cloud", Cloud()).fire();
    EXPECT_TRUE(stage.out<Planes>("planes").planes.empty());
    ASSERT_EQ(stage.notes().size(), 1u);
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("empty"));
}

TEST(PlanesRansac, PointsOnALineAreNoPlane) {
    Points points;
    for (int i = 0; i < 200; ++i) points.add({3.0, -0.4 + 0.004 * i, 0.002 * i});
    auto stage = StageHarness::of<PlanesRansac>();
    stage.give<Cloud>("cloud", points.cloud()).fire();
    EXPECT_TRUE(stage.out<Planes>("planes").planes.empty());
    ASSERT_EQ(stage.notes().size(), 1u);
    EXPECT_THAT(stage.notes()[0].threshold, HasSubstr("min_inliers 40"));
}

TEST(PlanesRansac, TheSeedDecidesAndCancellingEndsIt) {
    Noise noise(5);
    Points points;
    points.add_patch({3.0, 0.0, 0.0}, kNormal, 100, 0.01, noise);
    auto stage = StageHarness::of<PlanesRansac>();
    stage.give<Cloud>("cloud", points.cloud());
    stage.seed(7).fire();
    const Planes first = stage.out<Planes>("planes");
    stage.seed(7).fire();
    const Planes& second = stage.out<Planes>("planes");
    ASSERT_EQ(first.planes.size(), second.planes.size());
    EXPECT_EQ(first.planes[0].normal, second.planes[0].normal);
    EXPECT_EQ(first.planes[0].offset, second.planes[0].offset);
    stage.cancel();
    EXPECT_THROW(stage.fire(), Cancelled);
}

}  // namespace
}  // namespace petal
