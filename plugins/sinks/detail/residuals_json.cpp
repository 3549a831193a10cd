// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/residuals_json.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "petal/html/plots.hpp"

namespace petal {

namespace {

using JsonList = nlohmann::ordered_json;

/// Residuals that are told together, px.
struct ResidualGroup {
    std::vector<double> u, v;
    double sum = 0.0;
    double squares = 0.0;
    double largest = 0.0;

    void add(const Eigen::Vector2d& error) {
        u.push_back(error.x());
        v.push_back(error.y());
        const double length = error.norm();
        sum += length;
        squares += length * length;
        largest = std::max(largest, length);
    }
    double over_count(double total) const {
        return u.empty() ? 0.0 : total / static_cast<double>(u.size());
    }
    double rms() const { return std::sqrt(over_count(squares)); }
    void add_axes(JsonList& told) const {
        told["u_px"] = u.empty() ? JsonList() : JsonList(html::five_numbers(u));
        told["v_px"] = v.empty() ? JsonList() : JsonList(html::five_numbers(v));
    }
};

JsonList group_json(const char* key, const std::string& name, const ResidualGroup& group) {
    JsonList told{{key, name}, {"rms_px", group.rms()}, {"count", group.u.size()}};
    group.add_axes(told);
    return told;
}

}  // namespace

nlohmann::ordered_json residuals_json(const Extrinsics& extrinsics,
                                      const std::map<std::uint64_t, std::string>& names) {
    ResidualGroup total;
    std::map<std::uint64_t, ResidualGroup> scenes;
    JsonList per_camera = JsonList::array();
    for (const CameraExtrinsics& camera : extrinsics.cameras) {
        ResidualGroup its;
        for (const Residual& residual : camera.residuals) {
            total.add(residual.error_px);
            its.add(residual.error_px);
            scenes[residual.scene].add(residual.error_px);
        }
        per_camera.push_back(group_json("camera", camera.camera, its));
    }
    JsonList per_scene = JsonList::array();
    for (const auto& [number, group] : scenes) {
        const auto named = names.find(number);
        per_scene.push_back(group_json(
            "scene", named == names.end() ? "scene " + std::to_string(number) : named->second,
            group));
    }
    JsonList told{{"count", total.u.size()},
                  {"rms_px", total.rms()},
                  {"mean_px", total.over_count(total.sum)},
                  {"max_px", total.largest}};
    total.add_axes(told);
    told["per_camera"] = std::move(per_camera);
    told["per_scene"] = std::move(per_scene);
    return told;
}

}  // namespace petal
