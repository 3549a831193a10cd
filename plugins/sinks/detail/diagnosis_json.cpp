// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/diagnosis_json.hpp"

#include "petal/calibration/angles.hpp"
#include "petal/calibration/extrinsics_sigma.hpp"
#include "petal/calibration/se3.hpp"

namespace petal {
namespace {

using OrderedJson = nlohmann::ordered_json;

template <class Derived>
OrderedJson rows_of(const Eigen::MatrixBase<Derived>& matrix) {
    OrderedJson rows = OrderedJson::array();
    for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
        OrderedJson row = OrderedJson::array();
        for (Eigen::Index c = 0; c < matrix.cols(); ++c) row.push_back(matrix(r, c));
        rows.push_back(std::move(row));
    }
    return rows;
}

OrderedJson list_of(const Eigen::Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

/// A covariance of (rho, phi) and the sigmas of the fourth column of T and of the rotation.
OrderedJson covariance_json(const Matrix6d& covariance, const Eigen::Isometry3d& T_camera_lidar) {
    const Vector6d sigmas =
        column_covariance(covariance, T_camera_lidar).diagonal().cwiseMax(0.0).cwiseSqrt();
    return {{"covariance", rows_of(covariance)},
            {"sigma_translation_m", list_of(sigmas.head<3>())},
            {"sigma_rotation_deg", list_of(sigmas.tail<3>() * kDegrees)}};
}

OrderedJson scene_influences(const Diagnosis& diagnosis) {
    OrderedJson scenes = OrderedJson::array();
    for (const Diagnosis::Scene& scene : diagnosis.scenes) {
        OrderedJson told{{"scene", scene.name},
                         {"chi2", scene.chi2},
                         {"degrees_of_freedom", scene.degrees_of_freedom},
                         {"influence", scene.influence},
                         {"outlier", scene.outlier}};
        if (scene.solvable_without) {
            told["shift"] = {scene.shift[0], scene.shift[1], scene.shift[2],
                             scene.shift[3], scene.shift[4], scene.shift[5]};
            told["shift_sigmas"] = scene.shift_sigmas;
        } else {
            told["shift"] = nullptr;
            told["shift_sigmas"] = nullptr;
        }
        scenes.push_back(std::move(told));
    }
    return scenes;
}

OrderedJson advice_json(const Diagnosis::Advice& advice) {
    return {{"sentence", advice.sentence},
            {"range_m", advice.range},
            {"centre_px", {advice.u, advice.v}},
            {"pitch_deg", advice.pitch * kDegrees},
            {"yaw_deg", advice.yaw * kDegrees},
            {"sigma_translation_before_m", advice.sigma_translation_before},
            {"sigma_translation_after_m", advice.sigma_translation_after},
            {"sigma_rotation_before_deg", advice.sigma_rotation_before * kDegrees},
            {"sigma_rotation_after_deg", advice.sigma_rotation_after * kDegrees}};
}

}  // namespace

void add_diagnosis(nlohmann::ordered_json& entry, const CameraExtrinsics& camera) {
    entry["chi2"] = camera.chi2;
    entry["degrees_of_freedom"] = camera.degrees_of_freedom;
    if (!camera.diagnosis) return;
    const Diagnosis& diagnosis = *camera.diagnosis;
    entry["variance_scale"] = diagnosis.variance_scale;
    entry["considered"] = covariance_json(diagnosis.covariance_considered, camera.T_camera_lidar);
    OrderedJson drifts = OrderedJson::array();
    for (const Diagnosis::Drift& drift : diagnosis.drifts)
        drifts.push_back({{"range_m", drift.range},
                          {"sigma_px", drift.px},
                          {"considered_px", drift.considered_px}});
    entry["drift_px"] = std::move(drifts);
    entry["scenes"] = scene_influences(diagnosis);
    entry["advice"] = diagnosis.advice ? advice_json(*diagnosis.advice) : OrderedJson();
    if (diagnosis.focal)
        entry["focal"] = {{"scale", diagnosis.focal->scale},
                          {"sigma", diagnosis.focal->sigma},
                          {"estimated", diagnosis.focal->estimated}};
    if (diagnosis.prior)
        entry["prior"] = {{"distance_m", diagnosis.prior->distance},
                          {"distance_sigmas", diagnosis.prior->sigmas},
                          {"without", covariance_json(diagnosis.prior->covariance_without_prior,
                                                      camera.T_camera_lidar)}};
}

}  // namespace petal
