// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/intrinsics_check.hpp"

#include <cmath>
#include <string>

#include "metrics/detail/intrinsics_figures.hpp"
#include "metrics/detail/scene_name.hpp"
#include "petal/calibration/camera_model.hpp"
#include "petal/printed.hpp"

namespace petal {
namespace {

constexpr double kLeastExpected = 0.05;  // px: covariances of corners are never surer than this

std::string who(const CameraImage& image) {
    return "camera '" + image.label + "': ";
}

}  // namespace

void IntrinsicsCheck::describe(Spec<Params>& s) {
    s.summary("Whether a camera's intrinsics can be those of its images.");
    s.doc(R"(Looks for what makes a calibration wrong however small its residuals are:

| what | finding |
|---|---|
| focal lengths and coefficients that are no camera (zero, NaN) | not usable |
| intrinsics for another image size than the image has | not usable |
| principal point outside the image | not usable |
| principal point farther than `centre_share` of the width (height) from the middle | weak |
| the distorted radius stops growing before a corner of the image | weak |
| rows and columns of hole corners that are not straight after undistortion: more than `sigmas` times what the corners' covariances make, and more than `min_bend_px` | weak |

Straightness is measured in ideal pixels (those of the same camera without distortion), over all boards of a camera in a scene; a board spans a part of
the image, so it tells of the distortion where the boards are. One metric a camera and scene: `intrinsics.CAMERA.bend_px`
(RMS per degree of freedom), `intrinsics.CAMERA.bend_expected_px`; where the distortion folds also `fold_px`, `corner_px`, distances from the principal
point.

A wrong focal length bends nothing: it is told by a solver that knows the boards' distances. Distortion of both radii's signs
cannot be told right or wrong by a single small board in the image's middle.)");
    s.role("metric");
    s.reads<Images>("images", "the images of a scene with their intrinsics");
    s.reads<ImageBoards>("image_boards", "boards whose edges ought to be straight").optional();
    s.writes<Metrics>("metrics", "figures in px, and findings");
    s.param("centre_share", &Params::centre_share)
        .unit("1")
        .within(0.0, 0.5)
        .doc("how far from the image's middle the principal point may lie, of width and height");
    s.param("sigmas", &Params::sigmas)
        .unit("1")
        .within(1.0, 100.0)
        .doc("edges are bent above so many times what the corners' covariances make");
    s.param("min_bend_px", &Params::min_bend_px)
        .unit("px")
        .within(0.0, 100.0)
        .doc("and above this");
    s.param("targets", &Params::targets)
        .doc("target files of boards that petal does not ship; the boards name them");
}

void IntrinsicsCheck::run(Run& run) {
    Metrics metrics;
    const auto& images = run.in<Images>("images");
    const auto boards = run.find<ImageBoards>("image_boards");
    if (images.cameras.empty())
        run.note({"intrinsics to check", "the scene has no image", "", "see the source's notes"});
    for (const CameraImage& image : images.cameras) {
        run.check_cancelled();
        if (!check_pinhole(image, metrics)) continue;
        check_distortion(image, scene_name(run.frame()), metrics);
        if (boards) check_straightness(image, *boards, run, metrics);
    }
    run.write("metrics", std::move(metrics));
}

bool IntrinsicsCheck::check_pinhole(const CameraImage& image, Metrics& metrics) const {
    const auto& camera = image.camera;
    const auto find = [&](Level level, const std::string& reason) {
        metrics.findings.push_back({level, who(image) + reason});
    };
    bool finite = std::isfinite(camera.cx()) && std::isfinite(camera.cy());
    for (const double coefficient : camera.dist) finite = finite && std::isfinite(coefficient);
    if (!finite || !(camera.fx() > 0.0) || !(camera.fy() > 0.0)) {
        find(Level::not_usable,
             printed("its intrinsics are no camera (fx %.6g, fy %.6g, cx %.6g, cy %.6g); calibrate "
                     "it, and give the source its intrinsics",
                     camera.fx(), camera.fy(), camera.cx(), camera.cy()));
        return false;
    }
    const double width = static_cast<double>(image.image.getWidth());
    const double height = static_cast<double>(image.image.getHeight());
    if (camera.ncols != image.image.getWidth() || camera.nrows != image.image.getHeight()) {
        find(Level::not_usable,
             printed("its intrinsics are for images of %u x %u px, but this one has %.0f x %.0f; "
                     "give the intrinsics of this size (a resized image scales fx, fy, cx, cy)",
                     static_cast<unsigned>(camera.ncols), static_cast<unsigned>(camera.nrows),
                     width, height));
        return false;
    }
    const double aside = std::abs(camera.cx() - 0.5 * (width - 1.0));
    const double above = std::abs(camera.cy() - 0.5 * (height - 1.0));
    const std::string point =
        printed("its principal point (%.1f, %.1f) lies ", camera.cx(), camera.cy());
    if (aside > 0.5 * width || above > 0.5 * height) {
        find(Level::not_usable,
             point + printed("outside the image of %.0f x %.0f px; the intrinsics are of another "
                             "size, or cx and cy are exchanged",
                             width, height));
    } else if (aside > p_.centre_share * width || above > p_.centre_share * height) {
        find(Level::weak,
             point + printed("%.0f and %.0f px from the middle of the image; unless it is a crop, "
                             "the intrinsics are of another size, or badly calibrated",
                             aside, above));
    }
    return true;
}

void IntrinsicsCheck::check_distortion(const CameraImage& image, const std::string& scene,
                                       Metrics& metrics) const {
    const auto fold = fold_inside_image(CameraModel(image.camera));
    if (!fold) return;
    const std::string name = "intrinsics." + image.label + ".";
    metrics.values.push_back({name + "fold_px", fold->fold_px, "px", scene});
    metrics.values.push_back({name + "corner_px", fold->corner_px, "px", scene});
    metrics.findings.push_back(
        {Level::weak,
         who(image) +
             printed("its distortion turns back %.0f px from the principal point, but a corner of "
                     "the image lies %.0f px away; calibrate with views that reach the corners, or "
                     "with fewer coefficients",
                     fold->fold_px, fold->corner_px)});
}

void IntrinsicsCheck::check_straightness(const CameraImage& image, const ImageBoards& boards,
                                         Run& run, Metrics& metrics) {
    const CameraModel model(image.camera);
    StraightnessSum sum;
    for (const ImageBoard& board : boards.boards)
        if (board.camera == image.label)
            sum.add(model, board, targets_.find(board.target, run).corners());
    const Straightness straight = sum.result();
    if (straight.count == 0) return;
    const std::string name = "intrinsics." + image.label + ".";
    const std::string scene = scene_name(run.frame());
    metrics.values.push_back({name + "bend_px", straight.rms_px, "px", scene});
    metrics.values.push_back({name + "bend_expected_px", straight.expected_px, "px", scene});
    if (straight.rms_px <= p_.min_bend_px ||
        straight.rms_px <= p_.sigmas * std::max(straight.expected_px, kLeastExpected))
        return;
    metrics.findings.push_back(
        {Level::weak,
         scene + ": " + who(image) +
             printed("the boards' edges are bent by %.2f px RMS after undistortion, where noise "
                     "makes %.2f; the distortion coefficients are not this camera's (or the board "
                     "is bent)",
                     straight.rms_px, straight.expected_px)});
}

}  // namespace petal
