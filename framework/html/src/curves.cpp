// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <system_error>

#include "petal/html/plots.hpp"
#include "petal/printed.hpp"
#include "svg.hpp"

namespace petal::html {

namespace {

constexpr double kMarginLeft = 62.0;   // px: numbers and name of the standing axis
constexpr double kMarginRight = 14.0;  // px
constexpr double kPlotHeight = 210.0;  // px
constexpr double kAxisRoom = 42.0;     // px

std::string tone(const char* what, int number) {
    return printed("%s tone%d", what, number);
}

/// The standing axis: lines and numbers.
void standing_axis(Svg& svg, const Scale& scale, double left, double right) {
    for (const double tick : scale.ticks(5)) {
        const double y = scale.at(tick);
        svg.line(left, y, right, y, tick == 0.0 ? "zero" : "grid");
        svg.text(left - 6.0, y + 4.0, "end", "tick", printed("%g", tick));
    }
}

std::string step_to(double x, double y, bool first) {
    return printed("%c%.1f %.1f", first ? 'M' : 'L', x, y);
}

std::string distribution_path(const std::vector<double>& sorted, const Scale& across,
                              const Scale& up) {
    std::string steps;
    const double count = static_cast<double>(sorted.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const double x = across.at(sorted[i]);
        steps += step_to(x, up.at(static_cast<double>(i) / count), i == 0);
        steps += step_to(x, up.at(static_cast<double>(i + 1) / count), false);
    }
    return steps;
}

std::optional<double> number_of(const std::string& text) {
    double value = 0.0;
    const char* const end = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, value);
    if (read.ec != std::errc() || read.ptr != end || !std::isfinite(value)) return {};
    return value;
}

/// Where the points stand: by their number, or one after the other where one has none.
std::vector<double> places_of(const std::vector<CurvePoint>& points, bool& by_number) {
    std::vector<double> places;
    by_number = true;
    for (const CurvePoint& point : points) {
        const auto number = number_of(point.x);
        by_number = by_number && number;
        places.push_back(number.value_or(0.0));
    }
    if (!by_number)
        for (std::size_t i = 0; i < places.size(); ++i) places[i] = static_cast<double>(i);
    return places;
}

}  // namespace

std::string distribution_plot(const PlotFrame& frame, const std::vector<Sample>& samples) {
    std::vector<double> all;
    for (const Sample& sample : samples)
        all.insert(all.end(), sample.values.begin(), sample.values.end());
    const Scale across = scale_of(all, kMarginLeft, kPlotWidth - kMarginRight, false);
    const Scale up{0.0, 1.0, kPlotHeight, 8.0};
    Svg svg(frame);
    svg.axis(across, 8.0, kPlotHeight);
    standing_axis(svg, up, kMarginLeft, kPlotWidth - kMarginRight);
    double y = kPlotHeight + kAxisRoom;
    for (const Sample& sample : samples) {
        std::vector<double> sorted;
        std::copy_if(sample.values.begin(), sample.values.end(), std::back_inserter(sorted),
                     [](double value) { return std::isfinite(value); });
        std::sort(sorted.begin(), sorted.end());
        svg.path(distribution_path(sorted, across, up), tone("curve", sample.tone));
        svg.text(kMarginLeft, y + 12.0, "start", tone("key", sample.tone),
                 sample.label + " (" + std::to_string(sorted.size()) + ")");
        for (const double value : sorted)
            svg.line(across.at(value), y + 17.0, across.at(value), y + 25.0,
                     tone("stroke", sample.tone));
        y += 30.0;
    }
    return svg.text_of(y);
}

std::string curve_plot(const PlotFrame& frame, const std::string& x_axis,
                       const std::vector<CurvePoint>& points) {
    bool by_number = true;
    const std::vector<double> places = places_of(points, by_number);
    std::vector<double> values;
    for (const CurvePoint& point : points)
        for (const auto& value : {point.y, point.low, point.high})
            if (value) values.push_back(*value);
    const double right = kPlotWidth - kMarginRight;
    const Scale across = scale_of(places, kMarginLeft, right, false);
    const Scale up = scale_of(values, kPlotHeight, 24.0, false);
    PlotFrame lying = frame;
    lying.axis = x_axis;
    Svg svg(lying);
    svg.text(4.0, 14.0, "start", "name", frame.axis);
    standing_axis(svg, up, kMarginLeft, right);
    svg.text((kMarginLeft + right) / 2.0, kPlotHeight + 34.0, "middle", "name", x_axis);
    std::string steps;
    bool broken = true;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const CurvePoint& point = points[i];
        const double x = across.at(places[i]);
        svg.text(x, kPlotHeight + 16.0, "middle", "tick", point.x, 14);
        if (!point.y || !std::isfinite(*point.y)) {
            broken = true;
            continue;
        }
        const auto end = [&](const std::optional<double>& value, double edge) {
            return value && std::isfinite(*value) ? up.at(*value) : edge;
        };
        if (point.low && point.high)
            svg.line(x, end(point.low, up.begin), x, end(point.high, up.end), "whisker tone0");
        steps += step_to(x, up.at(*point.y), broken);
        broken = false;
        svg.dot(x, up.at(*point.y), point.reference ? 6.0 : 4.0,
                point.reference ? "point reference" : "point tone0");
    }
    svg.path(steps, "curve tone0");
    return svg.text_of(kPlotHeight + kAxisRoom);
}

}  // namespace petal::html
