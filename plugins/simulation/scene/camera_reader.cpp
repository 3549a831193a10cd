// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/scene/camera_reader.hpp"

#include "petal/calibration/camera_model.hpp"
#include "petal/error.hpp"
#include "simulation/scene/placement.hpp"

namespace petal::simulation {
namespace {

constexpr double kLongest = 100000.0;  // px: of a focal length

/// From the camera's place and its angles from looking along the LiDAR's x axis.
Eigen::Isometry3d mounted(const Eigen::Vector3d& position, const Eigen::Vector3d& angles_deg) {
    Eigen::Isometry3d T_lidar_camera = Eigen::Isometry3d::Identity();
    T_lidar_camera.translate(position);
    T_lidar_camera.rotate(turned_deg(angles_deg) * looking_ahead());
    return T_lidar_camera.inverse();
}

/// As many numbers as there are, up to `most`; 0 for the others.
std::vector<double> read_coefficients(const JsonValue& node, std::size_t most) {
    std::vector<double> values;
    const auto list = node.find("distortion");
    if (list)
        for (const JsonValue& value : list->list())
            values.push_back(value.number(-100.0, 100.0, "1"));
    if (values.size() > most)
        list->fail("has " + std::to_string(values.size()) + " coefficients; this model has " +
                   std::to_string(most));
    values.resize(most);
    return values;
}

void read_distortion(const JsonValue& node, mrpt::img::TCamera& camera) {
    const auto model = node.find("model");
    if (!model && !node.has("distortion")) return;  // the default camera's
    const std::string name =
        model ? model->choice({"none", "plumb_bob", "kannala_brandt"}) : "plumb_bob";
    if (name == "plumb_bob") {
        const std::vector<double> d = read_coefficients(node, 8);  // k1 k2 p1 p2 k3 k4 k5 k6
        camera.setDistortionPlumbBob(d[0], d[1], d[2], d[3], d[4]);
        for (std::size_t i = 5; i < d.size(); ++i) camera.dist[i] = d[i];
    } else if (name == "kannala_brandt") {
        const std::vector<double> d = read_coefficients(node, 4);
        camera.setDistortionKannalaBrandt(d[0], d[1], d[2], d[3]);
    } else {
        read_coefficients(node, 0);
        camera.distortion = mrpt::img::DistortionModel::none;
    }
}

void read_intrinsics(const JsonValue& node, mrpt::img::TCamera& camera) {
    const auto size = [&node](const char* key, int otherwise) {
        const auto value = node.find(key);
        return value ? value->integer(16, 20000) : otherwise;
    };
    const auto pixels = [&node](const char* key, double low, double high, double otherwise) {
        const auto value = node.find(key);
        return value ? value->number(low, high, "px") : otherwise;
    };
    const int width = size("width", 1280), height = size("height", 720);
    camera.ncols = static_cast<std::uint32_t>(width);
    camera.nrows = static_cast<std::uint32_t>(height);
    const double fx = pixels("fx", 1.0, kLongest, 920.0);
    const double fy = pixels("fy", 1.0, kLongest, fx);
    const double cx = pixels("cx", 0.0, width, 0.5 * (width - 1));
    const double cy = pixels("cy", 0.0, height, 0.5 * (height - 1));
    camera.setIntrinsicParamsFromValues(fx, fy, cx, cy);
    read_distortion(node, camera);
}

void read_sensor(const JsonValue& node, CameraDevice& device) {
    const auto number = [&node](const char* key, double low, double high, const char* unit,
                                double& value) {
        if (const auto given = node.find(key)) value = given->number(low, high, unit);
    };
    number("blur_px", 0.0, 20.0, "px", device.blur_px);
    number("vignetting", 0.0, 1.0, "1", device.vignetting);
    number("exposure", 0.001, 1000.0, "1", device.exposure);
    number("electrons", 10.0, 1e7, "electrons", device.electrons);
    number("read_noise", 0.0, 1e5, "electrons", device.read_noise);
    if (const auto colour = node.find("colour")) device.colour = colour->boolean();
}

}  // namespace

SceneCamera read_camera(const JsonValue& node) {
    node.only({"label", "model", "width", "height", "fx", "fy", "cx", "cy", "distortion", "blur_px",
               "vignetting", "exposure", "electrons", "read_noise", "colour", "mounting",
               "focal_error", "principal_point_error_px"});
    SceneCamera camera = default_camera();
    if (const auto label = node.find("label")) camera.device.label = label->text();
    read_intrinsics(node, camera.device.intrinsics);
    camera.device.intrinsics.cameraName = camera.device.label;
    read_sensor(node, camera.device);
    try {
        CameraModel(camera.device.intrinsics);
    } catch (const Error& error) {
        node.fail(error.what());
    }
    if (const auto error = node.find("focal_error"))
        camera.focal_error = error->number(-0.5, 0.5, "1");
    if (const auto error = node.find("principal_point_error_px")) {
        camera.principal_point_error_px = error->vector2();
        if (camera.principal_point_error_px.norm() > 0.5 * camera.device.intrinsics.ncols)
            error->fail("must be shorter than half the image's width");
    }
    if (const auto mounting = node.find("mounting")) {
        mounting->only({"position", "yaw_deg", "pitch_deg", "roll_deg"});
        const Eigen::Vector3d position = mounting->at("position").vector3();
        if (position.norm() > 10.0)
            mounting->at("position").fail("must lie within 10 m of the LiDAR");
        camera.T_camera_lidar = mounted(position, read_angles_deg(*mounting));
    }
    return camera;
}

mrpt::img::TCamera SceneCamera::recorded_intrinsics() const {
    mrpt::img::TCamera recorded = device.intrinsics;
    recorded.fx(recorded.fx() * (1.0 + focal_error));
    recorded.fy(recorded.fy() * (1.0 + focal_error));
    recorded.cx(recorded.cx() + principal_point_error_px.x());
    recorded.cy(recorded.cy() + principal_point_error_px.y());
    return recorded;
}

SceneCamera default_camera() {
    SceneCamera camera;
    camera.T_camera_lidar = mounted({0.0, -0.05, 0.06}, Eigen::Vector3d::Zero());
    mrpt::img::TCamera& intrinsics = camera.device.intrinsics;
    intrinsics.ncols = 1280;
    intrinsics.nrows = 720;
    intrinsics.setIntrinsicParamsFromValues(920.0, 920.0, 639.5, 359.5);
    intrinsics.setDistortionPlumbBob(-0.05, 0.02, 0.0003, -0.0004, 0.0);
    intrinsics.cameraName = camera.device.label;
    return camera;
}

}  // namespace petal::simulation
