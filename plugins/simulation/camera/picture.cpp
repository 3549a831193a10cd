// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/camera/picture.hpp"

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "simulation/camera/rows.hpp"

namespace petal::simulation {
namespace {

// Contrasts, as shares of a white surface's radiance, from which a pixel is looked at more closely.
constexpr float kVisible = 0.02F;
constexpr float kStrong = 0.15F;  // of a pattern: its finer grain is not worth 64 samples

constexpr unsigned kPlaces = 64;
constexpr unsigned kFirst = 8;    // of them, for the first look
constexpr unsigned kBeside = 16;  // where no board is: one in each of 4 x 4 cells

/// 64 places in a pixel, in 64ths: the beginning of Sobol's sequence. All their columns and all
/// their rows differ, so that edges along the axes (boards hang upright) are met to 1/128 px where
/// a grid of 8 x 8 would give 1/16 px, and each of 4 x 4 cells has four of them. The first eight
/// are spread alike.
std::array<Eigen::Array2i, kPlaces> sobol_places() {
    std::array<Eigen::Array2i, kPlaces> places;
    for (unsigned k = 0; k < kPlaces; ++k) {
        unsigned column = 0, row = 0, column_bit = kPlaces / 2, row_bits = kPlaces / 2;
        for (unsigned rest = k; rest != 0; rest >>= 1U) {
            if ((rest & 1U) != 0) {
                column ^= column_bit;
                row ^= row_bits;
            }
            column_bit >>= 1U;
            row_bits ^= row_bits >> 1U;
        }
        places[k] = {static_cast<int>(column), static_cast<int>(row)};
    }
    return places;
}
const std::array<Eigen::Array2i, kPlaces> kSobol = sobol_places();

/// The places of one pixel. The same ones in every pixel would be coarse in some directions, and
/// move an edge in those; so they are scrambled bit by bit, which leaves them as evenly spread.
class Places {
   public:
    Places(int column, int row) {
        // Fractions that fill the square evenly: g^-1 and g^-2 with g^3 = g + 1.
        constexpr double kA = 0.7548776662466927, kB = 0.5698402909980532;
        const Eigen::Array2d spread(kA * column + kB * row, kB * column + kA * row);
        mask_ = (kPlaces * (spread - spread.floor())).cast<int>();
    }
    /// (0, 0) to (1, 1).
    Eigen::Array2d at(unsigned k) const {
        const Eigen::Array2i place = scrambled(k);
        return (place.cast<double>() + 0.5) / kPlaces;
    }
    std::size_t cell(unsigned k) const {
        const Eigen::Array2i place = scrambled(k) * Pixel::kCells / static_cast<int>(kPlaces);
        return static_cast<std::size_t>(place.y()) * Pixel::kCells +
               static_cast<std::size_t>(place.x());
    }

   private:
    Eigen::Array2i scrambled(unsigned k) const {
        return {kSobol[k].x() ^ mask_.x(), kSobol[k].y() ^ mask_.y()};
    }
    Eigen::Array2i mask_;
};

}  // namespace

/// What was seen in one pixel.
class Picture::Tally {
   public:
    void add(const Sight& sample) {
        if (count_ == 0) first_ = sample;
        edge_ = edge_ || sample.surface != first_.surface || sample.lit != first_.lit;
        board_ = board_ || (sample.surface != nullptr && sample.surface->kind() == Kind::board);
        low_ = low_.cwiseMin(sample.radiance);
        high_ = high_.cwiseMax(sample.radiance);
        sum_ += sample.radiance;
        ++count_;
    }
    /// Whether an edge of a surface or of a shadow was met.
    bool edge() const { return edge_; }
    bool board() const { return board_; }
    float contrast() const { return (high_ - low_).maxCoeff(); }
    Eigen::Vector3f mean() const { return sum_ / static_cast<float>(count_); }

   private:
    Sight first_;
    bool edge_ = false;
    bool board_ = false;
    Eigen::Vector3f low_ = Eigen::Vector3f::Constant(std::numeric_limits<float>::max());
    Eigen::Vector3f high_ = Eigen::Vector3f::Constant(std::numeric_limits<float>::lowest());
    Eigen::Vector3f sum_ = Eigen::Vector3f::Zero();
    int count_ = 0;
};

Picture::Picture(const PixelRays& rays, const Shading& shading, const Run& run)
    : rays_(rays),
      shading_(shading),
      stride_(static_cast<std::size_t>(rays.columns()) + 1),
      corners_(stride_ * (static_cast<std::size_t>(rays.rows()) + 1)),
      detail_(rays.rows(), rays.columns(), CV_8U) {
    for_rows(run, rays.rows() + 1, [&](int row) {
        for (int column = 0; column <= rays_.columns(); ++column) {
            const Eigen::Vector3d& direction = rays_.corner(column, row);
            if (direction.z() > 0.0) corners_[index(column, row)] = shading_.seen(direction);
        }
    });
    for_rows(run, rays.rows(), [&](int row) {
        for (int column = 0; column < rays_.columns(); ++column) {
            const Tally tally = at_corners(column, row);
            const bool contrast = tally.contrast() > kVisible * shading_.white();
            detail_.at<unsigned char>(row, column) =
                tally.edge() ? kEdge : (contrast ? kPattern : kSmooth);
        }
    });
    // For things whose ends lie between two corners of a pixel; its neighbour knows of them.
    cv::dilate(detail_, detail_, cv::Mat::ones(3, 3, CV_8U));
}

Pixel Picture::pixel(int column, int row) const {
    Pixel result;
    if (!rays_.exists(column, row)) return result;
    Tally all = at_corners(column, row);
    if (detail_.at<unsigned char>(row, column) == kSmooth) {
        result.mean = all.mean();
        return result;
    }
    const Places places(column, row);
    std::array<Sight, kPlaces> samples;
    Tally inside;
    for (unsigned k = 0; k < kFirst; ++k) {
        samples[k] = look(column, row, places.at(k));
        all.add(samples[k]);
        inside.add(samples[k]);
    }
    if (all.contrast() <= (all.edge() ? kVisible : kStrong) * shading_.white()) {
        result.mean = inside.mean();
        return result;
    }
    // Leaves and bricks are many, and nobody measures their edges.
    const unsigned count = all.board() ? kPlaces : kBeside;
    for (unsigned k = kFirst; k < count; ++k) {
        samples[k] = look(column, row, places.at(k));
        inside.add(samples[k]);
    }
    result.mean = inside.mean();
    result.divided = true;
    result.cells.fill(-result.mean);
    const unsigned in_cell = count / (Pixel::kCells * Pixel::kCells);
    for (unsigned k = 0; k < count; ++k)
        result.cells[places.cell(k)] += samples[k].radiance / static_cast<float>(in_cell);
    return result;
}

Picture::Tally Picture::at_corners(int column, int row) const {
    Tally tally;
    for (int k = 0; k < 4; ++k) tally.add(corners_[index(column + k % 2, row + k / 2)]);
    return tally;
}

Sight Picture::look(int column, int row, const Eigen::Array2d& place) const {
    const Eigen::Vector3d direction = rays_.inside(column, row, place.x(), place.y());
    return detail_.at<unsigned char>(row, column) == kEdge
               ? shading_.seen(direction)
               : shading_.seen(direction, corners_[index(column, row)]);
}

}  // namespace petal::simulation
