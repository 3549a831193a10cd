// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/rawlog/rawlog_reader.hpp"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationStereoImages.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <cctype>
#include <utility>

#include "mrpt_message.hpp"
#include "petal/error.hpp"
#include "rawlog_class.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;

/// The class name in an object's header: a byte (0x80 + length), then the name. Empty where the
/// bytes are no such header. (Rawlogs from before 2008 have a header without the 0x80; MRPT reads
/// them, this names them not.)
std::string class_in_header(const std::string& head) {
    if (head.empty()) return {};
    const auto first = static_cast<unsigned char>(head[0]);
    const std::size_t length = first & 0x7FU;
    if ((first & 0x80U) == 0 || length == 0 || head.size() < length + 1) return {};
    std::string name = head.substr(1, length);
    for (const char c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != ':' && c != '_' && c != '<' &&
            c != '>' && c != ',' && c != ' ')
            return {};
    return name;
}

/// MRPT tells of a class that it does not know, also inside another object, only in its message.
std::string unknown_class(const std::string& message) {
    const std::size_t end = message.find("' which is not registered");
    if (end == std::string::npos || end == 0) return {};
    const std::size_t begin = message.rfind('\'', end - 1);
    return begin == std::string::npos ? std::string() : message.substr(begin + 1, end - begin - 1);
}

/// MRPT's words on a version of a known class that it does not know; empty where there are none.
std::string unknown_version(const std::string& message) {
    const std::size_t found = message.find("unknown serialization version");
    return found == std::string::npos ? std::string()
                                      : message.substr(found, message.find('\n', found) - found);
}

}  // namespace

RawlogReader::RawlogReader(fs::path file) : file_(std::move(file)), stream_(file_) {}

void RawlogReader::fail(const std::string& what) const {
    throw Error("rawlog " + file_.string() + ": " + what + (what.back() == '?' ? " " : ". ") +
                std::to_string(objects_) + " objects (" + std::to_string(stream_.object_begin()) +
                " bytes, uncompressed) were read whole before");
}

void RawlogReader::fail_foreign(const std::string& name) const {
    fail("a " + name + " at byte " + std::to_string(stream_.object_begin()) +
         " is neither observation, action nor sensory frame");
}

mrpt::obs::CObservation::Ptr RawlogReader::next() {
    while (pending_.empty()) {
        const auto object = next_object();
        if (!object) return nullptr;
        if (auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object))
            return observation;
        if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))
            for (const auto& each : *frame)
                if (each) pending_.push_back(each);
    }
    mrpt::obs::CObservation::Ptr observation = std::move(pending_.front());
    pending_.pop_front();
    return observation;
}

mrpt::serialization::CSerializable::Ptr RawlogReader::next_object() {
    while (true) {
        stream_.begin_object();
        if (stream_.at_end()) {
            if (!stream_.failure().empty()) fail(stream_.failure() + "; copy the file again");
            return nullptr;
        }
        if (auto object = read_object()) return object;
    }
}

mrpt::serialization::CSerializable::Ptr RawlogReader::read_object() {
    mrpt::serialization::CSerializable::Ptr object;
    try {
        auto archive = mrpt::serialization::archiveFrom(stream_);
        object = archive.ReadObject();
    } catch (const std::exception& e) {
        const std::string name = class_in_header(stream_.head());
        const std::string unknown = unknown_class(e.what());
        const std::string where = (name.empty() ? std::string("the object") : name) +
                                  " that begins at byte " + std::to_string(stream_.object_begin());
        if (objects_ == 0 && name.empty() && (!stream_.compressed() || stream_.failure().empty()))
            fail("it does not begin with an MRPT object; is it a rawlog?");
        const auto* known = mrpt::rtti::findRegisteredClass(name);
        if (known != nullptr && !stands_in_rawlogs(*known)) fail_foreign(known->className);
        if (!stream_.failure().empty())
            fail("it breaks inside " + where + ": " + stream_.failure() + "; copy the file again");
        if (!unknown.empty())
            fail("class " + unknown + " (in " + where +
                 ") is not known to this MRPT; a newer one wrote it. Convert it there to a class "
                 "that MRPT 2.5 has");
        if (const std::string version = unknown_version(e.what()); !version.empty())
            fail(where + " is not known to this MRPT in its version (" + version +
                 "); a newer MRPT wrote it, or the file is damaged");
        fail("it is damaged inside " + where + " (" + mrpt_message(e.what()) +
             "); copy the file again");
    }
    if (object && !stands_in_rawlogs(*object->GetRuntimeClass()))
        fail_foreign(object->GetRuntimeClass()->className);
    ++objects_;
    return object;
}

fs::path RawlogReader::find_external(const std::string& name, const std::string& label) const {
    const fs::path given = name;
    const fs::path folder = file_.parent_path();
    const std::string stem = file_.stem().string();
    std::error_code ignored;
    std::string tried;
    for (const fs::path& base :
         {folder / (stem + "_Images"), folder / (stem + "_images"), folder / "Images", folder}) {
        const fs::path candidate = given.is_absolute() ? given : base / given;
        if (fs::is_regular_file(candidate, ignored)) return fs::absolute(candidate);
        tried += (tried.empty() ? "" : ", ") + candidate.string();
        if (given.is_absolute()) break;
    }
    throw Error("rawlog " + file_.string() + ": sensor '" + label + "' keeps its data in '" + name +
                "', which is not there (looked for " + tried +
                "); put the file back beside the rawlog");
}

void RawlogReader::load_image(mrpt::img::CImage& image, const std::string& label) {
    if (!image.isExternallyStored()) return;
    const fs::path file = find_external(image.getExternalStorageFile(), label);
    // Into a new image: MRPT would look in one folder for the whole process.
    mrpt::img::CImage loaded;
    if (!loaded.loadFromFile(file.string()))
        throw Error("image " + file.string() + " of sensor '" + label + "' cannot be decoded");
    image = loaded;
    external_files_.push_back(file);
}

void RawlogReader::load(mrpt::obs::CObservation& observation) {
    using namespace mrpt::obs;
    const std::string& label = observation.sensorLabel;
    try {
        if (auto* image = dynamic_cast<CObservationImage*>(&observation))
            load_image(image->image, label);
        if (auto* stereo = dynamic_cast<CObservationStereoImages*>(&observation))
            for (auto* image : {&stereo->imageLeft, &stereo->imageRight, &stereo->imageDisparity})
                load_image(*image, label);
        if (auto* range = dynamic_cast<CObservation3DRangeScan*>(&observation))
            for (auto* image : {&range->intensityImage, &range->confidenceImage})
                load_image(*image, label);
        if (auto* cloud = dynamic_cast<CObservationPointCloud*>(&observation)) {
            if (cloud->isExternallyStored() && !cloud->pointcloud) {
                const fs::path file = find_external(cloud->getExternalStorageFile(), label);
                using Format = CObservationPointCloud::ExternalStorageFormat;
                // MRPT does not tell the format; only its own carries the class of the map.
                const std::string ending = file.extension().string();
                const Format format = ending == ".bin"   ? Format::KittiBinFile
                                      : ending == ".txt" ? Format::PlainTextFile
                                                         : Format::MRPT_Serialization;
                cloud->overrideExternalStorageFormatFlag(Format::None);
                cloud->setAsExternalStorage(file.string(), format);
                cloud->load();
                cloud->overrideExternalStorageFormatFlag(Format::None);
                external_files_.push_back(file);
            }
            if (!cloud->pointcloud)
                throw Error("rawlog " + file_.string() + ": a cloud of sensor '" + label +
                            "' holds no points map");
        }
        if (const auto* range = dynamic_cast<const CObservation3DRangeScan*>(&observation);
            range != nullptr &&
            (range->points3D_isExternallyStored() || range->rangeImage_isExternallyStored()))
            throw Error("rawlog " + file_.string() + ": sensor '" + label +
                        "' keeps its range images in files of their own, which is not read; put "
                        "them into the rawlog with `rawlog-edit --de-externalize`");
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {
        throw Error("rawlog " + file_.string() + ": the data of sensor '" + label +
                    "' cannot be loaded: " + mrpt_message(e.what()));
    }
}

}  // namespace petal
