// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/simulator.hpp"

#include <utility>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/truth.hpp"
#include "sources/detail/simulated_packets.hpp"

namespace petal {

void SimulatorSource::describe(Spec<Params>& spec) {
    spec.summary("Simulates captures of a LiDAR and cameras, with the exact truth about them.");
    spec.doc(
        R"(A scene file tells what stands where and how it may vary; the run's seed draws the rest:
where within its tolerances the rig and the boards are, the clearance behind them, the device's
range offset, and all noise. What is modelled, and how, is told in docs/simulator.md; the format of
scene files, and those that petal ships, in docs/simulator_scenes.md.

The points come as a recorder would write them, in messages of 0.1 s, with intensity; of each
camera there are as many images as the scene file says (three, by default), spread over the
capture. `images` holds the one of each camera that `source.rawlog` would choose, and the others
beside it for `sink.rawlog`: a pipeline gives the same result on this stage as on a rawlog that
`sink.rawlog` made of it.

A file with several captures gives as many scenes, and they share one rig unless `rig` says `each`.
With `rig_seed` runs of different seeds share it too.

**Truth**: `T_camera_lidar` is that of the first camera, and so are the boards' corners in the
image; a board that does not lie whole in its image has none. With `motion` in the scene file the
rig moves; the truth is that of its beginning.)");
    spec.writes<Cloud>("cloud",
                       "the LiDAR's points, in the order of the pulses, with their messages");
    spec.writes<Images>("images", "one image a camera, and the others");
    spec.writes<Truth>("truth", "T_camera_lidar, the boards, and a label for each point");
    spec.param("scenes", &Params::scenes)
        .doc("scenes that petal ships, by name, or scene files; each of their captures is a scene");
    spec.param("lidar", &Params::lidar)
        .doc("a sensor that petal ships, by name, or a sensor file; empty: the scene file's");
    spec.param("duration", &Params::duration)
        .unit("s")
        .within(0.0, 3600.0)
        .doc("of each capture; 0: the scene file's");
    spec.param("rig", &Params::rig)
        .choices({"shared", "each"})
        .doc("shared: all scenes of a run have one rig; each: every scene has its own");
    spec.param("rig_seed", &Params::rig_seed)
        .at_least(-1)
        .doc("draws the rig alone, for runs that share one; -1: the run's seed");
    spec.param("image_choice", &Params::image_choice)
        .choices({"sharpest", "first", "last"})
        .doc("which of several images of one camera is taken");
    spec.check([](const Params& p) {
        if (p.scenes.empty()) return "scenes is empty; name at least one scene";
        if (p.rig == "each" && p.rig_seed >= 0)
            return "rig_seed gives all scenes one rig, but rig is 'each'; leave one of them out";
        return "";
    });
}

void SimulatorSource::open(Run& run) {
    for (const std::filesystem::path& scene : params_.scenes) {
        files_.push_back(simulation::SceneFile::load(scene));
        captures_ += files_.back().captures();
        for (const std::filesystem::path& file : files_.back().files()) run.used_file(file);
    }
}

std::string SimulatorSource::unique_name(const std::string& name) {
    std::string unique = name;
    for (int copy = 2; !names_.insert(unique).second; ++copy)
        unique = name + "_" + std::to_string(copy);
    return unique;
}

void SimulatorSource::run(Run& run) {
    if (files_.empty()) open(run);
    if (file_ == files_.size()) {
        run.end_of_data();
        return;
    }
    const simulation::SceneFile& file = files_[file_];
    // Drawn always, so that a rig_seed changes nothing but the rig.
    Rng rig_random(run.rng()());
    if (params_.rig_seed >= 0) rig_random.seed(static_cast<std::uint64_t>(params_.rig_seed));
    if (!rig_ || params_.rig == "each") rig_ = file.make_rig(params_.lidar, rig_random);

    simulation::Scene scene = file.make_scene(capture_, run.rng(), rig_->boards_seed);
    if (params_.duration > 0.0) scene.duration = params_.duration;
    if (++capture_ == file.captures()) {
        capture_ = 0;
        ++file_;
    }
    emit(run, scene);
    ++emitted_;
    run.progress(static_cast<double>(emitted_), static_cast<double>(captures_), "scenes");
}

void SimulatorSource::emit(Run& run, const simulation::Scene& scene) {
    SimulatedPackets packets = simulate_packets(scene, *rig_, emitted_, params_.image_choice, run);
    run.set_frame(unique_name(scene.name), packets.stamp);
    run.log(LogLevel::info,
            scene.name + ": " + std::to_string(packets.cloud.parts.size()) + " messages with " +
                std::to_string(packets.cloud.size()) + " points, " +
                std::to_string(packets.images.cameras.size() + packets.images.others.size()) +
                " images, " + std::to_string(scene.boards.size()) + " boards");
    run.write("cloud", std::move(packets.cloud));
    run.write("images", std::move(packets.images));
    run.write("truth", std::move(packets.truth));
}

}  // namespace petal
