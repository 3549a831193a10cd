// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/detail/margin_cells.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "filters/detail/cell_window.hpp"
#include "filters/detail/for_pieces.hpp"
#include "filters/detail/range_mode.hpp"

namespace petal {
namespace {

constexpr std::size_t kRowsAtOnce = 4;
constexpr float kFar = std::numeric_limits<float>::max();
constexpr int kApart = 2;  ///< cells between those that slopes are taken from

/// What a cell tells its neighbours.
struct CellRanges {
    float nearest = 0.0F;
    float farthest = 0.0F;
    float front = 0.0F;  ///< where its nearest points crowd
};

/// A plane near one direction: the inverse of the range to it is linear in small angles.
struct Plane {
    float inverse = 0.0F;                    ///< 1/m, at:
    float azimuth = 0.0F, elevation = 0.0F;  ///< rad
    float across = 0.0F, up = 0.0F;          ///< change of the inverse with both, 1/m/rad

    /// m that a point lies behind it along its ray; 0 for rays that pass the plane by.
    float behind(const AngularPoint& point) const {
        const float here =
            inverse + across * (point.azimuth - azimuth) + up * (point.elevation - elevation);
        return here > 0.0F ? point.range - 1.0F / here : 0.0F;
    }
};

/// The slopes (1/m/rad) that a surface through a cell may have along one axis: one or three.
struct Slopes {
    std::array<float, 3> values{};
    std::size_t count = 1;
};

/// Judges cells, one after the other.
class MarginJudge {
   public:
    MarginJudge(const AngularCells& cells, const std::vector<CellRanges>& ranges,
                const MarginSettings& settings)
        : cells_(cells), ranges_(ranges), settings_(settings) {}

    /// Marks the cell's margin points. False where there are none.
    bool mark(const CellWindow& window, std::uint32_t cell, std::vector<std::uint8_t>& marks);

   private:
    /// How far a window's points lie behind a plane, m: the two nearest and the two farthest.
    struct Flattened {
        std::array<float, 2> nearest{kFar, kFar}, farthest{-kFar, -kFar};
    };

    bool has_depth(const CellWindow& window, std::uint32_t cell) const;
    Slopes slopes(const CellWindow& window, std::uint32_t cell, int dx, int dy) const;
    /// Puts how far the window's points lie behind the plane into behind_.
    Flattened flatten(const CellWindow& window, const Plane& plane);
    bool keep(const CellWindow& window, std::uint32_t cell, const Plane& surface,
              const RangeMode& frontier, std::vector<std::uint8_t>& marks);

    const AngularCells& cells_;
    const std::vector<CellRanges>& ranges_;
    const MarginSettings& settings_;
    const float step_ = static_cast<float>(cells_.step());
    std::vector<float> behind_;      ///< m
    std::vector<AngularPoint> far_;  ///< of a window, those behind the frontier
};

CellRanges cell_ranges(const AngularCells& cells, std::size_t cell, const MarginSettings& settings,
                       std::vector<float>& sorted) {
    sorted.clear();
    for (std::size_t i = cells.begin(cell); i < cells.begin(cell + 1); ++i)
        sorted.push_back(cells.points()[i].range);
    CellRanges result;
    const auto [nearest, farthest] = std::minmax_element(sorted.begin(), sorted.end());
    result.nearest = *nearest;
    result.farthest = *farthest;
    std::size_t first = 0, last = sorted.size();
    if (result.farthest - result.nearest > settings.threshold) {
        std::sort(sorted.begin(), sorted.end());
        const std::size_t needed = std::max<std::size_t>(2, (sorted.size() + 4) / 5);
        const float width = 4.0F * settings.noise;
        while (first + needed <= sorted.size() &&
               sorted[first + needed - 1] - sorted[first] > width)
            ++first;
        if (first + needed > sorted.size()) first = 0;
        last = static_cast<std::size_t>(
            std::upper_bound(sorted.begin(), sorted.end(), sorted[first] + width) - sorted.begin());
    }
    float sum = 0.0F;
    for (std::size_t i = first; i < last; ++i) sum += sorted[i] - result.nearest;
    result.front = result.nearest + sum / static_cast<float>(last - first);
    return result;
}

Slopes MarginJudge::slopes(const CellWindow& window, std::uint32_t cell, int dx, int dy) const {
    const float here = ranges_[cell].front;
    const auto front = [&](int side) {
        const std::uint32_t other = window.cell(side * dx, side * dy);
        return other == CellWindow::kNone ? 0.0F : ranges_[other].front;
    };
    const float before = front(-kApart), after = front(kApart);
    const auto rise = [&](float from, float to) {
        return (1.0F / to - 1.0F / from) / (kApart * step_);
    };
    Slopes result;
    if (before > 0.0F && after > 0.0F) {
        const float back = rise(before, here), forth = rise(here, after);
        const float bend = before + after - 2.0F * here;
        if (bend > settings_.threshold) {
            // The surface ends on one side: there something is behind it, and the slope is steeper.
            result.values[0] = std::abs(back) < std::abs(forth) ? back : forth;
        } else {
            result.values = {0.5F * (back + forth), back, forth};
            // In the window the three planes differ by up to 3/8 of the bend.
            if (bend > -settings_.threshold && std::abs(bend) > 8.0F / 3.0F * settings_.noise)
                result.count = 3;
        }
    } else if (before > 0.0F) {
        result.values[0] = rise(before, here);
    } else if (after > 0.0F) {
        result.values[0] = rise(here, after);
    }
    return result;
}

MarginJudge::Flattened MarginJudge::flatten(const CellWindow& window, const Plane& plane) {
    std::size_t count = 0;
    window.for_spans(settings_.reach,
                     [&](std::uint32_t first, std::uint32_t last) { count += last - first; });
    behind_.resize(count);
    Flattened result;
    float* next = behind_.data();
    window.for_spans(settings_.reach, [&](std::uint32_t first, std::uint32_t last) {
        const AngularPoint* points = cells_.points().data();
        for (std::uint32_t i = first; i < last; ++i) *next++ = plane.behind(points[i]);
    });
    for (const float range : behind_) {
        if (range < result.nearest[1]) {
            result.nearest[1] = std::max(range, result.nearest[0]);
            result.nearest[0] = std::min(range, result.nearest[0]);
        }
        if (range > result.farthest[1]) {
            result.farthest[1] = std::min(range, result.farthest[0]);
            result.farthest[0] = std::max(range, result.farthest[0]);
        }
    }
    return result;
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
    Plane plane;
    for (std::uint32_t i = cells_.begin(cell); i < cells_.begin(cell + 1); ++i) {
        plane.azimuth += cells_.points()[i].azimuth;
        plane.elevation += cells_.points()[i].elevation;
    }
    plane.azimuth /= static_cast<float>(cells_.count(cell));
    plane.elevation /= static_cast<float>(cells_.count(cell));
    plane.inverse = 1.0F / ranges_[cell].front;

    const Slopes across = slopes(window, cell, 1, 0), up = slopes(window, cell, 0, 1);
    std::optional<RangeMode> frontier;
    Plane surface;
    for (std::size_t x = 0; x < across.count; ++x)
        for (std::size_t y = 0; y < up.count; ++y) {
            plane.across = across.values[x];
            plane.up = up.values[y];
            const Flattened flat = flatten(window, plane);
            if (flat.farthest[1] - flat.nearest[1] <= settings_.threshold) return false;
            const auto mode = nearest_mode(behind_, settings_.noise,
                                           static_cast<std::size_t>(settings_.min_points));
            if (!mode) continue;
            if (flat.farthest[1] <= mode->centre + settings_.threshold) return false;
            if (frontier && mode->count <= frontier->count) continue;
            frontier = mode;
            surface = plane;
        }
    if (!frontier) return false;
    return keep(window, cell, surface, *frontier, marks);
}

bool MarginJudge::keep(const CellWindow& window, std::uint32_t cell, const Plane& surface,
                       const RangeMode& frontier, std::vector<std::uint8_t>& marks) {
    const AngularPoint* points = cells_.points().data();
    far_.clear();
    window.for_spans(settings_.reach, [&](std::uint32_t first, std::uint32_t last) {
        for (std::uint32_t i = first; i < last; ++i)
            if (surface.behind(points[i]) > frontier.centre + settings_.threshold)
                far_.push_back(points[i]);
    });
    const float narrow = std::cos(surface.elevation);
    const float reach = settings_.edge_reach * settings_.edge_reach;
    bool any = false;
    for (std::uint32_t i = cells_.begin(cell); i < cells_.begin(cell + 1); ++i) {
        const AngularPoint& point = points[i];
        if (std::abs(surface.behind(point) - frontier.centre) >
            settings_.deflation * frontier.deviation)
            continue;
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
        std::vector<float> sorted;
        for (std::size_t cell = first; cell < last; ++cell)
            ranges[cell] = cell_ranges(cells, cell, settings, sorted);
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
