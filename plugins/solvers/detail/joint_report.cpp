// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/joint_report.hpp"

#include <Eigen/Core>
#include <algorithm>

#include "petal/calibration/angles.hpp"
#include "petal/error.hpp"
#include "petal/printed.hpp"
#include "solvers/detail/extrinsics_estimate.hpp"
#include "solvers/detail/joint_focal.hpp"
#include "solvers/detail/joint_scenes.hpp"
#include "solvers/detail/pixel_drift.hpp"
#include "solvers/detail/placement_advice.hpp"
#include "solvers/detail/placement_tilt.hpp"

namespace petal {
namespace {

constexpr double kUpperZ3 = 3.0902;  // one-sided 99.9 %

class JointReport {
   public:
    JointReport(const JointInput& input, const JointParams& params,
                const std::optional<TranslationPrior>& prior, const std::function<void()>& poll,
                Extrinsics& extrinsics)
        : input_(input), params_(params), reasons_(extrinsics.reasons), extrinsics_(extrinsics) {
        options_.robust_loss = params.robust_loss;
        options_.range_offset_sigma = params.range_offset_allowance * params.range_offset_sigma;
        options_.prior = prior;
        options_.poll = poll;
    }

    std::optional<Level> write() {
        auto minima = search_joint(input_, options_);
        if (!minima) return std::nullopt;
        solution_ = std::move(minima->best);
        free_focal_lengths();
        const JointUncertainty uncertainty(input_.model, options_, solution_);
        const SceneInfluence influence(input_.model, options_, solution_, uncertainty);
        std::vector<std::vector<Diagnosis::Scene>> scenes;
        for (std::size_t c = 0; c < input_.cameras.size(); ++c) scenes.push_back(influence.of(c));
        for (std::size_t c = 0; c < input_.cameras.size(); ++c) {
            if (options_.poll) options_.poll();
            CameraExtrinsics camera = extrinsics_of(c, uncertainty);
            Diagnosis& diagnosis = *camera.diagnosis;
            diagnosis.scenes = scenes[c];
            lower(judge(camera, params_, reasons_));
            tell_tilt(c);
            tell_assumed(c);
            tell_focal(c, *diagnosis.focal);
            tell_outliers(c, scenes);
            if (options_.prior && options_.prior->camera == c)
                diagnosis.prior = prior_of(c, camera, uncertainty);
            if (minima->other && minima->other->camera == c)
                tell_other(*minima->other, diagnosis.variance_scale);
            if (diagnosis.advice && too_wide(camera))
                reasons_.push_back(who(c) +
                                   "what would help most next: " + diagnosis.advice->sentence);
            extrinsics_.cameras.push_back(std::move(camera));
        }
        return level_;
    }

   private:
    std::string who(std::size_t c) const { return "camera '" + input_.cameras[c].camera + "': "; }
    void lower(Level to) { level_ = std::max(level_, to); }
    void weak(std::string reason) {
        lower(Level::weak);
        reasons_.push_back(std::move(reason));
    }
    bool too_wide(const CameraExtrinsics& camera) const {
        const PrincipalSigma sigma = principal_sigma(camera);
        return sigma.translation > params_.usable_sigma ||
               sigma.rotation * kDegrees > params_.usable_sigma_deg;
    }

    /// Where asked to, and where the depths of the boards tell focal length from distance.
    void free_focal_lengths() {
        if (!params_.estimate_focal) return;
        const JointUncertainty held(input_.model, options_, solution_);
        JointOptions freed = options_;
        freed.free_focal.assign(input_.cameras.size(), false);
        bool any = false;
        for (std::size_t c = 0; c < input_.cameras.size(); ++c) {
            const double sigma = held.focal(c).sigma;
            if (sigma <= params_.max_focal_sigma) {
                freed.free_focal[c] = any = true;
            } else {
                weak(who(c) +
                     printed("the focal length was not estimated: its 1 sigma would be %.2f %% "
                             "(limit %.2f %%); place boards at more different distances",
                             sigma * 100.0, params_.max_focal_sigma * 100.0));
            }
        }
        if (!any) return;
        if (auto solved = solve_joint(input_.model, freed, solution_.state)) {
            solution_ = *std::move(solved);
            options_ = freed;
        }
    }

    CameraExtrinsics extrinsics_of(std::size_t c, const JointUncertainty& uncertainty) const {
        const SolveInput& input = input_.cameras[c];
        CameraExtrinsics camera;
        camera.camera = input.camera;
        camera.lidar = input.lidar;
        camera.model = input_.model.cameras[c].camera();
        camera.model.fx(camera.model.fx() * solution_.state.focal[c]);
        camera.model.fy(camera.model.fy() * solution_.state.focal[c]);
        camera.T_camera_lidar = solution_.state.T_camera_lidar[c];
        camera.order = input.order;
        camera.chi2 = uncertainty.chi2();
        camera.degrees_of_freedom = uncertainty.degrees_of_freedom();
        camera.covariance = uncertainty.covariance(c, params_.range_offset_sigma);
        const Matrix6d column = column_covariance(camera);
        camera.sigma_translation = column.diagonal().head<3>().cwiseMax(0.0).cwiseSqrt();
        camera.sigma_rotation = column.diagonal().tail<3>().cwiseMax(0.0).cwiseSqrt();

        const CameraModel model(camera.model);
        for (std::size_t i = 0; i < input.pairs.size(); ++i) {
            const PointPair& pair = input.pairs[i];
            const auto pixel = model.project(camera.T_camera_lidar * pair.lidar);
            if (!pixel)
                throw Error(who(c) +
                            "a pair does not project into the image at the pose that was found; "
                            "check the pairs and the intrinsics");
            camera.residuals.push_back({input.origins[i].scene, input.origins[i].board,
                                        input.origins[i].corner, pair.image, pair.image - *pixel});
        }

        Diagnosis& diagnosis = camera.diagnosis.emplace();
        diagnosis.variance_scale = uncertainty.variance_scale();
        diagnosis.covariance_considered = uncertainty.covariance_considered(c, params_);
        diagnosis.focal = best_focal(input_.model, options_, solution_, uncertainty, c);
        diagnosis.drifts = pixel_drifts(model, camera.covariance, diagnosis.covariance_considered);
        AdviceParams advice;
        advice.range_offset_sigma = params_.range_offset_sigma;
        advice.allowed_range_offset = options_.range_offset_sigma;
        advice.variance_scale = diagnosis.variance_scale;
        advice.min_range = params_.advice_min_range;
        advice.max_range = params_.advice_max_range;
        if (params_.usable_sigma > 0.0) advice.usable_sigma = params_.usable_sigma;
        if (params_.usable_sigma_deg > 0.0)
            advice.usable_sigma_rotation = params_.usable_sigma_deg / kDegrees;
        diagnosis.advice =
            advise_placement(input_.model, solution_, c, uncertainty.information(c), advice);
        camera.weakest_direction =
            describe_weakest(column, advice.usable_sigma_rotation / advice.usable_sigma) +
            drift_text(diagnosis.drifts);
        return camera;
    }

    void tell_tilt(std::size_t c) {
        std::vector<Eigen::Vector3d> normals;
        for (std::size_t b = 0; b < input_.model.boards.size(); ++b)
            for (const auto& view : input_.model.boards[b].views)
                if (view.camera == c)
                    normals.push_back((solution_.state.T_camera_lidar[c].linear() *
                                       solution_.state.T_lidar_board[b].linear())
                                          .col(2));
        const auto tilt = least_tilt(normals);
        if (!tilt) return;
        if (const auto doubt = tilt_doubt(*tilt, params_.usable_tilt_deg)) weak(who(c) + *doubt);
    }

    void tell_assumed(std::size_t c) {
        int assumed = 0;
        for (const JointBoard& board : input_.model.boards)
            for (const auto& view : board.views) assumed += board.assumed && view.camera == c;
        if (assumed > 0)
            weak(who(c) +
                 printed("%d LiDAR boards came without a covariance of their pose; %.1f mm and "
                         "%.2f deg were assumed, so the sigmas rest on a guess",
                         assumed, params_.assumed_board_sigma * 1e3,
                         params_.assumed_board_sigma_deg));
    }

    void tell_focal(std::size_t c, const Diagnosis::FocalScale& focal) {
        if (const auto doubt = focal_doubt(focal, params_.focal_sigma)) weak(who(c) + *doubt);
    }

    /// The camera that moves most, in sigmas, where one of `scenes` is left out: an outlier is one
    /// of the whole group, but only that camera may have seen anything wrong.
    static std::size_t most_moved(const std::vector<std::vector<Diagnosis::Scene>>& cameras,
                                  const std::vector<std::size_t>& scenes) {
        std::size_t most = 0;
        double sigmas = -1.0;
        for (std::size_t c = 0; c < cameras.size(); ++c)
            for (const std::size_t s : scenes)
                if (cameras[c][s].shift_sigmas > sigmas) {
                    most = c;
                    sigmas = cameras[c][s].shift_sigmas;
                }
        return most;
    }

    /// Those that move this camera most.
    void tell_outliers(std::size_t c, const std::vector<std::vector<Diagnosis::Scene>>& cameras) {
        const std::vector<Diagnosis::Scene>& scenes = cameras[c];
        if (scenes.size() == 2 && scenes[0].outlier && scenes[1].outlier) {
            if (most_moved(cameras, {0, 1}) != c) return;
            return weak(who(c) + "scenes '" + scenes[0].name + "' and '" + scenes[1].name +
                        "' contradict each other; which of them is wrong a third one would tell");
        }
        for (std::size_t s = 0; s < scenes.size(); ++s) {
            const Diagnosis::Scene& scene = scenes[s];
            if (scene.outlier && most_moved(cameras, {s}) == c)
                weak(who(c) + "scene '" + scene.name +
                     "' does not fit the others: without it the "
                     "pose moves by " +
                     printed("%.1f mm and %.2f deg (%.1f sigma); look at its boards, or leave it "
                             "out",
                             column_shift(c, scene.shift).norm() * 1e3,
                             scene.shift.tail<3>().norm() * kDegrees, scene.shift_sigmas));
        }
    }
    Eigen::Vector3d column_shift(std::size_t c, const Vector6d& shift) const {
        const Eigen::Isometry3d& pose = solution_.state.T_camera_lidar[c];
        return (se3_exp(shift) * pose).translation() - pose.translation();
    }

    Diagnosis::Prior prior_of(std::size_t c, const CameraExtrinsics& camera,
                              const JointUncertainty& uncertainty) {
        const TranslationPrior& prior = *options_.prior;
        const double distance = (camera.T_camera_lidar.translation() - prior.translation).norm();
        Diagnosis::Prior told{distance, distance / prior.sigma,
                              uncertainty.covariance_without_prior(c, params_.range_offset_sigma)};
        // What the prior adds to the least sum of squares says whether it and the data agree.
        JointOptions data_only = options_;
        data_only.prior.reset();
        if (const auto data = solve_joint(input_.model, data_only, solution_.state)) {
            const double added =
                (solution_.chi2 - data->chi2) / told_scale(uncertainty) + told.sigmas * told.sigmas;
            if (added > chi2_quantile(3, kUpperZ3))
                weak(who(c) + "the data contradict the prior on the translation: " +
                     printed(
                         "without it the result lies %.1f mm from it (sigma of the prior "
                         "%.1f mm)",
                         (data->state.T_camera_lidar[c].translation() - prior.translation).norm() *
                             1e3,
                         prior.sigma * 1e3));
        }
        CameraExtrinsics alone = camera;
        alone.covariance = told.covariance_without_prior;
        if (too_wide(alone) && !too_wide(camera)) {
            const PrincipalSigma sigma = principal_sigma(alone);
            weak(who(c) + printed("only the prior on the translation makes it precise: without it "
                                  "1 sigma is up to %.1f mm and %.3f deg",
                                  sigma.translation * 1e3, sigma.rotation * kDegrees));
        }
        return told;
    }
    static double told_scale(const JointUncertainty& uncertainty) {
        return uncertainty.variance_scale();
    }

    void tell_other(const JointMinima::Other& other, double variance_scale) {
        const double more = other.squares / variance_scale;
        if (more >= chi2_quantile(6, kUpperZ3)) return;
        const std::string pose =
            who(other.camera) + printed("another pose, %.1f deg and %.2f m away, ",
                                        other.angle * kDegrees, other.distance);
        weak(pose + (more < 0.0 ? printed("explains the same boards better (chi-square %.1f less); "
                                          "the prior on the order kept this one",
                                          -more)
                                : printed("explains the same boards nearly as well (chi-square "
                                          "%.1f more)",
                                          more)));
    }

    const JointInput& input_;
    const JointParams& params_;
    std::vector<std::string>& reasons_;
    Extrinsics& extrinsics_;
    JointOptions options_;
    JointSolution solution_;
    Level level_ = Level::usable;
};

}  // namespace

std::optional<Level> report_joint(const JointInput& input, const JointParams& params,
                                  const std::optional<TranslationPrior>& prior,
                                  const std::function<void()>& poll, Extrinsics& extrinsics) {
    return JointReport(input, params, prior, poll, extrinsics).write();
}

}  // namespace petal
