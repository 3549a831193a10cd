// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "result_diff.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>

#include "petal/calibration/extrinsics_sigma.hpp"
#include "petal/calibration/read_result.hpp"
#include "petal/calibration/se3.hpp"
#include "petal/json_value.hpp"

namespace petal {
namespace {

constexpr double kBand = 1e-3;  // as the verdict's 99.9 %
constexpr double kRanges[] = {5.0, 20.0, 50.0};

/// The survival function of chi-square with six degrees of freedom, in closed form.
double chance_of_larger(double chi2) {
    const double half = 0.5 * chi2;
    return std::exp(-half) * (1.0 + half + 0.5 * half * half);
}

struct OneResult {
    Extrinsics extrinsics;
    JsonValue json;
};

OneResult read_one(std::filesystem::path file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) file /= "result.json";
    return {read_result(file), JsonValue::read(file, "result")};
}

/// Of the corners that both sensors have of a camera's boards: u = f x / z + c, least squares. The
/// distortion is left out, which costs a percent or two: enough to tell what a pose means.
std::optional<double> focal_of(const OneResult& result, const CameraExtrinsics& camera) {
    std::vector<Eigen::Vector2d> places;  // x / z of the point, u
    const auto scenes = result.json.find("scenes");
    if (!scenes || !scenes->is_list()) return std::nullopt;
    for (const JsonValue& scene : scenes->list())
        for (const JsonValue& board : scene.at("boards").list()) {
            const JsonValue lidar = board.at("corners_lidar"), image = board.at("corners_image");
            const JsonValue label = board.at("camera");
            if (!lidar.is_list() || !image.is_list()) continue;
            if (!label.is_text() || label.text() != camera.camera) continue;
            const auto points = lidar.list(), pixels = image.list();
            for (std::size_t i = 0; i < std::min(points.size(), pixels.size()); ++i) {
                const Eigen::Vector3d p = camera.T_camera_lidar * points[i].vector3();
                if (p.z() > 0.0) places.emplace_back(p.x() / p.z(), pixels[i].vector2().x());
            }
        }
    Eigen::MatrixX2d A(static_cast<Eigen::Index>(places.size()), 2);
    Eigen::VectorXd u(A.rows());
    for (Eigen::Index i = 0; i < A.rows(); ++i) {
        A.row(i) << places[static_cast<std::size_t>(i)].x(), 1.0;
        u[i] = places[static_cast<std::size_t>(i)].y();
    }
    if (A.rows() < 4) return std::nullopt;
    const Eigen::ColPivHouseholderQR<Eigen::MatrixX2d> fit(A);
    const double focal = fit.solve(u)[0];
    if (fit.rank() < 2 || !std::isfinite(focal) || focal <= 0.0) return std::nullopt;
    return focal;
}

/// Straight ahead of A's camera, p = (0, 0, range): d(u, v) = f (x / z, y / z) of Exp(xi) p, whose
/// derivative by xi at 0 is f / range [1 0 0 0 range 0; 0 1 0 -range 0 0].
PixelShift shift_at(double range, double focal, const Vector6d& xi, const Matrix6d& covariance) {
    const Eigen::Vector3d moved = se3_exp(xi) * Eigen::Vector3d(0.0, 0.0, range);
    Eigen::Matrix<double, 2, 6> J;
    J << 1, 0, 0, 0, range, 0, 0, 1, 0, -range, 0, 0;
    J *= focal / range;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(J * covariance * J.transpose(),
                                                               Eigen::EigenvaluesOnly);
    return {range, focal * moved.head<2>().norm() / moved.z(),
            std::sqrt(std::max(0.0, eigen.eigenvalues()[1]))};
}

PoseDifference difference_of(const CameraExtrinsics& a, const CameraExtrinsics& b, double focal) {
    PoseDifference result;
    result.camera = a.camera;
    result.lidar = a.lidar;
    const Vector6d xi = se3_log(b.T_camera_lidar * a.T_camera_lidar.inverse());
    result.translation = b.T_camera_lidar.translation() - a.T_camera_lidar.translation();
    result.rotation = xi.tail<3>();
    const Eigen::Matrix<double, 6, 1> variances =
        (column_covariance(a) + column_covariance(b)).diagonal();
    result.sigma_translation = variances.head<3>().cwiseSqrt();
    result.sigma_rotation = variances.tail<3>().cwiseSqrt();
    const Matrix6d sum = a.covariance + b.covariance;
    const Eigen::LLT<Matrix6d> factor(sum);
    if (factor.info() == Eigen::Success) {
        result.mahalanobis_squared = xi.dot(factor.solve(xi));
        result.probability = chance_of_larger(*result.mahalanobis_squared);
    }
    result.focal_px = focal;
    if (focal > 0.0)
        for (const double range : kRanges) result.pixels.push_back(shift_at(range, focal, xi, sum));
    return result;
}

void add_figures(const JsonValue& root, bool first,
                 std::map<std::string, FigureDifference>& figures) {
    const auto add = [&](const std::string& name, const JsonValue& value) {
        if (!value.is_number()) return;
        FigureDifference& figure = figures[name];
        figure.name = name;
        (first ? figure.a : figure.b) = value.number();
    };
    if (const auto metrics = root.find("metrics"); metrics && metrics->is_object())
        for (const std::string& key : metrics->keys()) add(key, metrics->at(key));
    if (const auto residuals = root.find("residuals"); residuals && residuals->is_object())
        for (const std::string& key : residuals->keys())
            add("residuals." + key, residuals->at(key));
}

std::string sensors_of(const CameraExtrinsics& camera) {
    return "camera '" + camera.camera + "' and LiDAR '" + camera.lidar + "'";
}

const CameraExtrinsics* same_sensors(const Extrinsics& among, const CameraExtrinsics& camera) {
    for (const CameraExtrinsics& other : among.cameras)
        if (other.camera == camera.camera && other.lidar == camera.lidar) return &other;
    return nullptr;
}

}  // namespace

bool ResultDifference::agree() const {
    if (poses.empty() || !only_a.empty() || !only_b.empty()) return false;
    return std::all_of(poses.begin(), poses.end(), [](const PoseDifference& pose) {
        return pose.mahalanobis_squared && pose.probability >= kBand;
    });
}

ResultDifference compare_results(const std::filesystem::path& file_a,
                                 const std::filesystem::path& file_b, double focal_px) {
    const OneResult a = read_one(file_a), b = read_one(file_b);
    ResultDifference result;
    result.a = {to_string(a.extrinsics.level), a.extrinsics.reasons};
    result.b = {to_string(b.extrinsics.level), b.extrinsics.reasons};
    for (const CameraExtrinsics& camera : a.extrinsics.cameras) {
        const CameraExtrinsics* other = same_sensors(b.extrinsics, camera);
        if (other == nullptr) {
            result.only_a.push_back(sensors_of(camera));
            continue;
        }
        std::optional<double> focal;
        if (focal_px > 0.0) focal = focal_px;
        if (!focal) focal = focal_of(a, camera);
        if (!focal) focal = focal_of(b, *other);
        result.poses.push_back(difference_of(camera, *other, focal.value_or(0.0)));
    }
    for (const CameraExtrinsics& camera : b.extrinsics.cameras)
        if (same_sensors(a.extrinsics, camera) == nullptr)
            result.only_b.push_back(sensors_of(camera));
    std::map<std::string, FigureDifference> figures;
    add_figures(a.json, true, figures);
    add_figures(b.json, false, figures);
    for (const auto& [name, figure] : figures)
        if (figure.a != figure.b) result.figures.push_back(figure);
    return result;
}

}  // namespace petal
