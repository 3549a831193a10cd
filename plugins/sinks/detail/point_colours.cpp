// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/point_colours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/for_pieces.hpp"

namespace petal {

namespace {

constexpr int kSmallestCell = 4;   // px
constexpr int kLargestCell = 32;   // px
constexpr double kFullCell = 4.0;  // points: then hardly a cell of a surface stays empty by chance

}  // namespace

PointColours::PointColours(const Run& run, const Cloud& cloud, const CameraImage& image,
                           const Eigen::Isometry3d& T_camera_lidar, const Occlusion& occlusion)
    : photo_(image.image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY)), occlusion_(occlusion) {
    const auto itself = [](std::size_t i) { return i; };
    project(run, cloud, cloud.size(), itself, image.camera, T_camera_lidar);
}

PointColours::PointColours(const Run& run, const Cloud& cloud,
                           const std::vector<std::size_t>& points, const CameraImage& image,
                           const Eigen::Isometry3d& T_camera_lidar, const Occlusion& occlusion)
    : photo_(image.image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY)), occlusion_(occlusion) {
    const auto chosen = [&points](std::size_t k) { return points[k]; };
    project(run, cloud, points.size(), chosen, image.camera, T_camera_lidar);
}

template <class IndexOf>
void PointColours::project(const Run& run, const Cloud& cloud, std::size_t count,
                           const IndexOf& index_of, const mrpt::img::TCamera& camera,
                           const Eigen::Isometry3d& T_camera_lidar) {
    const CameraModel model(camera);
    const auto& xs = cloud.points->getPointsBufferRef_x();
    const auto& ys = cloud.points->getPointsBufferRef_y();
    const auto& zs = cloud.points->getPointsBufferRef_z();
    seen_.resize(count);
    constexpr std::size_t kPiece = 16384;
    for_pieces(run, count, kPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t i = index_of(k);
            const Eigen::Vector3d p = T_camera_lidar * Eigen::Vector3d(xs[i], ys[i], zs[i]);
            if (!p.allFinite()) continue;
            const auto pixel = model.project(p);
            if (!pixel) continue;
            const double column = std::round(pixel->x());
            const double row = std::round(pixel->y());
            // Written so that NaN is outside too.
            if (!(column >= 0.0 && row >= 0.0 && column < photo_.cols && row < photo_.rows))
                continue;
            seen_[k].pixel =
                static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(photo_.cols) +
                static_cast<std::uint32_t>(column);
            seen_[k].depth = static_cast<float>(p.z());
        }
    });
    if (occlusion_.cell_px > 0) {
        fill_grid(occlusion_.cell_px);
        return;
    }
    int cell = kSmallestCell;
    while (fill_grid(cell) < kFullCell && cell < kLargestCell) cell *= 2;
}

double PointColours::fill_grid(int cell_px) {
    cell_px_ = cell_px;
    const auto cells = [cell_px](int pixels) {
        return static_cast<std::size_t>((pixels + cell_px - 1) / cell_px);
    };
    columns_ = cells(photo_.cols);
    nearest_.assign(columns_ * cells(photo_.rows), std::numeric_limits<float>::infinity());
    std::size_t inside = 0;
    for (const Seen& seen : seen_) {
        if (seen.pixel == kOutside) continue;
        ++inside;
        float& nearest = nearest_[cell_of(seen.pixel)];
        nearest = std::min(nearest, seen.depth);
    }
    const auto occupied = std::count_if(nearest_.begin(), nearest_.end(),
                                        [](float depth) { return std::isfinite(depth); });
    return occupied == 0 ? 0.0 : static_cast<double>(inside) / static_cast<double>(occupied);
}

std::size_t PointColours::cell_of(std::uint32_t pixel) const {
    const auto width = static_cast<std::uint32_t>(photo_.cols);
    const auto cell = static_cast<std::uint32_t>(cell_px_);
    return static_cast<std::size_t>(pixel / width / cell) * columns_ + pixel % width / cell;
}

bool PointColours::hidden(std::size_t point) const {
    const Seen& seen = seen_[point];
    if (seen.pixel == kOutside) return false;
    const double slack = std::max(occlusion_.slack, occlusion_.slack_share * seen.depth);
    return seen.depth > nearest_[cell_of(seen.pixel)] + slack;
}

std::optional<PointColour> PointColours::of(std::size_t point) const {
    const Seen& seen = seen_[point];
    if (seen.pixel == kOutside || hidden(point)) return {};
    const int row = static_cast<int>(seen.pixel) / photo_.cols;
    const int column = static_cast<int>(seen.pixel) % photo_.cols;
    if (photo_.channels() == 1) {
        const std::uint8_t grey = photo_.at<std::uint8_t>(row, column);
        return PointColour{grey, grey, grey};
    }
    const auto& bgr = photo_.at<cv::Vec3b>(row, column);
    return PointColour{bgr[2], bgr[1], bgr[0]};
}

std::optional<PointColours::Place> PointColours::place_of(std::size_t point) const {
    const Seen& seen = seen_[point];
    if (seen.pixel == kOutside) return {};
    const auto width = static_cast<std::uint32_t>(photo_.cols);
    return Place{seen.pixel % width, seen.pixel / width, seen.depth};
}

}  // namespace petal
