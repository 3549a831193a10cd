// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <array>
#include <charconv>
#include <cmath>

#include "drawing.hpp"
#include "petal/calibration/angles.hpp"

namespace petal {
namespace {

constexpr double kPoints = 72.0 / 25.4;  ///< a millimetre
/// Of Helvetica's digits and the mean of its letters, in sizes of the font.
constexpr double kMeanWidth = 0.53;
constexpr double kCapital = 0.72;

/// Six decimals: of a factor, a micrometre over a metre.
std::string pdf_number(double value) {
    std::array<char, 400> text{};
    const auto end =
        std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, 6);
    return {text.data(), end.ptr};
}

std::string pdf_point(const Eigen::Vector2d& p) {
    return millimetres(p.x()) + " " + millimetres(p.y());
}

/// What is no ASCII has no place in the standard fonts' encoding.
std::string pdf_string(const std::string& text) {
    std::string escaped = "(";
    for (const char c : text) {
        if (c == '(' || c == ')' || c == '\\') escaped += '\\';
        escaped += c < ' ' || c > '~' ? '?' : c;
    }
    return escaped + ")";
}

std::string pdf_path(const Drawing::Path& path) {
    std::string text;
    for (std::size_t i = 0; i < path.points.size(); ++i)
        text += pdf_point(path.points[i]) + (i == 0 ? " m " : " l ");
    const char* paint = path.closed ? "s" : "S";
    return text + (path.filled ? "f" : paint) + "\n";
}

/// Eight cubic arcs: within 4e-6 of the radius.
std::string pdf_circle(const Drawing::Circle& circle) {
    constexpr int kArcs = 8;
    const double step = 2.0 * kPi / kArcs;
    const double handle = 4.0 / 3.0 * std::tan(step / 4.0);
    std::string text;
    for (int i = 0; i < kArcs; ++i) {
        const auto at = [&](double angle, double along) {
            return pdf_point(circle.centre +
                             circle.radius *
                                 Eigen::Vector2d(std::cos(angle) - along * std::sin(angle),
                                                 std::sin(angle) + along * std::cos(angle)));
        };
        if (i == 0) text += at(0.0, 0.0) + " m ";
        text += at(i * step, handle) + " " + at((i + 1) * step, -handle) + " " +
                at((i + 1) * step, 0.0) + " c ";
    }
    return text + "s\n";
}

std::string pdf_text(const Drawing::Text& text) {
    const double size = text.height / kCapital;
    const double back =
        text.middle ? 0.5 * size * kMeanWidth * static_cast<double>(text.text.size()) : 0.0;
    // The page's y points down, so text would stand on its head.
    const char* turn = text.upwards ? "0 -1 -1 0 " : "1 0 0 -1 ";
    const Eigen::Vector2d along = text.upwards ? Eigen::Vector2d(0, -1) : Eigen::Vector2d(1, 0);
    const Eigen::Vector2d from = text.at - back * along;
    return "BT /F1 " + millimetres(size) + " Tf " + turn + pdf_point(from) + " Tm " +
           pdf_string(text.text) + " Tj ET\n";
}

std::string page_content(const Drawing& drawing) {
    // Millimetres of the board, y down.
    std::string text = pdf_number(kPoints) + " 0 0 " + pdf_number(-kPoints) + " " +
                       pdf_number(-kPoints * drawing.page.min().x()) + " " +
                       pdf_number(kPoints * drawing.page.max().y()) + " cm\n";
    for (const DrawingLayer layer : {DrawingLayer::print, DrawingLayer::outline,
                                     DrawingLayer::holes, DrawingLayer::dimensions}) {
        text += layer == DrawingLayer::dimensions ? "0.25 w 0.12 0.37 0.66 RG 0.12 0.37 0.66 rg\n"
                                                  : "0.5 w 0 0 0 RG 0 0 0 rg\n";
        for (const Drawing::Path& path : drawing.paths)
            if (path.layer == layer) text += pdf_path(path);
        for (const Drawing::Circle& circle : drawing.circles)
            if (circle.layer == layer) text += pdf_circle(circle);
    }
    for (const Drawing::Text& each : drawing.texts) text += pdf_text(each);
    return text;
}

}  // namespace

std::string pdf_of(const Drawing& drawing) {
    const Eigen::Vector2d size = kPoints * drawing.page.sizes();
    const std::string content = page_content(drawing);
    const std::string objects[] = {
        "<< /Type /Catalog /Pages 2 0 R >>",
        "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 " + pdf_number(size.x()) + " " +
            pdf_number(size.y()) + "] /Contents 4 0 R /Resources << /Font << /F1 5 0 R >> >> >>",
        "<< /Length " + std::to_string(content.size()) + " >>\nstream\n" + content + "endstream",
        "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
        "<< /Title " + pdf_string(drawing.title) + " >>"};
    std::string text = "%PDF-1.4\n";
    std::string table;
    int number = 0;
    for (const std::string& object : objects) {
        std::string offset = std::to_string(text.size());
        table += std::string(10 - offset.size(), '0') + offset + " 00000 n \n";
        text += std::to_string(++number) + " 0 obj\n" + object + "\nendobj\n";
    }
    const std::string count = std::to_string(number + 1);
    return text + "xref\n0 " + count + "\n0000000000 65535 f \n" + table + "trailer\n<< /Size " +
           count + " /Root 1 0 R /Info 6 0 R >>\nstartxref\n" + std::to_string(text.size()) +
           "\n%%EOF\n";
}

}  // namespace petal
