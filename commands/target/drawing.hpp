// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "petal/calibration/target.hpp"

namespace petal {

/// What a line is for: a workshop cuts the outline and the holes, prints the print, and leaves the
/// dimensions alone.
enum class DrawingLayer { outline, holes, print, dimensions };
const char* to_string(DrawingLayer layer);

/// A drawing to scale. Millimetres, in the board's frame: origin at its upper-left front corner, x
/// right, y down.
struct Drawing {
    struct Path {
        DrawingLayer layer;
        std::vector<Eigen::Vector2d> points;
        bool closed = false;
        bool filled = false;  ///< dark, without a line
    };
    struct Circle {
        DrawingLayer layer;
        Eigen::Vector2d centre;
        double radius = 0.0;
    };
    /// Of the dimensions' layer. `at` is the middle of its base line; height that of a capital.
    struct Text {
        Eigen::Vector2d at;
        double height = 0.0;
        std::string text;
        bool upwards = false;  ///< read from below to above
        bool middle = true;    ///< else `at` is its left end
    };
    std::string title;
    Eigen::AlignedBox2d page;
    std::vector<Path> paths;
    std::vector<Circle> circles;
    std::vector<Text> texts;
};

/// The target with its overall size, the places of holes and prints from its upper left corner,
/// thickness and name. \throws Error for a marker that OpenCV does not have.
Drawing draw_target(const Target& target);

/// The page is as large as the drawing says; the board's coordinates stand in the text as they are,
/// or, in DXF (R12, a unit a millimetre, layers OUTLINE HOLES PRINT DIMENSIONS), with y up from the
/// board's lower edge.
std::string svg_of(const Drawing& drawing);
std::string pdf_of(const Drawing& drawing);
std::string dxf_of(const Drawing& drawing);

/// Up to four decimals (0.1 um), without zeros at the end, whatever the locale.
std::string millimetres(double value);

}  // namespace petal
