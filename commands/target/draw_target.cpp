// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "drawing.hpp"
#include "simulation/world/marker_texture.hpp"

namespace petal {
namespace {

constexpr double kMm = 1000.0;
/// Wider than the widest of Helvetica's usual letters, in heights of a capital.
constexpr double kWidthOfALetter = 0.95;

using Points = std::vector<Eigen::Vector2d>;

Points in_mm(Points points) {
    for (Eigen::Vector2d& p : points) p *= kMm;
    return points;
}

Points rectangle(const Eigen::Vector2d& corner, double width, double height) {
    return {corner, corner + Eigen::Vector2d(width, 0), corner + Eigen::Vector2d(width, height),
            corner + Eigen::Vector2d(0, height)};
}

/// Draws a target's parts, in millimetres.
class TargetDrawing {
   public:
    explicit TargetDrawing(const Target& target)
        : target_(target),
          width_(target.width() * kMm),
          height_(target.height() * kMm),
          // Legible on a board of any size.
          letter_(std::max(3.0, 0.011 * std::max(width_, height_))) {
        for (const Eigen::Vector2d& p : target.outline) board_.extend(Eigen::Vector2d(kMm * p));
        drawing_.title = target.name;
    }

    Drawing take() {
        drawing_.paths.push_back({DrawingLayer::outline, in_mm(target_.outline), true});
        add_holes();
        add_markers();
        add_checkerboards();
        add_overall();
        add_ordinates();
        add_words();
        return std::move(drawing_);
    }

   private:
    void add_holes() {
        for (const auto& hole : target_.holes) {
            drawing_.paths.push_back({DrawingLayer::holes, in_mm(hole), true});
            for (const Eigen::Vector2d& p : drawing_.paths.back().points) mark(p);
        }
        for (const Target::RoundHole& hole : target_.round_holes) {
            const Eigen::Vector2d centre = hole.centre * kMm;
            const double radius = hole.radius * kMm;
            drawing_.circles.push_back({DrawingLayer::holes, centre, radius});
            for (const Eigen::Vector2d& arm :
                 {Eigen::Vector2d(0.15 * radius, 0.0), Eigen::Vector2d(0.0, 0.15 * radius)})
                line(centre - arm, centre + arm);
            drawing_.texts.push_back({centre + Eigen::Vector2d(0.0, 0.5 * radius), letter_,
                                      "dia " + millimetres(2.0 * radius)});
            mark(centre);
        }
    }

    void fill(const Eigen::Vector2d& corner, double width, double height) {
        drawing_.paths.push_back(
            {DrawingLayer::print, rectangle(corner, width, height), true, true});
    }

    /// Dark cells, those of a row together.
    void add_markers() {
        for (const Target::Marker& marker : target_.markers) {
            const int cells = marker.dictionary.front() - '0' + 2;  // "6x6_250": and the border
            simulation::Look light;
            light.reflectivity = 1.0F;
            simulation::Look dark;
            dark.reflectivity = 0.0F;
            const simulation::MarkerTexture pattern(marker.dictionary, marker.id, cells, dark,
                                                    light);
            const double cell = marker.size * kMm / cells;
            const Eigen::Vector2d corner = marker.corner * kMm;
            for (int row = 0; row < cells; ++row)
                for (int begin = 0; begin < cells;) {
                    int end = begin;
                    while (end < cells && pattern.at({end + 0.5, row + 0.5}).reflectivity < 0.5F)
                        ++end;
                    if (end > begin)
                        fill(corner + cell * Eigen::Vector2d(begin, row), cell * (end - begin),
                             cell);
                    begin = end + 1;
                }
            mark(corner);
            mark(corner + Eigen::Vector2d::Constant(marker.size * kMm));
            words_.push_back("ArUco " + marker.dictionary + ", id " + std::to_string(marker.id) +
                             ": " + millimetres(marker.size * kMm) + " wide, upper left at " +
                             millimetres(corner.x()) + ", " + millimetres(corner.y()));
        }
    }

    void add_checkerboards() {
        for (const Target::Checkerboard& board : target_.checkerboards) {
            const Eigen::Vector2d corner = board.corner * kMm;
            const double square = board.square * kMm;
            for (int row = 0; row < board.rows; ++row)
                for (int column = row % 2; column < board.columns; column += 2)
                    fill(corner + square * Eigen::Vector2d(column, row), square, square);
            mark(corner);
            mark(corner + square * Eigen::Vector2d(board.columns, board.rows));
            words_.push_back("Checkerboard: " + std::to_string(board.columns) + " x " +
                             std::to_string(board.rows) + " squares of " + millimetres(square) +
                             ", upper left at " + millimetres(corner.x()) + ", " +
                             millimetres(corner.y()));
        }
    }

    void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
        drawing_.paths.push_back({DrawingLayer::dimensions, {from, to}});
    }

    /// A place whose distances from the edges are told.
    void mark(const Eigen::Vector2d& place) {
        marks_x_.push_back(place.x());
        marks_y_.push_back(place.y());
    }

    /// With strokes at both ends: to the right of the board and below it.
    void add_overall() {
        const double away = 2.5 * letter_;
        const double tick = 0.5 * letter_;
        const Eigen::Vector2d low = board_.min(), high = board_.max();
        const double y = high.y() + away, x = high.x() + away;
        line({low.x(), y}, {high.x(), y});
        line({x, low.y()}, {x, high.y()});
        for (const double end : {low.x(), high.x()}) {
            line({end, high.y() + tick}, {end, y + tick});
            line({end - tick, y + tick}, {end + tick, y - tick});
        }
        for (const double end : {low.y(), high.y()}) {
            line({high.x() + tick, end}, {x + tick, end});
            line({x - tick, end + tick}, {x + tick, end - tick});
        }
        const Eigen::Vector2d middle = board_.center();
        drawing_.texts.push_back({{middle.x(), y - 0.4 * letter_}, letter_, millimetres(width_)});
        drawing_.texts.push_back(
            {{x - 0.4 * letter_, middle.y()}, letter_, millimetres(height_), true});
    }

    /// The distances of holes and prints from the left and the upper edge, each once: above and to
    /// the left.
    void add_ordinates() {
        const Eigen::Vector2d low = board_.min();
        const auto spread = [this](std::vector<double> values, double first, double last) {
            values.push_back(first);
            values.push_back(last);
            std::sort(values.begin(), values.end());
            std::vector<std::pair<double, double>> places;  // of the thing, and of its text
            for (const double value : values) {
                if (!places.empty() && value - places.back().first < 1e-3) continue;
                const double free = places.empty() ? value : places.back().second + 1.3 * letter_;
                places.emplace_back(value, std::max(value, free));
            }
            return places;
        };
        const double tick = 0.5 * letter_, knee = 1.5 * letter_, text = 3.0 * letter_;
        for (const auto& [x, at] : spread(marks_x_, low.x(), board_.max().x())) {
            line({x, low.y() - tick}, {x, low.y() - knee});
            line({x, low.y() - knee}, {at, low.y() - text});
            const std::string words = millimetres(x - low.x());
            const double half = 0.5 * letter_ * kWidthOfALetter * static_cast<double>(words.size());
            drawing_.texts.push_back(
                {{at + 0.4 * letter_, low.y() - text - half}, letter_, words, true});
        }
        for (const auto& [y, at] : spread(marks_y_, low.y(), board_.max().y())) {
            line({low.x() - tick, y}, {low.x() - knee, y});
            line({low.x() - knee, y}, {low.x() - text, at});
            const std::string words = millimetres(y - low.y());
            const double half = 0.5 * letter_ * kWidthOfALetter * static_cast<double>(words.size());
            drawing_.texts.push_back({{low.x() - text - half, at + 0.4 * letter_}, letter_, words});
        }
    }

    /// Name and sizes below, and the page around all.
    void add_words() {
        std::vector<std::string> lines{
            target_.name, "Scale 1:1, millimetres. The front, as sensors see it.",
            millimetres(width_) + " x " + millimetres(height_) + ", thickness " +
                millimetres(target_.thickness * kMm) + "; " + target_.features()};
        lines.insert(lines.end(), words_.begin(), words_.end());
        const double margin = 10.0 * letter_;
        double right = board_.max().x() + 5.0 * letter_;
        double y = board_.max().y() + 6.0 * letter_;
        for (const std::string& words : lines) {
            drawing_.texts.push_back({{board_.min().x(), y}, letter_, words, false, false});
            right = std::max(right, board_.min().x() + letter_ * kWidthOfALetter *
                                                           static_cast<double>(words.size()));
            y += 1.8 * letter_;
        }
        drawing_.page.extend(Eigen::Vector2d(board_.min() - Eigen::Vector2d::Constant(margin)));
        drawing_.page.extend(Eigen::Vector2d(std::ceil(right), std::ceil(y)));
    }

    const Target& target_;
    double width_, height_;
    double letter_;
    Eigen::AlignedBox2d board_;
    std::vector<double> marks_x_, marks_y_;
    std::vector<std::string> words_;
    Drawing drawing_;
};

}  // namespace

const char* to_string(DrawingLayer layer) {
    switch (layer) {
        case DrawingLayer::outline:
            return "outline";
        case DrawingLayer::holes:
            return "holes";
        case DrawingLayer::print:
            return "print";
        case DrawingLayer::dimensions:
            break;
    }
    return "dimensions";
}

std::string millimetres(double value) {
    std::array<char, 400> text{};
    const auto end =
        std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, 4);
    std::string result(text.data(), end.ptr);
    result.erase(result.find_last_not_of('0') + 1);
    if (result.back() == '.') result.pop_back();
    return result == "-0" ? "0" : result;
}

Drawing draw_target(const Target& target) {
    return TargetDrawing(target).take();
}

}  // namespace petal
