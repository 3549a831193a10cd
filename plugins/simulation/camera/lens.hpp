// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "petal/run.hpp"
#include "simulation/camera/picture.hpp"
#include "simulation/camera/pixel_rays.hpp"

namespace petal::simulation {

/// Light lost towards the rim: as with the fourth power of the cosine of the angle off the axis,
/// and stretched so that the image's farthest pixel loses the given share.
class Vignetting {
   public:
    /// `margin`: pixels of `rays` beyond the image's rim.
    Vignetting(const PixelRays& rays, int margin, double loss);
    /// The share that is left.
    float left(int column, int row) const;

   private:
    const PixelRays& rays_;
    double scale_ = 0.0;
};

/// A Gaussian point spread, integrated over the pixels that receive it. Light from a divided pixel
/// starts at its cells: blurring the pixels' means alone would make an edge's profile depend on
/// where in a pixel the edge lies.
class Blur {
   public:
    explicit Blur(double sigma_px);
    /// Pixels that light may travel.
    int reach() const { return reach_; }

    /// A pixel with what its cells differ by from its mean.
    struct Divided {
        int column;
        std::array<Eigen::Vector3f, Pixel::kCells * Pixel::kCells> cells;
    };
    /// `means`: CV_32FC3; `divided`: by row. Nearer to the rim than reach() the result is wrong.
    cv::Mat of(const cv::Mat& means, const std::vector<std::vector<Divided>>& divided,
               const Run& run) const;

   private:
    const std::array<float, Pixel::kCells>& share(int offset) const {
        return shares_.begin()[offset + reach_];
    }

    int reach_;
    /// [offset + reach_][cell]: the share of a cell's light that a pixel so far away receives, in
    /// one dimension.
    std::vector<std::array<float, Pixel::kCells>> shares_;
};

}  // namespace petal::simulation
