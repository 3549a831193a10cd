// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/correspondences.hpp"
#include "solvers/detail/board_symmetry.hpp"

namespace petal {

/// One LiDAR board explained by one image board in one rotation; indices into a BoardSet.
struct BoardMatch {
    int lidar = -1;
    int image = -1;
    int rotation = 0;
    bool operator==(const BoardMatch& other) const {
        return lidar == other.lidar && image == other.image && rotation == other.rotation;
    }
};

struct GateParams {
    double gate = 0.03;        ///< m on the board
    double min_gate_px = 3.0;  ///< px
};

/// The boards that one LiDAR and one camera see, of all scenes. The rig is one in all of them, so
/// they are as those of a single scene, but for this: a LiDAR board can be an image board of its
/// own scene only. Immutable once the scenes are in.
class BoardSet {
   public:
    struct FromLidar {
        std::size_t scene = 0;
        int index = -1;  ///< in LidarBoards::boards of its scene
        const LidarBoard* board = nullptr;
        /// One after the other turned further about the board's z: the same number of two boards
        /// is the same turn.
        std::vector<CornerOrder> rotations;
        /// The motion of the LiDAR frame that puts the board onto itself in each rotation.
        std::vector<Eigen::Isometry3d> turns;
        Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    };
    struct FromImage {
        std::size_t scene = 0;
        int index = -1;  ///< in ImageBoards::boards of its scene
        const ImageBoard* board = nullptr;
        Eigen::Vector2d centre = Eigen::Vector2d::Zero();
        double radius = 0.0;  ///< px, of the corner furthest from the centre
    };

    /// `model` is kept by reference and must outlive this.
    BoardSet(const CameraModel& model, GateParams gates) : model_(model), gates_(gates) {}
    /// Adds a scene; the boards must outlive this. `lidar` may be null; `image` holds indices into
    /// `images.boards`.
    void add_scene(const LidarBoards* lidar, const ImageBoards& images,
                   const std::vector<int>& image);

    const CameraModel& model() const { return model_; }
    std::size_t scenes() const { return scenes_.size(); }
    const std::vector<FromLidar>& lidar() const { return lidar_; }
    const std::vector<FromImage>& image() const { return image_; }
    const FromLidar& lidar(const BoardMatch& match) const {
        return lidar_[static_cast<std::size_t>(match.lidar)];
    }
    const FromImage& image(const BoardMatch& match) const {
        return image_[static_cast<std::size_t>(match.image)];
    }

    /// Whether the two can be one board: same scene, target and number of corners.
    bool alike(std::size_t lidar, std::size_t image) const;
    /// Pairs of an order, board numbered by match, corners as the image has them.
    std::vector<PointPair> pairs(const std::vector<BoardMatch>& matches) const;
    /// T_lidar_board turned so that the corners have the image's order.
    Eigen::Isometry3d T_lidar_board(const BoardMatch& match) const;

    /// What an RMS of 1 gate is for a LiDAR board at a pose, px.
    double gate_px(const FromLidar& board, const Eigen::Isometry3d& pose) const;
    /// RMS of each match over its gate; none where a board is not in front or shows its back.
    std::optional<std::vector<double>> gate_ratios(const std::vector<BoardMatch>& matches,
                                                   const Eigen::Isometry3d& pose) const;

    /// The best assignment and rotation of every board at a pose, scene by scene: linear in the
    /// boards, never a product over them.
    struct Explained {
        std::vector<BoardMatch> matches;  ///< by LiDAR board
        double misfit =
            0.0;  ///< sum over LiDAR boards, 0 (explained exactly) to 1 (not at all) each
    };
    Explained explained(const Eigen::Isometry3d& pose) const;

   private:
    struct Scene {
        std::vector<std::size_t> lidar, image;
    };
    bool front_seen(const FromLidar& board, const Eigen::Isometry3d& pose) const;

    const CameraModel& model_;
    GateParams gates_;
    std::vector<FromLidar> lidar_;
    std::vector<FromImage> image_;
    std::vector<Scene> scenes_;
};

}  // namespace petal
