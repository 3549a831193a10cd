// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/pose_starts.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "petal/error.hpp"

namespace petal {
namespace {

struct Directions {
    std::vector<Eigen::Vector3d> points;
    std::vector<cv::Point2d> normalised;  ///< x / z, y / z
};

Directions directions(const CameraModel& model, const std::vector<PointPair>& pairs) {
    Directions result;
    for (const PointPair& pair : pairs) {
        const auto direction = model.unproject(pair.image);
        if (!direction) continue;
        result.points.push_back(pair.lidar);
        result.normalised.emplace_back(direction->x(), direction->y());
    }
    return result;
}

struct Axes {
    Eigen::Isometry3d T_lidar_plane = Eigen::Isometry3d::Identity();  ///< z along the normal
    Eigen::Vector3d singular_values = Eigen::Vector3d::Zero();
};

Axes principal_axes(const std::vector<Eigen::Vector3d>& points) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& point : points) mean += point;
    mean /= static_cast<double>(points.size());
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const auto& point : points) scatter += (point - mean) * (point - mean).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
    Axes axes;
    axes.singular_values = eigen.eigenvalues().reverse().cwiseMax(0.0).cwiseSqrt();
    Eigen::Matrix3d rotation = eigen.eigenvectors().rowwise().reverse();
    if (rotation.determinant() < 0.0) rotation.col(2) = -rotation.col(2);
    axes.T_lidar_plane.linear() = rotation;
    axes.T_lidar_plane.translation() = mean;
    return axes;
}

bool planar(const Eigen::Vector3d& s) {
    return s[1] > 0.01 * s[0] && s[2] < 0.1 * s[1];
}

Eigen::Isometry3d to_pose(const cv::Mat& rvec, const cv::Mat& tvec) {
    cv::Mat rotation;
    cv::Rodrigues(rvec, rotation);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) pose.linear()(i, j) = rotation.at<double>(i, j);
        pose.translation()(i) = tvec.at<double>(i);
    }
    return pose;
}

int flag_of(const std::string& method) {
    if (method == "iterative") return cv::SOLVEPNP_ITERATIVE;
    if (method == "epnp") return cv::SOLVEPNP_EPNP;
    if (method == "sqpnp") return cv::SOLVEPNP_SQPNP;
    if (method == "ippe") return cv::SOLVEPNP_IPPE;
    throw Error("PnP method '" + method + "' is unknown; use iterative, epnp, sqpnp or ippe");
}

}  // namespace

bool is_planar(const std::vector<Eigen::Vector3d>& points) {
    return points.size() >= 3 && planar(principal_axes(points).singular_values);
}

std::vector<Eigen::Isometry3d> pnp_poses(const std::string& method, const CameraModel& model,
                                         const std::vector<PointPair>& pairs) {
    const int flag = flag_of(method);
    const Directions seen = directions(model, pairs);
    std::vector<Eigen::Isometry3d> poses;
    if (seen.points.size() < 4) return poses;
    const Axes axes = principal_axes(seen.points);
    // Points on a line leave a rotation free.
    if (axes.singular_values[1] <= 0.01 * axes.singular_values[0]) return poses;
    const bool flat = planar(axes.singular_values);
    if (flag == cv::SOLVEPNP_IPPE && !flat) return poses;
    // OpenCV's iterative method starts from six points at least where they are not planar.
    if (flag == cv::SOLVEPNP_ITERATIVE && !flat && seen.points.size() < 6) return poses;

    // In the frame of the principal axes: well conditioned, and z = 0 as IPPE wants it.
    const Eigen::Isometry3d T_plane_lidar = axes.T_lidar_plane.inverse();
    std::vector<cv::Point3d> objects;
    for (const auto& point : seen.points) {
        const Eigen::Vector3d p = T_plane_lidar * point;
        objects.emplace_back(p.x(), p.y(), flag == cv::SOLVEPNP_IPPE ? 0.0 : p.z());
    }
    std::vector<cv::Mat> rotations, translations;
    try {
        cv::solvePnPGeneric(objects, seen.normalised, cv::Matx33d::eye(), cv::noArray(), rotations,
                            translations, false, static_cast<cv::SolvePnPMethod>(flag));
    } catch (const cv::Exception&) {
        return poses;  // OpenCV's way to say that the points are degenerate
    }
    for (std::size_t i = 0; i < rotations.size(); ++i) {
        const Eigen::Isometry3d pose = to_pose(rotations[i], translations[i]) * T_plane_lidar;
        bool in_front = pose.matrix().allFinite();
        for (const auto& point : seen.points) in_front = in_front && (pose * point).z() > 0.0;
        if (in_front) poses.push_back(pose);
    }
    return poses;
}

std::vector<Eigen::Isometry3d> planar_poses(const CameraModel& model,
                                            const std::vector<PointPair>& pairs) {
    return pnp_poses("ippe", model, pairs);
}

std::vector<Eigen::Isometry3d> pose_starts(const CameraModel& model,
                                           const std::vector<PointPair>& pairs) {
    std::vector<Eigen::Isometry3d> starts;
    const auto add = [&](const std::vector<Eigen::Isometry3d>& poses) {
        starts.insert(starts.end(), poses.begin(), poses.end());
    };
    add(pnp_poses("sqpnp", model, pairs));
    add(pnp_poses("epnp", model, pairs));
    add(planar_poses(model, pairs));
    std::map<int, std::vector<PointPair>> boards;
    for (const PointPair& pair : pairs)
        if (pair.board >= 0) boards[pair.board].push_back(pair);
    if (boards.size() > 1)
        for (const auto& [board, corners] : boards) add(planar_poses(model, corners));
    return starts;
}

}  // namespace petal
