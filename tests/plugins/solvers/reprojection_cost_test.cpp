// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/reprojection_cost.hpp"

#include <ceres/autodiff_cost_function.h>
#include <ceres/rotation.h>
#include <gtest/gtest.h>

#include <random>

#include "solvers/detail/se3_manifold.hpp"

namespace petal {
namespace {

mrpt::img::TCamera test_camera(mrpt::img::DistortionModel model) {
    mrpt::img::TCamera camera;
    camera.ncols = 640;
    camera.nrows = 540;
    camera.setIntrinsicParamsFromValues(349.8, 351.1, 315.4, 279.0);
    if (model == mrpt::img::DistortionModel::plumb_bob) {
        camera.setDistortionPlumbBob(-0.2, 0.05, 2e-3, -1e-3, 0.01);
        camera.k4(0.03);
        camera.k5(-0.01);
        camera.k6(0.002);
    } else if (model == mrpt::img::DistortionModel::kannala_brandt) {
        camera.setDistortionKannalaBrandt(-0.02, 0.006, -0.004, 0.0009);
    }
    return camera;
}

/// The residual written once more, for automatic differentiation, from the formulas of OpenCV's
/// manual.
struct Automatic {
    mrpt::img::TCamera c;
    Eigen::Vector3d point;
    Eigen::Vector2d pixel;
    Eigen::Matrix2d root;

    template <class T>
    bool operator()(const T* block, T* residuals) const {
        const T q[4] = {block[3], block[0], block[1], block[2]};  // Ceres: w first
        const T p[3] = {T(point.x()), T(point.y()), T(point.z())};
        T rotated[3];
        ceres::QuaternionRotatePoint(q, p, rotated);
        const T z = rotated[2] + block[6];
        T x = (rotated[0] + block[4]) / z, y = (rotated[1] + block[5]) / z;
        const T r2 = x * x + y * y;
        if (c.distortion == mrpt::img::DistortionModel::plumb_bob) {
            const T s = (1.0 + c.k1() * r2 + c.k2() * r2 * r2 + c.k3() * r2 * r2 * r2) /
                        (1.0 + c.k4() * r2 + c.k5() * r2 * r2 + c.k6() * r2 * r2 * r2);
            const T bent_x = x * s + 2.0 * c.p1() * x * y + c.p2() * (r2 + 2.0 * x * x);
            y = y * s + c.p1() * (r2 + 2.0 * y * y) + 2.0 * c.p2() * x * y;
            x = bent_x;
        } else if (c.distortion == mrpt::img::DistortionModel::kannala_brandt) {
            const T r = sqrt(r2), a = atan(r), a2 = a * a;
            const T s = a * (1.0 + a2 * (c.k1() + a2 * (c.k2() + a2 * (c.k3() + a2 * c.k4())))) / r;
            x *= s;
            y *= s;
        }
        const T du = pixel.x() - (c.fx() * x + c.cx()), dv = pixel.y() - (c.fy() * y + c.cy());
        residuals[0] = root(0, 0) * du + root(0, 1) * dv;
        residuals[1] = root(1, 0) * du + root(1, 1) * dv;
        return true;
    }
};

using LocalJacobian = Eigen::Matrix<double, 2, 6>;

LocalJacobian local_jacobian(const ceres::CostFunction& cost, const PoseBlock& block,
                             Eigen::Vector2d& residual) {
    const double* parameters[] = {block.data()};
    Eigen::Matrix<double, 2, 7, Eigen::RowMajor> ambient;
    double* jacobians[] = {ambient.data()};
    EXPECT_TRUE(cost.Evaluate(parameters, residual.data(), jacobians));
    Eigen::Matrix<double, 7, 6, Eigen::RowMajor> plus;
    EXPECT_TRUE(Se3Manifold().PlusJacobian(block.data(), plus.data()));
    return ambient * plus;
}

class Cost : public ::testing::TestWithParam<mrpt::img::DistortionModel> {};
INSTANTIATE_TEST_SUITE_P(Reprojection, Cost,
                         ::testing::Values(mrpt::img::DistortionModel::none,
                                           mrpt::img::DistortionModel::plumb_bob,
                                           mrpt::img::DistortionModel::kannala_brandt));

TEST_P(Cost, AnalyticJacobianIsThatOfAutomaticDifferentiation) {
    const auto camera = test_camera(GetParam());
    const CameraModel model(camera);
    std::mt19937_64 rng(9);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    Eigen::Matrix2d root;
    root << 1.3, 0.4, 0.0, 0.7;
    for (int i = 0; i < 100; ++i) {
        Vector6d twist;
        for (Eigen::Index k = 0; k < 6; ++k) twist[k] = u(rng);
        const Eigen::Isometry3d pose = se3_exp(twist);
        const Eigen::Vector3d p_camera(u(rng), u(rng), 2.5 + u(rng));
        const Eigen::Vector3d p_lidar = pose.inverse() * p_camera;
        const Eigen::Vector2d pixel(320.0 + 50.0 * u(rng), 270.0 + 50.0 * u(rng));
        const ReprojectionCost analytic(model, p_lidar, pixel, root);
        const ceres::AutoDiffCostFunction<Automatic, 2, 7> automatic(
            new Automatic{camera, p_lidar, pixel, root});
        Eigen::Vector2d e_analytic, e_automatic;
        const auto j_analytic = local_jacobian(analytic, to_block(pose), e_analytic);
        const auto j_automatic = local_jacobian(automatic, to_block(pose), e_automatic);
        // Entries of some 1000 px/m: 1e-8 is eleven digits.
        EXPECT_LT((e_analytic - e_automatic).norm(), 1e-9);
        EXPECT_LT((j_analytic - j_automatic).norm(), 1e-8);
    }
}

TEST(ReprojectionCost, FailsBehindTheCamera) {
    const CameraModel model(test_camera(mrpt::img::DistortionModel::none));
    const ReprojectionCost cost(model, {0.0, 0.0, -1.0}, {0.0, 0.0}, Eigen::Matrix2d::Identity());
    const PoseBlock block = to_block(Eigen::Isometry3d::Identity());
    const double* parameters[] = {block.data()};
    double residual[2];
    EXPECT_FALSE(cost.Evaluate(parameters, residual, nullptr));
}

TEST(Se3Manifold, PlusIsTheLeftPerturbationAndMinusInvertsIt) {
    Vector6d at, delta;
    at << 0.3, -0.2, 1.0, 0.5, -1.1, 0.2;
    delta << 0.1, 0.2, -0.3, 0.4, 0.1, -0.2;
    const Eigen::Isometry3d pose = se3_exp(at);
    const PoseBlock x = to_block(pose);
    PoseBlock y;
    const Se3Manifold manifold;
    ASSERT_TRUE(manifold.Plus(x.data(), delta.data(), y.data()));
    EXPECT_LT((to_pose(y.data()).matrix() - (se3_exp(delta) * pose).matrix()).norm(), 1e-14);
    Vector6d back;
    ASSERT_TRUE(manifold.Minus(y.data(), x.data(), back.data()));
    EXPECT_LT((back - delta).norm(), 1e-13);
}

TEST(Se3Manifold, JacobiansAgreeWithDifferencesAndInvertEachOther) {
    Vector6d at;
    at << 0.3, -0.2, 1.0, 0.5, -1.1, 0.2;
    const PoseBlock x = to_block(se3_exp(at));
    const Se3Manifold manifold;
    Eigen::Matrix<double, 7, 6, Eigen::RowMajor> plus;
    Eigen::Matrix<double, 6, 7, Eigen::RowMajor> minus;
    ASSERT_TRUE(manifold.PlusJacobian(x.data(), plus.data()));
    ASSERT_TRUE(manifold.MinusJacobian(x.data(), minus.data()));
    EXPECT_LT((minus * plus - Matrix6d::Identity()).norm(), 1e-14);
    for (Eigen::Index i = 0; i < 6; ++i) {
        const double h = 1e-6;
        const Vector6d step = h * Vector6d::Unit(i), opposite = -step;
        PoseBlock ahead, behind;
        manifold.Plus(x.data(), step.data(), ahead.data());
        manifold.Plus(x.data(), opposite.data(), behind.data());
        for (std::size_t k = 0; k < 7; ++k)
            EXPECT_NEAR((ahead[k] - behind[k]) / (2.0 * h), plus(static_cast<Eigen::Index>(k), i),
                        1e-9);  // central differences: h^2 and 1e-16 / h
    }
}

}  // namespace
}  // namespace petal
