// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "detectors/detail/lidar_template_shape.hpp"

namespace petal {

/// What is fitted: the board, and what the beam does to its edges.
struct PlateState {
    /// The frame of PlateShape: origin in the board's middle, x right, y down, z into the board.
    Eigen::Isometry3d T_lidar_middle = Eigen::Isometry3d::Identity();
    /// m at the board, across the beam's level and its upright axis: by how much the plate looks
    /// larger on each side (its holes smaller). Either sign.
    Eigen::Vector2d shift = Eigen::Vector2d::Zero();
    /// Logarithm of the width (m) of the passage from hits to misses, along the same axes.
    Eigen::Vector2d log_width = Eigen::Vector2d::Constant(-4.8);
    /// m: how much of the plate's thickness the walls of the holes hide, seen obliquely, along the
    /// same axes.
    Eigen::Vector2d wall = Eigen::Vector2d::Zero();
    /// m for each factor e, along the same axes: by how much less the plate looks larger where it
    /// is brighter behind an edge than behind the others. A beam that is half on the plate tells
    /// the stronger half.
    Eigen::Vector2d glare = Eigen::Vector2d::Zero();
    /// Relative: how much farther apart the sides stand than the target's, in x and y. 0 but for
    /// the check of the target.
    Eigen::Vector2d stretch = Eigen::Vector2d::Zero();
};

/// Indices of the parameters. The first six are a motion of the board in its own frame:
/// T_lidar_middle Exp(rho, phi).
enum PlateParameter : int {
    kRhoX,
    kRhoY,
    kRhoZ,
    kPhiX,
    kPhiY,
    kPhiZ,
    kShiftLevel,
    kShiftUpright,
    kWidthLevel,
    kWidthUpright,
    kWallLevel,
    kWallUpright,
    kStretchX,
    kStretchY,
    kGlareLevel,
    kGlareUpright,
    kPlateParameters
};
using PlateVector = Eigen::Matrix<double, kPlateParameters, 1>;
using PlateMatrix = Eigen::Matrix<double, kPlateParameters, kPlateParameters>;

PlateState moved(const PlateState& state, const PlateVector& step);

/// What is known before: means and sigmas of the parameters behind the pose.
struct PlatePriors {
    double shift_level_sigma = 0.006;    ///< m
    double shift_upright_sigma = 0.010;  ///< m
    double width = 0.004;                ///< m
    double width_log_sigma = 1.0;
    Eigen::Vector2d wall = Eigen::Vector2d::Zero();                 ///< m
    Eigen::Vector2d wall_sigma = Eigen::Vector2d::Constant(0.001);  ///< m
    double stretch_sigma = 0.05;
};

/// How the crossing of a ray and a board moves with the board's pose.
struct Crossing {
    Eigen::Vector2d place;  ///< in the frame of PlateShape
    Eigen::Vector2d slope;  ///< of the ray: x and y for each m into the board
    /// dplace / d(rho, phi).
    Eigen::Matrix<double, 2, 6> jacobian() const;
};
/// \pre the ray through `point` (LiDAR frame) crosses the board from its front.
Crossing cross_board(const Eigen::Isometry3d& T_middle_lidar, const Eigen::Vector3d& point);

/// How places on the board move when a beam moves level or upright by one metre at its range; the
/// columns. Up is the LiDAR's +z; its +x where the ray runs along z.
Eigen::Matrix2d beam_axes(const Eigen::Isometry3d& T_lidar_middle);

/// The distance of a crossing to the edge as the beam sees it, and its derivative.
struct SeenEdge {
    double inside = 0.0;  ///< m
    double width = 0.0;   ///< m
    int side = 0;
    Eigen::Vector2d inward;
    Eigen::Vector2d across;  ///< |beam axes^T inward|: how much of each shift this edge sees
    Eigen::Vector2d place;   ///< of the template: on the front, or behind a hole's wall
    /// Behind a hole's wall: how the place moves with each of PlateState::wall; else zero.
    Eigen::Matrix2d behind = Eigen::Matrix2d::Zero();
    double brightness = 0.0;  ///< of what is behind this edge
};
SeenEdge see_edge(const PlateShape& shape, const PlateState& state, const Eigen::Matrix2d& axes,
                  const Eigen::Vector2d& widths, const Crossing& crossing, double brightness = 0.0);
/// dinside / dparameters; zero for the widths.
PlateVector edge_jacobian(const SeenEdge& edge, const Crossing& crossing);

/// Rays that hit or missed, and places where rays that would have missed do not return.
struct ToldRays {
    struct Ray {
        Eigen::Vector3d point;  ///< LiDAR frame: its direction counts
        bool hit = false;
        double brightness = 0.0;  ///< of what is behind the nearest edge: see backgrounds_of()
    };
    struct Silent {
        Eigen::Vector3d point;  ///< LiDAR frame, on the plane
        double rays = 0.0;      ///< how many rays go there that would not return past the plate
        bool on_plate = false;
    };
    std::vector<Ray> rays;
    std::vector<Silent> silent;
    /// Rays so far off every edge that they tell nothing of its place: as the template has them, or
    /// against it. And of these the hits.
    double right = 0.0, wrong = 0.0, far_hits = 0.0;
    double floor = 0.005;  ///< share of rays that tell the wrong thing, whatever the reason
};

struct PlateEvaluation {
    double value = 0.0;       ///< logarithm of the likelihood, with the priors
    double rays_value = 0.0;  ///< without
    PlateVector gradient = PlateVector::Zero();
    PlateMatrix expected = PlateMatrix::Zero();  ///< Fisher's information, for steps
    /// From the scores, for the covariance. This and `sides` only where asked for.
    PlateMatrix observed = PlateMatrix::Zero();
    struct Side {
        double score = 0.0, information = 0.0;   ///< of a shift of this side alone, into the plate
        PlateVector pull = PlateVector::Zero();  ///< what it does to the gradient
        /// How much each axis of the beam passes it, squared, times the information.
        Eigen::Vector2d across = Eigen::Vector2d::Zero();
        /// The same as shares of 1. \pre information > 0
        Eigen::Vector2d share() const { return across / across.sum(); }
    };
    std::vector<Side> sides;
};

/// The logarithm of the likelihood of what the rays told:
///
///     P(hit) = e + (1 - 2 e) / (1 + exp(-D / w)),
///     D = d(u) + |a_l . n| (s_l - b g_l) + |a_u . n| (s_u - b g_u),
///
///     w^2 = (a_l . n)^2 w_l^2 + (a_u . n)^2 w_u^2,
///
///     sum over hits log P + sum over misses log(1 - P) - sum over silent places rays P,
///
/// d the distance of the crossing u to the template's edge (positive on the plate, of the front or
/// behind a hole's wall the back face), n the edge's normal, a_l and a_u the beam's axes on the
/// board, b how bright it is behind the edge. The last sum is what a Poisson process of known
/// density says where nothing returns.
///
/// On the threads of the calling task, summed in the same order for any number of them.
enum class PlateScores { left_out, gathered };
PlateEvaluation evaluate_plate(const PlateShape& shape, const PlateState& state,
                               const PlatePriors& priors, const ToldRays& rays, PlateScores scores);

}  // namespace petal
