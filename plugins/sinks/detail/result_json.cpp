// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/result_json.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "petal/calibration/angles.hpp"
#include "petal/printed.hpp"
#include "sinks/detail/diagnosis_json.hpp"
#include "sinks/detail/residuals_json.hpp"

namespace petal {

using Json = nlohmann::ordered_json;

namespace {

template <class Derived>
Json matrix_json(const Eigen::MatrixBase<Derived>& matrix) {
    Json rows = Json::array();
    for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
        Json row = Json::array();
        for (Eigen::Index c = 0; c < matrix.cols(); ++c) row.push_back(matrix(r, c));
        rows.push_back(std::move(row));
    }
    return rows;
}

template <class Vector>
Json vector_json(const Vector& vector) {
    Json list = Json::array();
    for (Eigen::Index i = 0; i < vector.size(); ++i) list.push_back(vector(i));
    return list;
}

template <class Points>
Json points_json(const Points& points) {
    Json list = Json::array();
    for (const auto& point : points) list.push_back(vector_json(point));
    return list;
}

Json extrinsics_json(const CameraExtrinsics& camera) {
    const Eigen::Vector3d rotation_deg = camera.sigma_rotation * kDegrees;
    Json entry{{"camera", camera.camera},
               {"lidar", camera.lidar},
               {"T_camera_lidar", matrix_json(camera.T_camera_lidar.matrix())},
               {"T_lidar_camera", matrix_json(camera.T_camera_lidar.inverse().matrix())},
               {"covariance", matrix_json(camera.covariance)},
               {"sigma_translation_m", vector_json(camera.sigma_translation)},
               {"sigma_rotation_deg", vector_json(rotation_deg)},
               {"weakest_direction", camera.weakest_direction},
               {"sentence", placement_sentence(camera.T_camera_lidar)}};
    add_diagnosis(entry, camera);
    return entry;
}

/// Names of the scenes, by frame number, from whatever was gathered.
std::map<std::uint64_t, std::string> scene_names(const ResultInput& input) {
    std::map<std::uint64_t, std::string> names;
    const auto add = [&names](const auto& packets) {
        for (const auto& packet : packets) {
            std::string& name = names[packet.frame.number];
            if (name.empty()) name = packet.frame.name;
        }
    };
    for (const auto& packet : input.correspondences)
        for (const CameraPairs& camera : packet->cameras) {
            std::string& name = names[camera.scene];
            if (name.empty()) name = camera.scene_name;
        }
    add(input.lidar_boards);
    add(input.image_boards);
    for (auto& [number, name] : names)
        if (name.empty()) name = "scene " + std::to_string(number);
    return names;
}

/// That of the camera whose order is least certain; data and given are equally good.
Json orientation_json(const ResultInput& input) {
    std::optional<OrderDecision> least_certain;
    const auto consider = [&least_certain](const OrderDecision& order) {
        if (!least_certain || order.by > least_certain->by) least_certain = order;
    };
    for (const CameraExtrinsics& camera : input.extrinsics->cameras) consider(camera.order);
    if (!least_certain)  // nothing was solved: what the matcher said
        for (const auto& packet : input.correspondences)
            for (const CameraPairs& camera : packet->cameras) consider(camera.order);
    const OrderDecision worst = least_certain.value_or(OrderDecision{});
    return Json{{"decided_by", to_string(worst.by)},
                {"runner_up_rms_ratio", worst.runner_up_rms_ratio},
                {"runner_up_chi2", worst.runner_up_chi2}};
}

Json board_json(const std::string& target, const Json& camera, Json lidar, Json image) {
    return Json{{"target", target},
                {"camera", camera},
                {"corners_lidar", std::move(lidar)},
                {"corners_image", std::move(image)}};
}

/// The boards of one scene: the matched ones in the order of the pairs, then those of one sensor
/// alone.
struct SceneBoards {
    std::vector<const CameraPairs*> pairs;
    const LidarBoards* lidar = nullptr;
    const ImageBoards* image = nullptr;

    Json json() const {
        Json boards = Json::array();
        std::set<int> lidar_used;
        std::set<int> image_used;
        for (const CameraPairs* camera : pairs)
            for (const int b : boards_of(*camera)) {
                if (static_cast<std::size_t>(b) < camera->boards.size()) {
                    lidar_used.insert(camera->boards[static_cast<std::size_t>(b)].lidar);
                    image_used.insert(camera->boards[static_cast<std::size_t>(b)].image);
                }
                boards.push_back(matched(*camera, b));
            }
        if (lidar != nullptr)
            for (std::size_t i = 0; i < lidar->boards.size(); ++i)
                if (lidar_used.count(static_cast<int>(i)) == 0)
                    boards.push_back(board_json(lidar->boards[i].target, nullptr,
                                                points_json(lidar->boards[i].corners), nullptr));
        if (image != nullptr)
            for (std::size_t i = 0; i < image->boards.size(); ++i)
                if (image_used.count(static_cast<int>(i)) == 0)
                    boards.push_back(board_json(image->boards[i].target, image->boards[i].camera,
                                                nullptr, points_json(image->boards[i].corners)));
        return boards;
    }

   private:
    /// The boards that the pairs name; given pairs have them without a detector's board behind
    /// each.
    static std::set<int> boards_of(const CameraPairs& camera) {
        std::set<int> boards;
        for (const PointPair& pair : camera.pairs)
            if (pair.board >= 0) boards.insert(pair.board);
        return boards;
    }
    Json matched(const CameraPairs& camera, int board) const {
        std::map<int, const PointPair*> by_corner;
        for (const PointPair& pair : camera.pairs)
            if (pair.board == board) by_corner[pair.corner] = &pair;
        std::vector<Eigen::Vector3d> in_lidar;
        std::vector<Eigen::Vector2d> in_image;
        for (const auto& [corner, pair] : by_corner) {
            in_lidar.push_back(pair->lidar);
            in_image.push_back(pair->image);
        }
        return board_json(target_of(camera, static_cast<std::size_t>(board)), camera.camera,
                          points_json(in_lidar), points_json(in_image));
    }
    std::string target_of(const CameraPairs& camera, std::size_t board) const {
        if (board >= camera.boards.size()) return {};
        const CameraPairs::BoardPair& pair = camera.boards[board];
        if (image != nullptr && pair.image >= 0 &&
            static_cast<std::size_t>(pair.image) < image->boards.size())
            return image->boards[static_cast<std::size_t>(pair.image)].target;
        if (lidar != nullptr && pair.lidar >= 0 &&
            static_cast<std::size_t>(pair.lidar) < lidar->boards.size())
            return lidar->boards[static_cast<std::size_t>(pair.lidar)].target;
        return {};
    }
};

Json scenes_json(const ResultInput& input, const std::map<std::uint64_t, std::string>& names) {
    std::map<std::uint64_t, SceneBoards> scenes;
    for (const auto& packet : input.correspondences)
        for (const CameraPairs& camera : packet->cameras)
            scenes[camera.scene].pairs.push_back(&camera);
    for (const auto& packet : input.lidar_boards)
        scenes[packet.frame.number].lidar = packet.value.get();
    for (const auto& packet : input.image_boards)
        scenes[packet.frame.number].image = packet.value.get();
    Json list = Json::array();
    for (const auto& [number, boards] : scenes)
        list.push_back({{"name", names.at(number)}, {"boards", boards.json()}});
    return list;
}

/// Totals under "metrics", as the contract has it; those of single scenes beside.
void add_metrics(Json& root, const ResultInput& input) {
    Json totals = Json::object();
    Json per_scene = Json::object();
    for (const auto& packet : input.metrics)
        for (const Metric& metric : packet->values) {
            if (metric.scene.empty()) {
                totals[metric.name] = metric.value;
            } else {
                per_scene[metric.scene][metric.name] = metric.value;
            }
        }
    root["metrics"] = std::move(totals);
    root["metrics_per_scene"] = std::move(per_scene);
}

/// "4.6 cm left of", or nothing below half a millimetre.
std::string offset_text(double metres, const char* positive, const char* negative) {
    if (std::abs(metres) < 0.0005) return {};
    return printed("%.1f cm %s", std::abs(metres) * 100.0, metres > 0.0 ? positive : negative);
}

}  // namespace

std::string placement_sentence(const Eigen::Isometry3d& T_camera_lidar) {
    const Eigen::Vector3d at = T_camera_lidar.translation();
    std::vector<std::string> parts;
    for (std::string part :
         {offset_text(at.x(), "right of", "left of"), offset_text(at.y(), "below", "above"),
          offset_text(at.z(), "in front of", "behind")})
        if (!part.empty()) parts.push_back(std::move(part));
    if (parts.empty()) return "the LiDAR sits at the camera's centre";
    std::string text = "the LiDAR sits ";
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (i > 0) text += i + 1 == parts.size() ? " and " : ", ";
        text += parts[i];
    }
    return text + " the camera";
}

std::string result_json(const ResultInput& input) {
    const auto names = scene_names(input);
    const Extrinsics& extrinsics = *input.extrinsics;
    Json cameras = Json::array();
    for (const CameraExtrinsics& camera : extrinsics.cameras)
        cameras.push_back(extrinsics_json(camera));
    Json root{
        {"verdict", to_string(extrinsics.level)}, {"reasons", extrinsics.reasons},
        {"extrinsics", std::move(cameras)},       {"residuals", residuals_json(extrinsics, names)},
        {"orientation", orientation_json(input)}, {"scenes", scenes_json(input, names)}};
    add_metrics(root, input);
    return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace petal
