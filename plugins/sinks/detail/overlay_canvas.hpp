// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/images.hpp"

namespace petal {

/// A photo or a part of it, magnified, on which things given in raw pixels or in the LiDAR frame
/// are drawn.
class OverlayCanvas {
   public:
    /// `line_width`, px of the picture, for one that will be shrunk: marks grow with it. `part`,
    /// raw pixels, lies in the photo; the whole photo where it is empty.
    OverlayCanvas(const CameraImage& image, int magnification, int line_width = 1,
                  const cv::Rect& part = {});

    /// Points coloured by distance from the camera, those behind it left out.
    /// `dot`: their diameter, as a share of a magnified pixel.
    void draw_cloud(const Cloud& cloud, const Eigen::Isometry3d& T_camera_lidar,
                    std::size_t max_points, double dot = 1.0);
    void draw_detected(const std::vector<Eigen::Vector2d>& corners);
    void draw_projected(const std::vector<Eigen::Vector3d>& corners,
                        const Eigen::Isometry3d& T_camera_lidar);
    /// From each measured corner along measured less projected, `scale` times as long.
    void draw_residuals(const std::vector<PointPair>& pairs,
                        const Eigen::Isometry3d& T_camera_lidar, double scale);
    void draw_caption(const std::string& text);

    const cv::Mat& picture() const { return picture_; }

   private:
    cv::Point at(const Eigen::Vector2d& pixel) const;

    CameraModel model_;
    int magnification_;
    int line_width_;
    cv::Point begin_;  ///< the part's upper left pixel
    cv::Mat picture_;  ///< BGR
};

}  // namespace petal
