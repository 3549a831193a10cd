// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include <cmath>
#include <locale>
#include <map>
#include <regex>
#include <sstream>

#include "drawing.hpp"
#include "simulation/world/marker_texture.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
using Points = std::vector<Eigen::Vector2d>;

Target shipped(const std::string& name) {
    return load_target(PETAL_SOURCE_DIR "/datasets/targets/" + name + ".json");
}

/// The numbers of a text, whatever stands between them.
std::vector<double> numbers_in(std::string text) {
    for (char& c : text)
        if (c == ',') c = ' ';
    std::istringstream in(text);
    in.imbue(std::locale::classic());
    std::vector<double> numbers;
    for (double number = 0.0; in >> number;) numbers.push_back(number);
    return numbers;
}

Points points_in(const std::string& text) {
    const auto numbers = numbers_in(text);
    Points points;
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2)
        points.emplace_back(numbers[i], numbers[i + 1]);
    return points;
}

/// What stands between the marks, each time.
std::vector<std::string> between(const std::string& text, const std::string& begin,
                                 const std::string& end) {
    std::vector<std::string> found;
    for (std::size_t at = 0; (at = text.find(begin, at)) != std::string::npos;) {
        at += begin.size();
        found.push_back(text.substr(at, text.find(end, at) - at));
    }
    return found;
}

std::string svg_layer(const std::string& svg, const std::string& id) {
    return between(svg, "<g id=\"" + id + "\"", "</g>").at(0);
}

/// Exact to what is printed: 0.1 um.
void expect_points(const Points& found, const Points& metres) {
    ASSERT_EQ(found.size(), metres.size());
    for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_LT((found[i] - 1000.0 * metres[i]).cwiseAbs().maxCoeff(), 1e-4) << i;
}

TEST(TargetDrawingTest, TheSvgHasTheBoardInMillimetres) {
    const Target target = shipped("four_square_holes_500mm");
    const std::string svg = svg_of(draw_target(target));
    const auto outline = between(svg_layer(svg, "outline"), "points=\"", "\"");
    ASSERT_EQ(outline.size(), 1u);
    expect_points(points_in(outline[0]), target.outline);
    const auto holes = between(svg_layer(svg, "holes"), "points=\"", "\"");
    ASSERT_EQ(holes.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) expect_points(points_in(holes[i]), target.holes[i]);
    // The page is 1:1: as many millimetres as user units.
    const auto view = numbers_in(between(svg, "viewBox=\"", "\"").at(0));
    EXPECT_EQ(between(svg, "width=\"", "mm\"").at(0), millimetres(view[2]));
    EXPECT_EQ(between(svg, "height=\"", "mm\"").at(0), millimetres(view[3]));
    EXPECT_LT(view[0], 0.0);
    EXPECT_GT(view[0] + view[2], 500.0);
    EXPECT_THAT(svg, HasSubstr("four_square_holes_500mm</text>"));
    EXPECT_THAT(svg, HasSubstr("500 x 500, thickness 5; 4 polygonal holes"));
    for (const char* place : {">100<", ">200<", ">300<", ">400<", ">500<"})
        EXPECT_THAT(svg, HasSubstr(place));
}

TEST(TargetDrawingTest, RoundHolesAndMarkersAreThere) {
    const Target target = shipped("four_round_holes_aruco");
    const std::string svg = svg_of(draw_target(target));
    const auto circles = between(svg_layer(svg, "holes"), "<circle ", "/>");
    ASSERT_EQ(circles.size(), 4u);
    EXPECT_EQ(circles[3], "cx=\"950\" cy=\"700\" r=\"120\"");
    EXPECT_THAT(svg, HasSubstr(">dia 240<"));
    EXPECT_THAT(svg, HasSubstr("ArUco 6x6_250, id 3: 200 wide, upper left at 1150, 750"));
    // Each cell of each marker is dark exactly where a dark piece covers it.
    std::vector<Points> dark;
    for (const std::string& piece : between(svg_layer(svg, "print"), "points=\"", "\""))
        dark.push_back(points_in(piece));
    simulation::Look black, white;
    black.reflectivity = 0.0F;
    white.reflectivity = 1.0F;
    int light_cells = 0;
    for (const Target::Marker& marker : target.markers) {
        const simulation::MarkerTexture pattern(marker.dictionary, marker.id, 8.0, black, white);
        for (int cell = 0; cell < 64; ++cell) {
            const Eigen::Vector2d place(cell % 8 + 0.5, cell / 8 + 0.5);
            const Eigen::Vector2d mm = 1000.0 * (marker.corner + marker.size / 8.0 * place);
            const auto covers = [&mm](const Points& piece) {
                return mm.x() > piece[0].x() && mm.y() > piece[0].y() && mm.x() < piece[2].x() &&
                       mm.y() < piece[2].y();
            };
            const bool light = pattern.at(place).reflectivity > 0.5F;
            EXPECT_EQ(std::any_of(dark.begin(), dark.end(), covers), !light) << marker.id;
            light_cells += light ? 1 : 0;
        }
    }
    EXPECT_GT(light_cells, 20);
}

TEST(TargetDrawingTest, ACheckerboardHasItsDarkSquares) {
    const Target target = shipped("checkerboard");
    const auto squares =
        between(svg_layer(svg_of(draw_target(target)), "print"), "points=\"", "\"");
    ASSERT_EQ(squares.size(), 24u);  // half of 8 x 6
    expect_points(points_in(squares[0]), {{0.06, 0.07}, {0.12, 0.07}, {0.12, 0.13}, {0.06, 0.13}});
    expect_points(points_in(squares[4]),  // the second row begins light
                  {{0.12, 0.13}, {0.18, 0.13}, {0.18, 0.19}, {0.12, 0.19}});
}

/// Group codes and values of a DXF file.
std::vector<std::pair<int, std::string>> dxf_groups(const std::string& dxf) {
    std::vector<std::pair<int, std::string>> groups;
    std::istringstream in(dxf);
    for (std::string code, value; std::getline(in, code) && std::getline(in, value);)
        groups.emplace_back(std::stoi(code), value);
    return groups;
}

TEST(TargetDrawingTest, TheDxfHasYUpAndALayerForEachUse) {
    const Target target = shipped("four_round_holes_aruco");
    const auto groups = dxf_groups(dxf_of(draw_target(target)));
    std::string entity, layer;
    std::map<int, double> values;
    Points outline, centres;
    std::map<std::string, int> solids;
    const auto end_of_entity = [&] {
        // Up from the lower edge, so back to the board's frame by 1000 - y.
        if (entity == "VERTEX" && layer == "OUTLINE")
            outline.emplace_back(values[10], 1000.0 - values[20]);
        if (entity == "CIRCLE" && layer == "HOLES") {
            centres.emplace_back(values[10], 1000.0 - values[20]);
            EXPECT_EQ(values[40], 120.0);
        }
        if (entity == "SOLID") {
            ++solids[layer];
            // 1, 2, 4, 3: the first and the last are opposite corners.
            EXPECT_NE(values[10], values[13]);
            EXPECT_NE(values[20], values[23]);
        }
        values.clear();
    };
    for (const auto& [code, value] : groups) {
        if (code == 0) {
            end_of_entity();
            entity = value;
        } else if (code == 8) {
            layer = value;
        } else if ((code >= 10 && code <= 33) || code == 40) {
            values[code] = numbers_in(value).at(0);
        }
    }
    expect_points(outline, target.outline);
    Points expected;
    for (const auto& hole : target.round_holes) expected.push_back(hole.centre);
    expect_points(centres, expected);
    ASSERT_EQ(solids.size(), 1u);
    EXPECT_GT(solids["PRINT"], 40);
    EXPECT_EQ(groups.back().second, "EOF");
}

TEST(TargetDrawingTest, ThePdfIsToScaleAndWhole) {
    const Target target = shipped("four_round_holes_aruco");
    const Drawing drawing = draw_target(target);
    const std::string pdf = pdf_of(drawing);
    EXPECT_EQ(pdf.rfind("%PDF-1.4\n", 0), 0u);
    // The table of objects points at each of them.
    const std::size_t table = std::stoul(between(pdf, "startxref\n", "\n").at(0));
    EXPECT_EQ(pdf.compare(table, 4, "xref"), 0);
    std::istringstream in(pdf.substr(table));
    std::string line;
    std::getline(in, line);
    std::getline(in, line);
    std::getline(in, line);
    for (int number = 1; number <= 6; ++number) {
        std::getline(in, line);
        EXPECT_EQ(line.size(), 19u);  // and the line's end: 20 bytes each
        const std::string begin = std::to_string(number) + " 0 obj";
        EXPECT_EQ(pdf.compare(std::stoul(line), begin.size(), begin), 0) << number;
    }
    const std::string content = between(pdf, "stream\n", "endstream").at(0);
    EXPECT_EQ(std::stoul(between(pdf, "/Length ", " ").at(0)), content.size());
    // 72 points an inch, and y turned over: the matrix takes the board's corners to the page.
    const auto matrix = numbers_in(content.substr(0, content.find(" cm")));
    ASSERT_EQ(matrix.size(), 6u);
    EXPECT_NEAR(matrix[0], 72.0 / 25.4, 1e-6);
    EXPECT_NEAR(matrix[3], -72.0 / 25.4, 1e-6);
    const auto box = numbers_in(between(pdf, "/MediaBox [", "]").at(0));
    EXPECT_NEAR(box[2], 72.0 / 25.4 * drawing.page.sizes().x(), 1e-5);
    // Six decimals of the factor, over 1.5 m.
    EXPECT_NEAR(matrix[0] * drawing.page.min().x() + matrix[4], 0.0, 1e-3);
    EXPECT_NEAR(matrix[3] * drawing.page.min().y() + matrix[5], box[3], 1e-3);
    EXPECT_THAT(content, HasSubstr("0 0 m 1400 0 l 1400 1000 l 0 1000 l s"));
    // A round hole: every end of its arcs lies on the circle, and so does the middle of an arc, to
    // the 4e-6 of the radius that a cubic leaves.
    const std::string arcs =
        std::regex_replace(between(content, "570 300 m ", " s").at(0), std::regex("c"), "");
    const Points points = points_in(arcs);
    ASSERT_EQ(points.size(), 24u);
    const Eigen::Vector2d centre(450.0, 300.0);
    for (std::size_t i = 2; i < 24; i += 3) EXPECT_NEAR((points[i] - centre).norm(), 120.0, 1e-3);
    const Eigen::Vector2d middle =
        (Eigen::Vector2d(570.0, 300.0) + 3.0 * points[0] + 3.0 * points[1] + points[2]) / 8.0;
    EXPECT_NEAR((middle - centre).norm(), 120.0, 1e-3);
}

TEST(TargetDrawingTest, NumbersNeedNoLocale) {
    EXPECT_EQ(millimetres(500.0), "500");
    EXPECT_EQ(millimetres(0.1 * 1000.0 + 0.25), "100.25");
    EXPECT_EQ(millimetres(-0.0), "0");
    EXPECT_EQ(millimetres(-0.00004), "0");
}

TEST(TargetDrawingTest, CloseOrdinatesDoNotOverlap) {
    Target target = shipped("four_square_holes_500mm");
    for (auto& hole : target.holes)
        for (auto& p : hole) p.x() = p.x() < 0.25 ? 0.2 + 0.01 * p.x() : p.x();
    const Drawing drawing = draw_target(target);
    std::vector<double> places;
    for (const Drawing::Text& text : drawing.texts)
        if (text.upwards && text.at.y() < 0.0) places.push_back(text.at.x());
    ASSERT_EQ(places.size(), 6u);
    for (std::size_t i = 1; i < places.size(); ++i)
        EXPECT_GE(places[i] - places[i - 1], drawing.texts[0].height);
}

}  // namespace
}  // namespace petal
