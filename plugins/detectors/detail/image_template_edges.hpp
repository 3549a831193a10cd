// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "detectors/detail/image_edge_sampler.hpp"
#include "detectors/detail/image_template_model.hpp"
#include "petal/calibration/camera_model.hpp"

namespace petal {

/// What moves the edges seen in the image from where the target file and the pose put them.
struct EdgeShifts {
    double inset = 0.0;   ///< m: so much smaller do holes look on each side
    double outset = 0.0;  ///< m: so much larger does the plate look on each side
    /// How much of a wall's width an edge moves, by the x and y of the side's normal: of holes and
    /// of the plate.
    std::array<double, 2> hole_wall{0.0, 0.0};
    std::array<double, 2> plate_wall{0.0, 0.0};
    /// By side: how much fainter than usual its edge is. `hole_wall` is that of a usual one: a wall
    /// that differs from the plate moves a faint edge by more of its width. Empty: all are usual.
    std::vector<double> faintness;

    double faintness_of(std::size_t side) const {
        return side < faintness.size() ? faintness[side] : 1.0;
    }
};

/// One place on the template's edges, and the edge that the image shows near it.
struct EdgeSample {
    std::size_t side = 0;
    bool outline = false;
    double u = 0.0;                  ///< along the side, -1 to 1
    Eigen::Vector2d outwards{0, 0};  ///< board frame: TemplateSide::outwards
    bool in_image = false;           ///< else nothing below is meant
    double px_per_m = 0.0;           ///< along the normal in the image
    double wall = 0.0;  ///< m outwards: where the back edge appears beside the front one
    Eigen::Matrix<double, 1, 6> by_pose;  ///< px outwards by a step of the pose (TemplatePose)
    bool seen = false;
    double offset = 0.0;    ///< px outwards from the front edge under the pose
    double strength = 0.0;  ///< EdgePoint::strength

    /// px outwards that `shifts` explain.
    double shifted(const EdgeShifts& shifts) const;
};

/// How far from the template edges are looked for, and at how many places.
struct EdgeReach {
    double in_holes = 0.1;  ///< of a hole's size in the image
    double least_px = 1.5, most_px = 3.0;
    int most_samples = 40;  ///< a side
    bool outline = true;

    /// px, for holes that are so large in the image
    double range(double hole_px) const { return std::clamp(in_holes * hole_px, least_px, most_px); }
};

/// A pose of the board in the camera, and small steps of it: rho (m) and phi (rad) along the
/// camera's axes, turning about the board's middle: p + rho + phi x (p - middle).
struct TemplatePose {
    Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();

    /// d (pixel) / d (rho, phi) of a board point and its pixel; none where the camera cannot see
    /// it.
    struct Seen {
        Eigen::Vector2d pixel;
        Eigen::Matrix<double, 2, 6> by_pose;
        Eigen::Matrix2d by_board;  ///< px/m
    };
    std::optional<Seen> see(const TemplateModel& model, const CameraModel& camera,
                            const Eigen::Vector2d& board) const;
    void step(const TemplateModel& model, const Eigen::Matrix<double, 6, 1>& by);
};

/// Samples along all sides of the template under a pose, near where `shifts` put them.
std::vector<EdgeSample> sample_edges(const EdgeSampler& edges, const TemplateModel& model,
                                     const CameraModel& camera, const TemplatePose& pose,
                                     const EdgeShifts& shifts, const EdgeReach& reach);

}  // namespace petal
