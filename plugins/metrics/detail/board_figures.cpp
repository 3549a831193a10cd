// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/board_figures.hpp"

#include <array>
#include <cmath>

#include "petal/calibration/angles.hpp"

namespace petal {
namespace {

/// An axis of a board's pose error as it is told.
struct Axis {
    const char* name;
    const char* unit;
    double scale;
};
constexpr std::array<Axis, 6> kAxes = {{{"x", "m", 1.0},
                                        {"y", "m", 1.0},
                                        {"z", "m", 1.0},
                                        {"turn_x", "deg", kDegrees},
                                        {"turn_y", "deg", kDegrees},
                                        {"turn_z", "deg", kDegrees}}};

double root_mean(double sum, int count) {
    return std::sqrt(sum / count);
}

std::string with_unit(const Axis& axis, const char* middle) {
    return std::string(axis.name) + middle + "_" + axis.unit;
}

}  // namespace

void BoardCounts::add(const BoardCounts& other) {
    found += other.found;
    missed += other.missed;
    spurious += other.spurious;
}

std::vector<Metric> count_figures(const BoardCounts& counts, const std::string& prefix,
                                  const std::string& scene) {
    return {{prefix + "found", static_cast<double>(counts.found), "1", scene},
            {prefix + "missed", static_cast<double>(counts.missed), "1", scene},
            {prefix + "false", static_cast<double>(counts.spurious), "1", scene}};
}

std::vector<Metric> lidar_figures(const LidarBoardError& error, const std::string& prefix,
                                  const std::string& scene) {
    std::vector<Metric> figures;
    for (std::size_t i = 0; i < kAxes.size(); ++i)
        figures.push_back({prefix + with_unit(kAxes[i], ""),
                           error.error(static_cast<Eigen::Index>(i)) * kAxes[i].scale,
                           kAxes[i].unit, scene});
    if (!error.whole || !error.in_sigmas) return figures;
    for (std::size_t i = 0; i < kAxes.size(); ++i)
        figures.push_back({prefix + kAxes[i].name + "_sigmas",
                           (*error.in_sigmas)(static_cast<Eigen::Index>(i)), "1", scene});
    figures.push_back({prefix + "nees", error.whole->squared, "1", scene});
    return figures;
}

std::vector<Metric> image_figures(const ImageBoardError& error, const std::string& prefix,
                                  const std::string& scene) {
    std::vector<Metric> figures = {{prefix + "rms_px", error.rms_px, "px", scene},
                                   {prefix + "shift_u_px", error.shift_px.x(), "px", scene},
                                   {prefix + "shift_v_px", error.shift_px.y(), "px", scene}};
    if (error.shift_in_sigmas) {
        figures.push_back({prefix + "shift_u_sigmas", error.shift_in_sigmas->x(), "1", scene});
        figures.push_back({prefix + "shift_v_sigmas", error.shift_in_sigmas->y(), "1", scene});
    }
    if (!error.whole) return figures;
    figures.push_back({prefix + "nees", error.whole->squared, "1", scene});
    figures.push_back(
        {prefix + "nees_freedoms", static_cast<double>(error.whole->freedoms), "1", scene});
    return figures;
}

std::vector<Metric> lidar_summary(const std::vector<LidarBoardError>& errors,
                                  const BoardCounts& counts, const std::string& prefix) {
    std::vector<Metric> figures = count_figures(counts, prefix, "");
    Vector6d squares = Vector6d::Zero(), sigmas = Vector6d::Zero();
    double nees = 0.0;
    int judged = 0;
    for (const LidarBoardError& error : errors) {
        squares += error.error.cwiseAbs2();
        if (!error.whole || !error.in_sigmas) continue;
        sigmas += error.in_sigmas->cwiseAbs2();
        nees += error.whole->squared;
        ++judged;
    }
    for (std::size_t i = 0; i < kAxes.size() && !errors.empty(); ++i)
        figures.push_back(
            {prefix + with_unit(kAxes[i], "_rms"),
             root_mean(squares(static_cast<Eigen::Index>(i)), static_cast<int>(errors.size())) *
                 kAxes[i].scale,
             kAxes[i].unit, ""});
    if (judged == 0) return figures;
    for (std::size_t i = 0; i < kAxes.size(); ++i)
        figures.push_back({prefix + kAxes[i].name + "_rms_sigmas",
                           root_mean(sigmas(static_cast<Eigen::Index>(i)), judged), "1", ""});
    figures.push_back({prefix + "nees_mean", nees / judged, "1", ""});
    return figures;
}

std::vector<Metric> image_summary(const std::vector<ImageBoardError>& errors,
                                  const BoardCounts& counts, const std::string& prefix) {
    std::vector<Metric> figures = count_figures(counts, prefix, "");
    if (errors.empty()) return figures;
    double squares = 0.0, nees = 0.0, freedoms = 0.0;
    Eigen::Vector2d shift = Eigen::Vector2d::Zero(), sigmas = Eigen::Vector2d::Zero();
    int judged = 0;
    for (const ImageBoardError& error : errors) {
        squares += error.rms_px * error.rms_px;
        shift += error.shift_px.cwiseAbs2();
        if (!error.whole || !error.shift_in_sigmas) continue;
        sigmas += error.shift_in_sigmas->cwiseAbs2();
        nees += error.whole->squared;
        freedoms += error.whole->freedoms;
        ++judged;
    }
    const int count = static_cast<int>(errors.size());
    figures.push_back({prefix + "rms_px", root_mean(squares, count), "px", ""});
    figures.push_back({prefix + "shift_u_rms_px", root_mean(shift.x(), count), "px", ""});
    figures.push_back({prefix + "shift_v_rms_px", root_mean(shift.y(), count), "px", ""});
    if (judged == 0) return figures;
    figures.push_back({prefix + "shift_u_rms_sigmas", root_mean(sigmas.x(), judged), "1", ""});
    figures.push_back({prefix + "shift_v_rms_sigmas", root_mean(sigmas.y(), judged), "1", ""});
    figures.push_back({prefix + "nees_per_freedom", nees / freedoms, "1", ""});
    return figures;
}

}  // namespace petal
