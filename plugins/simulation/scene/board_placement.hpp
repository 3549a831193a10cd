// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>

#include "petal/calibration/target.hpp"
#include "petal/json_value.hpp"
#include "simulation/scene/scene_file.hpp"
#include "simulation/world/random.hpp"

namespace petal::simulation {

/// A board of a scene file: where it stands, and how far that may vary.
class BoardPlacement {
   public:
    /// Reads one element of "boards". \throws Error naming file and key.
    explicit BoardPlacement(const JsonValue& node);

    SceneBoard draw(double floor, Engine& engine) const;
    /// What was made of the target: the same board for the same seed, wherever it stands.
    Target cut(std::uint64_t seed) const;
    /// What holds the board where it is, if anything.
    void add_stand(World& world, const SceneBoard& board, double floor) const;

    const JsonValue& node() const { return node_; }
    const std::filesystem::path& target_file() const { return target_file_; }

   private:
    enum class Stands { none, floor, pole, hung };
    void read_place();
    void read_variation();

    JsonValue node_;
    std::filesystem::path target_file_;
    Target target_;
    Stands stands_ = Stands::none;
    Eigen::Vector3d centre_ =
        Eigen::Vector3d::Zero();  ///< of the outline's box; z is the floor's business for `floor`
    Eigen::Vector3d angles_deg_ = Eigen::Vector3d::Zero();  ///< yaw, pitch, roll
    Eigen::Vector3d vary_position_ = Eigen::Vector3d::Zero();
    Eigen::Vector3d vary_angles_deg_ = Eigen::Vector3d::Zero();
    double raise_ = 0.0;      ///< m: of its lowest corner above the floor
    double cord_ = 0.6;       ///< m
    double cut_sigma_ = 0.0;  ///< m: see cut_board()
};

}  // namespace petal::simulation
