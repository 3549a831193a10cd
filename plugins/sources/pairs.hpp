// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "petal/calibration/correspondences.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct PairsParams {
    std::filesystem::path pairs = "${data}/pairs.csv";
    std::filesystem::path lidar_points;
    std::filesystem::path image_points;
    std::filesystem::path intrinsics = "${data}/intrinsics.yaml";
    std::vector<int> image_size;
    std::string distortion_model = "auto";
    std::string camera = "CAMERA";
    std::string lidar = "LIDAR";
    int first = 0;
    int count = 0;
    int leading_points = 0;
    int corners_per_board = 0;
    std::string corner_order = "rows";
};

/// Given pairs of LiDAR and image points, with the camera's intrinsics.
class PairsSource final : public Stage {
   public:
    using Params = PairsParams;
    static void describe(Spec<Params>& spec);
    explicit PairsSource(Params params) : params_(std::move(params)) {}
    void run(Run& run) override;

   private:
    std::vector<PointPair> read_pairs(Run& run) const;
    void mark_boards(std::vector<PointPair>& pairs) const;
    mrpt::img::TCamera read_camera(Run& run) const;

    Params params_;
    bool done_ = false;
};

}  // namespace petal
