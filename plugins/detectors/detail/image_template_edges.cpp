// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_template_edges.hpp"

#include <algorithm>
#include <cmath>

#include "petal/calibration/se3.hpp"

namespace petal {

namespace {

/// m outwards from the front edge to where the back edge appears, in the plane of the front: seen
/// past the front edge of a hole only where it lies inside the hole, of the plate only outside.
double wall_seen(const TemplateSide& side, const Eigen::Vector2d& at,
                 const Eigen::Vector2d& outwards, const Eigen::Vector3d& eye, double thickness) {
    if (thickness <= 0.0 || eye.z() >= 0.0) return 0.0;
    const double moved = (eye.head<2>() - at).dot(outwards) * thickness / (thickness - eye.z());
    return side.outline ? std::max(0.0, moved) : std::min(0.0, moved);
}

/// The edge nearest to what is looked for: a rise out of a hole; rise or fall out of the plate,
/// whichever is stronger. Offset along `normal`.
std::optional<EdgePoint> edge_of(const EdgeSampler& edges, const TemplateSide& side,
                                 const Eigen::Vector2d& start, const Eigen::Vector2d& normal,
                                 double reach) {
    auto rise = edges.steepest_rise(start, normal, reach);
    if (!side.outline) return rise;
    auto fall = edges.steepest_rise(start, -normal, reach);
    if (fall) fall->offset = -fall->offset;
    if (!fall || (rise && rise->strength > fall->strength)) return rise;
    return fall;
}

}  // namespace

double EdgeSample::shifted(const EdgeShifts& shifts) const {
    const auto& share = outline ? shifts.plate_wall : shifts.hole_wall;
    const double faint = outline ? 1.0 : shifts.faintness_of(side);
    const double part =
        outwards.x() * outwards.x() * share[0] + outwards.y() * outwards.y() * share[1];
    const double moved = 1.0 - (1.0 - part) * faint;
    return px_per_m * ((outline ? shifts.outset : -shifts.inset) + moved * wall);
}

std::optional<TemplatePose::Seen> TemplatePose::see(const TemplateModel& model,
                                                    const CameraModel& camera,
                                                    const Eigen::Vector2d& board) const {
    const Eigen::Vector3d p = T_camera_board * Eigen::Vector3d(board.x(), board.y(), 0.0);
    const Eigen::Vector3d arm = T_camera_board.linear().leftCols<2>() * (board - model.center());
    Eigen::Matrix<double, 2, 3> by_point;
    const auto pixel = camera.project(p, &by_point);
    if (!pixel) return std::nullopt;
    Seen seen;
    seen.pixel = *pixel;
    seen.by_pose << by_point, -by_point * skew(arm);
    seen.by_board = by_point * T_camera_board.linear().leftCols<2>();
    return seen;
}

void TemplatePose::step(const TemplateModel& model, const Eigen::Matrix<double, 6, 1>& by) {
    const Eigen::Vector3d middle =
        T_camera_board * Eigen::Vector3d(model.center().x(), model.center().y(), 0.0);
    const Eigen::Vector3d turn = by.tail<3>();
    const double angle = turn.norm();
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    if (angle > 0.0) rotation = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
    T_camera_board.linear() = rotation * T_camera_board.linear();
    T_camera_board.translation() =
        middle + by.head<3>() + rotation * (T_camera_board.translation() - middle);
}

std::vector<EdgeSample> sample_edges(const EdgeSampler& edges, const TemplateModel& model,
                                     const CameraModel& camera, const TemplatePose& pose,
                                     const EdgeShifts& shifts, const EdgeReach& reach) {
    std::vector<EdgeSample> samples;
    const auto middle = pose.see(model, camera, model.center());
    if (!middle) return samples;
    const double scale = std::sqrt(std::abs(middle->by_board.determinant()));
    const double range = reach.range(model.hole_size() * scale);
    const Eigen::Vector3d eye = pose.T_camera_board.inverse().translation();
    for (std::size_t s = 0; s < model.sides().size(); ++s) {
        const TemplateSide& side = model.sides()[s];
        if (side.outline && !reach.outline) continue;
        const auto whole = pose.see(model, camera, side.at(0.5));
        const double length =
            whole ? side.length() * (whole->by_board * side.along(0.5)).norm() : 0.0;
        // Near a corner the other side's blur bends the edge.
        const double margin =
            side.radius > 0.0 ? 0.0 : std::clamp(1.5 / std::max(length, 1.0), 0.05, 0.3);
        const int count = std::clamp(static_cast<int>(std::lround(length * (1.0 - 2.0 * margin))),
                                     std::min(4, reach.most_samples), reach.most_samples);
        for (int i = 0; i < count; ++i) {
            const double t = margin + (1.0 - 2.0 * margin) * (i + 0.5) / count;
            EdgeSample sample;
            sample.side = s;
            sample.outline = side.outline;
            sample.u = 2.0 * t - 1.0;
            sample.outwards = side.outwards(t);
            const auto seen = pose.see(model, camera, side.at(t));
            if (seen) {
                const Eigen::Vector2d along = (seen->by_board * side.along(t)).normalized();
                Eigen::Vector2d normal(along.y(), -along.x());
                sample.px_per_m = normal.dot(seen->by_board * sample.outwards);
                if (sample.px_per_m < 0.0) {
                    normal = -normal;
                    sample.px_per_m = -sample.px_per_m;
                }
                sample.in_image = edges.grey(seen->pixel).has_value();
                sample.by_pose = normal.transpose() * seen->by_pose;
                sample.wall =
                    wall_seen(side, side.at(t), sample.outwards, eye, model.target().thickness);
                const double expected = sample.shifted(shifts);
                const auto edge =
                    edge_of(edges, side, seen->pixel + expected * normal, normal, range);
                if (edge) {
                    sample.seen = true;
                    sample.offset = expected + edge->offset;
                    sample.strength = edge->strength;
                }
            }
            samples.push_back(sample);
        }
    }
    return samples;
}

}  // namespace petal
