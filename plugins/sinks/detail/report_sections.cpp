// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/report_sections.hpp"

#include "petal/html/escape.hpp"
#include "sinks/detail/report_words.hpp"

namespace petal {

using html::NumberStyle;
using html::Traced;
using Section = html::Page::Section;

namespace {

const NumberStyle kMillimetres{1000.0, 1, "mm"};
const NumberStyle kDegreeStyle{1.0, 3, "deg"};

std::string in_row(const std::string& pointer, std::size_t index) {
    return pointer + "/" + std::to_string(index);
}

/// The largest of the three numbers there.
std::string largest(const Traced& result, const std::string& pointer, const NumberStyle& style) {
    std::size_t most = 0;
    const auto& list = result.at(pointer);
    for (std::size_t i = 1; i < list.size(); ++i)
        if (list[i].is_number() && list[most].is_number() && list[i] > list[most]) most = i;
    return result.number(in_row(pointer, most), style);
}

std::string matrix_html(const Traced& result, const std::string& pointer, const std::string& name,
                        const std::string& words) {
    std::string text = "<div class=\"keep\"><h3><code>" + name + "</code></h3><p class=\"soft\">" +
                       words +
                       "</p><div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"" +
                       name + "\"><table class=\"matrix\"><tbody>\n";
    for (std::size_t r = 0; r < 4; ++r) {
        text += "<tr>";
        for (std::size_t c = 0; c < 4; ++c)
            text += "<td>" + result.number(in_row(in_row(pointer, r), c), {1.0, r < 3 ? 6 : 0}) +
                    "</td>";
        text += "</tr>\n";
    }
    return text + "</tbody></table></div><p data-copy=\"" + pointer + "\"></p></div>\n";
}

std::string sigma_table(const Traced& result, const std::string& camera) {
    const bool considered = result.at(camera + "/considered").is_object();
    std::vector<std::string> head{"camera's axis", "shift, mm"};
    if (considered) head.emplace_back("with doubt, mm");
    head.emplace_back("turn, deg");
    if (considered) head.emplace_back("with doubt, deg");
    const char* const axes[] = {"x, right", "y, down", "z, forward"};
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < 3; ++i) {
        std::vector<std::string> row{axes[i]};
        for (const char* kind : {"/sigma_translation_m", "/sigma_rotation_deg"}) {
            const bool shift = kind[7] == 't';
            const NumberStyle style = shift ? NumberStyle{1000.0, 2} : NumberStyle{1.0, 3};
            row.push_back(result.number(in_row(camera + kind, i), style));
            if (considered)
                row.push_back(result.number(in_row(camera + "/considered" + kind, i), style));
        }
        rows.push_back(std::move(row));
    }
    return html::table("1 sigma: two of three errors are smaller", head, rows);
}

std::string drift_table(const Traced& result, const std::string& camera) {
    const auto& drifts = result.at(camera + "/drift_px");
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < drifts.size(); ++i) {
        const std::string drift = in_row(camera + "/drift_px", i);
        rows.push_back({result.number(drift + "/range_m", {1.0, 0, "m"}),
                        result.number(drift + "/sigma_px", {1.0, 2}),
                        result.number(drift + "/considered_px", {1.0, 2})});
    }
    if (rows.empty()) return {};
    return html::table("What that does to a pixel straight ahead, 1 sigma",
                       {"distance", "px", "with doubt, px"}, rows);
}

std::string focal_and_prior(const Traced& result, const std::string& camera) {
    std::string text;
    if (result.at(camera + "/focal").is_object()) {
        const bool estimated = result.at(camera + "/focal/estimated") == true;
        text += std::string("<p>") +
                (estimated ? "The focal length was estimated: it is "
                           : "Were the focal length free, it would be ") +
                result.number(camera + "/focal/scale", {1.0, 5}) + " of the given one (1 sigma " +
                result.number(camera + "/focal/sigma", {1.0, 5}) + ").</p>\n";
    }
    if (result.at(camera + "/prior").is_object())
        text += "<p>The result lies " + result.number(camera + "/prior/distance_m", kMillimetres) +
                " from the prior on the translation (" +
                result.number(camera + "/prior/distance_sigmas", {1.0, 1}) +
                " of its sigmas).</p>\n";
    return text;
}

std::string advice(const Traced& result, const std::string& camera) {
    if (!result.at(camera + "/advice").is_object()) return {};
    return "<p><strong>What would help most:</strong> " + result.text(camera + "/advice/sentence") +
           ". The largest 1 sigma goes from " +
           result.number(camera + "/advice/sigma_translation_before_m", {1000.0, 2}) + " to " +
           result.number(camera + "/advice/sigma_translation_after_m", {1000.0, 2, "mm"}) +
           " and from " + result.number(camera + "/advice/sigma_rotation_before_deg", {1.0, 3}) +
           " to " + result.number(camera + "/advice/sigma_rotation_after_deg", kDegreeStyle) +
           ".</p>\n";
}

/// A heading where there are several cameras.
std::string camera_heading(const Traced& result, const std::string& camera) {
    if (result.at("/extrinsics").size() < 2) return {};
    return "<h3>" + result.text(camera + "/camera") + "</h3>\n";
}

std::string for_cameras(const Traced& result,
                        std::string (*told)(const Traced&, const std::string&)) {
    std::string text;
    for (std::size_t i = 0; i < result.at("/extrinsics").size(); ++i) {
        const std::string camera = in_row("/extrinsics", i);
        text += camera_heading(result, camera) + told(result, camera);
    }
    return text.empty() ? "<p>No camera was solved, so there is nothing to tell here.</p>\n" : text;
}

}  // namespace

std::string report_header(const Traced& result) {
    const auto& cameras = result.at("/extrinsics");
    const std::string level = result.at("/verdict").get<std::string>();
    std::string text = "<h1>Calibration of camera and LiDAR</h1>\n<p><span class=\"badge " +
                       verdict_style(level) + "\">" + verdict_word(level) + "</span></p>\n";
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        const std::string camera = in_row("/extrinsics", i);
        text += "<p class=\"lead\">" + result.text(camera + "/camera") + " and " +
                result.text(camera + "/lidar") + ": " + result.text(camera + "/sentence") +
                ".</p>\n<p class=\"soft\">Known to " +
                largest(result, camera + "/sigma_translation_m", kMillimetres) + " and " +
                largest(result, camera + "/sigma_rotation_deg", kDegreeStyle) +
                " (largest 1 sigma along an axis).</p>\n";
    }
    if (cameras.empty()) text += "<p class=\"lead\">No pose was found.</p>\n";
    if (result.at("/residuals/count") != 0)
        text += "<p class=\"soft\">Corners miss by " +
                result.number("/residuals/rms_px", {1.0, 2, "px"}) + " (RMS of " +
                result.number("/residuals/count", {1.0, 0}) + " corners in " +
                Traced::count("/scenes", "members", result.at("/scenes").size()) +
                " scenes).</p>\n";
    return text;
}

Section verdict_section(const Traced& result) {
    const std::string level = result.at("/verdict").get<std::string>();
    std::string text = "<p>" + verdict_sentence(level) + "</p>\n";
    const auto& reasons = result.at("/reasons");
    if (reasons.empty()) {
        text += "<p>No check found anything that speaks against it.</p>\n";
    } else {
        text += "<ul>\n";
        for (std::size_t i = 0; i < reasons.size(); ++i)
            text += "<li>" + result.text(in_row("/reasons", i)) + "</li>\n";
        text += "</ul>\n";
    }
    if (result.at("/extrinsics").empty()) {
        text +=
            "<p>What the detectors looked for and how near they came stands among the notes of "
            "<code>run.json</code>.</p>\n";
    } else {
        const std::string by = result.at("/orientation/decided_by").get<std::string>();
        text += "<p>Which corner of the image is which of the LiDAR: " + order_sentence(by);
        if (result.at("/orientation/runner_up_rms_ratio") != 0.0)
            text += " The best other order has " +
                    result.number("/orientation/runner_up_rms_ratio", {1.0, 1}) +
                    " times the error.";
        text += "</p>\n";
    }
    for (std::size_t i = 0; i < result.at("/extrinsics").size(); ++i)
        text += advice(result, in_row("/extrinsics", i));
    return {"verdict", "Verdict", text};
}

Section pose_section(const Traced& result) {
    const std::string text = for_cameras(result, [](const Traced& from, const std::string& camera) {
        const std::string names = "<code>" + from.text(camera + "/camera") + "</code>";
        return "<p>In words: " + from.text(camera + "/sentence") +
               ".</p>\n<div class=\"columns\">\n" +
               matrix_html(from, camera + "/T_camera_lidar", "T_camera_lidar",
                           "Maps points of the LiDAR to " + names +
                               ": x right, y down, z forward; metres.") +
               matrix_html(from, camera + "/T_lidar_camera", "T_lidar_camera",
                           "Its inverse: maps points of " + names + " to the LiDAR.") +
               "</div>\n";
    });
    return {"pose", "Pose", text};
}

Section trust_section(const Traced& result) {
    std::string text =
        "<p class=\"soft\">From the noise and the LiDAR's range offset, intrinsics exact. With "
        "doubt: the same, were focal length and principal point known only as well as the solver's "
        "parameters say.</p>\n" +
        for_cameras(result, [](const Traced& from, const std::string& camera) {
            std::string told = "<div class=\"columns\">\n<div>" + sigma_table(from, camera) +
                               "</div>\n<div>" + drift_table(from, camera) + "</div>\n</div>\n";
            if (from.at(camera + "/weakest_direction") != "")
                told += "<p><strong>Weakest direction:</strong> " +
                        from.text(camera + "/weakest_direction") + ".</p>\n";
            told += "<p>Chi-square is " + from.number(camera + "/chi2", {1.0, 1}) + " for " +
                    from.number(camera + "/degrees_of_freedom", {1.0, 0}) + " degrees of freedom";
            if (from.at(camera + "/variance_scale").is_number())
                told += "; the variances are scaled by " +
                        from.number(camera + "/variance_scale", {1.0, 2});
            return told + ".</p>\n" + focal_and_prior(from, camera);
        });
    return {"trust", "How sure", text};
}

}  // namespace petal
