// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/se3.hpp"
#include "petal/error.hpp"
#include "result_diff.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

template <class Matrix>
json rows_of(const Matrix& matrix) {
    json rows = json::array();
    for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
        json row = json::array();
        for (Eigen::Index c = 0; c < matrix.cols(); ++c) row.push_back(matrix(r, c));
        rows.push_back(row);
    }
    return rows;
}

constexpr double kSigma = 2e-3;      // m
constexpr double kSigmaTurn = 1e-3;  // rad

/// A result with a diagonal covariance about the pose.
json result_of(const Eigen::Isometry3d& T, const std::string& camera = "CAMERA") {
    Vector6d variances;
    variances << Eigen::Vector3d::Constant(kSigma * kSigma),
        Eigen::Vector3d::Constant(kSigmaTurn * kSigmaTurn);
    const Matrix6d covariance = variances.asDiagonal();
    return {{"verdict", "usable"},
            {"reasons", json::array()},
            {"extrinsics",
             {{{"camera", camera},
               {"lidar", "LIDAR"},
               {"T_camera_lidar", rows_of(T.matrix())},
               {"covariance", rows_of(covariance)}}}},
            {"metrics", {{"reprojection.rms_px", 0.5}, {"same", 1.0}}}};
}

class DiffTest : public ::testing::Test {
   protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "petal-diff-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
        T_.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
        T_.translation() << 0.04, -0.11, -0.03;
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path write(const std::string& name, const json& result) const {
        std::ofstream(folder_ / name) << result;
        return folder_ / name;
    }
    ResultDifference compared(const json& a, const json& b, double focal = 1000.0) const {
        return compare_results(write("a.json", a), write("b.json", b), focal);
    }

    fs::path folder_;
    Eigen::Isometry3d T_ = Eigen::Isometry3d::Identity();
};

TEST_F(DiffTest, TellsTheDifferenceByAxisInSigmas) {
    Vector6d xi;
    xi << 0.004, 0.0, 0.0, 0.0, 0.002, 0.0;
    const ResultDifference found = compared(result_of(T_), result_of(se3_exp(xi) * T_));
    ASSERT_EQ(found.poses.size(), 1u);
    const PoseDifference& pose = found.poses[0];
    EXPECT_LT((pose.rotation - Eigen::Vector3d(0.0, 0.002, 0.0)).norm(), 1e-12);
    // t' = Exp(phi) t + V rho: to first order t + phi x t + rho.
    const Eigen::Vector3d first_order =
        xi.head<3>() + xi.tail<3>().cross(Eigen::Vector3d(T_.translation()));
    EXPECT_LT((pose.translation - first_order).norm(), 1e-5);
    // Two covariances, added.
    EXPECT_NEAR(pose.sigma_rotation.y(), std::sqrt(2.0) * kSigmaTurn, 1e-12);
    const double lever_yz = std::hypot(0.11, 0.03);
    EXPECT_NEAR(pose.sigma_translation.x(),
                std::sqrt(2.0) * std::hypot(kSigma, kSigmaTurn * lever_yz), 1e-9);
    // (2 sigma)^2 / 2 along each of two axes.
    ASSERT_TRUE(pose.mahalanobis_squared);
    EXPECT_NEAR(*pose.mahalanobis_squared, 2.0 + 2.0, 1e-9);
    EXPECT_NEAR(pose.probability, std::exp(-2.0) * (1.0 + 2.0 + 2.0), 1e-12);
    EXPECT_TRUE(found.agree());
    // Straight ahead, f (rho_x + phi_y range) / range.
    ASSERT_EQ(pose.pixels.size(), 3u);
    for (const PixelShift& shift : pose.pixels) {
        EXPECT_NEAR(shift.px, 1000.0 * (0.004 / shift.range + 0.002), 0.01);
        EXPECT_NEAR(shift.sigma_px,
                    1000.0 * std::sqrt(2.0) * std::hypot(kSigma / shift.range, kSigmaTurn), 1e-9);
    }
    EXPECT_EQ(pose.pixels[2].range, 50.0);
}

TEST_F(DiffTest, WhatTheCovariancesDoNotExplainIsNoAgreement) {
    Vector6d xi = Vector6d::Zero();
    xi[2] = 8.0 * kSigma;  // 8^2 / 2 = 32, of which 22.5 are the 99.9 % band
    const ResultDifference found = compared(result_of(T_), result_of(se3_exp(xi) * T_));
    EXPECT_FALSE(found.agree());
    EXPECT_THAT(difference_table(found), HasSubstr("differ by more than"));
    xi[2] = 6.0 * kSigma;  // 18
    EXPECT_TRUE(compared(result_of(T_), result_of(se3_exp(xi) * T_)).agree());
}

TEST_F(DiffTest, TellsFiguresThatDifferAndVerdicts) {
    json b = result_of(T_);
    b["verdict"] = "weak";
    b["reasons"] = {"one board"};
    b["metrics"] = {{"reprojection.rms_px", 0.7}, {"same", 1.0}, {"truth.nees", nullptr}};
    b["residuals"] = {{"rms_px", 0.7}, {"per_scene", json::array()}};
    const ResultDifference found = compared(result_of(T_), b);
    EXPECT_EQ(found.a.verdict, "usable");
    EXPECT_EQ(found.b.verdict, "weak");
    ASSERT_EQ(found.figures.size(), 2u);
    EXPECT_EQ(found.figures[0].name, "reprojection.rms_px");
    EXPECT_EQ(found.figures[0].a, 0.5);
    EXPECT_EQ(found.figures[0].b, 0.7);
    EXPECT_EQ(found.figures[1].name, "residuals.rms_px");
    EXPECT_FALSE(found.figures[1].a);
    const std::string table = difference_table(found);
    EXPECT_THAT(table, HasSubstr("B: weak"));
    EXPECT_THAT(table, HasSubstr("1 in B alone"));
}

TEST_F(DiffTest, TheJsonHoldsTheSame) {
    Vector6d xi = Vector6d::Zero();
    xi[4] = 0.5 / kDegrees;
    const json found =
        json::parse(difference_json(compared(result_of(T_), result_of(se3_exp(xi) * T_))));
    EXPECT_EQ(found["agree"], false);
    EXPECT_NEAR(found["poses"][0]["rotation_deg"][1].get<double>(), 0.5, 1e-9);
    EXPECT_NEAR(found["poses"][0]["sigma_rotation_deg"][0].get<double>(),
                kDegrees * std::sqrt(2.0) * kSigmaTurn, 1e-9);
    EXPECT_EQ(found["poses"][0]["straight_ahead"][0]["range_m"], 5.0);
    EXPECT_EQ(found["b"]["verdict"], "usable");
}

TEST_F(DiffTest, TheFocalLengthComesFromTheCorners) {
    json a = result_of(T_);
    json lidar = json::array(), image = json::array();
    for (int i = 0; i < 6; ++i) {
        const Eigen::Vector3d p_camera(0.2 * i - 0.5, 0.1, 3.0 + 0.1 * i);
        const Eigen::Vector3d p = T_.inverse() * p_camera;
        lidar.push_back({p.x(), p.y(), p.z()});
        image.push_back({900.0 * p_camera.x() / p_camera.z() + 640.0, 0.0});
    }
    a["scenes"] = {{{"name", "s"},
                    {"boards",
                     {{{"target", "t"},
                       {"camera", "CAMERA"},
                       {"corners_lidar", lidar},
                       {"corners_image", image}},
                      {{"target", "t"},
                       {"camera", nullptr},
                       {"corners_lidar", lidar},
                       {"corners_image", nullptr}}}}}};
    EXPECT_NEAR(compared(a, result_of(T_), 0.0).poses[0].focal_px, 900.0, 1e-6);
    EXPECT_NEAR(compared(result_of(T_), a, 0.0).poses[0].focal_px, 900.0, 1e-6);
    const ResultDifference none = compared(result_of(T_), result_of(T_), 0.0);
    EXPECT_TRUE(none.poses[0].pixels.empty());
    EXPECT_THAT(difference_table(none), HasSubstr("give --focal"));
}

TEST_F(DiffTest, OtherSensorsAreTold) {
    const ResultDifference found = compared(result_of(T_), result_of(T_, "LEFT"));
    EXPECT_TRUE(found.poses.empty());
    EXPECT_THAT(found.only_a, ::testing::ElementsAre("camera 'CAMERA' and LiDAR 'LIDAR'"));
    EXPECT_THAT(found.only_b, ::testing::ElementsAre("camera 'LEFT' and LiDAR 'LIDAR'"));
    EXPECT_FALSE(found.agree());
}

TEST_F(DiffTest, WithoutCovariancesNothingIsInSigmas) {
    json a = result_of(T_);
    a["extrinsics"][0]["covariance"] = rows_of(Matrix6d(Matrix6d::Zero()));
    const ResultDifference found = compared(a, a);
    EXPECT_FALSE(found.poses[0].mahalanobis_squared);
    EXPECT_FALSE(found.agree());
    EXPECT_THAT(difference_table(found), HasSubstr("cannot be inverted"));
}

TEST_F(DiffTest, ARunFolderIsAResultToo) {
    write("result.json", result_of(T_));
    EXPECT_TRUE(compare_results(folder_, folder_ / "result.json").agree());
    EXPECT_THROW(compare_results(folder_ / "none.json", folder_), Error);
}

}  // namespace
}  // namespace petal
