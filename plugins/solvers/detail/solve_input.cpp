// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/solve_input.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "petal/error.hpp"

namespace petal {
namespace {

/// Worst first: undecided, prior, then what the data or the input said.
int rank(DecidedBy by) {
    switch (by) {
        case DecidedBy::undecided:
            return 0;
        case DecidedBy::prior:
            return 1;
        case DecidedBy::data:
            return 2;
        case DecidedBy::given:
            break;
    }
    return 3;
}

bool worse(const OrderDecision& a, const OrderDecision& b) {
    if (rank(a.by) != rank(b.by)) return rank(a.by) < rank(b.by);
    // 0 says that there was no runner-up at all.
    const auto ratio = [](const OrderDecision& order) {
        return order.runner_up_rms_ratio > 0.0 ? order.runner_up_rms_ratio
                                               : std::numeric_limits<double>::infinity();
    };
    return ratio(a) < ratio(b);
}

}  // namespace

CameraModel camera_model(const mrpt::img::TCamera& camera, bool use_distortion) {
    mrpt::img::TCamera used = camera;
    if (!use_distortion) {
        used.distortion = mrpt::img::DistortionModel::none;
        used.dist.fill(0.0);
    }
    return CameraModel(used);
}

std::vector<SolveInput> gather(const std::vector<Packet<Correspondences>>& packets) {
    std::vector<const CameraPairs*> all;
    for (const auto& packet : packets)
        for (const CameraPairs& seen : packet->cameras) all.push_back(&seen);
    std::stable_sort(all.begin(), all.end(), [](const CameraPairs* a, const CameraPairs* b) {
        return a->scene < b->scene;
    });
    std::vector<SolveInput> inputs;
    std::vector<int> boards_so_far;
    for (const CameraPairs* each : all) {
        const CameraPairs& seen = *each;
        auto input = std::find_if(inputs.begin(), inputs.end(), [&](const SolveInput& other) {
            return other.camera == seen.camera && other.lidar == seen.lidar;
        });
        if (input == inputs.end()) {
            SolveInput made;
            made.camera = seen.camera;
            made.lidar = seen.lidar;
            made.model = seen.model;
            inputs.push_back(made);
            boards_so_far.push_back(0);
            input = inputs.end() - 1;
        } else if (!same_projection(input->model, seen.model)) {
            throw Error("camera '" + seen.camera + "' has other intrinsics in scene " +
                        std::to_string(seen.scene) +
                        " than before; give every scene of a camera the same intrinsics, or solve "
                        "the scenes apart");
        }
        if (seen.pairs.empty()) continue;
        if (input->pairs.empty() || worse(seen.order, input->order)) input->order = seen.order;
        std::map<int, int> renumbered;
        int& next = boards_so_far[static_cast<std::size_t>(input - inputs.begin())];
        for (const PointPair& pair : seen.pairs) {
            input->origins.push_back({seen.scene, pair.board, pair.corner});
            input->pairs.push_back(pair);
            if (pair.board < 0) continue;
            const auto [entry, is_new] = renumbered.emplace(pair.board, next);
            if (is_new) ++next;
            input->pairs.back().board = entry->second;
        }
        // A matcher that decided over all scenes tells the same poses with each of them.
        for (const Eigen::Isometry3d& pose : seen.initial)
            if (std::none_of(input->initial.begin(), input->initial.end(),
                             [&](const auto& known) { return known.matrix() == pose.matrix(); }))
                input->initial.push_back(pose);
    }
    return inputs;
}

}  // namespace petal
