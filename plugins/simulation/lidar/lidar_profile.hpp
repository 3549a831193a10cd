// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace petal::simulation {

/// How a LiDAR moves its beams over its field of view. Only the members of its kind are filled.
struct ScanPatternProfile {
    enum class Kind {
        prisms,   ///< two prisms that turn on one axis: a rosette
        nodding,  ///< all around, while the elevation swings up and down
        rings     ///< all around, every beam at an elevation of its own
    };
    Kind kind = Kind::prisms;

    std::vector<double> deflections;  ///< rad, of each prism
    std::vector<double> rates;        ///< Hz, of each prism; the sign is the sense of rotation
    /// rad, prisms: of each beam before the prisms; rings: of each beam, in the order of firing
    std::vector<double> elevations;

    double rotation = 0.0;        ///< Hz, nodding and rings: of the azimuth
    double swing = 0.0;           ///< Hz, nodding: of the elevation
    double elevation_low = 0.0;   ///< rad, nodding
    double elevation_high = 0.0;  ///< rad, nodding
};

/// What a type of LiDAR is: the numbers of its data sheet, and those assumed where the sheet says
/// nothing (datasets/sensors/*.json tell which). Metres, radians, seconds.
struct LidarProfile {
    std::string name;
    ScanPatternProfile pattern;
    double points_per_second = 0.0;
    double messages_per_second = 10.0;

    double footprint_vertical = 0.0;    ///< rad, full width of the beam
    double footprint_horizontal = 0.0;  ///< rad
    double pulse_width = 0.0;           ///< m of range, full width at half maximum: 4 ns are 0.6 m
    double late_error = 0.0;  ///< m that an echo comes late when its energy is 1/e of a whole one

    /// Range noise, 1 sigma: `range_noise_near` for strong echoes, `range_noise_far` for a surface
    /// at `noise_range` of reflectivity `noise_reflectivity`; between and beyond them as
    /// LidarProfile::range_noise() says.
    double range_noise_near = 0.0;
    double range_noise_far = 0.0;
    double noise_range = 20.0;
    double noise_reflectivity = 0.8;
    double range_offset_sigma = 0.0;  ///< m: how devices of this type differ
    double angular_noise = 0.0;       ///< rad, 1 sigma about each axis, of the reported direction
    double intensity_noise = 0.0;     ///< 1 sigma, relative

    enum class Quantised { coordinates, range };
    Quantised quantised = Quantised::coordinates;
    double quantisation = 0.001;  ///< m

    double range_min = 0.0;
    double range_max = 0.0;
    /// The weakest surface that gives an echo: of this reflectivity, at this range, met squarely.
    double detection_range = 0.0;
    double detection_reflectivity = 0.0;
    double dropout = 0.0;  ///< share of the echoes that are lost for no reason of the scene

    /// Which echo is told where there are several.
    enum class Return { first, strongest };
    Return returned = Return::first;

    /// Energies are relative to a white surface met squarely at 1 m: reflectivity * cos(incidence)
    /// / range^2.
    double detection_energy() const {
        return detection_reflectivity / (detection_range * detection_range);
    }
    /// 1 sigma, m, of an echo of this energy: a constant part, and one of the photons' number.
    double range_noise(double energy) const;
    /// rad: the largest angle off the x axis (prisms), or the largest elevation either way.
    double rim() const;
};

/// The file that load_lidar_profile would read: for Run::used_file. \throws Error when there is
/// none.
std::filesystem::path find_lidar_profile(const std::filesystem::path& name_or_path);

/// Reads a profile (JSON; see datasets/sensors). `name_or_path` is the path of a file or the name
/// of a sensor that petal ships: livox_mid70, livox_avia, livox_mid360, spinning_32. \throws Error
/// naming the file, the key and what was expected.
LidarProfile load_lidar_profile(const std::filesystem::path& name_or_path);

}  // namespace petal::simulation
