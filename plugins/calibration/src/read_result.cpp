// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/read_result.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "petal/calibration/angles.hpp"
#include "petal/json_value.hpp"

namespace petal {
namespace {

constexpr double kRigid = 1e-6;      // of R' R - 1: what rounding to 7 digits leaves
constexpr double kSymmetric = 1e-6;  // relative to the largest element

Eigen::MatrixXd matrix_of(const JsonValue& value, int rows, int columns) {
    const std::string shape = std::to_string(rows) + " x " + std::to_string(columns);
    if (!value.is_list()) value.fail("must be a " + shape + " matrix: a list of rows");
    const auto list = value.list();
    if (list.size() != static_cast<std::size_t>(rows))
        value.fail("must be a " + shape + " matrix, not " + std::to_string(list.size()) + " rows");
    Eigen::MatrixXd matrix(rows, columns);
    for (int r = 0; r < rows; ++r) {
        const JsonValue& row = list[static_cast<std::size_t>(r)];
        if (!row.is_list()) row.fail("must be a row of " + std::to_string(columns) + " numbers");
        const auto numbers = row.list();
        if (numbers.size() != static_cast<std::size_t>(columns))
            row.fail("must be a row of " + std::to_string(columns) + " numbers, not " +
                     std::to_string(numbers.size()));
        for (int c = 0; c < columns; ++c) {
            matrix(r, c) = numbers[static_cast<std::size_t>(c)].number();
            if (!std::isfinite(matrix(r, c))) row.fail("must be finite");
        }
    }
    return matrix;
}

Eigen::Isometry3d pose_of(const JsonValue& value) {
    const Eigen::Matrix4d matrix = matrix_of(value, 4, 4);
    const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
    const Eigen::RowVector4d last(0.0, 0.0, 0.0, 1.0);
    if ((matrix.row(3) - last).cwiseAbs().maxCoeff() > kRigid)
        value.fail("must have 0 0 0 1 as its last row");
    const double off =
        (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (!(off < kRigid) || rotation.determinant() < 0.0)
        value.fail("must be a rigid motion: its upper left 3 x 3 is no rotation");
    // What the rounding left is taken out, so that the inverse is the transpose again.
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rotation,
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = svd.matrixU() * svd.matrixV().transpose();
    pose.translation() = matrix.topRightCorner<3, 1>();
    return pose;
}

Matrix6d covariance_of(const JsonValue& value) {
    const Matrix6d matrix = matrix_of(value, 6, 6);
    const double largest = matrix.cwiseAbs().maxCoeff();
    if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() > kSymmetric * largest)
        value.fail("must be a covariance: it is not symmetric");
    Matrix6d symmetric = 0.5 * (matrix + matrix.transpose());
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(symmetric, Eigen::EigenvaluesOnly);
    if (eigen.eigenvalues().minCoeff() < -kSymmetric * largest)
        value.fail("must be a covariance: it has a negative variance");
    return symmetric;
}

/// What a later run needs of the diagnosis: the intrinsics that the pose belongs to. None where the
/// focal length was not estimated.
std::optional<Diagnosis> diagnosis_of(const JsonValue& entry, const Matrix6d& covariance) {
    const auto told = entry.find("focal");
    if (!told || !told->is_object() || !told->at("estimated").boolean()) return std::nullopt;
    Diagnosis::FocalScale focal;
    focal.estimated = true;
    focal.scale = told->at("scale").number();
    if (!(focal.scale > 0.0)) told->at("scale").fail("must be positive");
    focal.sigma = told->at("sigma").number();
    Diagnosis diagnosis;
    diagnosis.focal = focal;
    const auto considered = entry.find("considered");
    diagnosis.covariance_considered =
        considered ? covariance_of(considered->at("covariance")) : covariance;
    return diagnosis;
}

Level level_of(const JsonValue& value) {
    const std::string name = value.choice({"usable", "weak", "not_usable"});
    if (name == "usable") return Level::usable;
    return name == "weak" ? Level::weak : Level::not_usable;
}

}  // namespace

Extrinsics read_result(const std::filesystem::path& file) {
    const JsonValue root = JsonValue::read(file, "result");
    if (!root.has("verdict") || !root.has("extrinsics"))
        root.fail("has no 'verdict' or no 'extrinsics': it is no result.json of a calibration");
    Extrinsics extrinsics;
    extrinsics.level = level_of(root.at("verdict"));
    if (const auto reasons = root.find("reasons"))
        for (const JsonValue& reason : reasons->list()) extrinsics.reasons.push_back(reason.text());
    const JsonValue list = root.at("extrinsics");
    if (!list.is_list()) list.fail("must be a list of cameras");
    const auto cameras = list.list();
    if (cameras.empty())
        list.fail(
            "is empty: that run solved nothing, so there is nothing to go by; see its "
            "reasons, and name the result of a run that did");
    std::set<std::pair<std::string, std::string>> known;
    for (const JsonValue& entry : cameras) {
        if (!entry.is_object()) entry.fail("must be an object with camera, lidar, T_camera_lidar");
        CameraExtrinsics camera;
        camera.camera = entry.at("camera").text();
        camera.lidar = entry.at("lidar").text();
        if (!known.insert({camera.camera, camera.lidar}).second)
            entry.fail("is of camera '" + camera.camera + "' and LiDAR '" + camera.lidar +
                       "', which was there before");
        camera.T_camera_lidar = pose_of(entry.at("T_camera_lidar"));
        camera.covariance = covariance_of(entry.at("covariance"));
        if (const auto sigma = entry.find("sigma_translation_m"))
            camera.sigma_translation = sigma->vector3();
        if (const auto sigma = entry.find("sigma_rotation_deg"))
            camera.sigma_rotation = sigma->vector3() / kDegrees;
        if (const auto weakest = entry.find("weakest_direction"))
            if (weakest->is_text()) camera.weakest_direction = weakest->text();
        camera.diagnosis = diagnosis_of(entry, camera.covariance);
        camera.order.by = DecidedBy::given;
        camera.order.reason = "the extrinsics were given";
        extrinsics.cameras.push_back(std::move(camera));
    }
    return extrinsics;
}

}  // namespace petal
