// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <set>

#include "petal/error.hpp"
#include "petal/html/escape.hpp"
#include "sinks/detail/export_format.hpp"

namespace petal {
namespace {

/// A static transform: the pose of the child in the parent, p_parent = T p_child.
struct StaticTransform {
    std::string parent, child;
    Eigen::Isometry3d pose;
};

std::vector<StaticTransform> transforms_of(const ExportInput& input) {
    std::vector<StaticTransform> list;
    std::set<std::string> children;
    for (const ExportCamera& each : input.cameras) {
        StaticTransform one;
        if (input.lidar_is_parent)
            one = {each.lidar_frame, each.camera_frame, each.T_camera_lidar.inverse()};
        else
            one = {each.camera_frame, each.lidar_frame, each.T_camera_lidar};
        if (one.parent == one.child)
            throw Error("frame '" + one.child +
                        "' would be its own parent; give camera_frame and lidar_frame different "
                        "names");
        if (!children.insert(one.child).second)
            throw Error("frame '" + one.child +
                        "' would have two parents, which a tree of frames does not allow; set "
                        "parent to " +
                        (input.lidar_is_parent ? "camera" : "lidar") +
                        ", or export the cameras apart");
        list.push_back(std::move(one));
    }
    return list;
}

/// A comment of XML may not hold two hyphens.
std::string xml_comment(const std::vector<std::string>& lines) {
    std::string text = comment(lines, "  ");
    for (std::size_t at = 0; (at = text.find("--", at)) != std::string::npos;)
        text.replace(at, 2, "- -");
    return "<!--\n" + text + "-->\n";
}

/// Arguments go through a shell's rules: what is no plain name is refused rather than quoted, since
/// tf2 allows none of it in a frame's name.
std::string frame_id(const std::string& name) {
    if (name.empty() || name.find_first_of(" \t\r\n\"'\\") != std::string::npos)
        throw Error("'" + name +
                    "' is no name of a ROS frame; set camera_frame and lidar_frame to names "
                    "without blanks and quotes");
    return html::escape(name);
}

/// A node's name has letters, digits and underscores alone.
std::string node_name(const StaticTransform& one) {
    std::string name = "static_" + one.parent + "_to_" + one.child;
    for (char& c : name)
        if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'))) c = '_';
    return name;
}

/// The optical frame as a turn of the camera's body frame (x forward, y left, z up): REP 103.
Eigen::Matrix3d body_from_optical() {
    Eigen::Matrix3d R;
    R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    return R;
}

}  // namespace

ExportText export_ros1(const ExportInput& input) {
    std::vector<std::string> head = export_head(input);
    head.emplace_back("");
    head.emplace_back("ROS 1. args: x y z (m), quaternion x y z w, parent frame, child frame;");
    head.emplace_back("the pose of the child in the parent: p_parent = R p_child + t.");
    std::string text = xml_comment(head) + "<launch>\n";
    for (const StaticTransform& one : transforms_of(input)) {
        const Eigen::Quaterniond q(one.pose.linear());
        const Eigen::Vector3d t = one.pose.translation();
        text += "  <node pkg=\"tf2_ros\" type=\"static_transform_publisher\" name=\"" +
                node_name(one) + "\"\n        args=\"" +
                fixed9_list({t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}, " ") + " " +
                frame_id(one.parent) + " " + frame_id(one.child) + "\"/>\n";
    }
    return {text + "</launch>\n"};
}

ExportText export_ros2(const ExportInput& input) {
    std::vector<std::string> head = export_head(input);
    head.emplace_back("");
    head.emplace_back("ROS 2: ros2 launch FILE, or the arguments behind");
    head.emplace_back("ros2 run tf2_ros static_transform_publisher");
    head.emplace_back("The pose of the child in the parent: p_parent = R p_child + t.");
    std::string text = xml_comment(head) + "<launch>\n";
    for (const StaticTransform& one : transforms_of(input)) {
        const Eigen::Quaterniond q(one.pose.linear());
        const Eigen::Vector3d t = one.pose.translation();
        text += "  <node pkg=\"tf2_ros\" exec=\"static_transform_publisher\" name=\"" +
                node_name(one) + "\"\n        args=\"--x " + fixed9(t.x()) + " --y " +
                fixed9(t.y()) + " --z " + fixed9(t.z()) + " --qx " + fixed9(q.x()) + " --qy " +
                fixed9(q.y()) + " --qz " + fixed9(q.z()) + " --qw " + fixed9(q.w()) +
                " --frame-id " + frame_id(one.parent) + " --child-frame-id " + frame_id(one.child) +
                "\"/>\n";
    }
    return {text + "</launch>\n"};
}

ExportText export_autoware(const ExportInput& input) {
    std::vector<std::string> head = export_head(input);
    head.emplace_back("");
    head.emplace_back(
        "sensor_kit_calibration.yaml of Autoware: the pose of the child in the parent,");
    head.emplace_back("x y z in m, R = Rz(yaw) Ry(pitch) Rx(roll) in rad.");
    head.emplace_back(
        "camera_link is the camera's body frame: x forward, y left, z up. The optical");
    head.emplace_back("frame above is camera_link turned by roll -pi/2, pitch 0, yaw -pi/2.");
    ExportInput body = input;
    for (ExportCamera& each : body.cameras) {
        each.T_camera_lidar.linear() = body_from_optical() * each.T_camera_lidar.linear();
        each.T_camera_lidar.translation() =
            (body_from_optical() * each.T_camera_lidar.translation()).eval();
        each.camera_frame = each.camera + "/camera_link";
    }
    std::string text = comment(head);
    std::string parent;
    for (const StaticTransform& one : transforms_of(body)) {
        // Poses of one parent stand behind each other, as the cameras of a LiDAR do.
        if (one.parent != parent) text += yaml_text(parent = one.parent) + ":\n";
        const Eigen::Vector3d t = one.pose.translation();
        const Eigen::Vector3d angles = roll_pitch_yaw(one.pose.linear());
        text += "  " + yaml_text(one.child) + ":\n";
        const std::pair<const char*, double> values[] = {{"x", t.x()},         {"y", t.y()},
                                                         {"z", t.z()},         {"roll", angles[0]},
                                                         {"pitch", angles[1]}, {"yaw", angles[2]}};
        for (const auto& [key, value] : values)
            text += std::string("    ") + key + ": " + fixed9(value) + "\n";
    }
    return {text};
}

}  // namespace petal
