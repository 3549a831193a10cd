// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/se3.hpp"
#include "petal/calibration/truth.hpp"

namespace petal {

/// An error in units of the covariance that was told: e^T C^-1 e in the directions that C knows.
struct ErrorInSigmas {
    double squared = 0.0;
    int freedoms = 0;
};

/// None where C is not finite, not symmetric or all zero, or says of itself that a variance is
/// negative. Directions whose variance, after scaling to unit diagonal, is below 1e-10 of the
/// largest count as unknown to C and are left out.
std::optional<ErrorInSigmas> error_in_sigmas(const Eigen::VectorXd& error,
                                             const Eigen::MatrixXd& covariance);

/// A board of the truth, and the turns in its plane that leave its corners as they are.
class TrueBoard {
   public:
    explicit TrueBoard(const Truth::Board& board);

    const Truth::Board& board() const { return *board_; }
    /// The middle of the corners: board frame, LiDAR frame (m), image (raw px).
    const Eigen::Vector3d& middle() const { return middle_; }
    Eigen::Vector3d middle_lidar() const { return board_->T_lidar_board * middle_; }
    Eigen::Vector2d middle_image() const;
    /// RMS distance of the corners from their middle: m, raw px. A board found farther off is not
    /// this one.
    double radius_lidar() const { return radius_; }
    double radius_image() const;
    /// A turn about the middle, and for each corner the one whose place it takes.
    struct Turn {
        Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
        std::vector<std::size_t> order;
    };
    const std::vector<Turn>& turns() const { return turns_; }

   private:
    const Truth::Board* board_;
    Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
    double radius_ = 0.0;
    std::vector<Turn> turns_;
};

struct LidarBoardError {
    /// Estimated less true at the board's middle, along and about the board's own axes: x right, y
    /// down, z into the board; m and rad.
    Vector6d error = Vector6d::Zero();
    std::optional<Vector6d> in_sigmas;   ///< each over its own sigma
    std::optional<ErrorInSigmas> whole;  ///< all six together
};

/// In that of the board's orders which lies nearest to the truth. To the board's covariance
/// `range_sigma` (m) is added along the ray to its middle: the LiDAR's own constant error of
/// ranges, which no detector can see.
LidarBoardError lidar_board_error(const LidarBoard& found, const TrueBoard& truth,
                                  double range_sigma);

struct ImageBoardError {
    double rms_px = 0.0;                                 ///< of the 2-D distance, over corners
    Eigen::Vector2d shift_px = Eigen::Vector2d::Zero();  ///< mean over the corners
    std::optional<Eigen::Vector2d> shift_in_sigmas;      ///< by the joint covariance
    std::optional<ErrorInSigmas> whole;                  ///< all corners, by the joint covariance
};

/// The same for the corners in the image; both must have as many.
ImageBoardError image_board_error(const ImageBoard& found, const TrueBoard& truth);

/// Pairs of (found, true), the nearest first, each used once; `radius` bounds the distance of each
/// true one. `Point` is Eigen::Vector2d or Vector3d.
template <class Point>
std::vector<std::pair<std::size_t, std::size_t>> nearest_pairs(const std::vector<Point>& found,
                                                               const std::vector<Point>& truth,
                                                               const std::vector<double>& radius) {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    std::vector<bool> found_used(found.size(), false), true_used(truth.size(), false);
    while (true) {
        std::optional<std::pair<std::size_t, std::size_t>> best;
        double nearest = 0.0;
        for (std::size_t i = 0; i < found.size(); ++i)
            for (std::size_t j = 0; j < truth.size(); ++j) {
                const double distance = (found[i] - truth[j]).norm();
                if (found_used[i] || true_used[j] || !(distance <= radius[j])) continue;
                if (best && distance >= nearest) continue;
                best = {i, j};
                nearest = distance;
            }
        if (!best) return pairs;
        found_used[best->first] = true;
        true_used[best->second] = true;
        pairs.push_back(*best);
    }
}

}  // namespace petal
