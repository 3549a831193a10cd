// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_template_ideal.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace petal {

namespace {

/// cos 75 deg: boards nearer to edge on are not looked for.
constexpr double kLeastForeshortening = 0.26;

}  // namespace

Eigen::Matrix2d root_of(const Eigen::Matrix2d& spread) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).operatorSqrt();
}

std::vector<IdealRegion> ideal_regions(const std::vector<ImageRegion>& regions,
                                       const CameraModel& camera) {
    std::vector<IdealRegion> ideal;
    for (std::size_t i = 0; i < regions.size(); ++i) {
        const TemplateShape& raw = regions[i].shape;
        const auto here = camera.undistort(raw.center);
        const auto right = camera.undistort(raw.center + Eigen::Vector2d(0.5, 0.0));
        const auto down = camera.undistort(raw.center + Eigen::Vector2d(0.0, 0.5));
        if (!here || !right || !down) continue;
        Eigen::Matrix2d j;
        j << 2.0 * (*right - *here), 2.0 * (*down - *here);
        IdealRegion region;
        region.shape = {*here, j * raw.spread * j.transpose(),
                        raw.area * std::abs(j.determinant())};
        region.root = root_of(region.shape.spread);
        if (!(std::abs(region.root.determinant()) > 1e-9)) continue;
        region.whiten = region.root.inverse();
        region.index = static_cast<int>(i);
        ideal.push_back(region);
    }
    std::stable_sort(ideal.begin(), ideal.end(), [](const auto& a, const auto& b) {
        return a.shape.center.y() < b.shape.center.y();
    });
    return ideal;
}

Eigen::Matrix2d turn_by(double angle) {
    return Eigen::Rotation2Dd(angle).toRotationMatrix();
}

Homography affine_about(const Eigen::Matrix2d& linear, const Eigen::Vector2d& board,
                        const Eigen::Vector2d& image) {
    Homography h = Homography::Identity();
    h.topLeftCorner<2, 2>() = linear;
    h.topRightCorner<2, 1>() = image - linear * board;
    return h;
}

bool not_from_the_side(const Eigen::Matrix2d& linear) {
    const Eigen::Vector2d stretch = linear.jacobiSvd().singularValues();
    return stretch(1) >= kLeastForeshortening * stretch(0);
}

}  // namespace petal
