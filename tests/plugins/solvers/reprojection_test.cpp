// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/reprojection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/se3.hpp"
#include "petal/error.hpp"
#include "petal/testing/stage_harness.hpp"
#include "plugins/solvers/real_pairs.hpp"
#include "real_data.hpp"
#include "solvers/pnp.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
using testing::StageHarness;

Correspondences one_camera(const mrpt::img::TCamera& camera, std::vector<PointPair> pairs) {
    CameraPairs seen;
    seen.camera = "CAMERA";
    seen.lidar = "LIDAR";
    seen.model = camera;
    seen.pairs = std::move(pairs);
    seen.order.by = DecidedBy::given;
    return Correspondences{{seen}};
}

StageHarness solved(const Correspondences& scene) {
    auto stage = StageHarness::of<Reprojection>("solver.reprojection");
    stage.give<Correspondences>("correspondences", scene);
    stage.fire();
    return stage;
}

const CameraExtrinsics& solved_camera(const StageHarness& stage) {
    return stage.out<Extrinsics>("extrinsics").cameras.at(0);
}

double rms_px(const CameraExtrinsics& camera) {
    double sum = 0.0;
    for (const Residual& residual : camera.residuals) sum += residual.error_px.squaredNorm();
    return std::sqrt(sum / static_cast<double>(camera.residuals.size()));
}

double degrees_apart(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    return kDegrees * rotation_angle(a.linear() * b.linear().transpose());
}

Eigen::Isometry3d some_pose() {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    Vector6d twist;
    twist << 0.05, -0.1, 0.2, 0.03, -0.05, 0.04;
    return se3_exp(twist) * pose;
}

/// Points in front of some_pose() with their pixels, moved by Gaussian noise.
std::vector<PointPair> made_pairs(const mrpt::img::TCamera& camera, int count, double noise_px,
                                  std::uint64_t seed = 3) {
    std::mt19937_64 rng(seed);
    std::uniform_real_distribution<double> side(-1.0, 1.0), depth(2.0, 6.0);
    std::normal_distribution<double> noise(0.0, 1.0);
    const CameraModel model(camera);
    std::vector<PointPair> pairs;
    while (static_cast<int>(pairs.size()) < count) {
        PointPair pair;
        pair.lidar = Eigen::Vector3d(depth(rng), 0.0, 0.0);
        pair.lidar.y() = 0.7 * side(rng) * pair.lidar.x();
        pair.lidar.z() = 0.5 * side(rng) * pair.lidar.x();
        const auto pixel = model.project(some_pose() * pair.lidar);
        if (!pixel) continue;
        pair.image = *pixel + noise_px * Eigen::Vector2d(noise(rng), noise(rng));
        pairs.push_back(pair);
    }
    return pairs;
}

TEST(Reprojection, PublishedIndoorPairsGiveThePublishedPose) {
    PETAL_NEEDS_REAL_DATA();
    const auto data = testing::real_data();
    const auto stage = solved(one_camera(testing::indoor_camera(), testing::indoor_pairs(data)));
    const auto& camera = solved_camera(stage);
    const auto published = testing::published_pose(data / "sjtu_indoor/published_extrinsic.txt");
    // The file is rounded to six digits; the authors' fit is the same least squares.
    EXPECT_LT(degrees_apart(camera.T_camera_lidar, published), 0.03);
    EXPECT_LT((camera.T_camera_lidar.translation() - published.translation()).norm(), 2e-4);
    EXPECT_NEAR(rms_px(camera), 1.055, 0.002);
    EXPECT_EQ(camera.residuals.size(), 64u);
    EXPECT_EQ(camera.degrees_of_freedom, 26);  // 128 / 4 - 6
    EXPECT_EQ(camera.order.by, DecidedBy::given);
    EXPECT_EQ(stage.verdict(), Level::weak);  // 64 corners at 1 px leave more than 5 mm
    EXPECT_FALSE(camera.weakest_direction.empty());
}

TEST(Reprojection, CampusPairsFitAsMeasured) {
    PETAL_NEEDS_REAL_DATA();
    const auto stage =
        solved(one_camera(testing::campus_camera(), testing::campus_pairs(testing::real_data())));
    const auto& camera = solved_camera(stage);
    EXPECT_NEAR(rms_px(camera), 2.60, 0.01);
    const auto published =
        testing::published_pose(testing::real_data() / "sjtu_campus/published_extrinsic.txt");
    EXPECT_NEAR(degrees_apart(camera.T_camera_lidar, published), 0.07, 0.01);
}

TEST(Reprojection, TwoBoardsSideBySideAreWeakAndTheDirectionIsNamed) {
    PETAL_NEEDS_REAL_DATA();
    auto pairs = testing::campus_pairs(testing::real_data());
    pairs.erase(pairs.begin(), pairs.begin() + 10);
    const auto stage = solved(one_camera(testing::campus_camera(), pairs));
    EXPECT_EQ(stage.verdict(), Level::weak) << stage.reasons().at(0);
    // The fit lies 5.9 deg and 0.48 m off: tilting about x with a vertical shift.
    EXPECT_THAT(solved_camera(stage).weakest_direction,
                HasSubstr("tilting about the camera's x axis"));
    EXPECT_THAT(solved_camera(stage).weakest_direction,
                HasSubstr("shift along the camera's y axis"));
    EXPECT_THAT(stage.reasons().at(0), HasSubstr("tilting"));
}

TEST(Reprojection, CovarianceIsThatOfRepeatedExperiments) {
    const auto camera = testing::indoor_camera();
    constexpr int kRuns = 300;
    Matrix6d scatter = Matrix6d::Zero();
    Matrix6d told = Matrix6d::Zero();
    double chi2 = 0.0;
    for (int i = 0; i < kRuns; ++i) {
        const auto stage =
            solved(one_camera(camera, made_pairs(camera, 60, 0.5, static_cast<std::uint64_t>(i))));
        const Vector6d error = se3_log(some_pose() * solved_camera(stage).T_camera_lidar.inverse());
        // Each run has points of its own: compare in units of its own covariance.
        const Eigen::LLT<Matrix6d> root(solved_camera(stage).covariance);
        const Vector6d unit = root.matrixL().solve(error);
        scatter += unit * unit.transpose() / kRuns;
        told += solved_camera(stage).covariance / kRuns;
        chi2 += solved_camera(stage).chi2 / kRuns;
        EXPECT_EQ(solved_camera(stage).degrees_of_freedom, 114);
    }
    // The scatter of 300 experiments is known to sqrt(2 / 300) = 8 %; s0^2 of 60 medians to
    // 0.2, which in the mean makes it some 5 % wider.
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(scatter(i, i), 1.0, 0.35);
    // Identity covariance stands for 1 px; the noise was half of that.
    EXPECT_NEAR(chi2, 114 * 0.25, 2.0);
}

TEST(Reprojection, DistortionIsPartOfTheModel) {
    auto camera = testing::indoor_camera();
    camera.setDistortionPlumbBob(-0.25, 0.06, 1e-3, -5e-4);
    const auto scene = one_camera(camera, made_pairs(camera, 40, 0.0));
    // Noise-free: what is left is the solver's convergence.
    EXPECT_LT(degrees_apart(solved_camera(solved(scene)).T_camera_lidar, some_pose()), 1e-6);
    EXPECT_LT(rms_px(solved_camera(solved(scene))), 1e-6);
    auto rectified = StageHarness::of<Reprojection>();
    rectified.set("use_distortion", false).give<Correspondences>("correspondences", scene).fire();
    EXPECT_GT(rms_px(solved_camera(rectified)), 1.0);
    EXPECT_EQ(solved_camera(rectified).model.distortion, mrpt::img::DistortionModel::none);
}

TEST(Reprojection, GoodPairsAreUsable) {
    const auto camera = testing::indoor_camera();
    auto stage = StageHarness::of<Reprojection>();
    stage.set("sigma_px", 0.3)
        .give<Correspondences>("correspondences",
                               one_camera(camera, made_pairs(camera, 2000, 0.3)));
    stage.fire();
    EXPECT_EQ(stage.verdict(), Level::usable)
        << (stage.reasons().empty() ? "" : stage.reasons()[0]);
    EXPECT_TRUE(stage.reasons().empty());
}

TEST(Reprojection, ChiSquareOutsideItsBandIsTold) {
    const auto camera = testing::indoor_camera();
    auto stage = StageHarness::of<Reprojection>();
    stage.set("sigma_px", 0.1)
        .give<Correspondences>("correspondences",
                               one_camera(camera, made_pairs(camera, 2000, 0.3)));
    stage.fire();
    EXPECT_EQ(stage.verdict(), Level::weak);
    EXPECT_THAT(stage.reasons().at(0), HasSubstr("chi-square"));
    stage.set("sigma_px", 10.0).fire();
    EXPECT_EQ(stage.verdict(), Level::usable);
    stage.set("chi2_two_sided", true).fire();
    EXPECT_EQ(stage.verdict(), Level::weak);
}

TEST(Reprojection, ARobustLossTakesAwayTheForceOfAWrongPair) {
    const auto camera = testing::indoor_camera();
    auto pairs = made_pairs(camera, 40, 0.2);
    pairs[7].image += Eigen::Vector2d(60.0, -40.0);
    const auto scene = one_camera(camera, pairs);
    const double plain = degrees_apart(solved_camera(solved(scene)).T_camera_lidar, some_pose());
    for (const char* loss : {"huber", "cauchy"}) {
        auto stage = StageHarness::of<Reprojection>();
        stage.set("robust_loss", loss).give<Correspondences>("correspondences", scene).fire();
        EXPECT_LT(degrees_apart(solved_camera(stage).T_camera_lidar, some_pose()), 0.3 * plain)
            << loss;
    }
}

TEST(Reprojection, ScenesAreJoinedAndTheWorstOrderIsTold) {
    const auto camera = testing::indoor_camera();
    auto first = one_camera(camera, made_pairs(camera, 20, 0.1, 1));
    auto second = one_camera(camera, made_pairs(camera, 30, 0.1, 2));
    second.cameras[0].scene = 1;
    second.cameras[0].order.by = DecidedBy::prior;
    second.cameras[0].order.reason = "only one board";
    auto stage = StageHarness::of<Reprojection>();
    stage.give<Correspondences>("correspondences", first)
        .give<Correspondences>("correspondences", second)
        .fire();
    EXPECT_EQ(solved_camera(stage).residuals.size(), 50u);
    EXPECT_EQ(solved_camera(stage).residuals.front().scene, 0u);
    EXPECT_EQ(solved_camera(stage).residuals.back().scene, 1u);
    EXPECT_EQ(solved_camera(stage).order.by, DecidedBy::prior);
    EXPECT_EQ(stage.verdict(), Level::weak);

    second.cameras[0].model.fx(400.0);
    auto mixed = StageHarness::of<Reprojection>();
    mixed.give<Correspondences>("correspondences", first)
        .give<Correspondences>("correspondences", second);
    EXPECT_THROW(mixed.fire(), Error);
}

TEST(Reprojection, AnUndecidedOrderIsNotUsable) {
    const auto camera = testing::indoor_camera();
    auto scene = one_camera(camera, made_pairs(camera, 2000, 0.1));
    scene.cameras[0].order.by = DecidedBy::undecided;
    EXPECT_EQ(solved(scene).verdict(), Level::not_usable);
}

TEST(Reprojection, NothingToSolveIsTold) {
    const auto camera = testing::indoor_camera();
    for (const int count : {0, 1, 3}) {
        const auto stage = solved(one_camera(camera, made_pairs(camera, count, 0.0)));
        EXPECT_TRUE(stage.out<Extrinsics>("extrinsics").cameras.empty());
        EXPECT_EQ(stage.verdict(), Level::not_usable);
        ASSERT_EQ(stage.notes().size(), 1u);
        EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr(std::to_string(count) + " pairs"));
    }
    EXPECT_EQ(solved(Correspondences{}).verdict(), Level::not_usable);
}

TEST(Reprojection, DegeneratePairsNeverGiveNaN) {
    const auto camera = testing::indoor_camera();
    const CameraModel model(camera);
    for (const bool same_point : {false, true}) {
        std::vector<PointPair> pairs;
        for (int i = 0; i < 8; ++i) {
            PointPair pair;
            pair.lidar =
                Eigen::Vector3d(3.0, same_point ? 0.1 : 0.1 * i, same_point ? 0.1 : 0.05 * i);
            pair.image = *model.project(some_pose() * pair.lidar);
            pairs.push_back(pair);
        }
        // From the matcher's pose, and from none.
        auto scene = one_camera(camera, pairs);
        EXPECT_EQ(solved(scene).verdict(), Level::not_usable);
        scene.cameras[0].initial.push_back(some_pose());
        const auto stage = solved(scene);
        EXPECT_EQ(stage.verdict(), Level::not_usable);
        for (const auto& solution : stage.out<Extrinsics>("extrinsics").cameras) {
            EXPECT_TRUE(solution.covariance.allFinite());
            EXPECT_TRUE(solution.T_camera_lidar.matrix().allFinite());
            EXPECT_TRUE(solution.sigma_translation.allFinite());
        }
    }
}

TEST(Reprojection, NaNIsRefusedAndNamed) {
    const auto camera = testing::indoor_camera();
    auto pairs = made_pairs(camera, 10, 0.0);
    pairs[4].image.x() = std::numeric_limits<double>::quiet_NaN();
    try {
        solved(one_camera(camera, pairs));
        FAIL() << "accepted NaN";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("pair 4"));
    }
    pairs = made_pairs(camera, 10, 0.0);
    pairs[2].covariance.setZero();
    EXPECT_THROW(solved(one_camera(camera, pairs)), Error);
}

TEST(Reprojection, BothPlanarMinimaAreSeen) {
    // A small board far away, seen at a slant: two poses fit alike, and the verdict says so.
    const auto camera = testing::indoor_camera();
    const CameraModel model(camera);
    const Eigen::Isometry3d tilt =
        Eigen::Translation3d(0.0, 0.0, 4.0) *
        Eigen::Isometry3d(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY()));
    std::mt19937_64 rng(11);
    std::normal_distribution<double> noise(0.0, 0.4);
    std::vector<PointPair> pairs;
    for (int i = 0; i < 16; ++i) {
        PointPair pair;
        pair.lidar = Eigen::Vector3d(0.1 * (i % 4) - 0.15, 0.1 * (i / 4) - 0.15, 0.0);
        pair.image = *model.project(tilt * pair.lidar) + Eigen::Vector2d(noise(rng), noise(rng));
        pair.board = 0;
        pair.corner = i;
        pairs.push_back(pair);
    }
    const auto stage = solved(one_camera(camera, pairs));
    EXPECT_NE(stage.verdict(), Level::usable);
    EXPECT_THAT(stage.reasons(), ::testing::Contains(HasSubstr("another pose")));
}

TEST(Reprojection, TheSameBytesTwice) {
    PETAL_NEEDS_REAL_DATA();
    const auto scene =
        one_camera(testing::indoor_camera(), testing::indoor_pairs(testing::real_data()));
    const auto a = solved(scene), b = solved(scene);
    EXPECT_EQ(solved_camera(a).T_camera_lidar.matrix(), solved_camera(b).T_camera_lidar.matrix());
    EXPECT_EQ(solved_camera(a).covariance, solved_camera(b).covariance);
}

}  // namespace
}  // namespace petal
