// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/board_truth.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "metrics/detail/board_errors.hpp"
#include "metrics/detail/board_figures.hpp"
#include "metrics/detail/scene_name.hpp"
#include "petal/calibration/boards.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/truth.hpp"

namespace petal {
namespace {

const char* const kErrorsSought = "the errors of the boards against the truth";

/// What was measured of all scenes together.
struct BoardTotals {
    std::vector<LidarBoardError> lidar;
    std::vector<ImageBoardError> image;
    BoardCounts lidar_counts, image_counts;
};

void append(Metrics& metrics, std::vector<Metric> figures) {
    for (Metric& figure : figures) metrics.values.push_back(std::move(figure));
}

std::string board_prefix(std::size_t board, const char* sensor) {
    return "board_truth.board_" + std::to_string(board + 1) + "." + sensor + "_";
}

/// The packets by frame. Several wires may bring boards of one frame.
template <class T>
std::map<std::uint64_t, std::vector<std::shared_ptr<const T>>> by_frame(Run& run,
                                                                        const char* port) {
    std::map<std::uint64_t, std::vector<std::shared_ptr<const T>>> frames;
    for (const Packet<T>& packet : run.all<T>(port))
        frames[packet.frame.number].push_back(packet.value);
    return frames;
}

Eigen::Vector3d middle_of(const LidarBoard& board) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& corner : board.corners) sum += corner;
    return board.corners.empty() ? board.T_lidar_board.translation()
                                 : Eigen::Vector3d(sum / static_cast<double>(board.corners.size()));
}

Eigen::Vector2d middle_of(const ImageBoard& board) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& corner : board.corners) sum += corner;
    return sum / static_cast<double>(std::max<std::size_t>(board.corners.size(), 1));
}

void measure_lidar(const std::vector<std::shared_ptr<const LidarBoards>>& packets,
                   const std::vector<TrueBoard>& truth, double range_sigma,
                   const std::string& scene, Metrics& metrics, BoardTotals& totals) {
    std::vector<const LidarBoard*> found;
    std::vector<Eigen::Vector3d> found_at, true_at;
    std::vector<double> radius;
    for (const auto& packet : packets)
        for (const LidarBoard& board : packet->boards) {
            found.push_back(&board);
            found_at.push_back(middle_of(board));
        }
    for (const TrueBoard& board : truth) {
        true_at.push_back(board.middle_lidar());
        radius.push_back(board.radius_lidar());
    }
    const auto pairs = nearest_pairs(found_at, true_at, radius);
    for (const auto& [i, j] : pairs) {
        totals.lidar.push_back(lidar_board_error(*found[i], truth[j], range_sigma));
        append(metrics, lidar_figures(totals.lidar.back(), board_prefix(j, "lidar"), scene));
    }
    const auto count = static_cast<int>(pairs.size());
    const BoardCounts counts{count, static_cast<int>(truth.size()) - count,
                             static_cast<int>(found.size()) - count};
    append(metrics, count_figures(counts, "board_truth.lidar_", scene));
    totals.lidar_counts.add(counts);
}

void measure_image(const std::vector<const ImageBoard*>& boards,
                   const std::vector<TrueBoard>& truth, const std::string& scene, Metrics& metrics,
                   BoardTotals& totals) {
    std::vector<Eigen::Vector2d> found_at, true_at;
    std::vector<double> radius;
    std::vector<std::size_t> in_view;
    for (const ImageBoard* board : boards) found_at.push_back(middle_of(*board));
    for (std::size_t j = 0; j < truth.size(); ++j) {
        const auto& corners = truth[j].board().corners_image;
        if (corners.empty() || corners.size() != truth[j].board().corners_lidar.size()) continue;
        in_view.push_back(j);
        true_at.push_back(truth[j].middle_image());
        radius.push_back(truth[j].radius_image());
    }
    int measured = 0;
    for (const auto& [i, j] : nearest_pairs(found_at, true_at, radius)) {
        const TrueBoard& board = truth[in_view[j]];
        if (boards[i]->corners.size() != board.board().corners_image.size()) continue;
        ++measured;
        totals.image.push_back(image_board_error(*boards[i], board));
        append(metrics,
               image_figures(totals.image.back(), board_prefix(in_view[j], "image"), scene));
    }
    const BoardCounts counts{measured, static_cast<int>(in_view.size()) - measured,
                             static_cast<int>(boards.size()) - measured};
    append(metrics, count_figures(counts, "board_truth.image_", scene));
    totals.image_counts.add(counts);
}

/// The camera that the truth is of; none, and a note why, where it cannot be told.
std::optional<std::string> chosen_camera(Run& run, const std::string& asked) {
    std::vector<std::string> labels;
    for (const Packet<ImageBoards>& packet : run.all<ImageBoards>("image"))
        for (const CameraInfo& camera : packet->cameras)
            if (std::find(labels.begin(), labels.end(), camera.label) == labels.end())
                labels.push_back(camera.label);
    if (!asked.empty() && std::find(labels.begin(), labels.end(), asked) == labels.end()) {
        run.note({kErrorsSought,
                  "no camera '" + asked + "' looked for boards; there are " +
                      (labels.empty() ? "none" : listed(labels)),
                  "", "set 'camera' to one of these, or leave it empty"});
        return std::nullopt;
    }
    if (!asked.empty()) return asked;
    if (labels.size() == 1) return labels.front();
    if (labels.size() > 1)
        run.note({kErrorsSought,
                  "the truth of a scene is of one camera, but several looked for boards: " +
                      listed(labels),
                  "", "set 'camera' to the one that the truth is of"});
    return std::nullopt;
}

}  // namespace

void BoardTruthMetric::describe(Spec<Params>& s) {
    s.summary(
        "How far the boards that were found are from the true ones: m, deg, px, and in their own "
        "sigmas.");
    s.doc(
        R"(Compares what detectors found in each scene with the boards that a simulated scene brings along. A found board belongs to the
nearest true one whose middle is nearer than the RMS distance of its corners from it; what is left is missed or false. A board that looks alike
after a quarter or half turn is taken in that of its orders that lies nearest to the truth: which one it is, the matcher decides.

For each scene and board, k counting from 1 in the order of the truth:

| name | what |
|---|---|
| board_truth.board_k.lidar_x_m, _y_m, _z_m | estimated less true place of the board's middle, along its own axes: right, down, into the board |
| board_truth.board_k.lidar_turn_x_deg, _y_deg, _z_deg | rotation vector about the same axes |
| board_truth.board_k.lidar_x_sigmas and so on | each over its own sigma |
| board_truth.board_k.lidar_nees | all six: e^T C^-1 e; 6 on average where C is honest |
| board_truth.board_k.image_rms_px | RMS distance of the corners, raw pixels |
| board_truth.board_k.image_shift_u_px, _v_px | mean over the corners |
| board_truth.board_k.image_shift_u_sigmas, _v_sigmas | the same over its sigma, by the joint covariance |
| board_truth.board_k.image_nees, image_nees_freedoms | of all corners, by the joint covariance, in the directions that it knows |

In total: `lidar_found`, `lidar_missed`, `lidar_false` and the same for `image` (for each scene too); the RMS of each error (`lidar_x_rms_m`) and of each
error in sigmas (`lidar_x_rms_sigmas`: 1 where the sigma is honest); `lidar_nees_mean` (6); `image_nees_per_freedom` (1).

C is the covariance that the detector told, plus `range_offset_sigma` along the ray to the board's middle: a constant offset of all ranges, which no
detector can see and solvers take into account by themselves. Set it to 0 for a LiDAR without one.

Boards without a covariance have no sigmas. True boards that do not lie whole in the image do not count for the camera. The truth holds the corners of one camera:
where several looked, `camera` must say which. Scenes without true boards do not count, and a note says so.)");
    s.role("metric");
    s.gathers<LidarBoards>("lidar", "boards that a LiDAR detector found").optional();
    s.gathers<ImageBoards>("image", "boards that an image detector found").optional();
    s.gathers<Truth>("truth", "what is known of every scene; empty for real data");
    s.writes<Metrics>("metrics",
                      "errors in metres, degrees, pixels and sigmas, for each board and in total");
    s.param("range_offset_sigma", &Params::range_offset_sigma)
        .unit("m")
        .within(0.0, 1.0)
        .doc("1 sigma of the LiDAR's constant range offset, added to the boards' covariance");
    s.param("camera", &Params::camera)
        .doc("label of the camera that the truth is of; empty: the only one that looked");
}

void BoardTruthMetric::finish(Run& run) {
    const bool has_lidar = run.wired("lidar"), has_image = run.wired("image");
    Metrics metrics;
    auto scenes = run.all<Truth>("truth");
    std::stable_sort(scenes.begin(), scenes.end(),
                     [](const auto& a, const auto& b) { return a.frame.number < b.frame.number; });
    std::vector<std::string> unknown;
    std::vector<Packet<Truth>> known;
    for (const auto& scene : scenes) {
        if (scene->boards.empty())
            unknown.push_back(scene_name(scene.frame));
        else
            known.push_back(scene);
    }
    if (!unknown.empty())
        run.note({kErrorsSought,
                  "no truth: " + std::to_string(unknown.size()) + " of " +
                      std::to_string(scenes.size()) +
                      " scenes have no true boards and do not count: " + listed(unknown),
                  "",
                  "truth is known of simulated scenes only: source.simulator gives it, sink.rawlog "
                  "writes it as truth.json beside the rawlog"});
    const auto camera = has_image && !known.empty() ? chosen_camera(run, params_.camera)
                                                    : std::optional<std::string>{};
    if (known.empty() || (!has_lidar && !camera)) {
        if (!has_lidar && !has_image)
            run.note({kErrorsSought, "neither 'lidar' nor 'image' is wired", "",
                      "wire the boards of a detector to one of them"});
        run.write("metrics", std::move(metrics));
        return;
    }
    const auto lidar = by_frame<LidarBoards>(run, "lidar");
    const auto image = by_frame<ImageBoards>(run, "image");
    BoardTotals totals;
    for (const auto& scene : known) {
        run.check_cancelled();
        std::vector<TrueBoard> truth(scene->boards.begin(), scene->boards.end());
        const std::string name = scene_name(scene.frame);
        const auto boards = lidar.find(scene.frame.number);
        if (has_lidar)
            measure_lidar(boards == lidar.end() ? std::vector<std::shared_ptr<const LidarBoards>>{}
                                                : boards->second,
                          truth, params_.range_offset_sigma, name, metrics, totals);
        if (!camera) continue;
        std::vector<const ImageBoard*> seen;
        const auto packets = image.find(scene.frame.number);
        if (packets != image.end())
            for (const auto& packet : packets->second)
                for (const ImageBoard& board : packet->boards)
                    if (board.camera == *camera) seen.push_back(&board);
        measure_image(seen, truth, name, metrics, totals);
    }
    if (has_lidar)
        append(metrics, lidar_summary(totals.lidar, totals.lidar_counts, "board_truth.lidar_"));
    if (camera)
        append(metrics, image_summary(totals.image, totals.image_counts, "board_truth.image_"));
    run.write("metrics", std::move(metrics));
}

}  // namespace petal
