// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/detail/cell_ranges.hpp"

#include <algorithm>
#include <cmath>

#include "filters/detail/angular_plane.hpp"

namespace petal {
namespace {

/// The mean inverse range of points that lie on one plane, however slanted; 0 where they do not.
float inverse_on_plane(const AngularPoint* first, const AngularPoint* last, const CellRanges& cell,
                       float threshold) {
    const auto size = static_cast<float>(last - first);
    float mean = 0.0F;
    for (const AngularPoint* p = first; p != last; ++p) mean += 1.0F / p->range;
    mean /= size;
    // Normal equations about the means, in milliradians lest they underflow.
    constexpr float kScale = 1e3F;
    float xx = 0.0F, xy = 0.0F, yy = 0.0F, xq = 0.0F, yq = 0.0F;
    for (const AngularPoint* p = first; p != last; ++p) {
        const float x = kScale * (p->azimuth - cell.azimuth);
        const float y = kScale * (p->elevation - cell.elevation);
        const float q = 1.0F / p->range - mean;
        xx += x * x, xy += x * y, yy += y * y, xq += x * q, yq += y * q;
    }
    const float determinant = xx * yy - xy * xy;
    if (!(determinant > 1e-6F * xx * yy)) return 0.0F;
    const AngularPlane plane{mean, cell.azimuth, cell.elevation,
                             kScale * (xq * yy - yq * xy) / determinant,
                             kScale * (yq * xx - xq * xy) / determinant};
    for (const AngularPoint* p = first; p != last; ++p)
        if (std::abs(plane.behind(*p)) > 0.5F * threshold) return 0.0F;
    return mean;
}

/// The inverse of the nearest range at which a fifth of the points, and at least two, crowd.
float inverse_of_front(const AngularPoint* first, const AngularPoint* last, float width,
                       std::vector<float>& sorted) {
    sorted.clear();
    for (const AngularPoint* p = first; p != last; ++p) sorted.push_back(p->range);
    std::sort(sorted.begin(), sorted.end());
    const std::size_t needed = std::max<std::size_t>(2, (sorted.size() + 4) / 5);
    std::size_t begin = 0;
    while (begin + needed <= sorted.size() && sorted[begin + needed - 1] - sorted[begin] > width)
        ++begin;
    if (begin + needed > sorted.size()) begin = 0;
    float sum = 0.0F;
    std::size_t end = begin;
    for (; end < sorted.size() && sorted[end] <= sorted[begin] + width; ++end)
        sum += sorted[end] - sorted[begin];
    return 1.0F / (sorted[begin] + sum / static_cast<float>(end - begin));
}

}  // namespace

CellRanges cell_ranges(const AngularCells& cells, std::size_t cell, float threshold, float noise,
                       std::vector<float>& scratch) {
    const AngularPoint* first = cells.points().data() + cells.begin(cell);
    const AngularPoint* last = cells.points().data() + cells.begin(cell + 1);
    const auto size = static_cast<float>(last - first);
    CellRanges result;
    result.nearest = result.farthest = first->range;
    float azimuth = 0.0F, elevation = 0.0F, range = 0.0F;
    for (const AngularPoint* p = first; p != last; ++p) {
        result.nearest = std::min(result.nearest, p->range);
        result.farthest = std::max(result.farthest, p->range);
        azimuth += p->azimuth - first->azimuth;
        elevation += p->elevation - first->elevation;
        range += p->range - first->range;
    }
    result.azimuth = first->azimuth + azimuth / size;
    result.elevation = first->elevation + elevation / size;
    if (result.farthest - result.nearest <= threshold) {
        result.inverse = 1.0F / (first->range + range / size);
    } else {
        result.inverse = inverse_on_plane(first, last, result, threshold);
        if (result.inverse == 0.0F)
            result.inverse = inverse_of_front(first, last, 4.0F * noise, scratch);
    }
    return result;
}

}  // namespace petal
