// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/TCamera.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "petal/run.hpp"
#include "simulation/camera/camera_simulation.hpp"
#include "simulation/world/surfaces.hpp"
#include "simulation/world/world.hpp"

namespace petal::testing {

/// A run without a stage: for functions that only ask for threads and for a cancel.
class BareRun final : public Run {
   public:
    explicit BareRun(int threads = 2, bool cancelled = false)
        : threads_(threads), cancelled_(cancelled) {}
    bool wired(std::string_view) const override { return false; }
    const FrameInfo& frame() const override { return frame_; }
    void set_frame(std::string, double) override {}
    void end_of_data() override {}
    Rng& rng() override { return rng_; }
    int threads() const override { return threads_; }
    bool cancelled() const override { return cancelled_; }
    void log(LogLevel, const std::string&) override {}
    void note(const Note&) override {}
    void verdict(Level, const std::vector<std::string>&) override {}
    void progress(double, double, std::string_view) override {}
    void used_file(const std::filesystem::path&) override {}
    bool debug() const override { return false; }
    using Writer = std::function<void(const std::filesystem::path&)>;
    void save(const std::string&, const Writer&) override {}
    void output(const std::string&, const Writer&) override {}
    std::filesystem::path output_path(const std::filesystem::path&) override { return {}; }

   protected:
    const AnyPacket& input(std::string_view) const override { throw Error("no packets here"); }
    const std::vector<AnyPacket>& inputs(std::string_view) const override {
        throw Error("no packets here");
    }
    void publish(std::string_view, AnyPacket) override {}

   private:
    int threads_;
    bool cancelled_;
    Rng rng_;
    FrameInfo frame_;
};

}  // namespace petal::testing

namespace petal::simulation {

/// A camera without distortion, blur, vignetting and noise: tests add what they are about.
inline CameraDevice plain_camera(unsigned width, unsigned height, double focal) {
    CameraDevice camera;
    camera.intrinsics.ncols = width;
    camera.intrinsics.nrows = height;
    camera.intrinsics.setIntrinsicParamsFromValues(focal, focal, 0.5 * (width - 1.0),
                                                   0.5 * (height - 1.0));
    camera.blur_px = 0.0;
    camera.vignetting = 0.0;
    camera.electrons = 1e9;
    camera.read_noise = 0.0;
    return camera;
}

/// Light from everywhere alone: surfaces have the radiance of their albedo.
inline Light even_light() {
    Light light;
    light.lamp = 0.0F;
    light.ambient = 1.0F;
    return light;
}

inline std::shared_ptr<const Texture> grey(float albedo) {
    return std::make_shared<PlainTexture>(Look{Eigen::Vector3f::Constant(albedo), albedo});
}

/// From a surface's frame (x right, y down, z away as a camera sees it) to the camera's: its origin
/// moved to `centre`, then turned about its own y, x and z; degrees.
inline Eigen::Isometry3d facing(const Eigen::Vector3d& centre, double yaw_deg = 0.0,
                                double pitch_deg = 0.0, double roll_deg = 0.0) {
    constexpr double kDegree = 0.017453292519943295;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translate(centre);
    pose.rotate(Eigen::AngleAxisd(yaw_deg * kDegree, Eigen::Vector3d::UnitY()));
    pose.rotate(Eigen::AngleAxisd(pitch_deg * kDegree, Eigen::Vector3d::UnitX()));
    pose.rotate(Eigen::AngleAxisd(roll_deg * kDegree, Eigen::Vector3d::UnitZ()));
    return pose;
}

/// A rectangle about the origin of its frame.
inline PlanarSurface::Polygon centred(double width, double height) {
    const double x = 0.5 * width, y = 0.5 * height;
    return {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
}

inline void add_panel(World& world, const Eigen::Isometry3d& T_world_panel, double width,
                      double height, std::shared_ptr<const Texture> texture,
                      Kind kind = Kind::background) {
    world.add(std::make_unique<PlanarSurface>(T_world_panel,
                                              PlanarSurface::Shape{centred(width, height), {}, {}},
                                              std::move(texture), kind));
}

/// The corners of the four holes of the letter's board, about its centre: 0.5 m wide, holes 0.1 m.
inline std::vector<PlanarSurface::Polygon> four_holes() {
    std::vector<PlanarSurface::Polygon> holes;
    for (const double y : {-0.1, 0.1})
        for (const double x : {-0.1, 0.1}) {
            PlanarSurface::Polygon hole = centred(0.1, 0.1);
            for (Eigen::Vector2d& corner : hole) corner += Eigen::Vector2d(x, y);
            holes.push_back(hole);
        }
    return holes;
}

inline void add_board(World& world, const Eigen::Isometry3d& T_world_board,
                      std::shared_ptr<const Texture> texture) {
    world.add(std::make_unique<PlanarSurface>(
        T_world_board, PlanarSurface::Shape{centred(0.5, 0.5), four_holes(), {}},
        std::move(texture), Kind::board));
}

}  // namespace petal::simulation
