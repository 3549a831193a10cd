// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "simulation/camera/camera_simulation.hpp"
#include "simulation/world/random.hpp"

namespace petal::simulation {
namespace {

constexpr double kFullScale = 255.0;

/// Normal numbers of variance 1, both of a pair that Box and Muller's transform gives: an image
/// takes millions.
class NormalPairs {
   public:
    explicit NormalPairs(std::uint64_t seed) : engine_(seed) {}
    double next() {
        spare_used_ = !spare_used_;
        if (spare_used_) return spare_;
        constexpr double kTurn = 6.283185307179586476925;
        const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(engine_, 0.0, 1.0)));
        const double angle = kTurn * uniform(engine_, 0.0, 1.0);
        spare_ = radius * std::sin(angle);
        return radius * std::cos(angle);
    }

   private:
    Engine engine_;
    double spare_ = 0.0;
    bool spare_used_ = true;
};

/// A sensor of linear response.
class Sensor {
   public:
    explicit Sensor(const CameraDevice& camera)
        : gain_(camera.exposure * camera.electrons),
          read_variance_(camera.read_noise * camera.read_noise),
          levels_(kFullScale / camera.electrons) {}

    /// Shot noise is that of a Poisson number; a normal one of the same variance is as good from
    /// ten electrons on, and below them the read noise hides the difference.
    unsigned char level(double radiance, NormalPairs& random) const {
        const double light = std::max(0.0, gain_ * radiance);
        const double read = light + std::sqrt(light + read_variance_) * random.next();
        return static_cast<unsigned char>(
            std::floor(std::clamp(read * levels_, 0.0, kFullScale) + 0.5));
    }

   private:
    double gain_, read_variance_, levels_;
};

}  // namespace

cv::Mat expose(const cv::Mat& radiance, const CameraDevice& camera, std::uint64_t seed) {
    const Sensor sensor(camera);
    cv::Mat image(radiance.size(), camera.colour ? CV_8UC3 : CV_8UC1);
    tbb::parallel_for(0, image.rows, [&](int row) {
        NormalPairs random(mix(seed, static_cast<std::uint64_t>(row)));
        const auto* const light = radiance.ptr<cv::Vec3f>(row);
        auto* to = image.ptr(row);
        for (int column = 0; column < image.cols; ++column) {
            const cv::Vec3f& bgr = light[column];
            if (camera.colour)
                for (int channel = 0; channel < 3; ++channel)
                    *to++ = sensor.level(static_cast<double>(bgr[channel]), random);
            else  // ITU-R BT.601
                *to++ = sensor.level(0.114 * bgr[0] + 0.587 * bgr[1] + 0.299 * bgr[2], random);
        }
    });
    return image;
}

}  // namespace petal::simulation
