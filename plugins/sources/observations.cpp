// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/observations.hpp"

#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <system_error>
#include <utility>

#include "petal/error.hpp"
#include "petal/rawlog/sensor_label.hpp"

namespace petal {
namespace {

/// The class without MRPT's name space: "CObservationImage".
std::string short_class(const mrpt::obs::CObservation& observation) {
    const std::string name = observation.GetRuntimeClass()->className;
    return name.substr(name.rfind(':') + 1);
}

bool keeps_other_files(const mrpt::obs::CObservation& observation) {
    // A cloud without a points map passes too, which RawlogReader::load() refuses.
    const auto* cloud = dynamic_cast<const mrpt::obs::CObservationPointCloud*>(&observation);
    return cloud == nullptr || cloud->isExternallyStored();
}

/// A file that is not there is told when it is opened.
std::uint64_t bytes_of(const std::vector<std::filesystem::path>& files) {
    std::uint64_t sum = 0;
    for (const auto& file : files) {
        std::error_code error;
        const std::uint64_t size = std::filesystem::file_size(file, error);
        if (!error) sum += size;
    }
    return sum;
}

}  // namespace

void ObservationsSource::describe(Spec<Params>& spec) {
    spec.summary("Reads the observations of MRPT rawlogs one by one, as a stream.");
    spec.doc(R"(Each observation is a frame of its own, in the order of the files: named after its
sensor's label, with its stamp (0 where it has none). Both rawlog layouts are read, compressed or
not. Memory is that of a few observations, however long the log.

**Actions and sensory frames** go along with the observations, so `sink.rawlog` writes the layout
that was read. With `labels` or `classes` the observations that fit come alone, and the actions
are left out; the notes tell how many. So are the actions of a log without any observation.

`labels` and `classes` are exact or shell patterns (`LIDAR*`, `CObservation*Scan`); an observation
must fit one of each list that is not empty. A pattern that fits nothing ends the run with a list
of what is there. Classes go without their name space.

**Data in files of their own** (images, clouds) are looked for in `<stem>_Images`,
`<stem>_images`, `Images` and beside the rawlog, and put into the observation, so that what is
written from here needs no other file. Range images in files of their own are not read.

A damaged or truncated rawlog ends the run, with what was read whole and where it broke, as with
`source.rawlog`.)");
    spec.writes<Observation>("observation", "one observation, as it stands in the rawlog");
    spec.param("files", &Params::files).doc("rawlogs, one after the other");
    spec.param("labels", &Params::labels).doc("sensor labels or shell patterns; empty: all");
    spec.param("classes", &Params::classes)
        .doc("classes or shell patterns, e.g. CObservationImage; empty: all");
    spec.check([](const Params& p) {
        return p.files.empty() ? "files is empty; name at least one rawlog" : "";
    });
}

bool ObservationsSource::takes(const mrpt::obs::CObservation& observation) {
    const std::string name = short_class(observation);
    sensors_.insert("'" + observation.sensorLabel + "' (" + name + ")");
    const auto fits = [this](const std::vector<std::string>& patterns, const std::string& text) {
        bool any = patterns.empty();
        for (const std::string& pattern : patterns)
            if (label_fits(pattern, text)) {
                any = true;
                fitted_.insert(pattern);
            }
        return any;
    };
    const bool label = fits(params_.labels, observation.sensorLabel);
    return fits(params_.classes, name) && label;
}

void ObservationsSource::add(const mrpt::obs::CObservation::Ptr& observation, Run& run) {
    if (!takes(*observation)) return;
    if (keeps_other_files(*observation)) {
        const std::size_t before = reader_->external_files().size();
        reader_->load(*observation);
        for (std::size_t i = before; i < reader_->external_files().size(); ++i)
            run.used_file(reader_->external_files()[i]);
    }
    ready_.push_back(Observation{observation});
    ready_.back().place.before = std::move(loose_);
    loose_.clear();
}

void ObservationsSource::add_frame(const mrpt::serialization::CSerializable::Ptr& object,
                                   Run& run) {
    const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object);
    const std::size_t before = ready_.size();
    if (frame)
        for (const auto& each : *frame)
            if (each) add(each, run);
    if (selects()) {
        if (!frame) ++left_out_;
        return;
    }
    for (std::size_t i = before; i < ready_.size(); ++i) {
        ready_[i].place.in_frame = true;
        ready_[i].place.ends_frame = i + 1 == ready_.size();
    }
    if (ready_.size() == before) loose_.push_back(object);  // an action, or an empty frame
}

void ObservationsSource::keep_the_rest() {
    if (!ready_.empty())
        ready_.back().place.after = std::move(loose_);
    else
        left_out_ += loose_.size();  // there was no observation at all
    loose_.clear();
}

bool ObservationsSource::advance(Run& run) {
    run.check_cancelled();
    if (!reader_) {
        if (next_file_ == params_.files.size()) {
            if (!loose_.empty()) keep_the_rest();
            return false;
        }
        if (next_file_ == 0) bytes_ = bytes_of(params_.files);
        const std::filesystem::path& file = params_.files[next_file_++];
        reader_ = std::make_unique<RawlogReader>(file);
        run.used_file(file);
    }
    const auto object = reader_->next_object();
    if (!object) {
        bytes_done_ += reader_->stream().file_size();
        reader_.reset();
    } else if (const auto one = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object)) {
        add(one, run);
    } else {
        add_frame(object, run);
    }
    return true;
}

void ObservationsSource::tell_progress(Run& run) {
    const std::uint64_t done = bytes_done_ + (reader_ ? reader_->stream().file_position() : 0);
    run.progress(static_cast<double>(done), static_cast<double>(bytes_), "B");
}

void ObservationsSource::emit(Run& run) {
    Observation next = std::move(ready_.front());
    ready_.pop_front();
    const auto stamp = next.observation->timestamp;
    run.set_frame(next.observation->sensorLabel,
                  stamp == mrpt::Clock::time_point{} ? 0.0 : mrpt::Clock::toDouble(stamp));
    run.write("observation", std::move(next));
    ++emitted_;
    tell_progress(run);
}

void ObservationsSource::tell(Run& run) {
    std::string there;
    for (const std::string& sensor : sensors_) there += (there.empty() ? "" : ", ") + sensor;
    if (there.empty()) there = "none";
    for (const auto* patterns : {&params_.labels, &params_.classes})
        for (const std::string& pattern : *patterns)
            if (fitted_.count(pattern) == 0)
                throw Error("no observation fits '" + pattern + "' in " +
                            (patterns == &params_.labels ? "labels" : "classes") +
                            "; there are: " + there);
    if (left_out_ > 0)
        run.note({"observations",
                  std::to_string(left_out_) +
                      (selects() ? " actions are left out, the observations that were chosen "
                                   "come alone"
                                 : " actions are left out: there is no observation to go with"),
                  "", ""});
    if (emitted_ == 0)
        run.note({"observations",
                  sensors_.empty() ? "there is none"
                                   : "none fits both labels and classes; there are: " + there,
                  "", "`rawlog-edit --info -i FILE` tells what a rawlog holds"});
}

void ObservationsSource::run(Run& run) {
    while (ready_.size() < 2 && advance(run)) {
    }
    if (!ready_.empty()) return emit(run);
    tell(run);
    run.end_of_data();
}

}  // namespace petal
