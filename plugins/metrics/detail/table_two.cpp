// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/table_two.hpp"

#include <algorithm>
#include <cmath>

namespace petal {
namespace {

struct Limit {
    const char* name;
    double px;
};
constexpr Limit kLimits[] = {
    {"below_1px_share", 1.0}, {"below_5px_share", 5.0}, {"below_10px_share", 10.0}};

double mean_of(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

double deviation_of(const std::vector<double>& values, double mean) {
    double squares = 0.0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    return std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace

std::vector<Metric> table_two_figures(const std::vector<PairError>& errors, std::size_t expected,
                                      const std::string& scene) {
    std::vector<Metric> figures;
    const auto add = [&](const std::string& name, double value, const char* unit) {
        figures.push_back({"normalised_reprojection." + name, value, unit, scene});
    };
    add("count", static_cast<double>(errors.size()), "1");
    add("expected", static_cast<double>(expected), "1");
    std::vector<double> axes, norms;
    for (const Eigen::Vector2d& error : normalised_errors(errors)) {
        axes.insert(axes.end(), {error.x(), error.y()});
        norms.push_back(error.norm());
    }
    if (!errors.empty()) {
        add("largest_range", largest_range(errors), "m");
        add("mean_px", normalised_mean(errors), "px");
        add("deviation_px", deviation_of(axes, normalised_mean(errors)), "px");
        add("norm_mean_px", mean_of(norms), "px");
        add("norm_deviation_px", deviation_of(norms, mean_of(norms)), "px");
    }
    if (expected == 0) return figures;
    const auto share = [&](const std::vector<double>& values, double limit, double all) {
        const auto below = std::count_if(values.begin(), values.end(),
                                         [&](double value) { return value < limit; });
        return static_cast<double>(below) / all;
    };
    const auto corners = static_cast<double>(expected);
    for (const Limit& limit : kLimits) add(limit.name, share(axes, limit.px, 2.0 * corners), "1");
    for (const Limit& limit : kLimits)
        add(std::string("norm_") + limit.name, share(norms, limit.px, corners), "1");
    return figures;
}

}  // namespace petal
