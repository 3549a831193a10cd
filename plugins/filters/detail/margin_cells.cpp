// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/detail/margin_cells.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "filters/detail/angular_plane.hpp"
#include "filters/detail/cell_ranges.hpp"
#include "filters/detail/cell_window.hpp"
#include "filters/detail/range_mode.hpp"
#include "petal/calibration/for_pieces.hpp"

namespace petal {
namespace {

constexpr std::size_t kRowsAtOnce = 4;
constexpr float kFar = std::numeric_limits<float>::max();
/// Of the threshold: once a cell is known to have an edge, what lies so far behind shows where. Of
/// a wall close behind only the noise's tail passes the whole threshold.
constexpr float kNearer = 0.75F;
constexpr int kApart = 2;  ///< cells between those that slopes are taken from

/// The slopes (1/m/rad) that a surface through a cell may have along one axis: one to three.
struct Slopes {
    std::array<float, 3> values{};
    std::size_t count = 1;
};

/// Judges cells, one after the other.
class MarginJudge {
   public:
    MarginJudge(const AngularCells& cells, const std::vector<CellRanges>& ranges,
                const MarginSettings& settings)
        : cells_(cells), ranges_(ranges), settings_(settings), modes_(settings.noise) {}

    /// Marks the cell's margin points. False where there are none.
    bool mark(const CellWindow& window, std::uint32_t cell, std::vector<std::uint8_t>& marks);

   private:
    /// Whether two of the window's points, as flattened, lie farther back: one alone is no edge.
    bool two_lie_behind(float range) const;
    bool has_depth(const CellWindow& window, std::uint32_t cell) const;
    enum class Axis { azimuth, elevation };
    /// \param cross the slope along the other axis
    Slopes slopes(const CellWindow& window, std::uint32_t cell, Axis axis, float cross) const;
    /// Puts how far the window's points lie behind the plane into behind_.
    void flatten(const CellWindow& window, const AngularPlane& plane);
    /// How far the cell's own points lie behind the plane at most, m: a frontier behind that is
    /// not theirs.
    float last_own(std::uint32_t cell, const AngularPlane& plane) const;
    /// How far from the frontier's centre its points may lie, m: the letter's deflation.
    float depth(const RangeMode& frontier) const;
    bool has_points_at(std::uint32_t cell, const AngularPlane& plane,
                       const RangeMode& frontier) const;
    bool keep(const CellWindow& window, std::uint32_t cell, const AngularPlane& surface,
              const RangeMode& frontier, std::vector<std::uint8_t>& marks);

    const AngularCells& cells_;
    const std::vector<CellRanges>& ranges_;
    const MarginSettings& settings_;
    const float step_ = static_cast<float>(cells_.step());
    ModeFinder modes_;
    std::vector<float> behind_;      ///< m
    std::vector<AngularPoint> far_;  ///< of a window, those behind the frontier
};

Slopes MarginJudge::slopes(const CellWindow& window, std::uint32_t cell, Axis axis,
                           float cross) const {
    const CellRanges& here = ranges_[cell];
    const bool across = axis == Axis::azimuth;
    // The rise per rad to the cell on that side, without what it owes to lying off the axis.
    const auto rise = [&](int side) -> std::optional<float> {
        const std::uint32_t other = window.cell(across ? side : 0, across ? 0 : side);
        if (other == CellWindow::kNone) return std::nullopt;
        const float x = ranges_[other].azimuth - here.azimuth;
        const float y = ranges_[other].elevation - here.elevation;
        return (ranges_[other].inverse - here.inverse - cross * (across ? y : x)) /
               (across ? x : y);
    };
    const auto back = rise(-kApart), forth = rise(kApart);
    Slopes result;
    if (!back || !forth) {
        result.values[0] = back ? *back : forth.value_or(0.0F);
        return result;
    }
    const bool back_is_flatter = std::abs(*back) < std::abs(*forth);
    const float flatter = back_is_flatter ? *back : *forth;
    const float steeper = back_is_flatter ? *forth : *back;
    // By how much both sides turn away from the sensor, m.
    const float bend = (*back - *forth) * kApart * step_ / (here.inverse * here.inverse);
    if (bend > settings_.threshold) {
        // The surface ends on one side: there something is behind it, and the slope is steeper.
        result.values[0] = flatter;
    } else if (bend < -settings_.threshold) {
        result.values = {flatter, steeper};
        result.count = 2;
    } else {
        result.values = {0.5F * (*back + *forth), flatter, steeper};
        // In the window the three planes differ by up to 3/8 of the bend.
        result.count = std::abs(bend) > 8.0F / 3.0F * settings_.noise ? 3 : 1;
    }
    return result;
}

void MarginJudge::flatten(const CellWindow& window, const AngularPlane& plane) {
    std::size_t count = 0;
    window.for_spans(settings_.reach,
                     [&](std::uint32_t first, std::uint32_t last) { count += last - first; });
    behind_.resize(count);
    float* next = behind_.data();
    window.for_spans(settings_.reach, [&](std::uint32_t first, std::uint32_t last) {
        const AngularPoint* points = cells_.points().data() + first;
        for (std::uint32_t i = 0; i < last - first; ++i) next[i] = plane.behind(points[i]);
        next += last - first;
    });
}

bool MarginJudge::two_lie_behind(float range) const {
    std::uint32_t count = 0;
    for (const float behind : behind_) count += behind > range ? 1U : 0U;
    return count >= 2;
}

bool MarginJudge::has_depth(const CellWindow& window, std::uint32_t cell) const {
    float nearest = ranges_[cell].nearest, farthest = ranges_[cell].farthest;
    for (int dy = -settings_.reach; dy <= settings_.reach; ++dy)
        for (int dx = -settings_.reach; dx <= settings_.reach; ++dx) {
            const std::uint32_t other = window.cell(dx, dy);
            if (other == CellWindow::kNone) continue;
            nearest = std::min(nearest, ranges_[other].nearest);
            farthest = std::max(farthest, ranges_[other].farthest);
        }
    return farthest - nearest > settings_.threshold;
}

bool MarginJudge::mark(const CellWindow& window, std::uint32_t cell,
                       std::vector<std::uint8_t>& marks) {
    if (!has_depth(window, cell)) return false;
    const CellRanges& own = ranges_[cell];
    AngularPlane plane{own.inverse, own.azimuth, own.elevation, 0.0F, 0.0F};
    const float rough = slopes(window, cell, Axis::elevation, 0.0F).values[0];
    const Slopes across = slopes(window, cell, Axis::azimuth, rough);
    const Slopes up = slopes(window, cell, Axis::elevation, across.values[0]);
    std::optional<RangeMode> frontier;
    AngularPlane surface;
    for (std::size_t x = 0; x < across.count; ++x)
        for (std::size_t y = 0; y < up.count; ++y) {
            plane.across = across.values[x];
            plane.up = up.values[y];
            flatten(window, plane);
            const Eigen::Map<const Eigen::ArrayXf> all(behind_.data(),
                                                       static_cast<Eigen::Index>(behind_.size()));
            const float nearest = all.minCoeff();
            if (all.maxCoeff() - nearest <= settings_.threshold) return false;
            const auto mode = modes_.nearest_mode(behind_, nearest,
                                                  static_cast<std::size_t>(settings_.min_points),
                                                  last_own(cell, plane));
            const bool likeliest = x == 0 && y == 0;  // the others can only object
            if (!mode && likeliest) return false;
            if (!mode) continue;
            if (!two_lie_behind(mode->centre + settings_.threshold)) return false;
            if (!likeliest) continue;
            if (!has_points_at(cell, plane, *mode)) return false;
            frontier = mode;
            surface = plane;
        }
    return keep(window, cell, surface, *frontier, marks);
}

float MarginJudge::depth(const RangeMode& frontier) const {
    // Few points, or ones without noise, may happen to lie at one range.
    return settings_.deflation * std::max(frontier.deviation, 0.5F * settings_.noise);
}

bool MarginJudge::has_points_at(std::uint32_t cell, const AngularPlane& plane,
                                const RangeMode& frontier) const {
    const auto first = cells_.points().begin() + cells_.begin(cell);
    return std::any_of(first, first + cells_.count(cell), [&](const AngularPoint& point) {
        return std::abs(plane.behind(point) - frontier.centre) <= depth(frontier);
    });
}

float MarginJudge::last_own(std::uint32_t cell, const AngularPlane& plane) const {
    float last = -kFar;
    for (std::uint32_t i = cells_.begin(cell); i < cells_.begin(cell + 1); ++i)
        last = std::max(last, plane.behind(cells_.points()[i]));
    return last;
}

bool MarginJudge::keep(const CellWindow& window, std::uint32_t cell, const AngularPlane& surface,
                       const RangeMode& frontier, std::vector<std::uint8_t>& marks) {
    const AngularPoint* points = cells_.points().data();
    far_.clear();
    window.for_spans(settings_.reach, [&](std::uint32_t first, std::uint32_t last) {
        for (std::uint32_t i = first; i < last; ++i)
            if (surface.behind(points[i]) > frontier.centre + kNearer * settings_.threshold)
                far_.push_back(points[i]);
    });
    const float narrow = std::cos(surface.elevation);
    const float reach = settings_.edge_reach * settings_.edge_reach;
    bool any = false;
    for (std::uint32_t i = cells_.begin(cell); i < cells_.begin(cell + 1); ++i) {
        const AngularPoint& point = points[i];
        if (std::abs(surface.behind(point) - frontier.centre) > depth(frontier)) continue;
        const bool near = std::any_of(far_.begin(), far_.end(), [&](const AngularPoint& far) {
            const float x = narrow * (far.azimuth - point.azimuth);
            const float y = far.elevation - point.elevation;
            return x * x + y * y <= reach;
        });
        if (settings_.reach > 0 && !near) continue;
        marks[point.index] = 1;
        any = true;
    }
    return any;
}

}  // namespace

MarginCounts mark_margin_points(const AngularCells& cells, const MarginSettings& settings,
                                const Run& run, std::vector<std::uint8_t>& marks) {
    std::vector<CellRanges> ranges(cells.size());
    for_pieces(run, cells.size(), 1024, [&](std::size_t first, std::size_t last) {
        std::vector<float> scratch;
        for (std::size_t cell = first; cell < last; ++cell)
            ranges[cell] = cell_ranges(cells, cell, settings.threshold, settings.noise, scratch);
    });
    std::atomic<std::size_t> margin{0};
    for_pieces(run, cells.rows(), kRowsAtOnce, [&](std::size_t first, std::size_t last) {
        MarginJudge judge(cells, ranges, settings);
        std::size_t found = 0;
        for (std::size_t row = first; row < last; ++row) {
            CellWindow window(cells, row);
            for (std::uint32_t cell = cells.row_begin(row); cell < cells.row_begin(row + 1);
                 ++cell) {
                window.move_to(cell);
                found += judge.mark(window, cell, marks);
            }
        }
        margin += found;
    });
    return {cells.size(), margin};
}

}  // namespace petal
