// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cctype>

#include "drawing.hpp"

namespace petal {
namespace {

/// Group codes and values, a line each.
class DxfText {
   public:
    explicit DxfText(const Eigen::AlignedBox2d& board) : board_(board) {}

    void group(int code, const std::string& value) {
        text_ += std::to_string(code) + "\n" + value + "\n";
    }
    /// Of group 10 + `index`, 20 + `index`: from the board's lower left corner, y up.
    void point(const Eigen::Vector2d& p, int index = 0) {
        group(10 + index, millimetres(p.x() - board_.min().x()));
        group(20 + index, millimetres(board_.max().y() - p.y()));
        group(30 + index, "0");
    }
    void begin(const char* entity, DrawingLayer layer) {
        group(0, entity);
        std::string name = to_string(layer);
        for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        group(8, name);
    }
    std::string take() { return std::move(text_); }

   private:
    Eigen::AlignedBox2d board_;
    std::string text_;
};

void add_path(DxfText& dxf, const Drawing::Path& path) {
    if (path.filled && path.points.size() == 4) {
        dxf.begin("SOLID", path.layer);
        // By turns, not around: the third and the fourth corner change places in DXF.
        const std::size_t turns[] = {0, 1, 3, 2};
        for (int i = 0; i < 4; ++i) dxf.point(path.points[turns[i]], i);
        return;
    }
    if (path.points.size() == 2) {
        dxf.begin("LINE", path.layer);
        dxf.point(path.points[0], 0);
        dxf.point(path.points[1], 1);
        return;
    }
    dxf.begin("POLYLINE", path.layer);
    dxf.group(66, "1");  // vertices follow
    dxf.group(70, path.closed ? "1" : "0");
    for (const Eigen::Vector2d& p : path.points) {
        dxf.begin("VERTEX", path.layer);
        dxf.point(p);
    }
    dxf.begin("SEQEND", path.layer);
}

void add_text(DxfText& dxf, const Drawing::Text& text) {
    dxf.begin("TEXT", DrawingLayer::dimensions);
    dxf.point(text.at);
    dxf.group(40, millimetres(text.height));
    dxf.group(1, text.text);
    if (text.upwards) dxf.group(50, "90");
    if (!text.middle) return;
    dxf.group(72, "1");  // centred on the second point
    dxf.point(text.at, 1);
}

}  // namespace

std::string dxf_of(const Drawing& drawing) {
    Eigen::AlignedBox2d board;
    for (const Drawing::Path& path : drawing.paths)
        if (path.layer == DrawingLayer::outline)
            for (const Eigen::Vector2d& p : path.points) board.extend(p);
    DxfText dxf(board);
    dxf.group(999,
              "A unit is a millimetre. Cut OUTLINE and HOLES; print PRINT; DIMENSIONS are words.");
    dxf.group(0, "SECTION");
    dxf.group(2, "HEADER");
    dxf.group(9, "$ACADVER");
    dxf.group(1, "AC1009");
    dxf.group(0, "ENDSEC");
    dxf.group(0, "SECTION");
    dxf.group(2, "ENTITIES");
    for (const Drawing::Path& path : drawing.paths) add_path(dxf, path);
    for (const Drawing::Circle& circle : drawing.circles) {
        dxf.begin("CIRCLE", circle.layer);
        dxf.point(circle.centre);
        dxf.group(40, millimetres(circle.radius));
    }
    for (const Drawing::Text& text : drawing.texts) add_text(dxf, text);
    dxf.group(0, "ENDSEC");
    dxf.group(0, "EOF");
    return dxf.take();
}

}  // namespace petal
