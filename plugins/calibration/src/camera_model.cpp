// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/camera_model.hpp"

#include <Eigen/LU>
#include <cmath>
#include <string>

#include "petal/error.hpp"

namespace petal {
namespace {

using mrpt::img::DistortionModel;
using mrpt::img::TCamera;

constexpr double kRightAngle = 1.5707963267948966;
constexpr double kScanStep = 1e-3;  // rad, when looking for the angle at which the model turns back
constexpr double kMinDepth = 1e-9;  // m; nearer than this is not in front of the camera

/// A radial law: the factor on (x, y) at the ideal radius r, and its derivative by r, divided by r.
/// The latter costs as much again, and clouds that are projected do not ask for it.
enum class Slope { left_out, told };
struct Radial {
    double factor;
    double slope;
};

Radial plumb_bob(const TCamera& c, double r2, Slope slope) {
    const double num = 1.0 + r2 * (c.k1() + r2 * (c.k2() + r2 * c.k3()));
    const double den = 1.0 + r2 * (c.k4() + r2 * (c.k5() + r2 * c.k6()));
    if (slope == Slope::left_out) return {num / den, 0.0};
    const double d_num = c.k1() + r2 * (2.0 * c.k2() + r2 * 3.0 * c.k3());
    const double d_den = c.k4() + r2 * (2.0 * c.k5() + r2 * 3.0 * c.k6());
    return {num / den, 2.0 * (d_num * den - num * d_den) / (den * den)};
}

Radial kannala_brandt(const TCamera& c, double r2, Slope slope) {
    const double r = std::sqrt(r2);
    // theta_d(atan r) / r = 1 + (k1 - 1/3) r^2 + ...: the quotients below lose their digits at 0.
    if (r < 1e-3) {
        const double quadratic = c.k1() - 1.0 / 3.0;
        return {1.0 + quadratic * r2, 2.0 * quadratic};
    }
    const double theta = std::atan(r);
    const double t2 = theta * theta;
    const double distorted =
        theta * (1.0 + t2 * (c.k1() + t2 * (c.k2() + t2 * (c.k3() + t2 * c.k4()))));
    if (slope == Slope::left_out) return {distorted / r, 0.0};
    const double by_theta =
        1.0 + t2 * (3.0 * c.k1() + t2 * (5.0 * c.k2() + t2 * (7.0 * c.k3() + t2 * 9.0 * c.k4())));
    const double by_r = by_theta / (1.0 + r2);
    return {distorted / r, (by_r * r - distorted) / (r2 * r)};
}

Radial radial(const TCamera& c, double r2, Slope slope) {
    switch (c.distortion) {
        case DistortionModel::plumb_bob:
            return plumb_bob(c, r2, slope);
        case DistortionModel::kannala_brandt:
            return kannala_brandt(c, r2, slope);
        case DistortionModel::none:
            break;
    }
    return {1.0, 0.0};
}

/// Whether the distorted radius grows at this angle, and no pole lies there.
bool grows(const TCamera& c, double theta) {
    const double r = std::tan(theta);
    const Radial law = radial(c, r * r, Slope::told);
    return law.factor > 0.0 && law.factor + r * r * law.slope > 0.0;
}

/// The first angle at which the distorted radius stops growing; a right angle where it never does.
double monotonic_limit(const TCamera& c) {
    if (c.distortion == DistortionModel::none) return kRightAngle;
    for (double below = 0.0; below + kScanStep < kRightAngle; below += kScanStep) {
        if (grows(c, below + kScanStep)) continue;
        double low = below, high = below + kScanStep;
        for (int i = 0; i < 40; ++i) {
            const double middle = 0.5 * (low + high);
            (grows(c, middle) ? low : high) = middle;
        }
        return low;
    }
    return kRightAngle;
}

/// Distorted ideal coordinates (x / z, y / z), and their Jacobian where it is asked for.
Eigen::Vector2d distorted(const TCamera& c, const Eigen::Vector2d& ideal,
                          Eigen::Matrix2d* jacobian) {
    const double r2 = ideal.squaredNorm();
    const Radial law = radial(c, r2, jacobian != nullptr ? Slope::told : Slope::left_out);
    const bool tangential = c.distortion == DistortionModel::plumb_bob;
    const double x = ideal.x(), y = ideal.y();
    Eigen::Vector2d result = law.factor * ideal;
    if (tangential) {
        const double p1 = c.p1(), p2 = c.p2();
        result.x() += 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x);
        result.y() += p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y;
    }
    if (jacobian == nullptr) return result;
    *jacobian = law.factor * Eigen::Matrix2d::Identity() + law.slope * ideal * ideal.transpose();
    if (tangential) {
        const double p1 = c.p1(), p2 = c.p2();
        (*jacobian)(0, 0) += 2.0 * p1 * y + 6.0 * p2 * x;
        (*jacobian)(0, 1) += 2.0 * p1 * x + 2.0 * p2 * y;
        (*jacobian)(1, 0) += 2.0 * p1 * x + 2.0 * p2 * y;
        (*jacobian)(1, 1) += 6.0 * p1 * y + 2.0 * p2 * x;
    }
    return result;
}

/// The ideal radius whose distorted radius is the given one, without the tangential part.
double ideal_radius(const TCamera& c, double distorted_radius, double max_theta) {
    double low = 0.0, high = max_theta;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        const double r = std::tan(middle);
        (r * radial(c, r * r, Slope::left_out).factor < distorted_radius ? low : high) = middle;
    }
    return std::tan(low);
}

}  // namespace

CameraModel::CameraModel(const TCamera& camera)
    : camera_(camera),
      fx_(camera.fx()),
      fy_(camera.fy()),
      cx_(camera.cx()),
      cy_(camera.cy()),
      max_theta_(0.0) {
    const std::string who = "camera '" + camera.cameraName + "': ";
    bool finite =
        std::isfinite(cx_) && std::isfinite(cy_) && std::isfinite(fx_) && std::isfinite(fy_);
    for (const double coefficient : camera.dist) finite = finite && std::isfinite(coefficient);
    if (!finite)
        throw Error(who +
                    "the intrinsics hold NaN or infinity; give finite fx, fy, cx, cy and "
                    "distortion coefficients");
    if (fx_ <= 0.0 || fy_ <= 0.0)
        throw Error(who + "fx is " + std::to_string(fx_) + " and fy " + std::to_string(fy_) +
                    " px, both must be positive; give the calibrated intrinsics");
    if (camera.ncols == 0 || camera.nrows == 0)
        throw Error(who + "the image size is " + std::to_string(camera.ncols) + " x " +
                    std::to_string(camera.nrows) +
                    " px; give the size the intrinsics were made for");
    max_theta_ = monotonic_limit(camera_);
}

std::optional<Eigen::Vector2d> CameraModel::project(const Eigen::Vector3d& p,
                                                    Eigen::Matrix<double, 2, 3>* jacobian) const {
    if (!(p.z() > kMinDepth)) return std::nullopt;
    // A tangent is not less than its angle: most points are known to lie within by that alone, and
    // whole clouds come here. Written so that NaN fails too.
    const double surely_within = 0.999 * max_theta_ * p.z();
    if (!(p.head<2>().squaredNorm() < surely_within * surely_within) &&
        !(std::atan2(std::hypot(p.x(), p.y()), p.z()) < max_theta_))
        return std::nullopt;

    const double inverse_depth = 1.0 / p.z();
    const Eigen::Vector2d ideal = p.head<2>() * inverse_depth;
    Eigen::Matrix2d by_ideal;
    const Eigen::Vector2d bent =
        distorted(camera_, ideal, jacobian != nullptr ? &by_ideal : nullptr);
    const Eigen::Vector2d pixel(fx_ * bent.x() + cx_, fy_ * bent.y() + cy_);
    if (!pixel.allFinite()) return std::nullopt;
    if (jacobian != nullptr) {
        Eigen::Matrix<double, 2, 3> ideal_by_point;
        ideal_by_point << inverse_depth, 0.0, -ideal.x() * inverse_depth,  //
            0.0, inverse_depth, -ideal.y() * inverse_depth;
        *jacobian = Eigen::Vector2d(fx_, fy_).asDiagonal() * by_ideal * ideal_by_point;
    }
    return pixel;
}

std::optional<Eigen::Vector3d> CameraModel::unproject(const Eigen::Vector2d& pixel) const {
    if (!pixel.allFinite()) return std::nullopt;
    const Eigen::Vector2d target((pixel.x() - cx_) / fx_, (pixel.y() - cy_) / fy_);
    if (camera_.distortion == DistortionModel::none)
        return Eigen::Vector3d(target.x(), target.y(), 1.0);

    const double radius = target.norm();
    Eigen::Vector2d ideal = target;
    if (radius > 0.0) ideal *= ideal_radius(camera_, radius, max_theta_) / radius;
    // Newton's steps on the whole model. They also tell a pixel outside the model's range: the
    // start then lies at the rim and the residual stays.
    for (int i = 0; i < 20; ++i) {
        Eigen::Matrix2d jacobian;
        const Eigen::Vector2d error = distorted(camera_, ideal, &jacobian) - target;
        if (!error.allFinite()) return std::nullopt;
        if (error.norm() <= 1e-13 * (1.0 + radius)) break;
        const Eigen::Vector2d step = jacobian.fullPivLu().solve(error);
        if (!step.allFinite()) return std::nullopt;
        ideal -= step;
    }
    const Eigen::Vector3d direction(ideal.x(), ideal.y(), 1.0);
    const auto back = project(direction);
    constexpr double kClosePx = 1e-6;
    if (!back || (*back - pixel).norm() > kClosePx) return std::nullopt;
    return direction;
}

std::optional<Eigen::Vector2d> CameraModel::undistort(const Eigen::Vector2d& pixel) const {
    const auto direction = unproject(pixel);
    if (!direction) return std::nullopt;
    return Eigen::Vector2d(fx_ * direction->x() + cx_, fy_ * direction->y() + cy_);
}

std::optional<Eigen::Vector2d> CameraModel::distort(const Eigen::Vector2d& ideal_pixel) const {
    return project({(ideal_pixel.x() - cx_) / fx_, (ideal_pixel.y() - cy_) / fy_, 1.0});
}

}  // namespace petal
