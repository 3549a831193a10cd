// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/rawlog.hpp"

#include <algorithm>
#include <utility>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/truth.hpp"
#include "petal/calibration/truth_json.hpp"
#include "petal/rawlog/sensor_label.hpp"
#include "sources/detail/scene_name.hpp"

namespace petal {

namespace fs = std::filesystem;

namespace {

// Enough that neither side waits for the other at each message; each may be a whole scene.
constexpr std::size_t kReadAhead = 4;

}  // namespace

void RawlogSource::describe(Spec<Params>& spec) {
    spec.summary("Reads scenes from MRPT rawlogs: one LiDAR's points and an image of each camera.");
    spec.doc(
        R"(One file is one scene, unless `split` says otherwise: `gap` begins a new scene
where an observation's stamp is more than `gap` seconds after the latest before it. Both rawlog
layouts (observations only; actions and sensory frames) are read, compressed or not, as a stream:
memory is that of one scene.

**LiDAR**: all observations of one label are accumulated, in the sensor's own frame (its pose on
the vehicle is recorded, not applied): `CObservationPointCloud` with any points map,
`CObservation3DRangeScan`, `CObservationVelodyneScan`, `CObservation2DRangeScan`, and a flat
`CObservationRotatingScan`. One with rows is refused where it is the chosen LiDAR: MRPT 2.5 keeps
neither a row's elevation nor a column's azimuth. Intensity is kept where there is
one: as it is from a `CPointsMapXYZI`, divided by 255 where it is a byte. The label is given
exactly or as a shell pattern that fits one label; by default it is the only LiDAR there is, and
with several the run ends with the list of them. A rawlog without a LiDAR gives an empty cloud and
a note, unless a label was asked for.

**Cameras**: `CObservationImage` with its `cameraParams`, all labels by default. Of several images
of one camera the sharpest is taken, by the variance of the Laplacian; the first, one of the middle and the last
are kept beside it, for checks that ask whether anything moved (detectors pass over them). Images in files of their
own are looked for in `<stem>_Images`, `<stem>_images`, `Images` and beside the rawlog. An image
of another size than its intrinsics' ends the run.

**Truth**: a `truth.json` in the rawlog's folder, with `labels.u8`, one byte a point in rawlog
order; else empty. It is that of one scene, so it is left out where `split` is on.

MRPT takes a rawlog that was cut off, or is damaged, for one that ends. Here the run ends with
what was read whole and where it broke: at the gzip trailer or behind it, inside which object, at a
count that cannot be true, or at a class that this MRPT does not know. `petal inspect` shows what a
rawlog holds, also one that breaks. A file without compression that was cut off exactly between two
objects cannot be told from a whole one.

A scene is named after its file's stem, or after the folder where the stem is `scene`; split
scenes are numbered.)");
    spec.writes<Cloud>("cloud", "the LiDAR's points, in rawlog order, with their messages");
    spec.writes<Images>("images", "one image a camera, ordered by label");
    spec.writes<Truth>("truth", "what is known of a simulated scene; empty for real data");
    spec.param("files", &Params::files).doc("rawlogs, a scene each unless split");
    spec.param("lidar", &Params::lidar)
        .doc("sensor label or shell pattern; empty: the only LiDAR there is");
    spec.param("cameras", &Params::cameras).doc("sensor labels or shell patterns; empty: all");
    spec.param("image_choice", &Params::image_choice)
        .choices({"sharpest", "first", "last"})
        .doc("which of several images of one camera is taken");
    spec.param("split", &Params::split)
        .choices({"none", "gap"})
        .doc("none: a file is a scene; gap: a pause begins a new scene");
    spec.param("gap", &Params::gap)
        .unit("s")
        .within(0.001, 86400.0)
        .doc("the pause, for split gap");
    spec.check([](const Params& p) {
        return p.files.empty() ? "files is empty; name at least one rawlog" : "";
    });
}

void RawlogSource::open(Run& run) {
    const fs::path& file = params_.files[next_file_++];
    reader_ = std::make_unique<RawlogReadAhead>(file, run.threads() > 1 ? kReadAhead : 0);
    run.used_file(file);
    sensors_ = {};
    held_ = nullptr;
    latest_ = std::nullopt;
    scenes_of_file_ = 0;
}

bool RawlogSource::begins_scene(const mrpt::obs::CObservation& observation) {
    if (params_.split != "gap" || observation.timestamp == mrpt::Clock::time_point{}) return false;
    const double stamp = mrpt::Clock::toDouble(observation.timestamp);
    const bool begins = latest_ && stamp - *latest_ > params_.gap;
    latest_ = begins || !latest_ ? stamp : std::max(stamp, *latest_);
    return begins;
}

void RawlogSource::list_rest(const Run& run) {
    while (const auto observation = reader_->next()) {
        run.check_cancelled();
        sensors_.add(*observation);
    }
}

/// Ends the run where the choice of sensors does not fit those of the file (all are listed).
void RawlogSource::check_sensors() const {
    const std::string there = "; in " + reader_->file().string() + " there are: " + sensors_.text();
    std::size_t fitting = 0;
    for (const std::string& label : sensors_.lidars())
        if (params_.lidar.empty() || label_fits(params_.lidar, label)) ++fitting;
    if (fitting > 1)
        throw Error((params_.lidar.empty() ? std::string("there are several LiDARs")
                                           : "lidar '" + params_.lidar + "' fits several LiDARs") +
                    ", name one of them with lidar" + there);
    if (fitting == 0 && !params_.lidar.empty())
        throw Error("no LiDAR is called '" + params_.lidar + "'" + there);
    for (const std::string& pattern : params_.cameras)
        if (std::none_of(sensors_.cameras().begin(), sensors_.cameras().end(),
                         [&](const std::string& label) { return label_fits(pattern, label); }))
            throw Error("no camera is called '" + pattern + "'" + there);
    if (sensors_.lidars().empty() && sensors_.cameras().empty())
        throw Error("the rawlog has neither a LiDAR nor a camera" + there);
}

bool RawlogSource::read_scene(Run& run, SceneBuilder& scene) {
    const auto load = [&](mrpt::obs::CObservation& observation) {
        const std::size_t before = reader_->external_files().size();
        reader_->load(observation);
        for (std::size_t i = before; i < reader_->external_files().size(); ++i)
            run.used_file(reader_->external_files()[i]);
    };
    if (held_) scene.add(std::exchange(held_, nullptr), load);
    while (auto observation = reader_->next()) {
        run.check_cancelled();
        sensors_.add(*observation);
        std::size_t fitting = 0;
        for (const std::string& label : sensors_.lidars())
            if (params_.lidar.empty() || label_fits(params_.lidar, label)) ++fitting;
        if (fitting > 1) {
            list_rest(run);
            check_sensors();
        }
        if (begins_scene(*observation) && !scene.empty()) {
            held_ = std::move(observation);
            return true;
        }
        scene.add(observation, load);
    }
    check_sensors();
    return false;
}

std::string RawlogSource::name_scene(bool whole_file) {
    const fs::path& file = reader_->file();
    const std::string stem = file.stem().string();
    std::string base = stem == "scene" ? scene_name(file) : stem;
    if (!whole_file) base += "_" + std::to_string(scenes_of_file_);
    std::string name = base;
    for (int copy = 2; !names_.insert(name).second; ++copy)
        name = base + "_" + std::to_string(copy);
    return name;
}

void RawlogSource::emit(Run& run, SceneBuilder& scene, bool whole_file) {
    run.set_frame(name_scene(whole_file), scene.stamp());
    Cloud cloud = scene.take_cloud();
    Images images = scene.take_images();
    const std::string file = reader_->file().string();
    for (const std::string& remark : scene.remarks())
        run.log(LogLevel::warning, file + ": " + remark);
    run.log(LogLevel::info, file + ": " + std::to_string(cloud.parts.size()) + " messages of '" +
                                cloud.sensor_label + "' with " + std::to_string(cloud.size()) +
                                " points, " + std::to_string(images.cameras.size()) + " images");
    if (cloud.size() == 0)
        run.note({"LiDAR points in " + file,
                  cloud.parts.empty() ? "no LiDAR; there are: " + sensors_.text()
                                      : "all messages of the LiDAR are empty",
                  "", "`petal inspect FILE` tells what a rawlog holds"});
    Truth truth;
    if (whole_file) {
        const fs::path folder = fs::absolute(reader_->file()).parent_path();
        truth = read_truth(folder, cloud.size());
        for (const char* name : {"truth.json", "labels.u8"})
            if (!truth.empty() && fs::exists(folder / name)) run.used_file(folder / name);
    }
    run.write("cloud", std::move(cloud));
    run.write("images", std::move(images));
    run.write("truth", std::move(truth));
}

void RawlogSource::run(Run& run) {
    while (reader_ || next_file_ < params_.files.size()) {
        if (!reader_) open(run);
        SceneBuilder scene({params_.lidar, params_.cameras, params_.image_choice});
        const bool more = read_scene(run, scene);
        const bool has_scene = !scene.empty();
        if (has_scene) {
            ++scenes_of_file_;
            emit(run, scene, params_.split == "none");
        }
        if (!more) reader_.reset();
        if (has_scene) return;
    }
    run.end_of_data();
}

}  // namespace petal
