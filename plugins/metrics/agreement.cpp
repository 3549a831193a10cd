// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/agreement.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "metrics/detail/agreement_verdict.hpp"
#include "metrics/detail/point_to_edge.hpp"
#include "metrics/detail/pose_agreement.hpp"
#include "metrics/detail/scene_name.hpp"
#include "petal/calibration/angles.hpp"
#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/estimated_focal.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/same_projection.hpp"
#include "petal/error.hpp"
#include "petal/printed.hpp"

namespace petal {
namespace {

/// What one scene has of boards.
struct BoardScene {
    FrameInfo frame;
    std::shared_ptr<const LidarBoards> lidar;
    std::shared_ptr<const ImageBoards> image;
    std::shared_ptr<const Cloud> cloud;  ///< null where not wired
};

/// The scenes that both detectors looked at, by frame.
std::vector<BoardScene> scenes_of(const Run& run) {
    std::map<std::uint64_t, BoardScene> by_number;
    for (const auto& packet : run.all<LidarBoards>("lidar")) {
        by_number[packet.frame.number].frame = packet.frame;
        by_number[packet.frame.number].lidar = packet.value;
    }
    for (const auto& packet : run.all<ImageBoards>("image"))
        by_number[packet.frame.number].image = packet.value;
    for (const auto& packet : run.all<Cloud>("cloud"))
        by_number[packet.frame.number].cloud = packet.value;
    std::vector<BoardScene> scenes;
    for (auto& [number, scene] : by_number)
        if (scene.lidar && scene.image) scenes.push_back(std::move(scene));
    return scenes;
}

std::string quoted(const std::set<std::string>& labels) {
    return labels.empty() ? "none" : listed({labels.begin(), labels.end()});
}

/// \throws Error where the data have other sensors than the result is of.
void check_labels(const Extrinsics& known, const std::vector<BoardScene>& scenes) {
    std::set<std::string> cameras, lidars;
    for (const BoardScene& scene : scenes) {
        lidars.insert(scene.lidar->lidar);
        for (const CameraInfo& camera : scene.image->cameras) cameras.insert(camera.label);
    }
    if (cameras.empty()) return;  // no image at all: told as nothing to compare
    for (const CameraExtrinsics& one : known.cameras) {
        if (cameras.count(one.camera) == 0)
            throw Error("the result is of camera '" + one.camera + "', but the data have " +
                        quoted(cameras) + "; give data of that camera, or the result of this one");
        if (lidars.count(one.lidar) == 0)
            throw Error("the result is of LiDAR '" + one.lidar + "', but the data have " +
                        quoted(lidars) + "; give data of that LiDAR, or the result of this one");
    }
}

double rms(const std::vector<Eigen::Vector2d>& errors) {
    double sum = 0.0;
    for (const auto& error : errors) sum += error.squaredNorm();
    return errors.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(errors.size()));
}

double median_distance(std::vector<double> values) {
    const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), half, values.end());
    return *half;
}

/// Holds one camera's pose against all scenes.
class Holding {
   public:
    Holding(const CameraExtrinsics& known, const AgreementParams& params, TargetsByName& targets)
        : camera_(known), params_(params), targets_(targets) {
        camera_.residuals.clear();
    }

    void hold(const std::vector<BoardScene>& scenes, Run& run) {
        for (const BoardScene& scene : scenes) {
            run.check_cancelled();
            for (const CameraInfo& info : scene.image->cameras)
                if (info.label == camera_.camera && scene.lidar->lidar == camera_.lidar)
                    hold_scene(scene, info, run);
        }
    }
    void tell(Correspondences& correspondences, Extrinsics& extrinsics, Metrics& metrics) {
        for (CameraPairs& pairs : pairs_) correspondences.cameras.push_back(std::move(pairs));
        const std::string who = "camera '" + camera_.camera + "': ";
        const auto lower = [&](Level level, const std::string& reason) {
            extrinsics.level = std::max(extrinsics.level, level);
            extrinsics.reasons.push_back(who + reason);
        };
        if (!drift_ || drift_->errors().empty()) {
            lower(
                Level::not_usable,
                printed("nothing to compare: the LiDAR has %zu boards and the camera %zu, and the "
                        "result puts none of them on each other; it is far off, or the sensors do "
                        "not see the same boards",
                        lidar_boards_, image_boards_));
            return;
        }
        const double px = rms(drift_->errors());
        const DriftSum::Result drift = drift_->result(camera_.covariance);
        const auto value = [&](const char* name, double figure, const char* unit) {
            const std::string camera = several_ ? camera_.camera + "." : "";
            metrics.values.push_back({"agreement." + camera + name, figure, unit, ""});
        };
        value("boards", static_cast<double>(boards_), "1");
        value("reprojection_rms_px", px, "px");
        value("drift_sigmas", drift.sigmas, "1");
        value("drift_chi2", drift.chi2, "1");
        value("drift_rotation_deg", drift.drift.tail<3>().norm() * kDegrees, "deg");
        value("data_variance_scale", drift.variance_scale, "1");
        if (!to_edge_.empty()) {
            value("point_to_edge_count", static_cast<double>(to_edge_.size()), "1");
            value("point_to_edge_median_px", median_distance(to_edge_), "px");
        }
        if (drift.left_freedoms > 0) value("contradiction_sigmas", drift.left_sigmas, "1");
        std::vector<std::string> reasons;
        const Level level = judge_agreement(camera_, px, drift, params_, reasons);
        for (const std::string& reason : reasons) lower(level, reason);
        camera_.chi2 = drift.chi2;
        camera_.degrees_of_freedom = 6;
        extrinsics.cameras.push_back(camera_);
    }
    void name_camera() { several_ = true; }

   private:
    /// The camera of the first scene, with the focal length that the result estimated.
    void take_camera(const BoardScene& scene, const CameraInfo& info) {
        if (model_) {
            if (!same_projection(given_, info.camera))
                throw Error("camera '" + camera_.camera + "' has other intrinsics in scene '" +
                            scene_name(scene.frame) +
                            "' than before; give every scene of a camera the same intrinsics, or "
                            "verify the scenes apart");
            return;
        }
        given_ = info.camera;
        camera_.model = with_estimated_focal(info.camera, camera_);
        model_.emplace(camera_.model);
        drift_.emplace(*model_, camera_.T_camera_lidar,
                       MeasurementNoise{params_.lidar_sigma, params_.board_redundancy});
    }

    void hold_scene(const BoardScene& scene, const CameraInfo& info, Run& run) {
        lidar_boards_ += scene.lidar->boards.size();
        for (const ImageBoard& board : scene.image->boards)
            image_boards_ += board.camera == info.label ? 1U : 0U;
        take_camera(scene, info);
        CameraPairs pairs;
        pairs.scene = scene.frame.number;
        pairs.scene_name = scene.frame.name;
        pairs.camera = camera_.camera;
        pairs.lidar = camera_.lidar;
        pairs.model = info.camera;
        pairs.order.by = DecidedBy::given;
        pairs.order.reason = "the given extrinsics tell it";
        for (const PosedMatch& match : match_by_pose(*model_, camera_.T_camera_lidar, *scene.lidar,
                                                     *scene.image, camera_.camera, params_.reach)) {
            const LidarBoard& lidar = scene.lidar->boards[match.lidar];
            const ImageBoard& image = scene.image->boards[match.image];
            const std::size_t before = drift_->errors().size();
            if (!drift_->add(match, lidar, image)) continue;
            const int board = static_cast<int>(pairs.boards.size());
            pairs.boards.emplace_back();
            pairs.boards.back().lidar = static_cast<int>(match.lidar);
            pairs.boards.back().image = static_cast<int>(match.image);
            for (std::size_t i = 0; i < match.lidar_corners.size(); ++i) {
                PointPair pair;
                pair.lidar = match.lidar_corners[i];
                pair.image = image.corners[i];
                pair.board = board;
                pair.corner = static_cast<int>(i);
                pairs.pairs.push_back(pair);
                camera_.residuals.push_back({scene.frame.number, board, static_cast<int>(i),
                                             pair.image, drift_->errors()[before + i]});
            }
            ++boards_;
            if (!scene.cloud) continue;
            const auto found = point_to_edge(*model_, camera_.T_camera_lidar, *scene.cloud, lidar,
                                             image, match, targets_.find(lidar.target, run));
            to_edge_.insert(to_edge_.end(), found.begin(), found.end());
        }
        pairs_.push_back(std::move(pairs));
    }

    CameraExtrinsics camera_;
    mrpt::img::TCamera given_;  ///< of the first scene
    const AgreementParams& params_;
    TargetsByName& targets_;
    std::optional<CameraModel> model_;
    std::optional<DriftSum> drift_;
    std::vector<CameraPairs> pairs_;
    std::vector<double> to_edge_;
    std::size_t boards_ = 0, lidar_boards_ = 0, image_boards_ = 0;
    bool several_ = false;
};

}  // namespace

void AgreementMetric::describe(Spec<Params>& s) {
    s.summary("Holds known extrinsics against the boards of new scenes, without solving.");
    s.doc(
        R"(What `petal verify` runs. The extrinsics (`source.result`) put every LiDAR board into the image; a board of the image whose middle lies
within `reach` of its radius is the same board, in the turn that fits best. So a result that is off by more than about half a board finds
nothing to compare, which is told as not usable.

| name | what |
|---|---|
| agreement.boards | boards compared |
| agreement.reprojection_rms_px | of the hole corners |
| agreement.point_to_edge_median_px, point_to_edge_count | of the LiDAR's margin points beside the sides of holes to the same sides in the image (wire `cloud`) |
| agreement.drift_sigmas | how improbable the misses are, by the covariances of the result and of the boards together, as sigmas of a normal distribution |
| agreement.drift_chi2 | the same as a chi-square of 6 degrees of freedom |
| agreement.contradiction_sigmas | how improbable it is that the boards differ so much from each other beside a common drift, as sigmas (two boards or more) |
| agreement.drift_rotation_deg | the rotation by which the boards seem to have drifted, as far as they tell |

With several cameras the names begin with `agreement.CAMERA.`. The drift xi (T_now = Exp(xi) T_result) is that of weighted least squares over all boards,
b = A xi with A = sum J' S^-1 J; S is a board's image covariance plus its pose covariance as the image sees it. chi-square = xi' (C + A^-1)^-1 xi, C the result's covariance. A is
scaled down where the boards do not fit each other. Corners without a joint covariance count `board_redundancy` times less; a
LiDAR board without a covariance gets `lidar_sigma`.

A board counts as the 6 numbers of its motion, however many corners it has.

**Verdict.** At best that of the given result; weak where the result's largest 1 sigma is above `usable_sigma` or `usable_sigma_deg`. weak too
where boards miss by more than `max_px` (RMS), with the reason: a drift of more than `sigmas`; boards that contradict each other (what a common drift leaves is
beyond the 99.9 % point of its chi-square, 6 degrees of freedom a board less 6); or neither, so that the data agree only because they or the result
are vague. not_usable: nothing to compare. Else usable. The extrinsics go out unchanged, with their new residuals. A focal length that the result estimated (`focal`) is applied.

**Errors**: data of another camera or LiDAR than the result's; a camera with other intrinsics in a later scene.)");
    s.gathers<Extrinsics>("known", "the extrinsics to hold");
    s.gathers<LidarBoards>("lidar", "boards of the new scenes");
    s.gathers<ImageBoards>("image", "the same boards in the images");
    s.gathers<Cloud>("cloud", "margin points of the new scenes").optional();
    s.writes<Extrinsics>("extrinsics", "the same extrinsics with the new residuals and verdict");
    s.writes<Correspondences>("correspondences", "the corners that were compared");
    s.writes<Metrics>("metrics", "the figures above");
    s.param("sigmas", &Params::sigmas)
        .unit("1")
        .within(1.0, 100.0)
        .doc("data and result disagree beyond so many sigmas");
    s.param("max_px", &Params::max_px)
        .unit("px")
        .within(0.0, 1000.0)
        .doc("and beyond this reprojection RMS");
    s.param("usable_sigma", &Params::usable_sigma)
        .unit("m")
        .within(0.0, 1000.0)
        .doc("largest 1 sigma of the result's translation, to be usable");
    s.param("usable_sigma_deg", &Params::usable_sigma_deg)
        .unit("deg")
        .within(0.0, 360.0)
        .doc("largest 1 sigma of the result's rotation, to be usable");
    s.param("reach", &Params::reach)
        .unit("1")
        .within(0.1, 10.0)
        .doc(
            "how far from an image board its LiDAR board may come to lie, in radii of its corners");
    s.param("lidar_sigma", &Params::lidar_sigma)
        .unit("m")
        .within(0.0001, 1.0)
        .doc("1 sigma of a LiDAR board without a covariance");
    s.param("board_redundancy", &Params::board_redundancy)
        .unit("1")
        .within(1.0, 100.0)
        .doc("how many times fewer independent numbers a board's corners hold than they count");
    s.param("targets", &Params::targets)
        .doc("target files of boards that petal does not ship; the boards name them");
}

void AgreementMetric::finish(Run& run) {
    const auto scenes = scenes_of(run);
    Extrinsics extrinsics;
    extrinsics.level = Level::usable;
    Correspondences correspondences;
    Metrics metrics;
    Extrinsics known;
    for (const auto& packet : run.all<Extrinsics>("known")) {
        extrinsics.level =
            std::max(extrinsics.level, judge_known(*packet.value, extrinsics.reasons));
        for (const CameraExtrinsics& camera : packet->cameras) {
            if (!camera.T_camera_lidar.matrix().allFinite() || !camera.covariance.allFinite())
                throw Error("the extrinsics of camera '" + camera.camera +
                            "' are not finite; give a result that was solved");
            known.cameras.push_back(camera);
        }
    }
    check_labels(known, scenes);
    if (known.cameras.empty()) {
        run.note(
            {"extrinsics to hold", "there are none", "", "give the result of a run that solved"});
        extrinsics.level = Level::not_usable;
        extrinsics.reasons.emplace_back("there are no extrinsics to hold against the data");
    }
    for (const CameraExtrinsics& camera : known.cameras) {
        Holding holding(camera, p_, targets_);
        if (known.cameras.size() > 1) holding.name_camera();
        holding.hold(scenes, run);
        holding.tell(correspondences, extrinsics, metrics);
    }
    run.verdict(extrinsics.level, extrinsics.reasons);
    run.write("extrinsics", std::move(extrinsics));
    run.write("correspondences", std::move(correspondences));
    run.write("metrics", std::move(metrics));
}

}  // namespace petal
