// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/scene/placement.hpp"

#include "petal/calibration/angles.hpp"

namespace petal::simulation {

Interval read_interval(const JsonValue& node, double lowest, double highest, const char* unit) {
    if (!node.is_list()) {
        const double value = node.number(lowest, highest, unit);
        return {value, value};
    }
    const std::vector<JsonValue> ends = node.list();
    if (ends.size() != 2) node.fail("must be a number or an interval [low, high]");
    const Interval interval{ends[0].number(lowest, highest, unit),
                            ends[1].number(lowest, highest, unit)};
    if (interval.low > interval.high) node.fail("must begin with the smaller number");
    return interval;
}

Eigen::Matrix3d turned_deg(const Eigen::Vector3d& yaw_pitch_roll) {
    const Eigen::Vector3d angles = yaw_pitch_roll / kDegrees;
    return (Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitX()))
        .toRotationMatrix();
}

Eigen::Vector3d read_angles_deg(const JsonValue& node) {
    Eigen::Vector3d angles = Eigen::Vector3d::Zero();
    const char* keys[] = {"yaw_deg", "pitch_deg", "roll_deg"};
    for (int i = 0; i < 3; ++i)
        if (const auto angle = node.find(keys[i])) angles(i) = angle->number(-180.0, 180.0, "deg");
    return angles;
}

Eigen::Matrix3d looking_ahead() {
    Eigen::Matrix3d frame;
    frame.col(0) = -Eigen::Vector3d::UnitY();
    frame.col(1) = -Eigen::Vector3d::UnitZ();
    frame.col(2) = Eigen::Vector3d::UnitX();
    return frame;
}

Eigen::Vector3d draw_in_ball(Engine& engine, double radius) {
    // Three numbers a try: about every second one lies in the ball.
    for (;;) {
        Eigen::Vector3d p;
        for (int axis = 0; axis < 3; ++axis) p(axis) = uniform(engine, -1.0, 1.0);
        if (p.squaredNorm() <= 1.0) return radius * p;
    }
}

}  // namespace petal::simulation
