// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/html/plots.hpp"

#include <algorithm>
#include <cmath>

#include "petal/html/escape.hpp"
#include "petal/printed.hpp"
#include "svg.hpp"

namespace petal::html {

namespace {

constexpr double kLeft = 30.0;   // px beside the plot, for tags
constexpr double kRight = 14.0;  // px
constexpr double kLabel = 20.0;  // px: height of a row's label
constexpr double kRow = 18.0;    // px: height of a box
constexpr double kFoot = 42.0;   // px: the axis

std::string tone_class(const char* what, int tone) {
    return printed("%s tone%d", what, tone);
}

bool all_finite(const std::array<double, 5>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double n) { return std::isfinite(n); });
}

void draw_box(Svg& svg, const Box& box, const Scale& scale, double y) {
    const auto x = [&](std::size_t i) { return scale.at(box.numbers[i]); };
    const double half = kRow / 2.0 - 3.0;
    std::string values;
    for (const double number : box.numbers)
        values += printed(values.empty() ? "%.17g" : " %.17g", number);
    svg.raw("<g class=\"" + tone_class("box", box.tone) + "\" data-values=\"" + values + "\"" +
            (box.from.empty() ? "" : " data-box=\"" + escape(box.from) + "\"") + ">\n<title>" +
            escape(box.label + (box.tag.empty() ? "" : ", " + box.tag) +
                   printed(": smallest %.3g, quartiles %.3g and %.3g, median %.3g, largest %.3g",
                           box.numbers[0], box.numbers[1], box.numbers[3], box.numbers[2],
                           box.numbers[4])) +
            "</title>\n");
    svg.line(x(0), y, x(1), y, "whisker");
    svg.line(x(3), y, x(4), y, "whisker");
    svg.line(x(0), y - half / 2.0, x(0), y + half / 2.0, "whisker");
    svg.line(x(4), y - half / 2.0, x(4), y + half / 2.0, "whisker");
    svg.rect(x(1), y - half, x(3) - x(1), 2.0 * half, "body");
    svg.line(x(2), y - half, x(2), y + half, "median");
    svg.raw("</g>\n");
}

/// An interval's end: where it is, or an arrow at the plot's edge where it is infinite.
double draw_end(Svg& svg, double value, const Scale& scale, double y, const std::string& style) {
    if (std::isfinite(value)) {
        const double x = scale.at(value);
        svg.line(x, y - 4.0, x, y + 4.0, style);
        return x;
    }
    const double x = value > 0.0 ? scale.end : scale.begin;
    const double back = value > 0.0 ? -7.0 : 7.0;
    svg.path(printed("M%.1f %.1fL%.1f %.1fL%.1f %.1f", x + back, y - 5.0, x, y, x + back, y + 5.0),
             style);
    return x;
}

}  // namespace

std::array<double, 5> five_numbers(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    std::array<double, 5> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const double place = static_cast<double>(i) / 4.0 * static_cast<double>(values.size() - 1);
        const auto below = static_cast<std::size_t>(place);
        const std::size_t above = std::min(below + 1, values.size() - 1);
        const double share = place - static_cast<double>(below);
        // A whole place takes the value itself, so that the ends are values to the bit.
        numbers[i] =
            share == 0.0 ? values[below] : values[below] + share * (values[above] - values[below]);
    }
    return numbers;
}

std::string box_plot(const PlotFrame& frame, const std::vector<Box>& boxes, bool mark_zero) {
    std::vector<double> values;
    double height = 4.0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        values.insert(values.end(), boxes[i].numbers.begin(), boxes[i].numbers.end());
        if (i == 0 || boxes[i].label != boxes[i - 1].label) height += kLabel;
        height += kRow;
    }
    const Scale scale = scale_of(values, kLeft, kPlotWidth - kRight, mark_zero);
    Svg svg(frame);
    svg.axis(scale, 4.0, height);
    double y = 4.0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Box& box = boxes[i];
        if (i == 0 || box.label != boxes[i - 1].label) {
            svg.text(4.0, y + kLabel - 5.0, "start", "label", box.label);
            y += kLabel;
        }
        svg.text(4.0, y + kRow / 2.0 + 4.0, "start", tone_class("tag", box.tone), box.tag);
        if (all_finite(box.numbers)) draw_box(svg, box, scale, y + kRow / 2.0);
        y += kRow;
    }
    return svg.text_of(height + kFoot);
}

std::string interval_plot(const PlotFrame& frame, const std::vector<IntervalRow>& rows) {
    std::vector<double> values;
    for (const IntervalRow& row : rows)
        values.insert(values.end(), {row.value, row.low, row.high, -row.margin, row.margin});
    const Scale scale = scale_of(values, kLeft, kPlotWidth - kRight, true);
    const double step = kLabel + kRow;
    const double height = 4.0 + step * static_cast<double>(rows.size());
    Svg svg(frame);
    double y = 4.0;
    for (const IntervalRow& row : rows) {
        if (row.margin > 0.0)
            svg.rect(scale.at(-row.margin), y, scale.at(row.margin) - scale.at(-row.margin), step,
                     "margin");
        y += step;
    }
    svg.axis(scale, 4.0, height);
    y = 4.0;
    for (const IntervalRow& row : rows) {
        const double middle = y + kLabel + kRow / 2.0;
        svg.text(4.0, y + kLabel - 5.0, "start", "label", row.label);
        svg.raw("<g class=\"" + tone_class("interval", row.tone) + "\">\n");
        const double low = draw_end(svg, row.low, scale, middle, "whisker");
        const double high = draw_end(svg, row.high, scale, middle, "whisker");
        svg.line(low, middle, high, middle, "whisker");
        if (std::isfinite(row.value)) svg.dot(scale.at(row.value), middle, 4.5, "point");
        svg.raw("</g>\n");
        y += step;
    }
    return svg.text_of(height + kFoot);
}

}  // namespace petal::html
