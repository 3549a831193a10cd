// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/calibrated_rawlog.hpp"

#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <functional>
#include <optional>
#include <set>

#include "petal/calibration/extrinsics.hpp"
#include "petal/rawlog/rawlog_reader.hpp"
#include "sinks/detail/rawlog_writer.hpp"
#include "sinks/detail/sensor_poses.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;
using mrpt::obs::CObservation;
using mrpt::obs::CSensoryFrame;
using mrpt::poses::CPose3D;

void each_observation(const mrpt::serialization::CSerializable::Ptr& object,
                      const std::function<void(const CObservation::Ptr&)>& visit) {
    if (const auto one = std::dynamic_pointer_cast<CObservation>(object)) return visit(one);
    if (const auto frame = std::dynamic_pointer_cast<CSensoryFrame>(object))
        for (const auto& each : *frame)
            if (each) visit(each);
}

CPose3D pose_of(const CObservation& observation) {
    CPose3D pose;
    observation.getSensorPose(pose);
    return pose;
}

/// Poses that differ by what writing them rounds.
bool same_pose(const CPose3D& a, const CPose3D& b) {
    constexpr double kRounding = 1e-9;
    return (a.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen() -
            b.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen())
               .cwiseAbs()
               .maxCoeff() < kRounding;
}

/// The pose of the first observation of that sensor: another one's may stand before it.
CPose3D reference_pose(const fs::path& file, const std::string& label, const Run& run) {
    RawlogReader reader(file);
    std::set<std::string> labels;
    while (const auto object = reader.next_object()) {
        run.check_cancelled();
        std::optional<CPose3D> pose;
        each_observation(object, [&](const CObservation::Ptr& each) {
            labels.insert("'" + each->sensorLabel + "'");
            if (!pose && each->sensorLabel == label) pose = pose_of(*each);
        });
        if (pose) return *pose;
    }
    std::string there;
    for (const std::string& each : labels) there += (there.empty() ? "" : ", ") + each;
    throw Error(file.string() + " has no observation of the reference sensor '" + label +
                "'; there are: " + (there.empty() ? "none" : there));
}

/// Copies one rawlog.
class CalibratedCopy {
   public:
    CalibratedCopy(const fs::path& from, const SensorPoses& poses, const CPose3D& vehicle)
        : reader_(from), poses_(poses), vehicle_(vehicle) {}

    bool compressed() const { return reader_.stream().compressed(); }

    void write(RawlogWriter& writer, Run& run) {
        while (const auto object = reader_.next_object()) {
            run.check_cancelled();
            write_object(object, writer);
        }
        for (const auto& file : reader_.external_files()) run.used_file(file);
        for (const auto& [label, pose] : poses_.others())
            if (set_.count(label) == 0)
                run.note({"observations of '" + label + "', to give them their pose",
                          reader_.file().string() + " has none", "", ""});
    }

   private:
    void write_object(const mrpt::serialization::CSerializable::Ptr& object, RawlogWriter& writer) {
        std::vector<CObservation::Ptr> all;
        each_observation(object, [&](const CObservation::Ptr& each) { all.push_back(each); });
        if (all.empty()) return writer.write_other(*object);  // an action, or an empty frame
        const bool in_frame = std::dynamic_pointer_cast<CSensoryFrame>(object) != nullptr;
        for (std::size_t i = 0; i < all.size(); ++i) {
            calibrate(*all[i]);
            Observation out{all[i]};
            out.place.in_frame = in_frame;
            out.place.ends_frame = in_frame && i + 1 == all.size();
            writer.write(out);
        }
    }

    void calibrate(CObservation& observation) {
        if (observation.sensorLabel == poses_.reference() &&
            !same_pose(pose_of(observation), vehicle_))
            throw Error("the pose of the reference sensor '" + poses_.reference() +
                        "' changes within " + reader_.file().string() +
                        "; take a sensor that stays where it is as the reference");
        const auto* cloud = dynamic_cast<const mrpt::obs::CObservationPointCloud*>(&observation);
        if (cloud == nullptr || cloud->isExternallyStored()) reader_.load(observation);
        poses_.apply(observation, vehicle_);
        set_.insert(observation.sensorLabel);
    }

    RawlogReader reader_;
    const SensorPoses& poses_;
    CPose3D vehicle_;
    std::set<std::string> set_;  ///< labels that were there
};

std::string output_name(std::string name, const fs::path& file) {
    const std::pair<std::string, std::string> words[] = {
        {"{stem}", file.stem().string()}, {"{folder}", file.parent_path().filename().string()}};
    for (const auto& [word, text] : words)
        for (std::size_t at = 0; (at = name.find(word, at)) != std::string::npos; at += text.size())
            name.replace(at, word.size(), text);
    return name;
}

}  // namespace

void CalibratedRawlog::describe(Spec<Params>& spec) {
    spec.summary("Writes copies of rawlogs with the sensor poses that a calibration found.");
    spec.doc(
        R"(The pose of the sensor `reference` on the vehicle stays what the rawlog says; every other sensor of the calibration gets the pose that
follows from it: with the LiDAR as the reference, pose(camera) = pose(LiDAR) + `T_lidar_camera`. MRPT's pose of a camera is that of the optical frame (x right, y
down, z forward). A focal length that was estimated with the pose (`focal` in result.json) goes into the `cameraParams` of the images.

Everything else is copied as it stands: both rawlog layouts, actions, other sensors, compressed or not as the input was. What observations keep in files of
their own is put in. The rawlog is read as a stream, so memory is that of one object; each copy gets its name when it is whole.

A reference that moves on the vehicle, or that the rawlog lacks, is an error; another sensor that it lacks is told in a note.)");
    spec.gathers<Extrinsics>("extrinsics", "what a solver found, or source.result read");
    spec.param("files", &Params::files).doc("rawlogs to copy");
    spec.param("reference", &Params::reference)
        .doc("label of the sensor whose pose stays; empty: the LiDAR");
    spec.param("file", &Params::file)
        .doc("path in the run folder; {stem} and {folder} are those of the rawlog");
    spec.param("compression", &Params::compression)
        .within(-1, 9)
        .doc(
            "of gzip: 0 none, 1 fastest, 9 smallest; -1: 1 where the rawlog is compressed, else 0");
    spec.check([](const Params& p) {
        return p.files.empty() ? "files is empty; name at least one rawlog" : "";
    });
    spec.check([](const Params& p) {
        return fs::path(p.file).filename().empty() ? "file is empty or names a folder" : "";
    });
}

void CalibratedRawlog::finish(Run& run) {
    std::vector<CameraExtrinsics> cameras;
    Level level = Level::usable;
    for (const auto& packet : run.all<Extrinsics>("extrinsics")) {
        cameras.insert(cameras.end(), packet->cameras.begin(), packet->cameras.end());
        level = std::max(level, packet->level);
    }
    if (cameras.empty()) {
        run.verdict(Level::not_usable, {"there are no extrinsics to put into a rawlog"});
        return run.note({"extrinsics for the rawlog", "no camera was solved", "",
                         "see why in the reasons of the result"});
    }
    for (const CameraExtrinsics& camera : cameras)
        if (!camera.T_camera_lidar.matrix().allFinite())
            throw Error("the pose of camera '" + camera.camera +
                        "' is no number: there is nothing to write");
    const SensorPoses poses(cameras, params_.reference);
    for (const fs::path& file : params_.files) {
        run.used_file(file);
        CalibratedCopy copy(file, poses, reference_pose(file, poses.reference(), run));
        const int automatic = copy.compressed() ? 1 : 0;
        RawlogWriter writer(run.output_path(output_name(params_.file, file)),
                            params_.compression < 0 ? automatic : params_.compression);
        copy.write(writer, run);
        writer.commit();
        run.log(LogLevel::info, writer.file().string() + ": " +
                                    std::to_string(writer.observations()) +
                                    " observations, reference '" + poses.reference() + "'");
    }
    run.verdict(level, level == Level::usable
                           ? std::vector<std::string>{}
                           : std::vector<std::string>{std::string("the poses in the rawlog are ") +
                                                      to_string(level)});
}

}  // namespace petal
