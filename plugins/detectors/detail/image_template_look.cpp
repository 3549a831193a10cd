// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_template_look.hpp"

#include <algorithm>
#include <cmath>

#include "detectors/detail/image_template_ideal.hpp"

namespace petal {

namespace {

constexpr std::size_t kPlateLooks = 32;
/// Even is what differs from the plate's median by less than this part of the step down to the
/// holes, and 3 sigma; light may fall off over the plate.
constexpr double kLookEven = 0.5;
/// Holes may show something bright: their darkest quarter tells how dark they are.
constexpr double kDarkestPart = 0.25;
constexpr double kLeastStep = 2.0;  ///< of the noise

/// The value that `part` of them lie below.
double value_at(std::vector<double>& values, double part) {
    const auto place = values.begin() + std::lround(part * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

}  // namespace

PlaceLook::PlaceLook(const EdgeSampler& edges, const TemplateModel& model,
                     const CameraModel& camera, double noise)
    : edges_(edges), camera_(camera), noise_(noise) {
    const std::vector<Eigen::Vector2d>& plate = model.plate_points();
    const std::size_t looks = std::min(kPlateLooks, plate.size());
    for (std::size_t i = 0; i < looks; ++i)
        plate_.push_back(plate[(2 * i + 1) * plate.size() / (2 * looks)]);
    for (std::size_t i = 0; i < model.holes(); ++i) {
        const Eigen::Vector2d& middle = model.hole(i).center;
        const Eigen::Matrix2d root = root_of(model.hole(i).spread);
        holes_.push_back(middle);
        for (Eigen::Index axis = 0; axis < 2; ++axis) {
            holes_.emplace_back(middle + root.col(axis));
            holes_.emplace_back(middle - root.col(axis));
        }
    }
}

std::vector<double> PlaceLook::greys_at(const Homography& map,
                                        const std::vector<Eigen::Vector2d>& points) const {
    std::vector<double> greys;
    greys.reserve(points.size());
    for (const Eigen::Vector2d& p : points) {
        const auto pixel = camera_.distort(map_point(map, p));
        if (const auto grey = pixel ? edges_.grey(*pixel) : std::nullopt) greys.push_back(*grey);
    }
    return greys;
}

double PlaceLook::at(const Homography& map) const {
    std::vector<double> holes = greys_at(map, holes_);
    if (2 * holes.size() < holes_.size() || holes.empty()) return 0.0;
    std::vector<double> plate = greys_at(map, plate_);
    if (2 * plate.size() < plate_.size() || plate.empty()) return 0.0;
    const double bright = value_at(plate, 0.5);
    const double step = bright - value_at(holes, kDarkestPart);
    if (step < kLeastStep * noise_) return 0.0;
    const double allowed = kLookEven * step + 3.0 * noise_;
    const auto share = [](const std::vector<double>& greys, auto is) {
        return static_cast<double>(std::count_if(greys.begin(), greys.end(), is)) /
               static_cast<double>(greys.size());
    };
    return share(plate, [&](double grey) { return std::abs(grey - bright) < allowed; }) *
           share(holes, [&](double grey) { return grey < bright - kLookEven * step; });
}

}  // namespace petal
