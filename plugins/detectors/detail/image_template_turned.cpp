// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_template_turned.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/polygon.hpp"

namespace petal {

namespace {

constexpr std::size_t kTurnSteps = 60;  ///< in a full turn
constexpr double kOffHull = 0.1;        ///< of the root of the region's area

/// The linear parts of the maps that put a polygon of that shape on the region.
std::vector<Eigen::Matrix2d> turned_maps(const IdealRegion& region,
                                         const std::vector<Eigen::Vector2d>& hull,
                                         const TemplateShape& shape,
                                         const std::vector<Eigen::Vector2d>& polygon,
                                         const TemplateModel& model) {
    const Eigen::Matrix2d unroot = root_of(shape.spread).inverse();
    std::vector<Eigen::Matrix2d> linear(kTurnSteps);
    std::vector<char> wanted(kTurnSteps);
    for (std::size_t step = 0; step < kTurnSteps; ++step) {
        const double angle = 2.0 * kPi * static_cast<double>(step) / kTurnSteps;
        linear[step] = region.root * turn_by(angle) * unroot;
        wanted[step] =
            model.turns().is_upright(linear[step]) && not_from_the_side(linear[step]) ? 1 : 0;
    }
    std::vector<double> off(kTurnSteps, std::numeric_limits<double>::quiet_NaN());
    const auto off_at = [&](std::size_t step) {
        if (!std::isnan(off[step])) return off[step];
        off[step] = 0.0;
        for (const auto& p : polygon)
            off[step] +=
                distance_to_polygon(hull, region.shape.center + linear[step] * (p - shape.center)) /
                static_cast<double>(polygon.size());
        return off[step];
    };
    std::vector<Eigen::Matrix2d> maps;
    for (std::size_t step = 0; step < kTurnSteps; ++step)
        if (wanted[step] && off_at(step) < kOffHull * std::sqrt(region.shape.area) &&
            off_at(step) < off_at((step + kTurnSteps - 1) % kTurnSteps) &&
            off_at(step) <= off_at((step + 1) % kTurnSteps))
            maps.push_back(linear[step]);
    return maps;
}

}  // namespace

void guess_by_plate(const IdealRegion& plate, const std::vector<Eigen::Vector2d>& hull,
                    const TemplateModel& model, std::vector<TemplateGuess>& guesses) {
    const TemplateShape& shape = model.plate();
    for (const auto& linear : turned_maps(plate, hull, shape, model.target().outline, model))
        guesses.push_back(
            guess_at(affine_about(linear, shape.center, plate.shape.center), model, 0));
}

void guess_by_hole(const IdealRegion& hole, const std::vector<Eigen::Vector2d>& hull,
                   const TemplateModel& model, std::vector<TemplateGuess>& guesses) {
    const auto& polygons = model.target().holes;
    std::vector<Eigen::Matrix2d> maps;
    for (std::size_t i = 0; i < polygons.size(); ++i) {
        const TemplateShape& shape = model.hole(i);
        // Holes are mostly alike.
        bool as_before = i > 0 && polygons[i].size() == polygons[i - 1].size();
        for (std::size_t k = 0; as_before && k < polygons[i].size(); ++k)
            as_before =
                (polygons[i][k] - shape.center - polygons[i - 1][k] + model.hole(i - 1).center)
                    .norm() < 1e-6;
        if (!as_before) maps = turned_maps(hole, hull, shape, polygons[i], model);
        for (const auto& linear : maps)
            guesses.push_back(
                guess_at(affine_about(linear, shape.center, hole.shape.center), model, 1));
    }
}

}  // namespace petal
