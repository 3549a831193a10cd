// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/plane_points.hpp"

#include <algorithm>

#include "metrics/detail/scene_name.hpp"
#include "petal/calibration/angles.hpp"
#include "petal/error.hpp"

namespace petal {

void PlanePointsMetric::describe(Spec<Params>& s) {
    s.summary(
        "What filters and plane stage leave of the boards: edge points, vacant points, sides.");
    s.doc(
        R"(Looks at the points of all planes that lie on a true board or within `surroundings` of it, and tells by
the labels of a simulated scene what they are. Each figure is told for every scene and (without a scene's
name) in total, over all scenes so far.

| name | what |
|---|---|
| plane_points.count | points of planes on and around the boards |
| plane_points.board_count | of these, points of a board |
| plane_points.edge_share | of the board's points, those near a true edge: of the outline or of a hole |
| plane_points.vacant_share | of all counted, the vacant ones: between surfaces that shared the beam, on neither of them |
| plane_points.least_side_count | board points near the poorest side of a hole of any board: with none, a line is lost |
| plane_points.missed_boards | boards without a single point |

Near is within `edge_angle_deg` as seen from the LiDAR, in the plane of the board. The default is half the
diagonal of a cell of 0.16 deg, which is the margin filter's for 20 s of a Mid-70, and half the beam's longer
side, 0.28 deg: 13 mm at 3 m, 22 mm at 5 m. A board's edge is not drawn sharper than that by any filter that
decides cell by cell.)");
    s.role("metric");
    s.reads<Truth>("truth", "labels, one for each point of the scene's own cloud, and the boards");
    s.reads<Planes>("planes", "planes with their points, which have their scene_index");
    s.writes<Metrics>("metrics", "counts and shares, for the scene and in total so far");
    s.param("edge_angle_deg", &Params::edge_angle_deg)
        .unit("deg")
        .within(0.0, 10.0)
        .doc("board points at most so far from a true edge are edge points");
    s.param("surroundings", &Params::surroundings)
        .unit("m")
        .within(0.0, 1.0)
        .doc("points at most so far from a board's plate count");
    s.param("targets", &Params::targets)
        .doc("files of targets that petal does not ship, found by the name that the truth tells");
}

PlanePointsMetric::Counts PlanePointsMetric::count(const Truth& truth, const Planes& planes,
                                                   const std::string& scene, Run& run) {
    constexpr std::size_t kBoard = 1;
    const BoardEdges edges(truth.boards, targets_, run);
    std::vector<std::vector<std::size_t>> sides(edges.size());
    for (std::size_t i = 0; i < edges.size(); ++i)
        sides[i].resize(static_cast<std::size_t>(edges.hole_sides(static_cast<int>(i))));
    std::vector<bool> seen(edges.size(), false);

    Counts counts;
    counts.boards = edges.size();
    for (const Plane& plane : planes.planes) {
        run.check_cancelled();
        const Cloud& cloud = plane.inliers;
        if (cloud.scene_index.size() != cloud.size())
            throw Error("scene '" + scene + "': a plane on port 'planes' has " +
                        std::to_string(cloud.size()) + " points and " +
                        std::to_string(cloud.scene_index.size()) +
                        " entries in scene_index; the stage that wrote it must write one a point");
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            const std::size_t index = cloud.scene_index[i];
            const std::size_t label = index < truth.labels.size() ? truth.labels[index] : 4;
            if (label >= counts.label.size())
                throw Error("scene '" + scene + "': point " + std::to_string(index) +
                            " of the scene's cloud has " +
                            (index < truth.labels.size()
                                 ? "the unknown label " + std::to_string(label)
                                 : std::string("no label")) +
                            "; wire the truth of the same scene");
            float x = 0.0F, y = 0.0F, z = 0.0F;
            cloud.points->getPointFast(i, x, y, z);
            const Eigen::Vector3d point(x, y, z);
            const BoardEdges::Place place = edges.place(point);
            if (place.board < 0 || place.away > p_.surroundings) continue;
            ++counts.near_boards;
            ++counts.label[label];
            if (label != kBoard) continue;
            const auto board = static_cast<std::size_t>(place.board);
            seen[board] = true;
            const double near = p_.edge_angle_deg / kDegrees * point.norm();
            if (place.edge <= near) ++counts.edge;
            const auto side = edges.nearest_hole_side(place.board, point);
            if (side.side >= 0 && side.distance <= near)
                ++sides[board][static_cast<std::size_t>(side.side)];
        }
    }
    for (std::size_t board = 0; board < sides.size(); ++board) {
        if (!seen[board]) ++counts.boards_without;
        for (const std::size_t points : sides[board])
            counts.least_side = std::min(points, counts.least_side.value_or(points));
    }
    return counts;
}

void PlanePointsMetric::add_figures(const Counts& counts, const std::string& scene,
                                    Metrics& metrics) {
    constexpr std::size_t kBoard = 1, kVacant = 2;
    const auto add = [&](const char* name, double value) {
        metrics.values.push_back({std::string("plane_points.") + name, value, "1", scene});
    };
    const auto number = [](std::size_t count) { return static_cast<double>(count); };
    add("count", number(counts.near_boards));
    add("board_count", number(counts.label[kBoard]));
    if (counts.label[kBoard] > 0)
        add("edge_share", number(counts.edge) / number(counts.label[kBoard]));
    if (counts.near_boards > 0)
        add("vacant_share", number(counts.label[kVacant]) / number(counts.near_boards));
    if (counts.least_side) add("least_side_count", number(*counts.least_side));
    add("missed_boards", number(counts.boards_without));
}

void PlanePointsMetric::run(Run& run) {
    const auto& truth = run.in<Truth>("truth");
    const std::string name = scene_name(run.frame());
    Metrics metrics;
    if (truth.labels.empty() || truth.boards.empty()) {
        without_truth_.push_back(name);
    } else {
        const Counts counts = count(truth, run.in<Planes>("planes"), name, run);
        total_.near_boards += counts.near_boards;
        for (std::size_t i = 0; i < counts.label.size(); ++i) total_.label[i] += counts.label[i];
        total_.edge += counts.edge;
        total_.boards += counts.boards;
        total_.boards_without += counts.boards_without;
        if (counts.least_side)
            total_.least_side =
                std::min(*counts.least_side, total_.least_side.value_or(*counts.least_side));
        add_figures(counts, name, metrics);
    }
    if (total_.boards > 0) add_figures(total_, "", metrics);
    run.write("metrics", std::move(metrics));
}

void PlanePointsMetric::finish(Run& run) {
    if (without_truth_.empty()) return;
    run.note({"labels of points, and boards",
              "no truth: " + std::to_string(without_truth_.size()) +
                  " scenes have no labels or no boards and do not count: " + listed(without_truth_),
              "",
              "they are known of simulated scenes only: source.simulator gives them, sink.rawlog "
              "writes them beside the rawlog"});
}

}  // namespace petal
