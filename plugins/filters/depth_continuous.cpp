// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/depth_continuous.hpp"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "filters/detail/space_cells.hpp"
#include "filters/detail/write_subset.hpp"
#include "petal/calibration/angles.hpp"
#include "petal/calibration/for_pieces.hpp"
#include "petal/printed.hpp"

namespace petal {

void DepthContinuous::describe(Spec<Params>& s) {
    s.summary("Keeps the points near lines where two planes join with continuous depth.");
    s.doc(
        R"(What the letter sets its margin points against: the natural edges of Yuan et al. (its reference 24, *Pixel-level extrinsic self
calibration of high resolution LiDAR and camera in targetless environments*, RA-L 2021), where a surface bends and the depth does not
jump: corners of rooms, of houses, kerbs. Such edges hold no vacant points. A board in front of a wall has none of them: its
margins, and with them its holes, go. Use it to see that, or for a stage that wants natural edges.

Space is cut into voxels of `voxel_size`. In each, planes are taken out one after the other by RANSAC (points within
`plane_threshold`, at least `min_points` and a share of `min_share` a plane, at most `max_planes`), each fitted again to its points by
least squares. Points at most three times as far from it are its noise: they take no part in the search for the next. Where two of
them meet at an angle between `min_angle_deg` and `max_angle_deg`, the points of both that lie within `line_distance` of
their line of intersection stay, if the other plane has such a point too at most `max_gap` away along the line: planes that would
meet only beyond their points do not join.

Simplified against the paper: the voxels have one size and a fixed grid, so a line near the side of a voxel is lost where one of its planes
has too few points on this side; the paper draws its edge points evenly on the fitted lines, here the measured points stay; the
bound on the lengths of lines and the matching with image edges are not part of it.

Each voxel has random numbers of its own: the result does not depend on the number of threads.)");
    s.role("outlier_remover");
    s.reads<Cloud>("cloud", "points in the LiDAR frame");
    s.writes<Cloud>("cloud", "the points that stay, in their order");
    s.param("voxel_size", &Params::voxel_size)
        .unit("m")
        .within(0.05, 100.0)
        .doc("edge of a voxel; the paper takes 0.5 m indoors and 1 m outdoors");
    s.param("plane_threshold", &Params::plane_threshold)
        .unit("m")
        .within(0.001, 1.0)
        .doc("a point at most so far from a plane belongs to it; 1.5 sigma of a Mid-70's range");
    s.param("min_points", &Params::min_points)
        .within(3, 1000000)
        .doc("points that a plane needs in a voxel");
    s.param("min_share", &Params::min_share)
        .unit("1")
        .within(0.0, 1.0)
        .doc(
            "share of a voxel's points that a plane needs: noise and vacant points make planes "
            "too");
    s.param("max_planes", &Params::max_planes)
        .within(2, 20)
        .doc("planes that are looked for in a voxel");
    s.param("min_angle_deg", &Params::min_angle_deg)
        .unit("deg")
        .within(0.0, 90.0)
        .doc("planes at a smaller angle do not join");
    s.param("max_angle_deg", &Params::max_angle_deg)
        .unit("deg")
        .within(0.0, 90.0)
        .doc("planes at a larger angle do not join; of the two angles the smaller one counts");
    s.param("line_distance", &Params::line_distance)
        .unit("m")
        .within(0.001, 10.0)
        .doc("points at most so far from the line stay");
    s.param("max_gap", &Params::max_gap)
        .unit("m")
        .within(0.001, 10.0)
        .doc("along the line a point of the other plane must be at most so far away");
    s.check([](const Params& p) {
        return p.min_angle_deg <= p.max_angle_deg
                   ? std::string()
                   : std::string("'min_angle_deg' must not exceed 'max_angle_deg'");
    });
}

void DepthContinuous::run(Run& run) {
    constexpr std::size_t kVoxels = 8;  // a piece of work
    const auto& cloud = run.in<Cloud>("cloud");
    const auto finite = finite_points(cloud);
    const SpaceCells voxels(cloud, finite, params_.voxel_size, run);
    const Rng::result_type seed = run.rng()();
    std::vector<std::uint8_t> stays(cloud.size(), 0);
    for_pieces(run, voxels.size(), kVoxels, [&](std::size_t begin, std::size_t end) {
        JoiningPlanes planes(params_, params_.min_angle_deg / kDegrees,
                             params_.max_angle_deg / kDegrees);
        std::vector<Eigen::Vector3d> points;
        for (std::size_t voxel = begin; voxel < end; ++voxel) {
            const SpaceCells::Points own = voxels.points(voxel);
            if (own.size() < 2 * static_cast<std::size_t>(params_.min_points)) continue;
            if (run.cancelled()) return;
            points.clear();
            for (const SpaceCells::Point& p : own)
                points.push_back(Eigen::Vector3f(p.x, p.y, p.z).cast<double>());
            Rng rng(seed + voxel);
            const auto& marked = planes.at_joins(points, rng);
            for (std::size_t k = 0; k < own.size(); ++k) stays[own.first[k].index] = marked[k];
        }
    });
    std::vector<std::uint32_t> kept;
    for (const std::uint32_t i : finite)
        if (stays[i] != 0) kept.push_back(i);
    write_subset(
        run, cloud, kept, finite.size(),
        {"lines where two planes join", "",
         printed("planes of min_points %d in voxels of %g m, at %g to %g deg", params_.min_points,
                 params_.voxel_size, params_.min_angle_deg, params_.max_angle_deg),
         "enlarge the voxels, or give more seconds of data"});
}

}  // namespace petal
