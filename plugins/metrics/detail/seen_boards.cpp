// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/seen_boards.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "petal/calibration/estimated_focal.hpp"

namespace petal {
namespace {

const CameraExtrinsics* pose_for(const std::vector<Packet<Extrinsics>>& packets,
                                 const CameraPairs& seen) {
    for (const auto& packet : packets)
        for (const CameraExtrinsics& camera : packet->cameras)
            if (camera.camera == seen.camera && camera.lidar == seen.lidar) return &camera;
    return nullptr;
}

mrpt::img::TCamera model_for(const CameraExtrinsics& solved, const CameraPairs& seen) {
    return solved.model.fx() > 0.0 ? solved.model : with_estimated_focal(seen.model, solved);
}

std::string target_name(const std::vector<Packet<LidarBoards>>& lidar, const CameraPairs& seen,
                        int board) {
    if (board < 0 || static_cast<std::size_t>(board) >= seen.boards.size()) return {};
    const int index = seen.boards[static_cast<std::size_t>(board)].lidar;
    for (const auto& packet : lidar)
        if (packet.frame.number == seen.scene && index >= 0 &&
            static_cast<std::size_t>(index) < packet->boards.size())
            return packet->boards[static_cast<std::size_t>(index)].target;
    return {};
}

}  // namespace

SeenBoards seen_boards(const std::vector<Packet<Extrinsics>>& extrinsics,
                       const std::vector<Packet<Correspondences>>& correspondences,
                       const std::vector<Packet<LidarBoards>>& lidar) {
    SeenBoards found;
    for (const auto& packet : correspondences)
        for (const CameraPairs& seen : packet->cameras) {
            std::map<int, std::vector<PointPair>> boards;
            for (const PointPair& pair : seen.pairs) {
                if (pair.board >= 0)
                    boards[pair.board].push_back(pair);
                else
                    ++found.single;
            }
            const CameraExtrinsics* solved = pose_for(extrinsics, seen);
            if (solved == nullptr) {
                found.unsolved += boards.size();
                continue;
            }
            for (auto& [board, corners] : boards)
                found.boards.push_back({seen.scene, seen.scene_name, seen.camera,
                                        target_name(lidar, seen, board), model_for(*solved, seen),
                                        solved->T_camera_lidar, std::move(corners)});
        }
    std::stable_sort(found.boards.begin(), found.boards.end(),
                     [](const SeenBoard& a, const SeenBoard& b) { return a.scene < b.scene; });
    return found;
}

}  // namespace petal
