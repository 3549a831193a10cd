// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/error_figures.hpp"

#include <algorithm>
#include <cmath>

namespace petal {
namespace {

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace

double largest_range(const std::vector<PairError>& errors) {
    double farthest = 0.0;
    for (const PairError& e : errors) farthest = std::max(farthest, e.range);
    return farthest;
}

std::vector<Eigen::Vector2d> normalised_errors(const std::vector<PairError>& errors) {
    const double farthest = largest_range(errors);
    std::vector<Eigen::Vector2d> normalised;
    normalised.reserve(errors.size());
    for (const PairError& e : errors)
        normalised.push_back(e.error_px.cwiseAbs() * (farthest > 0.0 ? e.range / farthest : 0.0));
    return normalised;
}

double normalised_mean(const std::vector<PairError>& errors) {
    double sum = 0.0;
    for (const Eigen::Vector2d& error : normalised_errors(errors)) sum += error.sum();
    return sum / (2.0 * static_cast<double>(errors.size()));
}

std::vector<Metric> error_figures(const std::vector<PairError>& errors, const std::string& scene) {
    std::vector<Metric> figures;
    const auto add = [&](const char* name, double value, const char* unit) {
        figures.push_back({std::string("reprojection.") + name, value, unit, scene});
    };
    add("count", static_cast<double>(errors.size()), "1");
    if (errors.empty()) return figures;

    std::vector<double> distances;
    double squares = 0.0, sum = 0.0, board_sum = 0.0, board_count = 0.0;
    for (const PairError& e : errors) {
        const double distance = e.error_px.norm();
        distances.push_back(distance);
        squares += distance * distance;
        sum += distance;
        if (!e.of_board) continue;
        board_sum += distance;
        board_count += 1.0;
    }
    const auto count = static_cast<double>(errors.size());
    add("rms_px", std::sqrt(squares / count), "px");
    add("mean_px", sum / count, "px");
    add("median_px", median(distances), "px");
    add("max_px", *std::max_element(distances.begin(), distances.end()), "px");
    add("normalised_px", normalised_mean(errors), "px");
    if (board_count > 0.0) add("board_drift_px", board_sum / board_count, "px");
    return figures;
}

}  // namespace petal
