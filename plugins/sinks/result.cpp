// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/result.hpp"

#include "petal/calibration/boards.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/output.hpp"
#include "sinks/detail/findings.hpp"
#include "sinks/detail/result_json.hpp"

namespace petal {

void ResultSink::describe(Spec<Params>& s) {
    s.summary(
        "Writes the extrinsics with their uncertainty, verdict, residuals and boards as "
        "result.json.");
    s.doc(
        "Metres and radians unless a key says `_deg`, `_mm` or `_px`. `T_camera_lidar` maps LiDAR "
        "to camera: "
        "p_camera = R p_lidar + t, camera x right, y down, z forward; `T_lidar_camera` is its "
        "inverse.\n\n"
        "`covariance` is that of (rho, phi) in T = Exp((rho, phi)) T_estimated, order rho x y z "
        "(m), phi x y z "
        "(rad). `sigma_translation_m` is that of the fourth column of T, `sigma_rotation_deg` "
        "about the camera's "
        "axes.\n\n"
        "The corners of a board stand row by row from the top left as the camera sees it; a board "
        "that only one "
        "sensor sees has `null` for the other. `orientation.decided_by` is `data` or `prior`; "
        "`given` where the "
        "input itself paired the points, `undecided` where nothing could tell (the verdict is then "
        "`not_usable`).\n\n"
        "The verdict is the solver's, lowered by what checks found: a finding of a metric brings "
        "its "
        "level, one of a board detector makes the result weak at most. Their words follow the "
        "solver's among `reasons`; the run is told the same verdict, so its exit code agrees.\n\n"
        "`residuals` are measured less projected, raw pixels: `u_px` and `v_px` are the smallest, "
        "lower "
        "quartile, median, upper quartile and largest along each axis of the image, in total, by "
        "camera and by scene.\n\n"
        "The same seed and data give the same bytes, so the file holds no time and no path.");
    s.reads<Extrinsics>("extrinsics", "what a solver found");
    s.gathers<Correspondences>("correspondences", "the pairs of all scenes, for the boards")
        .optional();
    s.gathers<LidarBoards>("lidar_boards", "also the boards that no camera saw").optional();
    s.gathers<ImageBoards>("image_boards", "also the boards that the LiDAR did not see").optional();
    s.gathers<Metrics>("metrics", "figures to tell beside, from one or more metrics").optional();
    s.param("file", &Params::file).doc("name in the run folder");
}

void ResultSink::finish(Run& run) {
    ResultInput input;
    input.extrinsics = run.in_ptr<Extrinsics>("extrinsics");
    input.correspondences = run.all<Correspondences>("correspondences");
    input.lidar_boards = run.all<LidarBoards>("lidar_boards");
    input.image_boards = run.all<ImageBoards>("image_boards");
    input.metrics = run.all<Metrics>("metrics");
    const Judgement found = judge(input);
    // The solver told its own level and reasons already: here come those of the checks alone.
    if (!found.reasons.empty()) run.verdict(found.level, found.reasons);
    const std::string text = result_json(input);
    run.output(params_.file.string(),
               [&text](const std::filesystem::path& path) { write_file(path, text); });
    for (const CameraExtrinsics& camera : input.extrinsics->cameras)
        run.log(LogLevel::info, camera.camera + ": " + placement_sentence(camera.T_camera_lidar));
}

}  // namespace petal
