// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/report.hpp"

#include <tbb/parallel_invoke.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "petal/calibration/for_pieces.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/html/escape.hpp"
#include "petal/html/page.hpp"
#include "petal/html/traced.hpp"
#include "petal/output.hpp"
#include "petal_report_files.hpp"
#include "sinks/detail/findings.hpp"
#include "sinks/detail/report_pictures.hpp"
#include "sinks/detail/report_sections.hpp"
#include "sinks/detail/report_view.hpp"
#include "sinks/detail/result_json.hpp"
#include "sinks/detail/scene_view.hpp"

namespace petal {

namespace {

/// The scenes of result.json stand in the order of their frame numbers.
ScenePlaces places_in_result(const ResultInput& input) {
    std::set<std::uint64_t> numbers;
    for (const auto& packet : input.correspondences)
        for (const CameraPairs& pairs : packet->cameras) numbers.insert(pairs.scene);
    for (const auto& packet : input.lidar_boards) numbers.insert(packet.frame.number);
    for (const auto& packet : input.image_boards) numbers.insert(packet.frame.number);
    ScenePlaces places;
    for (const std::uint64_t number : numbers) places.emplace(number, places.size());
    return places;
}

std::map<std::uint64_t, std::shared_ptr<const Cloud>> clouds_by_scene(
    const std::vector<Packet<Cloud>>& packets) {
    std::map<std::uint64_t, std::shared_ptr<const Cloud>> clouds;
    for (const auto& packet : packets) clouds[packet.frame.number] = packet.value;
    return clouds;
}

}  // namespace

void Report::describe(Spec<Params>& s) {
    s.summary(
        "Writes a calibration as one HTML page: verdict, pose, trust, plots, photos, 3D view.");
    s.doc(
        R"(One file that opens from disk and asks for nothing else. It holds the verdict with its reasons, the pose in
words and as a matrix in both directions, both uncertainties and what they do in pixels, the weakest direction, advice,
box plots of the residuals by axis (Figure 8 of the letter), what each scene does to the pose, the metrics, the photos with what was found
drawn on them, each board enlarged, and a 3D view of the coloured cloud with boards and sensors. Without extrinsics it says why, and
shows what was found. docs/report.md tells more.

Every figure is made from the text of `result.json` for the same inputs, which the page holds, and names the place there that it comes
from. Wire the same ports as those of `sink.result`, or the two will tell different things. Findings lower the verdict as they do there;
the run is told by `sink.result` alone.

The 3D view shows `view_points` at most of `cloud`, over all scenes, drawn by lot with the run's seed, and says how many of how many. A
point has the photo's colour where it projects into one and no other point that is shown hides it (nearest depth in cells of some
pixels). `edges` are the points that are drawn on the photos, best those of a filter that leaves edges; without it points of `cloud`.

The same inputs and seed give the same bytes. The clouds of all scenes are held until the end of the run.)");
    s.reads<Extrinsics>("extrinsics", "what a solver found");
    s.gathers<Images>("images", "the photos").optional();
    s.gathers<Cloud>("cloud", "points of the 3D view, in the LiDAR frame").optional();
    s.gathers<Cloud>("edges", "points to draw on the photos").optional();
    s.gathers<Correspondences>("correspondences", "the pairs of all scenes").optional();
    s.gathers<LidarBoards>("lidar_boards", "boards found by the LiDAR").optional();
    s.gathers<ImageBoards>("image_boards", "boards found in the photos").optional();
    s.gathers<Metrics>("metrics", "figures and findings, from one or more metrics").optional();
    s.param("file", &Params::file).doc("name in the run folder");
    s.param("view_points", &Params::view_points)
        .within(0, 2000000)
        .doc("points of the 3D view, over all scenes; 12 bytes of the page each");
    s.param("picture_width", &Params::picture_width)
        .within(160, 10000)
        .doc("wider photos are shrunk to so many pixels");
    s.param("picture_points", &Params::picture_points)
        .within(0, 10000000)
        .doc("points drawn on a photo at most");
    s.param("residual_scale", &Params::residual_scale)
        .unit("1")
        .within(0.0, 1000.0)
        .doc("residuals are drawn that many times as long as they are");
}

void Report::finish(Run& run) {
    ResultInput input;
    input.extrinsics = run.in_ptr<Extrinsics>("extrinsics");
    input.correspondences = run.all<Correspondences>("correspondences");
    input.lidar_boards = run.all<LidarBoards>("lidar_boards");
    input.image_boards = run.all<ImageBoards>("image_boards");
    input.metrics = run.all<Metrics>("metrics");
    judge(input);
    const Extrinsics& extrinsics = *input.extrinsics;
    const auto scenes = scenes_of(run, input.correspondences);
    const ScenePlaces places = places_in_result(input);

    PictureSettings settings;
    settings.width = params_.picture_width;
    settings.max_points = static_cast<std::size_t>(params_.picture_points);
    settings.residual_scale = params_.residual_scale;
    const auto edges = clouds_by_scene(run.all<Cloud>("edges"));
    const bool has_view = run.wired("cloud");
    const ViewPoints view_lots =
        has_view ? view_points(run.rng(), scenes, static_cast<std::size_t>(params_.view_points))
                 : ViewPoints();

    std::vector<ReportPicture> pictures;
    html::Page::Section view;
    on_run_threads(run, [&] {
        tbb::parallel_invoke(
            [&] { pictures = report_pictures(run, extrinsics, scenes, places, edges, settings); },
            [&] {
                if (has_view)
                    view = view_section(report_view(run, extrinsics, scenes, places, view_lots));
            });
    });

    html::Page page;
    page.document = result_json(input);
    page.document_name = "result.json";
    const auto document = nlohmann::ordered_json::parse(page.document);
    const html::Traced result(document);
    page.title = "Calibration of camera and LiDAR: " + document.at("verdict").get<std::string>();
    page.header = report_header(result);
    page.sections = {verdict_section(result), pose_section(result)};
    if (!extrinsics.cameras.empty()) {
        page.sections.push_back(trust_section(result));
        page.sections.push_back(residual_section(result));
    }
    if (has_view) {
        page.sections.push_back(std::move(view));
        page.scripts = {kThreeScript, kViewScript};
    }
    page.sections.push_back(photo_section(result, pictures, params_.residual_scale));
    page.sections.push_back(scene_section(result));
    page.sections.push_back(metric_section(result));
    page.style = kReportStyle;
    page.footer = "<p>Written by petal, sink.report.</p>\n";
    if (!page.scripts.empty())
        page.footer +=
            "<details class=\"screen\"><summary>The 3D view uses three.js</summary><pre "
            "tabindex=\"0\">" +
            html::escape(kThreeNotice) + "</pre></details>\n";
    const std::string text = html::page_text(page);
    run.output(params_.file.string(),
               [&text](const std::filesystem::path& path) { write_file(path, text); });
}

}  // namespace petal
