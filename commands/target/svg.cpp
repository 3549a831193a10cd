// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "drawing.hpp"
#include "petal/html/escape.hpp"

namespace petal {
namespace {

std::string svg_path(const Drawing::Path& path) {
    std::string text = path.closed ? "<polygon points=\"" : "<polyline points=\"";
    for (std::size_t i = 0; i < path.points.size(); ++i)
        text += (i > 0 ? " " : "") + millimetres(path.points[i].x()) + "," +
                millimetres(path.points[i].y());
    return text + (path.filled ? "\" fill=\"black\" stroke=\"none\"/>\n" : "\"/>\n");
}

std::string svg_text(const Drawing::Text& text) {
    // Helvetica's capitals are 0.72 of the size of the font.
    const std::string at = millimetres(text.at.x()) + "\" y=\"" + millimetres(text.at.y());
    const std::string turn = text.upwards
                                 ? "\" transform=\"rotate(-90 " + millimetres(text.at.x()) + " " +
                                       millimetres(text.at.y()) + ")"
                                 : "";
    return "<text x=\"" + at + "\" font-size=\"" + millimetres(text.height / 0.72) +
           "\" text-anchor=\"" + (text.middle ? "middle" : "start") + turn + "\">" +
           html::escape(text.text) + "</text>\n";
}

}  // namespace

std::string svg_of(const Drawing& drawing) {
    const Eigen::Vector2d size = drawing.page.sizes(), low = drawing.page.min();
    std::string text = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" +
                       millimetres(size.x()) + "mm\" height=\"" + millimetres(size.y()) +
                       "mm\" viewBox=\"" + millimetres(low.x()) + " " + millimetres(low.y()) + " " +
                       millimetres(size.x()) + " " + millimetres(size.y()) + "\">\n<title>" +
                       html::escape(drawing.title) + "</title>\n";
    for (const DrawingLayer layer : {DrawingLayer::print, DrawingLayer::outline,
                                     DrawingLayer::holes, DrawingLayer::dimensions}) {
        // Crisp, or the cells of a marker show seams.
        const char* style =
            layer == DrawingLayer::dimensions ? "stroke=\"#1f5fa8\" stroke-width=\"0.25\""
            : layer == DrawingLayer::print    ? "stroke=\"none\" shape-rendering=\"crispEdges\""
                                              : "stroke=\"black\" stroke-width=\"0.5\"";
        text += std::string("<g id=\"") + to_string(layer) + "\" fill=\"none\" " + style + ">\n";
        for (const Drawing::Path& path : drawing.paths)
            if (path.layer == layer) text += svg_path(path);
        for (const Drawing::Circle& circle : drawing.circles)
            if (circle.layer == layer)
                text += "<circle cx=\"" + millimetres(circle.centre.x()) + "\" cy=\"" +
                        millimetres(circle.centre.y()) + "\" r=\"" + millimetres(circle.radius) +
                        "\"/>\n";
        text += "</g>\n";
    }
    text += "<g id=\"words\" fill=\"#1f5fa8\" font-family=\"Helvetica, Arial, sans-serif\">\n";
    for (const Drawing::Text& each : drawing.texts) text += svg_text(each);
    return text + "</g>\n</svg>\n";
}

}  // namespace petal
