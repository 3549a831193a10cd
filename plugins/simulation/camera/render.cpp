// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "simulation/camera/camera_simulation.hpp"
#include "simulation/camera/pixel_rays.hpp"
#include "simulation/camera/rows.hpp"
#include "simulation/camera/shading.hpp"

namespace petal::simulation {
namespace {

// Contrasts, as shares of a white surface's radiance, from which a pixel is looked at more closely.
constexpr float kVisible = 0.02F;
constexpr float kStrong = 0.15F;  // of a pattern: its finer grain is not worth 64 samples

// Places in a pixel: a lattice of 64 whose columns and rows are all different, so that edges along
// the axes (boards hang upright) are met to 1/128 px, where a grid of 8 x 8 would give 1/16 px.
constexpr int kPlaces = 64;
constexpr int kNextRow = 19;  // a row's distance from that of the column before
constexpr int kStride = 8;    // every eighth is a lattice too: the first look at a pixel

/// The k-th place in a pixel, (0, 0) to (1, 1). Any lattice is coarse in some directions, where one
/// that is the same in all pixels would move an edge by up to 0.06 px. So it is shifted, round the
/// pixel, by the fractions of a sequence that fills the square evenly.
Eigen::Array2d place_in(int column, int row, int k) {
    constexpr double kA = 0.7548776662466927,
                     kB = 0.5698402909980532;  // g^-1 and g^-2, g^3 = g + 1
    const Eigen::Array2d shift(kA * column + kB * row, kB * column + kA * row);
    const Eigen::Array2d place =
        shift + Eigen::Array2d(k + 0.5, k * kNextRow % kPlaces + 0.5) / kPlaces;
    return place - place.floor();
}

/// What was seen in one pixel.
class Tally {
   public:
    void add(const Sample& sample) {
        if (count_ == 0) first_ = sample;
        edge_ = edge_ || sample.surface != first_.surface || sample.lit != first_.lit;
        low_ = low_.cwiseMin(sample.radiance);
        high_ = high_.cwiseMax(sample.radiance);
        sum_ += sample.radiance;
        ++count_;
    }
    /// Whether an edge of a surface or of a shadow was met.
    bool edge() const { return edge_; }
    float contrast() const { return (high_ - low_).maxCoeff(); }
    Eigen::Vector3f mean() const { return sum_ / static_cast<float>(count_); }

   private:
    Sample first_;
    bool edge_ = false;
    Eigen::Vector3f low_ = Eigen::Vector3f::Constant(std::numeric_limits<float>::max());
    Eigen::Vector3f high_ = Eigen::Vector3f::Constant(std::numeric_limits<float>::lowest());
    Eigen::Vector3f sum_ = Eigen::Vector3f::Zero();
    int count_ = 0;
};

/// Radiance averaged over the pixels' areas.
///
/// First one sample at each corner of the pixels. A straight edge that crosses a pixel parts its
/// corners, so that a pixel whose corners are alike, as are its neighbours', is done. All others
/// get eight samples inside, and those in which there is something to see get all 64.
class Picture {
   public:
    Picture(const PixelRays& rays, const Shading& shading, const Run& run)
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

    Eigen::Vector3f pixel(int column, int row) const {
        if (!rays_.exists(column, row)) return Eigen::Vector3f::Zero();
        Tally all = at_corners(column, row);
        if (detail_.at<unsigned char>(row, column) == kSmooth) return all.mean();
        Tally inside;
        for (int k = 0; k < kPlaces; k += kStride) {
            const Sample sample = look(column, row, k);
            all.add(sample);
            inside.add(sample);
        }
        const float enough = all.edge() ? kVisible : kStrong;
        if (all.contrast() <= enough * shading_.white()) return inside.mean();
        for (int k = 0; k < kPlaces; ++k)
            if (k % kStride != 0) inside.add(look(column, row, k));
        return inside.mean();
    }

   private:
    /// What a pixel or one next to it has. Dilation keeps the largest.
    enum Detail : unsigned char { kSmooth, kPattern, kEdge };

    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * stride_ + static_cast<std::size_t>(column);
    }
    Tally at_corners(int column, int row) const {
        Tally tally;
        for (int k = 0; k < 4; ++k) tally.add(corners_[index(column + k % 2, row + k / 2)]);
        return tally;
    }
    Sample look(int column, int row, int k) const {
        const Eigen::Array2d place = place_in(column, row, k);
        const Eigen::Vector3d direction = rays_.inside(column, row, place.x(), place.y());
        return detail_.at<unsigned char>(row, column) == kEdge
                   ? shading_.seen(direction)
                   : shading_.seen(direction, corners_[index(column, row)]);
    }

    const PixelRays& rays_;
    const Shading& shading_;
    std::size_t stride_;
    std::vector<Sample> corners_;
    cv::Mat detail_;
};

/// The fourth power of the cosine of the angle off the axis.
double cosine4(const Eigen::Vector3d& direction) {
    const double square = direction.z() * direction.z() / direction.squaredNorm();
    return square * square;
}

/// Light lost towards the rim: as with the fourth power of the cosine, and stretched so that the
/// image's farthest pixel loses the given share.
class Vignetting {
   public:
    Vignetting(const PixelRays& rays, int margin, double loss) : rays_(rays) {
        double least = 1.0;
        for (int row = margin; row < rays.rows() - margin; ++row)
            for (int column = margin; column < rays.columns() - margin; ++column)
                if (rays.exists(column, row))
                    least = std::min(least, cosine4(rays.inside(column, row, 0.5, 0.5)));
        if (least < 1.0) scale_ = loss / (1.0 - least);
    }
    float left(int column, int row) const {
        if (!rays_.exists(column, row)) return 0.0F;
        const double off = 1.0 - cosine4(rays_.inside(column, row, 0.5, 0.5));
        return static_cast<float>(std::max(0.0, 1.0 - scale_ * off));
    }

   private:
    const PixelRays& rays_;
    double scale_ = 0.0;
};

}  // namespace

cv::Mat render(const World& world, const Light& light, const CameraDevice& camera,
               const Eigen::Isometry3d& T_world_camera, const Run& run) {
    // Rendered beyond the rim as far as the blur reaches, which therefore needs no rule there.
    const int reach = camera.blur_px > 0.0 ? static_cast<int>(std::ceil(4.0 * camera.blur_px)) : 0;
    const PixelRays rays(CameraModel(camera.intrinsics), reach, run);
    const Shading shading(world, light, T_world_camera);
    const Picture picture(rays, shading, run);
    const Vignetting vignetting(rays, reach, camera.vignetting);

    cv::Mat image(rays.rows(), rays.columns(), CV_32FC3);
    for_rows(run, rays.rows(), [&](int row) {
        auto* const pixels = image.ptr<cv::Vec3f>(row);
        for (int column = 0; column < rays.columns(); ++column) {
            const Eigen::Vector3f value = vignetting.left(column, row) * picture.pixel(column, row);
            pixels[column] = {value.x(), value.y(), value.z()};
        }
    });
    if (reach == 0) return image;
    cv::Mat blurred;
    cv::GaussianBlur(image, blurred, cv::Size(2 * reach + 1, 2 * reach + 1), camera.blur_px);
    return blurred(cv::Rect(reach, reach, image.cols - 2 * reach, image.rows - 2 * reach)).clone();
}

}  // namespace petal::simulation
