// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/export.hpp"

#include <algorithm>
#include <map>
#include <string_view>

#include "petal/calibration/estimated_focal.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/file_name.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/same_projection.hpp"
#include "petal/output.hpp"
#include "sinks/detail/export_format.hpp"
#include "sinks/detail/findings.hpp"

namespace petal {
namespace {

struct ExportFormat {
    const char* name;
    const char* stem;
    const char* extension;
    ExportText (*text)(const ExportInput&);
    bool one_camera;  ///< a file a camera
};

constexpr ExportFormat kFormats[] = {
    {"ros1", "static_transforms", ".launch", export_ros1, false},
    {"ros2", "static_transforms", ".launch.xml", export_ros2, false},
    {"autoware", "sensor_kit_calibration", ".yaml", export_autoware, false},
    {"kalibr", "camchain", ".yaml", export_kalibr, false},
    {"fast_livo2", "fast_livo2", ".yaml", export_fast_livo2, true},
    {"opencv", "opencv", ".yaml", export_opencv, false},
    {"mrpt", "mrpt", ".ini", export_mrpt, false},
};

std::vector<std::string> format_names() {
    std::vector<std::string> names;
    for (const ExportFormat& format : kFormats) names.emplace_back(format.name);
    return names;
}

/// A label as a part of a frame's name, which has no blanks and quotes in ROS.
std::string frame_part(std::string label) {
    for (char& c : label)
        if (std::string_view(" \t\r\n\"'\\").find(c) != std::string_view::npos) c = '_';
    return label;
}

std::string with_labels(std::string text, const CameraExtrinsics& camera) {
    const std::pair<std::string, std::string> words[] = {{"{camera}", frame_part(camera.camera)},
                                                         {"{lidar}", frame_part(camera.lidar)}};
    for (const auto& [word, label] : words)
        for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos;
             at += label.size())
            text.replace(at, word.size(), label);
    return text;
}

bool is_camera(const mrpt::img::TCamera& model) {
    return model.fx() > 0.0 && model.fy() > 0.0 && model.ncols > 0 && model.nrows > 0;
}

/// The intrinsics that the images bring, by label.
std::map<std::string, mrpt::img::TCamera> models_of(const Run& run) {
    std::map<std::string, mrpt::img::TCamera> models;
    for (const auto& scene : run.all<Images>("images"))
        for (const CameraImage& image : scene->cameras) {
            const auto [known, added] = models.emplace(image.label, image.camera);
            if (!added && !same_projection(known->second, image.camera))
                throw Error("camera '" + image.label + "' has other intrinsics in scene '" +
                            scene.frame.name + "' than before; export from one of them");
        }
    return models;
}

/// Those of the solver, which hold an estimated focal length; else those of the images, with it.
std::optional<mrpt::img::TCamera> model_of(
    const CameraExtrinsics& solved, const std::map<std::string, mrpt::img::TCamera>& models) {
    if (is_camera(solved.model)) return solved.model;
    const auto found = models.find(solved.camera);
    if (found == models.end() || !is_camera(found->second)) return std::nullopt;
    return with_estimated_focal(found->second, solved);
}

/// Of all packets together, lowered by what checks found.
Extrinsics gathered(const Run& run) {
    Extrinsics all;
    all.level = Level::usable;
    for (const auto& packet : run.all<Extrinsics>("extrinsics")) {
        all.cameras.insert(all.cameras.end(), packet->cameras.begin(), packet->cameras.end());
        lower(all, {packet->level, packet->reasons});
    }
    ResultInput checks;
    checks.metrics = run.all<Metrics>("metrics");
    checks.lidar_boards = run.all<LidarBoards>("lidar_boards");
    checks.image_boards = run.all<ImageBoards>("image_boards");
    lower(all, found_by_checks(checks));
    return all;
}

void write_format(const ExportFormat& format, const ExportInput& input, Run& run) {
    const auto write = [&](const ExportInput& part, const std::string& stem) {
        const ExportText made = format.text(part);
        run.output("export/" + stem + format.extension,
                   [&made](const std::filesystem::path& file) { write_file(file, made.text); });
        for (const std::string& what : made.left_out)
            run.note({"what " + std::string(format.name) + " can tell", what, "", ""});
    };
    if (!format.one_camera || input.cameras.size() == 1) return write(input, format.stem);
    for (const ExportCamera& camera : input.cameras) {
        ExportInput alone = input;
        alone.cameras = {camera};
        write(alone, std::string(format.stem) + "_" + file_name(camera.camera) + "_" +
                         file_name(camera.lidar));
    }
}

}  // namespace

void Export::describe(Spec<Params>& s) {
    s.summary("Writes the extrinsics in the formats of other programs.");
    s.doc(R"(One file a format, below `export/` in the run folder:

| format | file | what it holds |
|---|---|---|
| `ros1` | `static_transforms.launch` | `tf2_ros static_transform_publisher`, quaternion x y z w, parent, child |
| `ros2` | `static_transforms.launch.xml` | the same with `--x` ... `--frame-id` ... `--child-frame-id` |
| `autoware` | `sensor_kit_calibration.yaml` | x y z roll pitch yaw below parent and child; the camera's body frame `<camera>/camera_link` |
| `kalibr` | `camchain.yaml` | `cam0`, ...: intrinsics, `T_cam_lidar`, `T_cn_cnm1` |
| `fast_livo2` | `fast_livo2.yaml` (of several cameras one each) | `Rcl`, `Pcl`, the camera block |
| `opencv` | `opencv.yaml` | `cv::FileStorage`: both matrices, `rvec`, `tvec`, `camera_matrix` |
| `mrpt` | `mrpt.ini` | poses for `CPose3D::FromString` both ways, the camera for `TCamera::loadFromConfigFile` |

Each file tells at its head, in comments, which frames are meant, **both** directions as translation and quaternion, and the verdict with its reasons where it is
not usable. A camera's frame is the optical one (x right, y down, z forward) but for Autoware, whose `camera_link` is x forward, y left, z
up. Numbers have nine decimals: nanometres.

In a static transform, p_parent = R p_child + t: with `parent` lidar it is `T_lidar_camera`. A frame may have one parent alone, so several cameras go
below their LiDAR.

The intrinsics are those of the solver; a result read from a file has none, so wire `images` beside it. A format whose model cannot hold them (a k3 in
Kalibr and FAST-LIVO2) leaves them out and says so in the file and in a note. What metrics and detectors found lowers the verdict as in `sink.result`, if it is wired.)");
    s.gathers<Extrinsics>("extrinsics", "what a solver found, or source.result read");
    s.gathers<Images>("images", "intrinsics, where the extrinsics bring none").optional();
    s.gathers<Metrics>("metrics", "for their findings").optional();
    s.gathers<LidarBoards>("lidar_boards", "for their findings").optional();
    s.gathers<ImageBoards>("image_boards", "for their findings").optional();
    s.param("formats", &Params::formats).choices(format_names()).doc("what to write");
    s.param("parent", &Params::parent)
        .choices({"lidar", "camera"})
        .doc("whose frame is the parent, in ROS and Autoware");
    s.param("camera_frame", &Params::camera_frame)
        .doc(
            "name of the camera's optical frame; {camera} and {lidar} are the labels, with _ for "
            "blanks and quotes");
    s.param("lidar_frame", &Params::lidar_frame).doc("name of the LiDAR's frame; likewise");
}

void Export::finish(Run& run) {
    const Extrinsics solved = gathered(run);
    const auto models = models_of(run);
    ExportInput input{{}, solved.level, solved.reasons, params_.parent == "lidar"};
    for (const CameraExtrinsics& camera : solved.cameras) {
        if (!camera.T_camera_lidar.matrix().allFinite())
            throw Error("the pose of camera '" + camera.camera +
                        "' is no number: there is nothing to export");
        input.cameras.push_back({camera.camera, camera.lidar,
                                 with_labels(params_.camera_frame, camera),
                                 with_labels(params_.lidar_frame, camera), camera.T_camera_lidar,
                                 model_of(camera, models)});
    }
    if (input.cameras.empty()) {
        run.verdict(Level::not_usable, {"there are no extrinsics to export"});
        return run.note({"extrinsics to export", "no camera was solved", "",
                         "see why in the reasons of the result"});
    }
    run.verdict(solved.level,
                solved.level == Level::usable
                    ? std::vector<std::string>{}
                    : std::vector<std::string>{std::string("what is exported is ") +
                                               to_string(solved.level) +
                                               "; the reasons stand at the head of each file"});
    for (const ExportFormat& format : kFormats)
        if (std::find(params_.formats.begin(), params_.formats.end(), format.name) !=
            params_.formats.end())
            write_format(format, input, run);
}

}  // namespace petal
