// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/matcher_scenes.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "petal/error.hpp"
#include "solvers/detail/corner_covariance.hpp"
#include "solvers/detail/solve_input.hpp"

namespace petal {
namespace {

std::string scene_text(const FrameInfo& frame) {
    return frame.name.empty() ? "scene " + std::to_string(frame.number)
                              : "scene '" + frame.name + "'";
}

void check(const Eigen::MatrixXd& covariance, const std::string& whose) {
    if (const auto fault = covariance_fault(covariance); !fault.empty())
        throw Error(whose + " " + fault +
                    "; repair its detector, or leave it out where it is unknown");
}

void check(const LidarBoards& lidar, const FrameInfo& frame) {
    for (std::size_t i = 0; i < lidar.boards.size(); ++i) {
        const LidarBoard& board = lidar.boards[i];
        const std::string who =
            scene_text(frame) + ": LiDAR board " + std::to_string(i) + " ('" + board.target + "')";
        bool good = board.corners.size() >= 4 && board.T_lidar_board.matrix().allFinite();
        for (const auto& corner : board.corners) good = good && corner.allFinite();
        if (!good)
            throw Error(who + " has fewer than four corners, or NaN in them; repair its detector");
        if (board.covariance) check(*board.covariance, who + ": the covariance of its pose");
    }
}

void check(const ImageBoards& image, const FrameInfo& frame) {
    for (std::size_t i = 0; i < image.boards.size(); ++i) {
        const ImageBoard& board = image.boards[i];
        const auto numbers = 2 * static_cast<Eigen::Index>(board.corners.size());
        bool good =
            board.corners.size() >= 4 &&
            (board.covariance.empty() || board.covariance.size() == board.corners.size()) &&
            (board.joint_covariance.size() == 0 || (board.joint_covariance.rows() == numbers &&
                                                    board.joint_covariance.cols() == numbers));
        for (const auto& corner : board.corners) good = good && corner.allFinite();
        const std::string who = scene_text(frame) + ": image board " + std::to_string(i);
        if (!good)
            throw Error(who + " of camera '" + board.camera +
                        "' has fewer than four corners, NaN in them, or a covariance for only "
                        "some; repair its detector");
        check(board.joint_covariance, who + ": the covariance of its corners");
        for (std::size_t c = 0; c < board.covariance.size(); ++c)
            check(board.covariance[c], who + ": the covariance of corner " + std::to_string(c));
        if (std::none_of(image.cameras.begin(), image.cameras.end(),
                         [&](const CameraInfo& camera) { return camera.label == board.camera; }))
            throw Error(who + " names camera '" + board.camera +
                        "', which is not among the cameras; its detector must list it");
    }
}

}  // namespace

std::vector<MatcherCamera> matcher_cameras(const std::vector<Packet<LidarBoards>>& lidar,
                                           const std::vector<Packet<ImageBoards>>& image) {
    std::map<std::uint64_t, const LidarBoards*> by_frame;
    std::string label;  // of scenes where the LiDAR's packet is missing or tells none
    for (const auto& packet : lidar) {
        check(*packet, packet.frame);
        if (!by_frame.emplace(packet.frame.number, packet.value.get()).second)
            throw Error(scene_text(packet.frame) +
                        " has LiDAR boards from two wires; wire one LiDAR's detector to 'lidar'");
        if (label.empty()) label = packet->lidar;
    }
    std::vector<Packet<ImageBoards>> scenes = image;
    std::stable_sort(scenes.begin(), scenes.end(),
                     [](const auto& a, const auto& b) { return a.frame.number < b.frame.number; });
    std::vector<MatcherCamera> cameras;
    const FrameInfo* last = nullptr;
    for (const auto& packet : scenes) {
        check(*packet, packet.frame);
        if (last != nullptr && last->number == packet.frame.number)
            throw Error(scene_text(packet.frame) +
                        " has image boards from two wires; wire one detector, which tells all "
                        "cameras, to 'image'");
        last = &packet.frame;
        const auto at = by_frame.find(packet.frame.number);
        const LidarBoards* seen = at == by_frame.end() ? nullptr : at->second;
        for (const CameraInfo& info : packet->cameras) {
            const std::string& by = seen == nullptr || seen->lidar.empty() ? label : seen->lidar;
            auto camera =
                std::find_if(cameras.begin(), cameras.end(), [&](const MatcherCamera& other) {
                    return other.camera == info.label && other.lidar == by;
                });
            if (camera == cameras.end()) {
                cameras.push_back({info.label, by, info.camera, {}});
                camera = cameras.end() - 1;
            } else if (!same_projection(camera->model, info.camera)) {
                throw Error("camera '" + info.label + "' has other intrinsics in " +
                            scene_text(packet.frame) +
                            " than before; give every scene of a camera the same intrinsics, or "
                            "match the scenes apart");
            }
            MatcherScene scene;
            scene.number = packet.frame.number;
            scene.name = packet.frame.name;
            scene.lidar = seen;
            scene.images = packet.value.get();
            for (std::size_t i = 0; i < packet->boards.size(); ++i)
                if (packet->boards[i].camera == info.label)
                    scene.image.push_back(static_cast<int>(i));
            camera->scenes.push_back(std::move(scene));
        }
    }
    return cameras;
}

}  // namespace petal
