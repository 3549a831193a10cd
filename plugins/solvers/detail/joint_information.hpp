// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "solvers/detail/joint_solve.hpp"

namespace petal {

/// Where the parameters that all scenes share stand in a vector: of each camera (rho, phi) of its
/// pose, the factor on its focal length, cx and cy (px); last the LiDAR's range offset (m).
class JointLayout {
   public:
    explicit JointLayout(std::size_t cameras) : cameras_(static_cast<Eigen::Index>(cameras)) {}
    Eigen::Index pose(std::size_t camera) const { return 9 * static_cast<Eigen::Index>(camera); }
    Eigen::Index focal(std::size_t camera) const { return pose(camera) + 6; }
    Eigen::Index centre(std::size_t camera) const { return pose(camera) + 7; }
    Eigen::Index range() const { return 9 * cameras_; }
    Eigen::Index size() const { return 9 * cameras_ + 1; }
    std::size_t cameras() const { return static_cast<std::size_t>(cameras_); }

   private:
    Eigen::Index cameras_;
};

/// What was seen says of the shared parameters, at a solution: normal matrix J'WJ and half gradient
/// J'Wr, with the poses of the boards eliminated (Schur), so both just add up.
struct JointInformation {
    Eigen::MatrixXd normal;
    Eigen::VectorXd gradient;

    explicit JointInformation(Eigen::Index size)
        : normal(Eigen::MatrixXd::Zero(size, size)), gradient(Eigen::VectorXd::Zero(size)) {}
    JointInformation& operator+=(const JointInformation& other) {
        normal += other.normal;
        gradient += other.gradient;
        return *this;
    }
};

/// Of a single board, with weight 1. A corner that does not project adds nothing.
JointInformation board_information(const JointModel& model, const JointBoard& board,
                                   const std::vector<Eigen::Isometry3d>& T_camera_lidar,
                                   const Eigen::Isometry3d& T_lidar_board,
                                   const std::vector<double>& focal, double range_offset);

/// Of every scene, with the weights of the robust loss.
std::vector<JointInformation> scene_information(const JointModel& model,
                                                const JointSolution& solution);

/// Of a prior on a translation, at the solution.
JointInformation prior_information(const JointLayout& layout, const TranslationPrior& prior,
                                   const JointState& state);

/// The inverse of a symmetric matrix of information on `parameters` that are lengths (m), angles
/// (rad) or factors; directions that nothing observes get a 1-sigma of 1000 instead of infinity.
Eigen::MatrixXd inverse_information(const Eigen::MatrixXd& information);

}  // namespace petal
