// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <string>

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct FilesParams {
    std::filesystem::path image = "${data}/image.jpg";
    std::filesystem::path intrinsics = "${data}/intrinsics.yaml";
    std::filesystem::path cloud;
    std::string distortion_model = "auto";
    std::string camera = "CAMERA";
    std::string lidar = "LIDAR";
};

/// One scene from plain files: an image with its intrinsics, a cloud, or both.
class FilesSource final : public Stage {
   public:
    using Params = FilesParams;
    static void describe(Spec<Params>& spec);
    explicit FilesSource(Params params) : params_(std::move(params)) {}
    void run(Run& run) override;

   private:
    void write_cloud(Run& run, std::size_t& points) const;
    void write_images(Run& run) const;

    Params params_;
    bool done_ = false;
};

}  // namespace petal
