// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace petal::html {

/// Five numbers of a sample: smallest, lower quartile, median, upper quartile, largest. Quartiles
/// are interpolated between order statistics (the definition of NumPy and R's type 7). \pre values
/// not empty.
std::array<double, 5> five_numbers(std::vector<double> values);

/// What all plots have: inline SVG that takes its colours from the page's style, with a title for
/// who does not see it. All texts are escaped. Numbers that are not finite are not drawn.
struct PlotFrame {
    std::string title;  ///< told to screen readers
    std::string axis;   ///< what the values are, with unit
};

/// A box from five numbers, lying. Boxes that follow each other with one label stand under it
/// together.
struct Box {
    std::string label;
    std::string tag;  ///< a letter or two beside the box: which of its group it is
    std::array<double, 5> numbers{};
    int tone = 0;  ///< colour: 0 to 5
    std::string
        from;  ///< where the numbers stand in the page's document (a JSON pointer), or empty
};
std::string box_plot(const PlotFrame& frame, const std::vector<Box>& boxes, bool mark_zero);

/// A value with its interval, and a band of what does not matter about zero. An infinite end is
/// drawn as an arrow at the plot's edge.
struct IntervalRow {
    std::string label;
    double value = 0.0, low = 0.0, high = 0.0;
    double margin = 0.0;  ///< half the band's width; 0: none
    int tone = 0;
};
std::string interval_plot(const PlotFrame& frame, const std::vector<IntervalRow>& rows);

/// All values of each sample as ticks in a row of their own, over the share that lies below as
/// a line (the empirical distribution).
struct Sample {
    std::string label;
    std::vector<double> values;
    int tone = 0;  ///< 0 to 5
};
std::string distribution_plot(const PlotFrame& frame, const std::vector<Sample>& samples);

/// A curve over a swept parameter; points without a number break it. Where not all `x` are numbers
/// they are spaced evenly.
struct CurvePoint {
    std::string x;
    std::optional<double> y, low, high;
    bool reference = false;
};
std::string curve_plot(const PlotFrame& frame, const std::string& x_axis,
                       const std::vector<CurvePoint>& points);

}  // namespace petal::html
