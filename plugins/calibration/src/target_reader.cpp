// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <array>
#include <cmath>

#include "petal/calibration/polygon.hpp"
#include "petal/calibration/shipped_file.hpp"
#include "petal/calibration/target.hpp"
#include "petal/error.hpp"
#include "petal/json_value.hpp"

namespace petal {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

/// Two lengths that differ by less are the same: far below what a saw can do, far above rounding.
constexpr double kSameLength = 1e-6;  // m
constexpr double kSmallest = 0.05;    // m, of an outline
constexpr double kLargest = 5.0;      // m
constexpr double kThickest = 0.5;     // m

double signed_area(const Polygon& polygon) {
    double twice = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d& a = polygon[i];
        const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
        twice += a.x() * b.y() - b.x() * a.y();
    }
    return twice / 2.0;  // positive when clockwise to the eye: y points down
}

Polygon box(const Eigen::Vector2d& corner, double width, double height) {
    return {corner, corner + Eigen::Vector2d(width, 0.0), corner + Eigen::Vector2d(width, height),
            corner + Eigen::Vector2d(0.0, height)};
}

Eigen::Vector2d upper_left(const Polygon& polygon) {
    Eigen::Vector2d low = polygon.front();
    for (const Eigen::Vector2d& p : polygon) low = low.cwiseMin(p);
    return low;
}

/// A hole or a print: what it covers, and where the file tells of it.
struct Piece {
    JsonValue node;
    Polygon polygon;  ///< or else
    Target::RoundHole circle;
    bool round() const { return polygon.empty(); }
};

bool covers(const Polygon& polygon, const Target::RoundHole& circle) {
    return inside_polygon(polygon, circle.centre) ||
           distance_to_polygon(polygon, circle.centre) < circle.radius - kSameLength;
}

bool overlap(const Piece& a, const Piece& b) {
    if (a.round() && b.round())
        return (a.circle.centre - b.circle.centre).norm() <
               a.circle.radius + b.circle.radius - kSameLength;
    if (a.round()) return covers(b.polygon, a.circle);
    if (b.round()) return covers(a.polygon, b.circle);
    const auto corner_inside = [](const Polygon& corners, const Polygon& polygon) {
        return std::any_of(corners.begin(), corners.end(), [&](const Eigen::Vector2d& p) {
            return inside_polygon(polygon, p) && distance_to_polygon(polygon, p) > kSameLength;
        });
    };
    return corner_inside(a.polygon, b.polygon) || corner_inside(b.polygon, a.polygon);
}

bool leaves(const Piece& piece, const Polygon& outline) {
    if (piece.round())
        return !inside_polygon(outline, piece.circle.centre) ||
               distance_to_polygon(outline, piece.circle.centre) < piece.circle.radius;
    return std::any_of(piece.polygon.begin(), piece.polygon.end(), [&](const Eigen::Vector2d& p) {
        return !inside_polygon(outline, p) && distance_to_polygon(outline, p) > kSameLength;
    });
}

Polygon read_polygon(const JsonValue& node) {
    if (!node.is_list() || node.list().size() < 3)
        node.fail("must be a list of at least three points [x, y]");
    Polygon points;
    for (const JsonValue& point : node.list()) points.push_back(point.vector2());
    const double area = signed_area(points);
    if (std::abs(area) < kSameLength) node.fail("has no area");
    if (area < 0.0)
        node.fail(
            "runs counter-clockwise; list its corners clockwise as seen from the front (x right, y "
            "down)");
    return points;
}

Eigen::Vector3d read_colour(const JsonValue& node) {
    if (!node.is_list()) return Eigen::Vector3d::Constant(node.number(0.0, 1.0, "1"));
    Eigen::Vector3d colour = node.vector3();
    if (colour.minCoeff() < 0.0 || colour.maxCoeff() > 1.0)
        node.fail("must be red, green and blue from 0 to 1");
    return colour;
}

/// OpenCV's dictionaries: "4x4_50" to "7x7_1000".
const std::vector<std::string>& dictionaries() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const char* bits : {"4x4_", "5x5_", "6x6_", "7x7_"})
            for (const char* count : {"50", "100", "250", "1000"})
                all.push_back(std::string(bits) + count);
        return all;
    }();
    return names;
}

/// Reads one target and keeps what it has read of holes and prints until all can be checked.
class TargetReader {
   public:
    Target read(const JsonValue& file) {
        file.only({"petal_target", "name", "thickness", "outline", "holes", "round_holes", "prints",
                   "surface"});
        const JsonValue version = file.at("petal_target");
        if (!version.is_number() || version.number() != 1.0)
            version.fail("is the format version and must be 1");
        target_.name = file.at("name").text();
        target_.thickness = file.at("thickness").number(0.0, kThickest, "m");
        target_.outline = read_polygon(file.at("outline"));
        check_size(file.at("outline"));
        if (const auto holes = file.find("holes")) read_holes(*holes);
        if (const auto holes = file.find("round_holes")) read_round_holes(*holes);
        if (const auto prints = file.find("prints"))
            for (const JsonValue& print : prints->list()) read_print(print);
        if (const auto surface = file.find("surface")) read_surface(*surface);
        if (target_.corners().empty())
            file.fail(
                "a target needs something to look for: at least one of holes, round_holes, or a "
                "checkerboard in prints");
        check_places();
        return target_;
    }

   private:
    void check_size(const JsonValue& outline) const {
        for (const double side : {target_.width(), target_.height()})
            if (!(side >= kSmallest && side <= kLargest))
                outline.fail("measures " + std::to_string(target_.width()) + " x " +
                             std::to_string(target_.height()) +
                             " m; sides of 0.05 to 5 m are expected. Lengths are metres");
    }

    void read_holes(const JsonValue& holes) {
        std::vector<Eigen::Vector2d> places;
        for (const JsonValue& hole : holes.list()) {
            target_.holes.push_back(read_polygon(hole));
            pieces_.push_back({hole, target_.holes.back(), {}});
            check_order(hole, places, upper_left(target_.holes.back()));
        }
    }

    void read_round_holes(const JsonValue& holes) {
        std::vector<Eigen::Vector2d> places;
        for (const JsonValue& hole : holes.list()) {
            hole.only({"centre", "radius"});
            target_.round_holes.push_back(
                {hole.at("centre").vector2(), hole.at("radius").number(0.001, kLargest, "m")});
            pieces_.push_back({hole, {}, target_.round_holes.back()});
            check_order(hole, places, target_.round_holes.back().centre);
        }
    }

    static void check_order(const JsonValue& hole, std::vector<Eigen::Vector2d>& places,
                            const Eigen::Vector2d& here) {
        if (!places.empty()) {
            const Eigen::Vector2d& before = places.back();
            const bool next_row = here.y() > before.y() + kSameLength;
            const bool same_row = std::abs(here.y() - before.y()) <= kSameLength;
            if (!next_row && !(same_row && here.x() > before.x()))
                hole.fail(
                    "comes before its predecessor; list the holes row by row from the top left");
        }
        places.push_back(here);
    }

    void read_print(const JsonValue& print) {
        const std::string kind = print.at("kind").choice({"aruco", "checkerboard"});
        if (kind == "aruco") {
            print.only({"kind", "dictionary", "id", "corner", "size"});
            Target::Marker marker;
            marker.dictionary = print.at("dictionary").choice(dictionaries());
            const int count = std::stoi(marker.dictionary.substr(4));
            marker.id = print.at("id").integer(0, count - 1);
            marker.corner = print.at("corner").vector2();
            marker.size = print.at("size").number(0.005, kLargest, "m");
            target_.markers.push_back(marker);
            pieces_.push_back({print, box(marker.corner, marker.size, marker.size), {}});
            return;
        }
        print.only({"kind", "corner", "square", "columns", "rows"});
        Target::Checkerboard board;
        board.corner = print.at("corner").vector2();
        board.square = print.at("square").number(0.001, 1.0, "m");
        board.columns = print.at("columns").integer(2, 1000);
        board.rows = print.at("rows").integer(2, 1000);
        target_.checkerboards.push_back(board);
        pieces_.push_back(
            {print,
             box(board.corner, board.columns * board.square, board.rows * board.square),
             {}});
    }

    void read_surface(const JsonValue& node) {
        node.only({"colour", "reflectivity", "dark_colour", "dark_reflectivity"});
        Target::Surface& surface = target_.surface;
        if (const auto value = node.find("colour")) surface.colour = read_colour(*value);
        if (const auto value = node.find("dark_colour")) surface.dark_colour = read_colour(*value);
        if (const auto value = node.find("reflectivity"))
            surface.reflectivity = value->number(0.0, 1.0, "1");
        if (const auto value = node.find("dark_reflectivity"))
            surface.dark_reflectivity = value->number(0.0, 1.0, "1");
    }

    void check_places() const {
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            if (leaves(pieces_[i], target_.outline)) pieces_[i].node.fail("leaves the outline");
            for (std::size_t j = 0; j < i; ++j)
                if (overlap(pieces_[i], pieces_[j]))
                    pieces_[i].node.fail("overlaps " + pieces_[j].node.path());
        }
    }

    Target target_;
    std::vector<Piece> pieces_;
};

}  // namespace

std::filesystem::path find_target_file(const std::filesystem::path& name_or_path) {
    return find_shipped_file("targets", "target", name_or_path);
}

Target load_target(const std::filesystem::path& name_or_path) {
    return TargetReader().read(JsonValue::read(find_target_file(name_or_path), "target"));
}

}  // namespace petal
