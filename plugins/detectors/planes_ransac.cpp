// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/planes_ransac.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "petal/calibration/cloud_subset.hpp"
#include "petal/printed.hpp"

namespace petal {
namespace {

std::string millimetres(double metres) {
    return printed("%.1f mm", metres * 1e3);
}

}  // namespace

void PlanesRansac::describe(Spec<Params>& s) {
    s.summary("Finds plane patches of the size of a board by RANSAC, the best supported first.");
    s.doc(
        R"(Three points at random define a plane n . p + d = 0, equation (2) of the letter. The points nearer than
`plane_threshold` are its inliers, equation (3). The best plane is fitted to its inliers by orthogonal least squares, saved, and its
points are removed; then the search starts again (Algorithm 1, lines 6 to 12) until `max_planes` are found or none has
`min_inliers` points.

Where the letter is silent:

- **Patches, not endless planes.** Boards on a floor share planes through their lower edges, and two boards side by side nearly share
  one: over the whole scene such a plane can beat the board's own. So the second and third point are drawn within `patch_radius` of the
  first, and only points within `patch_radius` (of the first point, later of the inliers' centroid) count. A board of 0.5 m fits in
  a ball of 0.35 m; the default 0.5 m leaves room for a lopsided centroid. A larger plane comes out as several patches.
- **Score.** The sum of 1 - (distance / `plane_threshold`)^2 over the inliers, which among planes with as many points prefers the
  one that fits better.
- **Enough.** "Not enough planes" of the letter is not defined. The seed points needed follow from the share of inliers found so far
  and `confidence`: 1 - (1 - w_a (1 - (1 - w^2)^8))^k, w_a the inliers' share of all points that remain, w of those near the seed,
  8 pairs a seed.

The letter's Table I gives `plane_threshold` as 0.05 m for boards 3 to 5 m away and 0.06 m for 8 m. The covariance of (n, d) takes the points' errors
as independent, along the normal, and as large as the residuals show; a range bias that all points share is not in it.

Which planes hold a board is not decided here: the next stage does, from the board's geometry. A point with a NaN or infinite coordinate is skipped
and counted in the log. All randomness comes from the run's seed.)");
    s.role("plane_detector");
    s.reads<Cloud>("cloud", "margin points in the LiDAR frame");
    s.writes<Planes>("planes",
                     "plane patches, the best supported first; normals towards the sensor");
    s.param("plane_threshold", &Params::plane_threshold)
        .unit("m")
        .within(0.001, 1.0)
        .doc("delta_d^Plane of (3): a point nearer than this to a plane is its inlier");
    s.param("patch_radius", &Params::patch_radius)
        .unit("m")
        .within(0.05, 100.0)
        .doc(
            "the points of one plane lie in a ball of this radius; at least 0.7 of the board's "
            "diagonal "
            "(0.71 m for a board of 0.5 m)");
    s.param("min_inliers", &Params::min_inliers)
        .at_least(3)
        .doc("a plane with fewer points is not written");
    s.param("max_planes", &Params::max_planes)
        .within(1, 1000)
        .doc("the search ends after that many planes");
    s.param("confidence", &Params::confidence)
        .unit("1")
        .within(0.5, 0.999999)
        .doc("probability that the best plane was drawn at least once");
    s.param("max_iterations", &Params::max_iterations)
        .within(1, 1000000)
        .doc("the most seed points for one plane, whatever the confidence");
}

void PlanesRansac::run(Run& run) {
    const Cloud& cloud = run.in<Cloud>("cloud");
    const auto& points = *cloud.points;
    std::vector<std::uint32_t> remaining;
    remaining.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        float x, y, z;
        points.getPoint(i, x, y, z);
        if (std::isfinite(x) && std::isfinite(y) && std::isfinite(z))
            remaining.push_back(static_cast<std::uint32_t>(i));
    }
    const std::size_t valid = remaining.size();
    const std::size_t skipped = points.size() - valid;
    if (skipped > 0)
        run.log(LogLevel::info, "skipped " + std::to_string(skipped) + " of " +
                                    std::to_string(points.size()) +
                                    " points: a coordinate is NaN or infinite");

    Planes planes;
    PlaneSearch search(points, p_);
    std::size_t most = 0;
    while (planes.planes.size() < static_cast<std::size_t>(p_.max_planes)) {
        const auto patch = search.best(remaining, run.rng(), [&run] { run.check_cancelled(); });
        if (planes.planes.empty()) most = search.most_inliers();
        if (!patch) break;
        Plane plane;
        plane.normal = patch->fit.normal;
        plane.offset = patch->fit.offset;
        plane.covariance = patch->fit.covariance;
        plane.rms = patch->fit.rms;
        plane.inliers = subset(cloud, patch->inliers);
        run.log(LogLevel::debug, "plane " + std::to_string(planes.planes.size()) + ": " +
                                     std::to_string(patch->inliers.size()) + " points, rms " +
                                     millimetres(plane.rms) + ", " +
                                     std::to_string(patch->iterations) + " seed points");
        planes.planes.push_back(std::move(plane));
        std::vector<std::uint32_t> rest;
        rest.reserve(remaining.size());
        std::set_difference(remaining.begin(), remaining.end(), patch->inliers.begin(),
                            patch->inliers.end(), std::back_inserter(rest));
        remaining = std::move(rest);
    }
    if (planes.planes.empty()) {
        Note note;
        note.looked_for = "plane patches of a board's size";
        note.threshold = "min_inliers " + std::to_string(p_.min_inliers);
        if (points.size() == 0) {
            note.nearest_miss = "the cloud is empty";
            note.hint = "look at the stage before: it let no point pass";
        } else if (valid < static_cast<std::size_t>(p_.min_inliers)) {
            note.nearest_miss = std::to_string(valid) + " of " + std::to_string(points.size()) +
                                " points are finite";
            note.hint = "look at the stage before: too few points passed";
        } else {
            note.nearest_miss = std::to_string(most) + " points within plane_threshold " +
                                millimetres(p_.plane_threshold) +
                                " of one plane and patch_radius of each other";
            note.hint = "points on one line make no plane; else lower min_inliers";
        }
        run.note(note);
    }
    run.write("planes", std::move(planes));
}

}  // namespace petal
