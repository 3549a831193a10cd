// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <array>

#include "petal/html/escape.hpp"
#include "petal/html/plots.hpp"
#include "petal/printed.hpp"
#include "sinks/detail/report_sections.hpp"

namespace petal {

using html::Traced;
using Section = html::Page::Section;
using ReportJson = nlohmann::ordered_json;

namespace {

std::string member(const std::string& list, std::size_t index) {
    return list + "/" + std::to_string(index);
}

/// The five numbers there as boxes along both axes; none where they are missing.
void add_boxes(const Traced& result, const std::string& from, const std::string& label,
               std::vector<html::Box>& boxes) {
    int tone = 0;
    for (const char* axis : {"u", "v"}) {
        const std::string place = from + "/" + axis + "_px";
        const ReportJson& five = result.at(place);
        if (five.is_array() && five.size() == 5 && five[0].is_number())
            boxes.push_back({label, axis, five.get<std::array<double, 5>>(), tone, place});
        ++tone;
    }
}

/// How many boards of a scene were seen by both sensors, or by one alone.
struct BoardCounts {
    std::size_t both = 0, lidar = 0, camera = 0;

    explicit BoardCounts(const ReportJson& boards) {
        for (const ReportJson& board : boards) {
            const bool by_lidar = !board.at("corners_lidar").is_null();
            const bool by_camera = !board.at("corners_image").is_null();
            both += by_lidar && by_camera ? 1 : 0;
            lidar += by_lidar && !by_camera ? 1 : 0;
            camera += by_camera && !by_lidar ? 1 : 0;
        }
    }
};

/// What one camera's solver says of each scene.
std::string influence_table(const Traced& result, const std::string& camera) {
    const std::string list = camera + "/scenes";
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < result.at(list).size(); ++i) {
        const std::string scene = member(list, i);
        const bool alone = result.at(scene + "/shift_sigmas").is_null();
        rows.push_back(
            {result.text(scene + "/scene"), result.number(scene + "/influence", {100.0, 0, "%"}),
             result.number(scene + "/chi2", {1.0, 1}),
             result.number(scene + "/degrees_of_freedom", {1.0, 0}),
             alone ? "no pose without it" : result.number(scene + "/shift_sigmas", {1.0, 1}),
             result.at(scene + "/outlier") == true ? "contradicts the others" : "fits"});
    }
    if (rows.empty()) return {};
    const std::string name = result.at(camera + "/camera").get<std::string>();
    return html::table(
        "What each scene does to the pose of " + name,
        {"scene", "share", "chi-square", "of", "result moves without it, sigmas", ""}, rows,
        {0, 5});
}

std::string picture_html(const ReportJpeg& picture, const std::string& words) {
    return "<img width=\"" + std::to_string(picture.width) + "\" height=\"" +
           std::to_string(picture.height) + "\" alt=\"" + html::escape(words) +
           "\" src=\"data:image/jpeg;base64," + html::base64(picture.bytes) + "\">";
}

}  // namespace

Section residual_section(const Traced& result) {
    std::vector<html::Box> boxes;
    add_boxes(result, "/residuals", "all", boxes);
    const ReportJson& cameras = result.at("/residuals/per_camera");
    if (cameras.size() > 1)
        for (std::size_t i = 0; i < cameras.size(); ++i)
            add_boxes(result, member("/residuals/per_camera", i),
                      cameras[i].at("camera").get<std::string>(), boxes);
    const ReportJson& scenes = result.at("/residuals/per_scene");
    if (scenes.size() > 1)
        for (std::size_t i = 0; i < scenes.size(); ++i)
            add_boxes(result, member("/residuals/per_scene", i),
                      scenes[i].at("scene").get<std::string>(), boxes);
    if (boxes.empty())
        return {"residuals", "Residuals",
                "<p>There are no pairs of corners, so no residuals.</p>\n"};
    std::string text =
        "<p>Where corners were seen, less where the pose puts them: u to the right, v down. A box "
        "holds the middle half, its line is the median, the ends are the smallest and the largest. "
        "A box that lies off zero is an error that its corners have in common.</p>\n" +
        html::box_plot({"Residuals by axis and scene", "px"}, boxes, true) + "<p>In all " +
        result.number("/residuals/count", {1.0, 0}) + " corners: RMS " +
        result.number("/residuals/rms_px", {1.0, 3, "px"}) + ", mean " +
        result.number("/residuals/mean_px", {1.0, 3, "px"}) + ", largest " +
        result.number("/residuals/max_px", {1.0, 3, "px"}) +
        " (of the distance). Small residuals alone prove little: see how sure the pose is.</p>\n";
    return {"residuals", "Residuals", text};
}

Section scene_section(const Traced& result) {
    const ReportJson& scenes = result.at("/scenes");
    const ReportJson& residuals = result.at("/residuals/per_scene");
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const std::string scene = member("/scenes", i);
        const BoardCounts boards(scenes[i].at("boards"));
        std::vector<std::string> row{result.text(scene + "/name"),
                                     Traced::count(scene + "/boards", "both", boards.both),
                                     Traced::count(scene + "/boards", "lidar", boards.lidar),
                                     Traced::count(scene + "/boards", "camera", boards.camera)};
        std::size_t r = 0;
        while (r < residuals.size() && residuals[r].at("scene") != scenes[i].at("name")) ++r;
        const std::string its = member("/residuals/per_scene", r);
        row.push_back(r < residuals.size() ? result.number(its + "/count", {1.0, 0}) : "none");
        row.push_back(r < residuals.size() ? result.number(its + "/rms_px", {1.0, 3}) : "");
        rows.push_back(std::move(row));
    }
    if (rows.empty()) return {"scenes", "Scenes", "<p>No board was looked for in any scene.</p>\n"};
    std::string text = html::table(
        "Boards that were found, and what is left at their corners",
        {"scene", "boards of both", "LiDAR alone", "camera alone", "corners", "RMS, px"}, rows);
    for (std::size_t i = 0; i < result.at("/extrinsics").size(); ++i)
        text += influence_table(result, member("/extrinsics", i));
    return {"scenes", "Scenes", text};
}

Section metric_section(const Traced& result) {
    std::vector<std::vector<std::string>> totals;
    for (const auto& [name, value] : result.at("/metrics").items())
        totals.push_back({"<code>" + html::escape(name) + "</code>",
                          result.general("/metrics/" + html::pointer_part(name))});
    const ReportJson& per_scene = result.at("/metrics_per_scene");
    std::vector<std::string> head{"metric"};
    std::vector<std::string> names;  // in the order in which scenes first have them
    for (const auto& [scene, metrics] : per_scene.items()) {
        head.push_back(html::escape(scene));
        for (const auto& [name, value] : metrics.items())
            if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    std::vector<std::vector<std::string>> rows;
    for (const std::string& name : names) {
        std::vector<std::string> row{"<code>" + html::escape(name) + "</code>"};
        for (const auto& [scene, metrics] : per_scene.items())
            row.push_back(metrics.contains(name)
                              ? result.general("/metrics_per_scene/" + html::pointer_part(scene) +
                                               "/" + html::pointer_part(name))
                              : "");
        rows.push_back(std::move(row));
    }
    if (totals.empty() && rows.empty())
        return {"metrics", "Checks and metrics", "<p>No metric was wired to the report.</p>\n"};
    std::string text =
        "<p class=\"soft\">Metres and radians unless a name says its unit. What speaks "
        "against the result stands among the reasons of the verdict.</p>\n";
    if (!totals.empty()) text += html::table("In total", {"metric", "value"}, totals);
    if (!rows.empty())
        text += "<details><summary>By scene</summary>\n" + html::table("By scene", head, rows) +
                "</details>\n";
    return {"metrics", "Checks and metrics", text};
}

Section photo_section(const Traced& result, const std::vector<ReportPicture>& pictures,
                      double residual_scale) {
    if (pictures.empty()) return {"photos", "Photos", "<p>No photo was wired to the report.</p>\n"};
    std::string text =
        "<p><span class=\"mark green\">Green crosses</span>: corners found in the photo. <span "
        "class=\"mark red\">Red circles</span>: the LiDAR's corners, put there by the pose. <span "
        "class=\"mark yellow\">Yellow lines</span>: residuals, " +
        printed("%g", residual_scale) +
        " times as long. Points of the LiDAR are red where near and blue where far.</p>\n";
    for (const ReportPicture& picture : pictures) {
        const std::string scene = picture.scene_from.empty()
                                      ? html::escape(picture.scene)
                                      : result.text(picture.scene_from + "/name");
        const std::string words = "Photo of " + picture.camera + ", scene " + picture.scene;
        text += "<figure class=\"photo\">\n<figcaption>" + scene + ", " +
                html::escape(picture.camera) +
                (picture.solved ? "" : ": no pose of this camera, so only what it found itself") +
                "</figcaption>\n" + picture_html(picture.photo, words) + "\n";
        if (!picture.boards.empty()) text += "<div class=\"boards\">\n";
        for (const ReportJpeg& board : picture.boards)
            text += picture_html(board, words + ": a board, enlarged") + "\n";
        if (!picture.boards.empty()) text += "</div>\n";
        text += "</figure>\n";
    }
    return {"photos", "Photos", text};
}

Section view_section(const ReportJson& view) {
    const auto number = [&view](const char* key) {
        const std::string value = view.at(key).dump();
        std::string grouped = value;  // 3 967 099, by narrow spaces that do not break
        for (std::size_t at = value.size(); at > 3;) grouped.insert(at -= 3, "\u202f");
        return "<data value=\"" + value + "\" data-view=\"/" + key + "\">" + grouped + "</data>";
    };
    const std::string text =
        "<p>" + number("shown") + " of " + number("of") +
        " points, drawn by lot, with the photo's colours where a camera sees them and grey where "
        "none does. Orange: the boards' corners as the LiDAR measured them. Axes of the sensors: x "
        "red, y green, z blue.</p>\n<div id=\"view3d\"><p class=\"soft\" id=\"view-message\">The "
        "3D "
        "view needs scripts and WebGL, and this browser shows one of them not. All else on this "
        "page is here without it.</p></div>\n<script type=\"application/json\" id=\"view-data\">" +
        html::json_for_script(view.dump(-1, ' ', false, ReportJson::error_handler_t::replace)) +
        "</script>\n";
    return {"space", "In space", text};
}

}  // namespace petal
