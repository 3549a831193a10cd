// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "petal/calibration/plane_fit.hpp"
#include "petal/run.hpp"

namespace petal {

struct JoiningPlanesParams {
    double plane_threshold = 0.03;
    int min_points = 30;
    double min_share = 0.1;
    int max_planes = 4;
    double line_distance = 0.05;
    double max_gap = 0.05;
};

/// The planes among the points of a small part of space, and which points lie where two of them
/// join. One object serves one part after the other; it keeps its memory.
class JoiningPlanes {
   public:
    /// Planes join where the angle between them (rad, at most pi / 2) lies in between.
    JoiningPlanes(const JoiningPlanesParams& params, double min_angle, double max_angle)
        : params_(params), min_angle_(min_angle), max_angle_(max_angle) {}

    /// Which of the points (m) lie at a join: 1, else 0. Random draws come from `rng`.
    const std::vector<std::uint8_t>& at_joins(const std::vector<Eigen::Vector3d>& points, Rng& rng);

   private:
    struct Surface {
        PlaneFit plane;
        std::vector<std::uint32_t> points;
    };
    /// A point near a line, and how far along the line it lies (m).
    struct Along {
        double t;
        std::uint32_t point;
    };

    /// Fills surfaces_, all but their points.
    void find_planes(const std::vector<Eigen::Vector3d>& points, Rng& rng);
    /// Gives each point to the first plane that it is near to.
    void share_out(const std::vector<Eigen::Vector3d>& points);
    /// The best plane through three of the remaining points; none where no three define one.
    bool draw_plane(const std::vector<Eigen::Vector3d>& points, Rng& rng, PlaneFit& best) const;
    void mark_join(const std::vector<Eigen::Vector3d>& points, const Surface& a, const Surface& b);
    std::vector<Along> near_line(const std::vector<Eigen::Vector3d>& points, const Surface& surface,
                                 const Eigen::Vector3d& origin,
                                 const Eigen::Vector3d& direction) const;
    /// Marks those of `some` that have one of `others` beside them.
    void mark_beside(const std::vector<Along>& some, const std::vector<Along>& others);

    JoiningPlanesParams params_;
    double min_angle_, max_angle_;
    std::vector<Surface> surfaces_;
    std::vector<std::uint32_t> remaining_;  ///< far from all planes found
    std::vector<std::uint8_t> marked_;
};

}  // namespace petal
