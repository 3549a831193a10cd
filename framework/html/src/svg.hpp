// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

#include "petal/html/plots.hpp"

namespace petal::html {

/// The width that plots are drawn for, px of the SVG; the page scales them.
constexpr double kPlotWidth = 600.0;

/// Numbers of a plot along one direction.
struct Scale {
    double low = 0.0, high = 1.0;   ///< the values at its ends
    double begin = 0.0, end = 1.0;  ///< the places

    double at(double value) const;
    /// Round values inside it, about `count`.
    std::vector<double> ticks(int count) const;
};

/// A scale that holds all finite `values` with a little room; 0 to 1 where there are none.
Scale scale_of(const std::vector<double>& values, double begin, double end, bool with_zero);

/// An SVG that grows: texts are escaped, places are told to a tenth of a pixel.
class Svg {
   public:
    explicit Svg(const PlotFrame& frame) : frame_(frame) {}

    void line(double x1, double y1, double x2, double y2, const std::string& style);
    void rect(double x, double y, double width, double height, const std::string& style);
    void dot(double x, double y, double radius, const std::string& style);
    void path(const std::string& steps, const std::string& style);
    /// `anchor`: start, middle or end. Texts longer than `most` characters are cut.
    void text(double x, double y, const std::string& anchor, const std::string& style,
              const std::string& content, std::size_t most = 80);
    void raw(const std::string& svg) { body_ += svg; }
    /// Lines and numbers of a lying axis below a plot of that height, and its name.
    void axis(const Scale& scale, double top, double bottom);
    std::string text_of(double height) const;

   private:
    const PlotFrame& frame_;
    std::string body_;
};

}  // namespace petal::html
