// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/board_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "detectors/detail/board_line_picture.hpp"
#include "petal/calibration/plane_fit.hpp"
#include "petal/calibration/target.hpp"

namespace petal {
namespace {

constexpr int kMaxBoardsPerPlane = 16;
constexpr double kOffEdges = 0.025;  ///< m: half of a Mid-70's beam at 10 m
constexpr int kPlateParts = 2;       ///< in each direction ...
constexpr int kMinPartPoints = 100;  ///< ... each of which must hold as many points
constexpr double kBorder =
    0.03;  ///< m: points that far outside the outline belong to the board too

/// The finite points of all planes, each once: a point that is there twice says nothing new.
/// Sorted, so that the result does not depend on the order in which a detector lists them.
std::vector<Eigen::Vector3d> gather(const Planes& planes) {
    std::vector<Eigen::Vector3d> points;
    for (const Plane& plane : planes.planes) {
        const auto& cloud = *plane.inliers.points;
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            float x, y, z;
            cloud.getPoint(i, x, y, z);
            if (std::isfinite(x) && std::isfinite(y) && std::isfinite(z))
                points.emplace_back(static_cast<double>(x), static_cast<double>(y),
                                    static_cast<double>(z));
        }
    }
    const auto less = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
        return std::make_tuple(a.x(), a.y(), a.z()) < std::make_tuple(b.x(), b.y(), b.z());
    };
    std::sort(points.begin(), points.end(), less);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
}

/// The points on the plate of a board, LiDAR frame, as far off its edges as no beam reaches that an
/// edge cuts. Empty where they cover too little of it to tell the plane: in a cloud of margin
/// points.
std::vector<Eigen::Vector3d> plate_points(const Cloud& cloud, const HoleGrid& grid,
                                          const Eigen::Isometry3d& T_lidar_board, double depth) {
    std::vector<Eigen::Vector3d> plate;
    const Eigen::Isometry3d to_board = T_lidar_board.inverse();
    const double reach = std::hypot(grid.width, grid.height);
    const Eigen::Vector3d at = T_lidar_board.translation();
    std::array<int, kPlateParts * kPlateParts> parts{};
    const auto& xs = cloud.points->getPointsBufferRef_x();
    const auto& ys = cloud.points->getPointsBufferRef_y();
    const auto& zs = cloud.points->getPointsBufferRef_z();
    for (std::size_t i = 0; i < xs.size(); ++i) {
        const Eigen::Vector3d p(static_cast<double>(xs[i]), static_cast<double>(ys[i]),
                                static_cast<double>(zs[i]));
        if (!((p - at).squaredNorm() <= reach * reach)) continue;
        const Eigen::Vector3d q = to_board * p;
        if (std::abs(q.z()) > depth || q.x() < kOffEdges || q.y() < kOffEdges ||
            q.x() > grid.width - kOffEdges || q.y() > grid.height - kOffEdges)
            continue;
        const bool by_hole =
            std::any_of(grid.holes.begin(), grid.holes.end(), [&](const HoleGrid::Hole& hole) {
                return q.x() > grid.x[hole.left].at - kOffEdges &&
                       q.x() < grid.x[hole.right].at + kOffEdges &&
                       q.y() > grid.y[hole.top].at - kOffEdges &&
                       q.y() < grid.y[hole.bottom].at + kOffEdges;
            });
        if (by_hole) continue;
        plate.push_back(p);
        const auto part = [](double along, double size) {
            return static_cast<std::size_t>(
                std::clamp(static_cast<int>(along / size * kPlateParts), 0, kPlateParts - 1));
        };
        ++parts[part(q.y(), grid.height) * kPlateParts + part(q.x(), grid.width)];
    }
    const bool covered =
        std::all_of(parts.begin(), parts.end(), [](int count) { return count >= kMinPartPoints; });
    if (!covered) plate.clear();
    return plate;
}

/// Where the plane's own points are: centre and radius.
struct Patch {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double radius = 0.0;
};

Patch patch_of(const Plane& plane) {
    Patch patch;
    std::vector<Eigen::Vector3d> points;
    const auto& cloud = *plane.inliers.points;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        float x, y, z;
        cloud.getPoint(i, x, y, z);
        if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) continue;
        points.emplace_back(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
        patch.centre += points.back();
    }
    if (points.empty()) return patch;
    patch.centre /= static_cast<double>(points.size());
    for (const auto& p : points) patch.radius = std::max(patch.radius, (p - patch.centre).norm());
    return patch;
}

/// Removes what belongs to a board that was found, so that no other plane finds it again.
void remove_board(std::vector<Eigen::Vector3d>& points, const LidarBoard& board,
                  const HoleGrid& grid, double depth) {
    const Eigen::Isometry3d to_board = board.T_lidar_board.inverse();
    points.erase(std::remove_if(points.begin(), points.end(),
                                [&](const Eigen::Vector3d& p) {
                                    const Eigen::Vector3d q = to_board * p;
                                    return std::abs(q.z()) <= depth && q.x() >= -kBorder &&
                                           q.y() >= -kBorder && q.x() <= grid.width + kBorder &&
                                           q.y() <= grid.height + kBorder;
                                }),
                 points.end());
}

}  // namespace

void BoardLines::describe(Spec<Params>& s) {
    s.summary("Finds boards with rectangular holes in planes of margin points, from lines.");
    s.doc(
        R"(In the coordinates of each plane, lines are found by RANSAC with removal (equation (4), lines 13 to 18 of Algorithm 1). The two
perpendicular directions that carry the most points split them into horizontal and vertical ones, relative to the board and not to the
world; each direction is the weighted sum (5). The board's corners are the crossings of the lines of its holes' sides.

**With `use_target_spacing`** (default) the pattern of the target's parallel lines is placed in that rotation where most points lie on them, and scored on
the sides of the holes; then the board's six degrees of freedom and two inflations d_x, d_y are fitted together, by least squares with
Tukey's weights, to the points on the sides: line k of a direction lies at c + x_k + s_k d, where s_k = -1 or +1 points outward from each
hole's middle. Edge points lie on the board's side of the real edge (by 5 to 15 mm at 2 to 3 m in the letter's indoor data),
or outdoors on the other side, differently in both axes: the common shift takes that up without moving the board. The corners are
exactly those of the target; `edge_inflation_x_mm` and `edge_inflation_y_mm` tell d, which has a prior of 0 +- 20 mm.

A point's range errs by more than its direction, so it counts where its ray meets the board. The plane is that of the **plate's own points**
where `cloud` holds them (wire the scene's cloud, and the margin points to the plane detector); they are taken 25 mm off every edge. In a cloud of margin points there are none:
then the points on the sides tell the plane, which lie behind it by some mm, because beams that the rim cuts return late or blend with what is behind.

The covariance of the pose (left perturbation; rho in m, phi in rad) is marginal over d. Points of one side are not independent: the beam
and the background move the whole side. So an error common to each side's points is estimated beside that of the single point: what opposite sides of a
hole have in common shifts the board, what they have not only makes the hole smaller. Across the plane the same is done for cells of a fifth of the plate. What the points
cannot tell is added: opposite edges moved unlike (`edge_asymmetry`; and an eighth of the plate's thickness as it is seen obliquely through a hole), 0.15 mm of the plate's place, and without
points of the plate `edge_range_sigma` along the ray. A range bias that all points share is not in it.

**Without it** the letter's plain lines are crossed: of two lines nearer than `min_line_distance` the one with fewer points goes; two lines as far
apart as the board is wide are its edges and go; of one line too many, the one with the most points goes (the only edge seen: the lower
one is lost on the floor). Where these rules do not leave the right number, the lines of the placed pattern are taken, each through the mean of its points, without the spacing.
The holes then come out too large or too small (`hole_side_x_mm`), and no covariance is given.

A plane without a board is rejected by the board's geometry: `min_sides` of the holes' sides must be covered by points (each is cut into
fifths), few points may lie inside the holes, and d may not exceed `max_inflation`. Several boards in one plane are found one after another.
The points looked at are the inliers of all planes near the plane in question, so a board that two patches share is whole again; equal points
count once. The letter's errors and silences: (5) sums vectors without aligning their signs; delta_d,min cannot be the side of a hole (0.1 m),
as it says: inflated holes leave 80 mm between each other, so the default is half of it; distances "approximately equal" to the board's
length have no tolerance there, here `edge_tolerance`.

Order: row by row from the top left for an observer at the sensor whose up is the LiDAR's +z (its +x where +z is along the normal).
The true upper side the LiDAR cannot tell: a square board looks alike in four orders.)");
    s.role("lidar_board_detector");
    s.reads<Cloud>(
        "cloud",
        "the scene's points in the LiDAR frame, of which the plate's own tell its plane; or "
        "the margin points that the planes were found in");
    s.reads<Planes>("planes", "plane patches with their points");
    s.writes<LidarBoards>("boards", "the boards, in the order of their planes");
    s.param("target", &Params::target)
        .doc(
            "the calibration board: a shipped name or the path of a target file; rectangular "
            "holes");
    s.param("use_target_spacing", &Params::use_target_spacing)
        .doc(
            "fit parallel lines with the target's spacing and one inflation a direction; false: "
            "the letter's "
            "plain lines");
    s.param("plane_threshold", &Params::plane_threshold)
        .unit("m")
        .within(0.001, 1.0)
        .doc("points nearer than this to a plane are looked at with it");
    s.param("line_threshold", &Params::line_threshold)
        .unit("m")
        .within(0.001, 0.1)
        .doc(
            "delta_d^Line of (4): a point nearer than this to a line is its inlier (Table I: 0.01 "
            "m at 3 m)");
    s.param("min_line_points", &Params::min_line_points)
        .at_least(2)
        .doc("a line with fewer points is none");
    s.param("min_line_distance", &Params::min_line_distance)
        .unit("m")
        .within(0.0, 1.0)
        .doc("delta_d,min: parallel lines nearer than this coincide; plain lines only");
    s.param("edge_tolerance", &Params::edge_tolerance)
        .unit("m")
        .within(0.0, 0.5)
        .doc(
            "two lines as far apart as the board is long, give or take this, are its edges; plain "
            "lines only");
    s.param("max_inflation", &Params::max_inflation)
        .unit("m")
        .within(0.0, 0.2)
        .doc("the most that a hole's side may lie outside (or inside) the real edge");
    s.param("edge_asymmetry", &Params::edge_asymmetry)
        .unit("m")
        .within(0.0, 0.1)
        .doc(
            "1 sigma by which opposite edges may be moved unlike, which the points cannot tell; in "
            "the covariance only");
    s.param("edge_range_sigma", &Params::edge_range_sigma)
        .unit("m")
        .within(0.0, 0.1)
        .doc(
            "1 sigma by which points on edges may lie behind the plate together; in the covariance "
            "only, where no points of the plate tell its plane");
    s.param("min_side_coverage", &Params::min_side_coverage)
        .unit("1")
        .within(0.0, 1.0)
        .doc("a side counts where this share of its fifths, 18 mm off its ends, holds a point");
    s.param("min_sides", &Params::min_sides)
        .unit("1")
        .within(0.0, 1.0)
        .doc("share of the holes' sides that must count (0.75: 12 of 16)");
    s.param("max_hole_points", &Params::max_hole_points)
        .unit("1")
        .within(0.0, 1.0)
        .doc("the most points inside holes, as a share of those on their sides and inside");
    s.param("max_line_rms", &Params::max_line_rms)
        .unit("m")
        .within(0.0001, 0.1)
        .doc(
            "the most RMS distance of a board's points from its holes' sides; with the spacing "
            "only");
    s.param("max_side_offset", &Params::max_side_offset)
        .unit("m")
        .within(0.0, 1.0)
        .doc(
            "no board where the sides, each as a whole, scatter by more about the target's (1 "
            "sigma): its holes stand otherwise than the target file says");
}

void BoardLines::run(Run& run) {
    const auto planes = run.in_ptr<Planes>("planes");
    const Target target = load_target(p_.target);
    const HoleGrid grid = HoleGrid::of(target);
    const BoardFinder finder(grid, p_);

    LidarBoards boards;
    const Cloud& cloud = run.in<Cloud>("cloud");
    boards.lidar = cloud.sensor_label;
    std::vector<Eigen::Vector3d> points = gather(*planes);
    const double diagonal = std::hypot(grid.width, grid.height);
    const auto poll = [&run] { run.check_cancelled(); };
    const auto plate_of = [&](const Eigen::Isometry3d& T_lidar_board) {
        return plate_points(cloud, grid, T_lidar_board, p_.plane_threshold);
    };

    struct Seen {
        std::size_t plane;
        BoardAttempt attempt;
    };
    std::vector<Seen> seen;
    for (std::size_t k = 0; k < planes->planes.size(); ++k) {
        const Plane& plane = planes->planes[k];
        const Patch patch = patch_of(plane);
        const Eigen::Isometry3d frame = plane_frame(plane.normal, patch.centre);
        for (int turn = 0; turn < kMaxBoardsPerPlane; ++turn) {
            run.check_cancelled();
            std::vector<Eigen::Vector3d> near;
            for (const Eigen::Vector3d& p : points)
                if (std::abs(plane.normal.dot(p) + plane.offset) <= p_.plane_threshold &&
                    (p - patch.centre).norm() <= patch.radius + 0.5 * diagonal)
                    near.push_back(p);
            BoardAttempt attempt = finder.find(near, frame, plate_of, run.rng(), poll);
            const bool found = attempt.board.has_value();
            if (found) {
                attempt.board->target = target.name;
                remove_board(points, *attempt.board, grid, p_.plane_threshold);
                boards.boards.push_back(*attempt.board);
            } else {
                run.log(LogLevel::debug, "plane " + std::to_string(k) + ": " + attempt.miss + "; " +
                                             attempt.threshold);
            }
            // After the last board of a plane only its rest is left: no miss worth a picture.
            if (found || turn == 0) seen.push_back({k, std::move(attempt)});
            if (!found) break;
        }
    }
    run.log(LogLevel::info, std::to_string(boards.boards.size()) + " boards in " +
                                std::to_string(planes->planes.size()) + " planes");

    if (boards.boards.empty()) {
        Note note;
        note.looked_for =
            "boards '" + target.name + "' in " + std::to_string(planes->planes.size()) + " planes";
        const auto best = std::max_element(
            seen.begin(), seen.end(),
            [](const Seen& a, const Seen& b) { return a.attempt.closeness < b.attempt.closeness; });
        if (best == seen.end()) {
            note.nearest_miss = "there is no plane";
            note.hint = "look at the plane detector and the filters before it";
        } else {
            note.nearest_miss = "plane " + std::to_string(best->plane) + " (" +
                                std::to_string(best->attempt.points.size()) +
                                " points): " + best->attempt.miss;
            note.threshold = best->attempt.threshold;
            note.hint =
                "see the saved pictures of the planes; is the target's file that of the board?";
        }
        run.note(note);
    }
    if (boards.boards.empty() || run.debug()) {
        std::vector<int> pictures(planes->planes.size(), 0);
        for (const Seen& s : seen) {
            const int number = pictures[s.plane]++;
            run.save("plane_" + std::to_string(s.plane) +
                         (number > 0 ? "_" + std::to_string(number) : "") + ".png",
                     [&s](const std::filesystem::path& file) { draw_attempt(s.attempt, file); });
        }
    }
    run.write("boards", std::move(boards));
}

}  // namespace petal
