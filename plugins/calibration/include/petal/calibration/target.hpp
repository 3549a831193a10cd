// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace petal {

/// The calibration board: a flat plate with polygonal holes. Board frame, in metres: origin at the
/// upper-left front corner, x right, y down, z into the board; so the front face is z = 0.
struct Target {
    std::string name;
    std::vector<Eigen::Vector2d> outline;  ///< corners, clockwise as seen from the front
    std::vector<std::vector<Eigen::Vector2d>>
        holes;  ///< row by row from the top left, each clockwise
    double thickness = 0.0;

    /// The corners that detectors look for: those of the holes, row by row from the top left (by y,
    /// then by x). 16 for the four-hole board.
    std::vector<Eigen::Vector2d> corners() const;
    /// The distinct x (or y) of the hole sides, ascending: 0.1 0.2 0.3 0.4 for the four-hole board.
    std::vector<double> lines_x() const;
    std::vector<double> lines_y() const;
    double width() const;   ///< of the outline's bounding box, m
    double height() const;  ///< m
};

/// The file that load_target would read: for Run::used_file. \throws Error when there is none.
std::filesystem::path find_target_file(const std::filesystem::path& name_or_path);

/// Reads a target file (JSON; see datasets/targets). `name_or_path` is the path of a file or the
/// name of a target that petal ships. \throws Error naming the file and what is wrong: no such file
/// (the shipped names are listed), JSON syntax, missing keys, sizes that are no board (outline
/// under 5 cm or over 5 m, holes outside).
Target load_target(const std::filesystem::path& name_or_path);

}  // namespace petal
