// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "svg.hpp"

#include <algorithm>
#include <cmath>

#include "petal/html/escape.hpp"
#include "petal/printed.hpp"

namespace petal::html {

double Scale::at(double value) const {
    return begin + (value - low) / (high - low) * (end - begin);
}

std::vector<double> Scale::ticks(int count) const {
    const double rough = (high - low) / count;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    double step = 10.0 * power;
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= rough) {
            step = factor * power;
            break;
        }
    std::vector<double> places;
    for (double n = std::ceil(low / step); n * step <= high; n += 1.0)
        places.push_back(n == 0.0 ? 0.0 : n * step);
    return places;
}

Scale scale_of(const std::vector<double>& values, double begin, double end, bool with_zero) {
    double low = with_zero ? 0.0 : HUGE_VAL;
    double high = with_zero ? 0.0 : -HUGE_VAL;
    for (const double value : values) {
        if (!std::isfinite(value)) continue;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    if (low > high) low = 0.0, high = 1.0;
    const double size = std::max(std::abs(low), std::abs(high));
    const bool alike = high - low <= 1e-6 * size;
    const double room = !alike ? 0.04 * (high - low) : size > 0.0 ? 0.1 * size : 1.0;
    return {low - room, high + room, begin, end};
}

void Svg::line(double x1, double y1, double x2, double y2, const std::string& style) {
    body_ += printed("<line class=\"%s\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>\n",
                     style.c_str(), x1, y1, x2, y2);
}

void Svg::rect(double x, double y, double width, double height, const std::string& style) {
    body_ += printed("<rect class=\"%s\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\"/>\n",
                     style.c_str(), x, y, std::max(0.0, width), std::max(0.0, height));
}

void Svg::dot(double x, double y, double radius, const std::string& style) {
    body_ += printed("<circle class=\"%s\" cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\"/>\n", style.c_str(),
                     x, y, radius);
}

void Svg::path(const std::string& steps, const std::string& style) {
    body_ += "<path class=\"" + style + "\" d=\"" + steps + "\"/>\n";
}

void Svg::text(double x, double y, const std::string& anchor, const std::string& style,
               const std::string& content, std::size_t most) {
    std::string shown = content;
    if (shown.size() > most) {
        std::size_t cut = most - 1;  // not inside a sequence of UTF-8
        while (cut > 0 && (static_cast<unsigned char>(shown[cut]) & 0xC0U) == 0x80U) --cut;
        shown = shown.substr(0, cut) + "\u2026";
    }
    body_ += printed("<text class=\"%s\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">", style.c_str(),
                     x, y, anchor.c_str()) +
             escape(shown) + "</text>\n";
}

void Svg::axis(const Scale& scale, double top, double bottom) {
    for (const double tick : scale.ticks(6)) {
        const double x = scale.at(tick);
        line(x, top, x, bottom, tick == 0.0 ? "zero" : "grid");
        text(x, bottom + 16.0, "middle", "tick", printed("%g", tick));
    }
    text((scale.begin + scale.end) / 2.0, bottom + 34.0, "middle", "name", frame_.axis);
}

std::string Svg::text_of(double height) const {
    return printed("<svg class=\"plot\" viewBox=\"0 0 %.0f %.0f\" role=\"img\">\n<title>",
                   kPlotWidth, height) +
           escape(frame_.title) + "</title>\n" + body_ + "</svg>\n";
}

}  // namespace petal::html
