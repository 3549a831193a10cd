// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/camera/pixel_rays.hpp"

#include <Eigen/LU>
#include <optional>

#include "simulation/camera/rows.hpp"

namespace petal::simulation {
namespace {

/// px between the nodes at which the model is inverted from nothing: costly, some microseconds
/// each.
constexpr int kCell = 8;

/// The directions at every kCell-th corner. All have z = 1.
class Nodes {
   public:
    Nodes(const CameraModel& model, const Eigen::Vector2d& origin, int columns, int rows,
          const Run& run)
        : width_(columns / kCell + 2), height_(rows / kCell + 2) {
        nodes_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
        for_rows(run, height_, [&](int row) {
            for (int column = 0; column < width_; ++column)
                nodes_[index(column, row)] =
                    model.unproject(origin + kCell * Eigen::Vector2d(column, row));
        });
    }

    /// The nodes around a corner.
    struct Around {
        int known = 0;          ///< of the four
        Eigen::Vector3d guess;  ///< where all four are known
    };
    Around around(int column, int row) const {
        const double right = static_cast<double>(column % kCell) / kCell;
        const double down = static_cast<double>(row % kCell) / kCell;
        Around around{0, Eigen::Vector3d::Zero()};
        for (int k = 0; k < 4; ++k) {
            const auto& node = nodes_[index(column / kCell + k % 2, row / kCell + k / 2)];
            if (!node) continue;
            ++around.known;
            around.guess +=
                (k % 2 == 0 ? 1.0 - right : right) * (k / 2 == 0 ? 1.0 - down : down) * *node;
        }
        return around;
    }

   private:
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(column);
    }

    int width_, height_;
    std::vector<std::optional<Eigen::Vector3d>> nodes_;
};

/// Newton's steps from a guess. One step squares the error: from 0.02 px it leaves 1e-6 px.
std::optional<Eigen::Vector3d> refined(const CameraModel& model, const Eigen::Vector2d& pixel,
                                       Eigen::Vector3d guess) {
    constexpr double kNearPx = 0.02;
    constexpr int kSteps = 4;
    for (int i = 0; i < kSteps; ++i) {
        Eigen::Matrix<double, 2, 3> jacobian;
        const auto at = model.project(guess, &jacobian);
        if (!at) return std::nullopt;
        const Eigen::Vector2d error = *at - pixel;
        guess.head<2>() -= jacobian.leftCols<2>().inverse() * error;
        if (error.norm() < kNearPx) return guess;
    }
    return std::nullopt;
}

}  // namespace

PixelRays::PixelRays(const CameraModel& model, int margin, const Run& run)
    : columns_(static_cast<int>(model.camera().ncols) + 2 * margin),
      rows_(static_cast<int>(model.camera().nrows) + 2 * margin) {
    const std::size_t stride = static_cast<std::size_t>(columns_) + 1;
    corners_.resize(stride * (static_cast<std::size_t>(rows_) + 1));
    const Eigen::Vector2d origin = Eigen::Vector2d::Constant(-0.5 - margin);
    const Nodes nodes(model, origin, columns_ + 1, rows_ + 1, run);

    // Straight lines of a pinhole are straight in (x, y, 1); a fisheye's circles are even in
    // angle. Interpolated otherwise, either would be off by up to 0.001 px.
    const auto distortion = model.camera().distortion;
    const bool straight = distortion == mrpt::img::DistortionModel::none;
    const bool unit = distortion == mrpt::img::DistortionModel::kannala_brandt;
    for_rows(run, rows_ + 1, [&](int row) {
        for (int column = 0; column <= columns_; ++column) {
            const Eigen::Vector2d pixel = origin + Eigen::Vector2d(column, row);
            const Nodes::Around around = nodes.around(column, row);
            std::optional<Eigen::Vector3d> direction;
            if (around.known == 4)
                direction = straight ? around.guess : refined(model, pixel, around.guess);
            // At the model's rim. A cell with no corner inside holds at most a hundredth of a
            // pixel's width of it.
            if (!direction && around.known > 0) direction = model.unproject(pixel);
            if (!direction) direction = Eigen::Vector3d::Zero();
            if (unit) direction->normalize();  // leaves zero as it is
            corners_[static_cast<std::size_t>(row) * stride + static_cast<std::size_t>(column)] =
                *direction;
        }
    });
}

bool PixelRays::exists(int column, int row) const {
    return corner(column, row).z() > 0.0 && corner(column + 1, row).z() > 0.0 &&
           corner(column, row + 1).z() > 0.0 && corner(column + 1, row + 1).z() > 0.0;
}

}  // namespace petal::simulation
