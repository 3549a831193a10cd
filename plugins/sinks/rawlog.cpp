// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/rawlog.hpp"

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/observation.hpp"
#include "petal/calibration/truth.hpp"
#include "petal/calibration/truth_json.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;
constexpr const char* kScene = "{scene}";

/// The frame's name as part of a path.
std::string scene_text(const FrameInfo& frame) {
    std::string name = frame.name;
    for (char& c : name)
        if (c == '/' || c == '\\') c = '_';
    return name.empty() || name == "." || name == ".." ? "scene_" + std::to_string(frame.number)
                                                       : name;
}

}  // namespace

void RawlogSink::describe(Spec<Params>& spec) {
    spec.summary("Writes scenes, or single observations, to an MRPT rawlog in the run folder.");
    spec.doc(R"(Wire either `cloud` and `images` (one or both, and `truth` where there is one),
or `observation`. Of a scene, each message of the cloud becomes a `CObservationPointCloud` with a
`CPointsMapXYZI`, each image a `CObservationImage` with its `cameraParams`; label, stamp and
sensor pose go with them, ordered by stamp. A filtered cloud has no messages any more: it is
written as one, with the scene's stamp. Observations are written as they come, in the layout that
they come from (`source.observations`): on their own, or in sensory frames with the actions between
them. What they keep in files of their own is put in.

`source.rawlog` reads from the file what was wired here: points and intensities bit by bit, stamps
to the tick (100 ns), pixels without loss (MRPT would pack colour as JPEG only if a switch of the
whole process asked for it; then this stage refuses to write), intrinsics. Sensor poses go through
MRPT's quaternion, so they may differ by rounding.

All scenes go into one file, unless `file` holds `{scene}`, for which the scene's name is put in:
then each has a file of its own. A truth that is not empty is written beside the rawlog, as
`truth.json` and `labels.u8`. It is that of one scene, so a second one in the same file is an
error.

The file is compressed with gzip, written as a stream, and gets its name when it is whole.
`rawlog-edit` and other MRPT programs open it.)");
    spec.reads<Cloud>("cloud", "points to write").optional();
    spec.reads<Images>("images", "images to write").optional();
    spec.reads<Truth>("truth", "what is known of the scene").optional();
    spec.reads<Observation>("observation", "an observation to write, in place of a scene")
        .optional();
    spec.param("file", &Params::file).doc("path in the run folder; {scene} is the scene's name");
    spec.param("compression", &Params::compression)
        .within(0, 9)
        .doc("of gzip: 0 none, 1 fastest, 9 smallest");
    spec.check([](const Params& p) {
        return fs::path(p.file).filename().empty() ? "file is empty or names a folder" : "";
    });
}

bool RawlogSink::each_scene() const {
    return params_.file.find(kScene) != std::string::npos;
}

void RawlogSink::write_truth(Run& run, const std::string& name) {
    const auto truth = run.find<Truth>("truth");
    if (!truth || truth->empty()) return;
    if (!truth_of_.empty())
        throw Error("scenes '" + truth_of_ + "' and '" + scene_text(run.frame()) +
                    "' both have a truth, but truth.json is that of one scene; give each a file "
                    "of its own, e.g. file \"{scene}/scene.rawlog\"");
    truth_of_ = scene_text(run.frame());
    const auto cloud = run.find<Cloud>("cloud");
    if (!truth->labels.empty() && cloud && cloud->size() != truth->labels.size())
        throw Error("the truth labels " + std::to_string(truth->labels.size()) +
                    " points, but the cloud to write has " + std::to_string(cloud->size()) +
                    "; wire the scene's own cloud, not a filtered one");
    const fs::path folder = fs::path(name).parent_path();
    run.output((folder / "truth.json").string(),
               [&](const fs::path& file) { write_truth_json(*truth, file); });
    if (!truth->labels.empty())
        run.output((folder / "labels.u8").string(),
                   [&](const fs::path& file) { write_truth_labels(*truth, file); });
}

void RawlogSink::write_scene(Run& run, const std::string& name) {
    const auto cloud = run.find<Cloud>("cloud");
    const auto images = run.find<Images>("images");
    writer_->write_scene(cloud.get(), images.get(), run.frame().stamp);
    write_truth(run, name);
}

void RawlogSink::run(Run& run) {
    const bool scene = run.wired("cloud") || run.wired("images");
    const bool single = run.wired("observation");
    if (scene == single || (single && run.wired("truth")))
        throw Error("wire either observation, or cloud and images (one or both, truth with them)");
    if (single && each_scene())
        throw Error("file holds {scene}, but observations are of no scene; name one file");
    std::string name = params_.file;
    for (std::size_t at = 0; (at = name.find(kScene, at)) != std::string::npos;) {
        const std::string text = scene_text(run.frame());
        name.replace(at, std::string(kScene).size(), text);
        at += text.size();
    }
    if (!writer_)
        writer_ = std::make_unique<RawlogWriter>(run.output_path(name), params_.compression);
    if (single)
        writer_->write(run.in<Observation>("observation"));
    else
        write_scene(run, name);
    if (each_scene()) {
        close(run);
        truth_of_.clear();
    }
}

void RawlogSink::close(Run& run) {
    writer_->commit();
    run.log(LogLevel::info, writer_->file().string() + ": " +
                                std::to_string(writer_->observations()) + " observations");
    writer_.reset();
}

void RawlogSink::finish(Run& run) {
    if (writer_) close(run);
}

}  // namespace petal
