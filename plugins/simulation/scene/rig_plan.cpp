// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/scene/rig_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/camera_model.hpp"
#include "simulation/scene/camera_reader.hpp"
#include "simulation/scene/placement.hpp"

namespace petal::simulation {
namespace {

constexpr double kNowhere = -1e9;  // px: the margin of what no camera sees

/// The least distance of a pixel from the image's border, below 0 outside.
double inside_by(const Eigen::Vector2d& pixel, const mrpt::img::TCamera& camera) {
    return std::min(
        {pixel.x(), pixel.y(), camera.ncols - 1.0 - pixel.x(), camera.nrows - 1.0 - pixel.y()});
}

/// Over a camera that turns by up to `rotation` rad and moves by up to `translation` m: the point
/// is then seen somewhere in a cone around where the nominal camera sees it. The image's directions
/// are (but for a weak distortion) a convex set, so the cone's rim decides.
double point_margin(const CameraModel& model, const Eigen::Vector3d& p_camera, double rotation,
                    double translation) {
    const double range = p_camera.norm();
    if (range <= translation) return kNowhere;
    const double opening = rotation + std::asin(translation / range);
    const Eigen::Vector3d axis = p_camera / range;
    const Eigen::Vector3d across = axis.unitOrthogonal();
    constexpr int kDirections = 24;
    double margin = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kDirections; ++i) {
        const Eigen::Vector3d about = Eigen::AngleAxisd(2.0 * kPi * i / kDirections, axis) * across;
        const auto pixel = model.project(Eigen::AngleAxisd(opening, about) * p_camera);
        if (!pixel) return kNowhere;
        margin = std::min(margin, inside_by(*pixel, model.camera()));
    }
    return margin;
}

}  // namespace

RigPlan::RigPlan(const JsonValue& scene) {
    if (const auto lidar = scene.find("lidar")) {
        read_lidar(*lidar);
    } else {
        profile_file_ = find_lidar_profile("livox_mid70");
        profile_ = load_lidar_profile(profile_file_);
    }
    if (const auto cameras = scene.find("cameras")) {
        std::set<std::string> labels;
        for (const JsonValue& camera : cameras->list()) {
            cameras_.push_back(read_camera(camera));
            if (!labels.insert(cameras_.back().device.label).second)
                camera.fail("has the label of another camera, '" + cameras_.back().device.label +
                            "'; give each a label of its own");
        }
        if (cameras_.empty()) cameras->fail("must list at least one camera");
    } else {
        cameras_.push_back(default_camera());
    }
    if (const auto rig = scene.find("rig")) {
        rig->only({"rotation_deg", "translation"});
        if (const auto value = rig->find("rotation_deg"))
            rotation_deg_ = value->number(0.0, 45.0, "deg");
        if (const auto value = rig->find("translation"))
            translation_ = value->number(0.0, 2.0, "m");
    }
}

void RigPlan::read_lidar(const JsonValue& lidar) {
    lidar.only({"profile", "range_offset_sigma", "direction_error_deg"});
    const auto name = lidar.find("profile");
    try {
        profile_file_ = find_lidar_profile(name ? name->text() : "livox_mid70");
    } catch (const Error& error) {
        if (name) name->fail(error.what());
        throw;
    }
    profile_ = load_lidar_profile(profile_file_);
    if (const auto sigma = lidar.find("range_offset_sigma"))
        range_offset_sigma_ = sigma->number(0.0, 1.0, "m");
    if (const auto error = lidar.find("direction_error_deg"))
        direction_error_deg_ = error->number(-5.0, 5.0, "deg");
}

Rig RigPlan::draw(const std::filesystem::path& lidar, Engine& engine) const {
    Rig rig;
    rig.lidar.profile = lidar.empty() ? profile_ : load_lidar_profile(lidar);
    const double sigma =
        range_offset_sigma_ < 0.0 ? rig.lidar.profile.range_offset_sigma : range_offset_sigma_;
    rig.lidar.range_offset = normal(engine, sigma);
    rig.lidar.direction_error_deg = direction_error_deg_;
    for (SceneCamera camera : cameras_) {
        Eigen::Isometry3d T_lidar_camera = camera.T_camera_lidar.inverse();
        T_lidar_camera.pretranslate(draw_in_ball(engine, translation_));
        const Eigen::Vector3d turn = draw_in_ball(engine, rotation_deg_ / kDegrees);
        if (turn.norm() > 0.0)
            T_lidar_camera.rotate(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
        camera.T_camera_lidar = T_lidar_camera.inverse();
        rig.cameras.push_back(std::move(camera));
    }
    rig.boards_seed = engine();
    return rig;
}

double RigPlan::image_margin(const SceneBoard& board) const {
    double best = kNowhere;
    for (const SceneCamera& camera : cameras_) {
        const CameraModel model(camera.device.intrinsics);
        double margin = std::numeric_limits<double>::infinity();
        for (const Eigen::Vector2d& p : board.target.outline)
            margin = std::min(margin, point_margin(model,
                                                   camera.T_camera_lidar * board.T_world_board *
                                                       Eigen::Vector3d(p.x(), p.y(), 0.0),
                                                   rotation_deg_ / kDegrees, translation_));
        best = std::max(best, margin);
    }
    return best;
}

}  // namespace petal::simulation
