// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_board_refinement.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "detectors/detail/image_corner_fit.hpp"
#include "detectors/detail/image_hole_walls.hpp"

#include "petal/printed.hpp"

namespace petal {

namespace {

using Matrix8d = Eigen::Matrix<double, 8, 8>;
using Vector8d = HomographyStep::Vector8d;

/// A side whose edge is weaker than this part of the board's ordinary edge is not measured.
constexpr double kMinStrength = 0.25;
/// A side is off the board when one of its ends is farther from the homography than this many px,
/// or this many times what is usual on this board.
constexpr double kSideOffPx = 0.5;
constexpr double kSideOffRatio = 4.0;
/// m: holes that differ by more from the target's are another board's.
constexpr double kMaxInset = 0.005;

double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

std::string figure(const char* format, double value, double threshold) {
    return printed(format, value, threshold);
}

}  // namespace

BoardRefiner::BoardRefiner(const EdgeSampler& edges, const HoleLayout& layout,
                           const CameraModel& camera, const RefinementLimits& limits)
    : edges_(edges), layout_(layout), camera_(camera), limits_(limits) {}

RefinedBoard BoardRefiner::refine(const Homography& rough) const {
    RefinedBoard board;
    board.board_to_image = layout_.upright(rough);
    Homography& h = board.board_to_image;
    if (!judge_plate(board)) return board;

    // The range shrinks while the homography settles: a rough one is half a pixel to a fifth of a
    // hole off.
    const std::array<std::array<double, 3>, 4> ranges{
        {{0.35, 2.5, 12.0}, {0.2, 2.0, 6.0}, {0.12, 1.5, 3.0}, {0.12, 1.5, 3.0}}};
    std::vector<SidePoint> points;
    const HoleWalls walls(layout_, camera_.camera());
    std::array<HoleWalls::Share, 2> share;
    board.wall.assign(layout_.sides().size(), 0.0);
    board.wall_sigma = board.wall;
    for (const auto& [in_sides, least, most] : ranges) {
        points = measure(h, in_sides, least, most);
        board.side_measured.assign(layout_.sides().size(), true);
        for (int round = 0; round < 2; ++round) {
            if (!fit_board(h, points, board.side_measured, board.wall) ||
                !layout_.plausible(h, 0.2)) {
                board.rejected = "the hole sides' edge points fit no homography";
                return board;
            }
            if (limits_.model_walls) {
                const std::vector<double> shown = walls.shown(h);
                share = walls.share(shown, share, side_insets(h, points, board.wall),
                                    board.side_measured, {board.contrast, scale_of(h)});
                for (std::size_t s = 0; s < shown.size(); ++s) {
                    const auto& of_axis = share[static_cast<std::size_t>(walls.axis(s))];
                    board.wall[s] = of_axis.mean * shown[s];
                    board.wall_sigma[s] = of_axis.sigma * shown[s];
                }
                if (!fit_board(h, points, board.side_measured, board.wall)) {
                    board.rejected = "the hole sides' edge points fit no homography";
                    return board;
                }
            }
            board.hole_inset = fit_inset(h, points, board.side_measured, board.wall);
            board.side_measured = select_sides(h, points, board.hole_inset, board.wall);
        }
    }
    board.sides_measured =
        static_cast<int>(std::count(board.side_measured.begin(), board.side_measured.end(), true));
    if (!judge_plate(board)) return board;
    std::vector<int> per_hole(layout_.holes(), 0);
    for (std::size_t s = 0; s < layout_.sides().size(); ++s)
        per_hole[layout_.sides()[s].hole] += board.side_measured[s] ? 1 : 0;
    const int fewest = *std::min_element(per_hole.begin(), per_hole.end());
    if (board.sides_measured < limits_.min_sides || fewest < 2) {
        board.rejected =
            figure("edges confirm %.0f hole sides (min_sides %.0f, and 2 of every hole)",
                   board.sides_measured, limits_.min_sides);
        return board;
    }
    const CornerFit corners(layout_, camera_, limits_.tolerance, limits_.sigma_floor_px);
    if (!corners.fit(points, board))
        board.rejected = "hole sides do not meet in corners that the camera can see";
    return board;
}

double BoardRefiner::scale_of(const Homography& h) const {
    double sum = 0.0;
    for (const SideFrame& frame : side_frames(layout_, h)) sum += frame.px_per_m;
    return sum / static_cast<double>(layout_.sides().size());
}

bool BoardRefiner::judge_plate(RefinedBoard& board) const {
    const auto look = [&](const std::vector<Eigen::Vector2d>& where) {
        std::vector<double> greys;
        for (const auto& p : where) {
            const auto raw = camera_.distort(map_point(board.board_to_image, p));
            const auto value = raw ? edges_.grey(*raw) : std::nullopt;
            if (value) greys.push_back(*value);
        }
        return greys;
    };
    const std::vector<double> plate = look(layout_.plate_points());
    const std::vector<double> holes = look(layout_.hole_points());
    if (holes.size() < layout_.hole_points().size() ||
        2 * plate.size() < layout_.plate_points().size()) {
        board.rejected = "the board reaches out of the image";
        return false;
    }
    const double bright = median(plate), dark = median(holes);
    board.contrast = bright > 0.0 ? (bright - dark) / bright : 0.0;
    if (board.contrast < limits_.min_contrast) {
        board.rejected =
            figure("contrast %.2f (min_contrast %.2f)", board.contrast, limits_.min_contrast);
        return false;
    }
    const double middle = 0.5 * (bright + dark);
    const auto above = [middle](double grey) { return grey > middle; };
    board.plate_fraction = static_cast<double>(std::count_if(plate.begin(), plate.end(), above)) /
                           static_cast<double>(plate.size());
    if (board.plate_fraction < limits_.min_plate_fraction) {
        board.rejected = figure("%.2f of the plate is bright (min_plate_fraction %.2f)",
                                board.plate_fraction, limits_.min_plate_fraction);
        return false;
    }
    const double dark_fraction =
        1.0 - static_cast<double>(std::count_if(holes.begin(), holes.end(), above)) /
                  static_cast<double>(holes.size());
    if (dark_fraction < limits_.min_hole_fraction) {
        board.rejected = figure("%.2f of the holes is dark (min_hole_fraction %.2f)", dark_fraction,
                                limits_.min_hole_fraction);
        return false;
    }
    return true;
}

std::vector<SidePoint> BoardRefiner::measure(const Homography& h, double reach_in_sides,
                                             double least_px, double most_px) const {
    std::vector<SidePoint> points;
    const std::vector<SideFrame> frame = side_frames(layout_, h);
    for (std::size_t s = 0; s < layout_.sides().size(); ++s) {
        const auto& side = layout_.sides()[s];
        const double length = (map_point(h, side.to) - map_point(h, side.from)).norm();
        const double reach = std::clamp(reach_in_sides * length, least_px, most_px);
        // Near a corner the other side's blur bends the edge.
        const double margin = std::clamp(1.5 / length, 0.12, 0.3);
        const int count =
            std::clamp(static_cast<int>(std::lround(length * (1.0 - 2.0 * margin))), 4, 40);
        for (int i = 0; i < count; ++i) {
            const double t = margin + (1.0 - 2.0 * margin) * (i + 0.5) / count;
            const Eigen::Vector2d ideal = map_point(h, side.from + t * (side.to - side.from));
            const auto start = camera_.distort(ideal);
            const auto outside = camera_.distort(ideal + 0.5 * frame[s].normal);
            if (!start || !outside) continue;
            const Eigen::Vector2d direction = (*outside - *start).normalized();
            const auto edge = edges_.steepest_rise(*start, direction, reach);
            if (!edge) continue;
            const auto image = camera_.undistort(*start + edge->offset * direction);
            if (image) points.push_back({s, t, *image, edge->strength});
        }
    }
    return points;
}

bool BoardRefiner::fit_board(Homography& h, const std::vector<SidePoint>& points,
                             const std::vector<bool>& use, const std::vector<double>& wall) const {
    const HomographyStep perturbation(layout_);
    for (int iteration = 0; iteration < 15; ++iteration) {
        const std::vector<SideFrame> frame = side_frames(layout_, h);
        std::vector<double> size;
        for (const SidePoint& point : points)
            if (use[point.side])
                size.push_back(std::abs(side_residual(layout_, h, frame[point.side], point) +
                                        wall[point.side] * frame[point.side].px_per_m));
        if (size.size() < 16) return false;
        const double scatter = std::max(1.4826 * median(size), kLeastScatter);
        Matrix8d normal_matrix = Matrix8d::Zero();
        Vector8d right = Vector8d::Zero();
        for (const SidePoint& point : points) {
            if (!use[point.side]) continue;
            const auto& s = layout_.sides()[point.side];
            const double r = side_residual(layout_, h, frame[point.side], point) +
                             wall[point.side] * frame[point.side].px_per_m;
            const double ratio = r / (2.4 * scatter);
            const double weight = 1.0 / (1.0 + ratio * ratio);  // Cauchy
            const Vector8d row =
                perturbation.jacobian(h, s.from + point.t * (s.to - s.from)).transpose() *
                frame[point.side].normal;
            normal_matrix += weight * row * row.transpose();
            right += weight * r * row;
        }
        const Eigen::LDLT<Matrix8d> solver(normal_matrix);
        const Vector8d step = solver.solve(right);
        if (solver.info() != Eigen::Success || !step.allFinite()) return false;
        h = perturbation.apply(h, step);
        if (!h.allFinite() || step.norm() > 1.0) return false;
        if (step.norm() < 1e-6) break;
    }
    return true;
}

std::vector<double> BoardRefiner::side_insets(const Homography& h,
                                              const std::vector<SidePoint>& points,
                                              const std::vector<double>& wall) const {
    const std::vector<SideFrame> frame = side_frames(layout_, h);
    std::vector<std::vector<double>> offsets(layout_.sides().size());
    for (const SidePoint& point : points)
        offsets[point.side].push_back(side_residual(layout_, h, frame[point.side], point));
    std::vector<double> insets(offsets.size(), 0.0);
    for (std::size_t s = 0; s < insets.size(); ++s)
        if (!offsets[s].empty()) insets[s] = -median(offsets[s]) / frame[s].px_per_m - wall[s];
    return insets;
}

double BoardRefiner::fit_inset(const Homography& h, const std::vector<SidePoint>& points,
                               const std::vector<bool>& use,
                               const std::vector<double>& wall) const {
    const std::vector<double> each = side_insets(h, points, wall);
    std::vector<bool> seen(each.size(), false);
    for (const SidePoint& point : points) seen[point.side] = true;
    std::vector<double> insets;
    for (std::size_t s = 0; s < each.size(); ++s)
        if (use[s] && seen[s]) insets.push_back(each[s]);
    return std::clamp(median(insets), -kMaxInset, kMaxInset);
}

std::vector<bool> BoardRefiner::select_sides(const Homography& h,
                                             const std::vector<SidePoint>& points, double inset,
                                             const std::vector<double>& wall) const {
    const std::size_t sides = layout_.sides().size();
    const std::vector<SideFrame> frame = side_frames(layout_, h);
    std::vector<std::vector<double>> offsets(sides), strength(sides);
    std::vector<double> strengths;
    for (const SidePoint& point : points) {
        const SideFrame& own = frame[point.side];
        offsets[point.side].push_back(side_residual(layout_, h, own, point) +
                                      (inset + wall[point.side]) * own.px_per_m);
        strength[point.side].push_back(point.strength);
        strengths.push_back(point.strength);
    }
    const double usual_strength = median(strengths);
    // How far each side is off: the middle of its points, and half of what they spread.
    std::vector<double> off(sides, 1e9);
    for (std::size_t s = 0; s < sides; ++s) {
        if (offsets[s].size() < 3) continue;
        const double middle = median(offsets[s]);
        std::vector<double> spread;
        for (const double offset : offsets[s]) spread.push_back(std::abs(offset - middle));
        off[s] = std::abs(middle) + 0.5 * median(spread);
    }
    const double usual_off = std::min(median(off), 0.5);
    std::vector<bool> use(sides, false);
    for (std::size_t s = 0; s < sides; ++s)
        use[s] = off[s] < std::max(kSideOffPx, kSideOffRatio * usual_off) &&
                 median(strength[s]) >= kMinStrength * usual_strength;
    return use;
}

}  // namespace petal
