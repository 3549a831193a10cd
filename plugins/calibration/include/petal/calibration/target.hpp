// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace petal {

/// The calibration board: a flat plate with holes and prints on its front. Board frame, in metres:
/// origin at the upper-left front corner, x right, y down, z into the board; so the front face is
/// z = 0.
struct Target {
    struct RoundHole {
        Eigen::Vector2d centre;
        double radius = 0.0;
    };
    /// A square marker of OpenCV's dictionaries, upright.
    struct Marker {
        std::string dictionary;  ///< "6x6_250": bits a side, markers in the dictionary
        int id = 0;
        Eigen::Vector2d corner;  ///< its upper left
        double size = 0.0;       ///< with its black border
    };
    /// Squares by turns dark and light; the upper left one is dark.
    struct Checkerboard {
        Eigen::Vector2d corner;     ///< its upper left
        double square = 0.0;        ///< side of one
        int columns = 0, rows = 0;  ///< squares, not inner corners
    };
    /// What the plate and the prints on it send back.
    struct Surface {
        Eigen::Vector3d colour =
            Eigen::Vector3d::Constant(0.8);  ///< linear albedo, 0 to 1: red, green, blue
        double reflectivity = 0.7;           ///< at the LiDAR's wavelength, 0 to 1
        Eigen::Vector3d dark_colour = Eigen::Vector3d::Constant(0.03);  ///< of the prints
        double dark_reflectivity = 0.1;
    };

    std::string name;
    std::vector<Eigen::Vector2d> outline;  ///< corners, clockwise as seen from the front
    std::vector<std::vector<Eigen::Vector2d>>
        holes;                           ///< row by row from the top left, each clockwise
    std::vector<RoundHole> round_holes;  ///< row by row from the top left
    std::vector<Marker> markers;
    std::vector<Checkerboard> checkerboards;
    Surface surface;
    double thickness = 0.0;

    /// The points that detectors look for, row by row from the top left (by y, then by x): the
    /// corners of the polygonal holes (16 for the four-hole board); where there are none, the
    /// centres of the round holes; where there are none of these either, the inner corners of the
    /// checkerboards.
    std::vector<Eigen::Vector2d> corners() const;
    /// The distinct x (or y) of the polygonal holes' sides, ascending: 0.1 0.2 0.3 0.4 for the
    /// four-hole board.
    std::vector<double> lines_x() const;
    std::vector<double> lines_y() const;
    double width() const;   ///< of the outline's bounding box, m
    double height() const;  ///< m
    /// What it shows, in words: "4 round holes, 4 markers". For messages.
    std::string features() const;
};

/// The file that load_target would read: for Run::used_file. \throws Error when there is none.
std::filesystem::path find_target_file(const std::filesystem::path& name_or_path);

/// Reads a target file (JSON; datasets/README.md tells its keys). `name_or_path` is the path of a
/// file or the name of a target that petal ships. \throws Error naming the file and what is wrong:
/// no such file (the shipped names are listed), JSON syntax, missing keys, sizes that are no board
/// (outline under 5 cm or over 5 m, holes or prints outside or on each other, nothing to look for).
Target load_target(const std::filesystem::path& name_or_path);

}  // namespace petal
