// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/report_view.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/cloud_subset.hpp"
#include "petal/html/escape.hpp"
#include "sinks/detail/point_colours.hpp"

namespace petal {

namespace {

using ViewJson = nlohmann::ordered_json;

/// How many points each cloud may show: an equal share, where it has so many; what small clouds
/// leave goes to the others.
std::map<std::uint64_t, std::size_t> shares(const std::map<std::uint64_t, SceneView>& scenes,
                                            std::size_t max_points) {
    std::vector<std::pair<std::size_t, std::uint64_t>> sizes;
    for (const auto& [number, scene] : scenes)
        if (scene.cloud) sizes.emplace_back(scene.cloud->size(), number);
    std::sort(sizes.begin(), sizes.end());
    std::map<std::uint64_t, std::size_t> told;
    std::size_t left = max_points;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const std::size_t share = std::min(sizes[i].first, left / (sizes.size() - i));
        told[sizes[i].second] = share;
        left -= share;
    }
    return told;
}

/// So many of `size` indices, ascending, each set of them equally likely (Floyd's algorithm: one
/// lot for each index drawn, not for each there is). Not every k-th: a scanner's lines would beat
/// with that.
std::vector<std::size_t> drawn_indices(Rng& rng, std::size_t size, std::size_t count) {
    std::vector<bool> taken(size);
    for (std::size_t last = size - count; last < size; ++last) {
        const auto lot = static_cast<std::size_t>(rng() % (last + 1));
        taken[taken[lot] ? last : lot] = true;
    }
    std::vector<std::size_t> drawn;
    drawn.reserve(count);
    for (std::size_t i = 0; i < size; ++i)
        if (taken[i]) drawn.push_back(i);
    return drawn;
}

/// A grey for each point that no camera sees, by intensity.
class Greys {
   public:
    Greys(const Cloud& cloud, const std::vector<std::size_t>& points)
        : intensities_(cloud.points->getPointsBufferRef_intensity()) {
        std::vector<float> known;
        for (const std::size_t i : points)
            if (i < intensities_.size() && std::isfinite(intensities_[i]))
                known.push_back(intensities_[i]);
        if (known.empty()) return;
        const auto bright = known.begin() + static_cast<std::ptrdiff_t>(known.size() * 9 / 10);
        std::nth_element(known.begin(), bright, known.end());
        bright_ = *bright;
    }
    PointColour of(std::size_t point) const {
        constexpr float kDark = 45.0F;
        constexpr float kSpan = 75.0F;
        const bool known =
            bright_ > 0.0F && point < intensities_.size() && std::isfinite(intensities_[point]);
        const float share = known ? std::clamp(intensities_[point] / bright_, 0.0F, 1.0F) : 0.5F;
        const auto grey = static_cast<std::uint8_t>(kDark + kSpan * share);
        return {grey, grey, grey};
    }

   private:
    const mrpt::aligned_std_vector<float>& intensities_;
    float bright_ = 0.0F;
};

struct ShownPoint {
    Eigen::Vector3d at;
    PointColour colour;
};

/// The points as the page reads them; rounded to 16 bit of their own bounding box.
void add_points(ViewJson& scene, const std::vector<ShownPoint>& points) {
    Eigen::AlignedBox3d box;
    for (const ShownPoint& point : points) box.extend(point.at);
    constexpr double kSteps = 65535.0;
    const Eigen::Vector3d low =
        points.empty() ? Eigen::Vector3d::Zero() : Eigen::Vector3d(box.min());
    const Eigen::Vector3d step =
        points.empty() ? Eigen::Vector3d::Zero() : Eigen::Vector3d(box.sizes() / kSteps);
    std::vector<unsigned char> places;
    std::vector<unsigned char> colours;
    places.reserve(6 * points.size());
    colours.reserve(3 * points.size());
    for (const ShownPoint& point : points) {
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            const double steps =
                step[axis] > 0.0 ? std::round((point.at[axis] - low[axis]) / step[axis]) : 0.0;
            const auto place = static_cast<std::uint16_t>(std::clamp(steps, 0.0, kSteps));
            places.push_back(static_cast<unsigned char>(place & 0xFFU));
            places.push_back(static_cast<unsigned char>(place >> 8U));
        }
        colours.insert(colours.end(), {point.colour.red, point.colour.green, point.colour.blue});
    }
    scene["low"] = {low.x(), low.y(), low.z()};
    scene["step"] = {step.x(), step.y(), step.z()};
    scene["points"] = html::base64(places);
    scene["colours"] = html::base64(colours);
}

ViewJson scene_view_json(const Run& run, const Extrinsics& extrinsics, const SceneView& scene,
                         const std::vector<std::size_t>& drawn) {
    const Cloud& cloud = *scene.cloud;
    std::vector<PointColours> cameras;
    if (scene.images)
        for (const CameraImage& image : scene.images->cameras)
            if (const CameraExtrinsics* solved = extrinsics_of(extrinsics, image.label))
                cameras.emplace_back(run, cloud, drawn, image, solved->T_camera_lidar);
    const Greys greys(cloud, drawn);
    std::vector<ShownPoint> points;  // seen ones in front
    std::vector<ShownPoint> unseen;
    points.reserve(drawn.size());
    for (std::size_t k = 0; k < drawn.size(); ++k) {
        const std::size_t i = drawn[k];
        if (!is_finite(cloud, i)) continue;
        std::optional<PointColour> colour;
        for (const PointColours& camera : cameras)
            if (!colour) colour = camera.of(k);
        float x = 0.0F, y = 0.0F, z = 0.0F;
        cloud.points->getPoint(i, x, y, z);
        if (colour)
            points.push_back({{x, y, z}, *colour});
        else
            unseen.push_back({{x, y, z}, greys.of(i)});
    }
    const std::size_t seen = points.size();
    points.insert(points.end(), unseen.begin(), unseen.end());
    ViewJson told;
    told["shown"] = points.size();
    told["of"] = cloud.size();
    told["seen"] = seen;
    add_points(told, points);
    return told;
}

/// Where the photo's corners look: (x, y, 1) in the camera frame. Nothing where one has no ray.
ViewJson photo_rays(const CameraExtrinsics& camera) {
    ViewJson rays = ViewJson::array();
    const CameraModel model(camera.model);
    const double right = static_cast<double>(camera.model.ncols) - 0.5;
    const double bottom = static_cast<double>(camera.model.nrows) - 0.5;
    for (const Eigen::Vector2d& corner :
         {Eigen::Vector2d(-0.5, -0.5), Eigen::Vector2d(right, -0.5), Eigen::Vector2d(right, bottom),
          Eigen::Vector2d(-0.5, bottom)})
        if (const auto ray = model.unproject(corner))
            rays.push_back({ray->x(), ray->y(), ray->z()});
    return rays.size() == 4 ? rays : ViewJson::array();
}

}  // namespace

ViewPoints view_points(Rng& rng, const std::map<std::uint64_t, SceneView>& scenes,
                       std::size_t max_points) {
    ViewPoints drawn;
    for (const auto& [number, share] : shares(scenes, max_points))
        drawn[number] = drawn_indices(rng, scenes.at(number).cloud->size(), share);
    return drawn;
}

nlohmann::ordered_json report_view(const Run& run, const Extrinsics& extrinsics,
                                   const std::map<std::uint64_t, SceneView>& scenes,
                                   const ScenePlaces& places, const ViewPoints& points) {
    ViewJson list = ViewJson::array();
    std::size_t shown = 0;
    std::size_t all = 0;
    for (const auto& [number, scene] : scenes) {
        run.check_cancelled();
        if (!scene.cloud) continue;
        ViewJson told = scene_view_json(run, extrinsics, scene, points.at(number));
        shown += told["shown"].get<std::size_t>();
        all += scene.cloud->size();
        told["name"] = scene.name;
        const auto place = places.find(number);
        told["place"] = place == places.end() ? ViewJson() : ViewJson(place->second);
        list.push_back(std::move(told));
    }
    ViewJson cameras = ViewJson::array();
    for (const CameraExtrinsics& camera : extrinsics.cameras) cameras.push_back(photo_rays(camera));
    return {{"shown", shown},
            {"of", all},
            {"scenes", std::move(list)},
            {"photo_rays", std::move(cameras)}};
}

}  // namespace petal
