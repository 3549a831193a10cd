// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <nlohmann/json.hpp>

#include "petal/calibration/angles.hpp"
#include "petal/printed.hpp"
#include "result_diff.hpp"

namespace petal {
namespace {

using Json = nlohmann::ordered_json;

/// In sigmas; a sigma of nothing is no measure.
std::string in_sigmas(double value, double sigma) {
    return sigma > 0.0 ? printed("%8.1f", value / sigma) : "       -";
}

std::string pose_table(const PoseDifference& pose) {
    const char axes[] = "xyz";
    std::string text = "camera '" + pose.camera + "', LiDAR '" + pose.lidar +
                       "': B less A, along and about the camera's axes (x right, y down, z "
                       "forward)\n                   difference     1 sigma   in sigmas\n";
    for (int i = 0; i < 3; ++i)
        text += printed("  translation %c %10.2f mm %8.2f mm  ", axes[i],
                        1000.0 * pose.translation[i], 1000.0 * pose.sigma_translation[i]) +
                in_sigmas(pose.translation[i], pose.sigma_translation[i]) + "\n";
    for (int i = 0; i < 3; ++i)
        text += printed("  rotation %c    %10.4f deg %7.4f deg ", axes[i],
                        kDegrees * pose.rotation[i], kDegrees * pose.sigma_rotation[i]) +
                in_sigmas(pose.rotation[i], pose.sigma_rotation[i]) + "\n";
    if (pose.mahalanobis_squared)
        text += printed("  all six together: chi-square %.1f with 6 degrees of freedom, p = %.2g\n",
                        *pose.mahalanobis_squared, pose.probability);
    else
        text += "  all six together: not known, the covariances cannot be inverted\n";
    if (pose.pixels.empty())
        return text + "  pixels: not known, the results hold no corners; give --focal\n";
    text += printed("  straight ahead (f = %.0f px):", pose.focal_px);
    for (std::size_t i = 0; i < pose.pixels.size(); ++i)
        text += printed("%s %.2f px at %.0f m (1 sigma %.2f px)", i > 0 ? "," : "",
                        pose.pixels[i].px, pose.pixels[i].range, pose.pixels[i].sigma_px);
    return text + "\n";
}

std::string side_text(const char* name, const ResultDifference::Side& side) {
    return std::string(name) + ": " + side.verdict +
           (side.reasons.empty()
                ? ""
                : ", for " + std::to_string(side.reasons.size()) + " reasons in its file") +
           "\n";
}

/// Those that both have, and how many others there are.
std::string figures_table(const std::vector<FigureDifference>& figures) {
    std::string rows;
    int only_a = 0, only_b = 0;
    std::size_t width = 28;
    for (const FigureDifference& figure : figures) width = std::max(width, figure.name.size());
    for (const FigureDifference& figure : figures) {
        if (!figure.b) ++only_a;
        if (!figure.a) ++only_b;
        if (figure.a && figure.b)
            rows += "  " + figure.name + std::string(width - figure.name.size(), ' ') +
                    printed("%14.6g %14.6g\n", *figure.a, *figure.b);
    }
    std::string text;
    if (!rows.empty())
        text = "\nfigures that differ" + std::string(width - 17, ' ') +
               "             A              B\n" + rows;
    if (only_a + only_b > 0)
        text +=
            printed("\n%d figures stand in A alone, %d in B alone: see --json\n", only_a, only_b);
    return text;
}

Json json_or_null(const std::optional<double>& value) {
    return value ? Json(*value) : Json();
}

Json three(const Eigen::Vector3d& v) {
    return Json{v.x(), v.y(), v.z()};
}

Json pose_json(const PoseDifference& pose) {
    Json pixels = Json::array();
    for (const PixelShift& shift : pose.pixels)
        pixels.push_back(
            {{"range_m", shift.range}, {"px", shift.px}, {"sigma_px", shift.sigma_px}});
    return {{"camera", pose.camera},
            {"lidar", pose.lidar},
            {"translation_mm", three(1000.0 * pose.translation)},
            {"sigma_translation_mm", three(1000.0 * pose.sigma_translation)},
            {"rotation_deg", three(kDegrees * pose.rotation)},
            {"sigma_rotation_deg", three(kDegrees * pose.sigma_rotation)},
            {"mahalanobis_squared", json_or_null(pose.mahalanobis_squared)},
            {"probability", pose.mahalanobis_squared ? Json(pose.probability) : Json()},
            {"focal_px", pose.focal_px > 0.0 ? Json(pose.focal_px) : Json()},
            {"straight_ahead", std::move(pixels)}};
}

}  // namespace

std::string difference_table(const ResultDifference& difference) {
    std::string text = side_text("A", difference.a) + side_text("B", difference.b);
    for (const PoseDifference& pose : difference.poses) text += "\n" + pose_table(pose);
    for (const std::string& sensors : difference.only_a) text += "\nonly A has " + sensors + "\n";
    for (const std::string& sensors : difference.only_b) text += "\nonly B has " + sensors + "\n";
    text += figures_table(difference.figures);
    return text + (difference.agree() ? "\nthey agree within what their covariances say\n"
                                      : "\nthey differ by more than their covariances say\n");
}

std::string difference_json(const ResultDifference& difference) {
    Json poses = Json::array(), figures = Json::object();
    for (const PoseDifference& pose : difference.poses) poses.push_back(pose_json(pose));
    for (const FigureDifference& figure : difference.figures)
        figures[figure.name] = {{"a", json_or_null(figure.a)}, {"b", json_or_null(figure.b)}};
    const auto side = [](const ResultDifference::Side& one) {
        return Json{{"verdict", one.verdict}, {"reasons", one.reasons}};
    };
    const Json root{{"petal_diff", 1},
                    {"agree", difference.agree()},
                    {"a", side(difference.a)},
                    {"b", side(difference.b)},
                    {"poses", std::move(poses)},
                    {"only_a", difference.only_a},
                    {"only_b", difference.only_b},
                    {"figures", std::move(figures)}};
    return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace petal
