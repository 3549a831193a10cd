// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/rawlog_writer.hpp"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <vector>

#include "petal/error.hpp"

namespace petal {
namespace {

/// The same pixels in memory that MRPT serialises as they are: not a reference to a file, rows
/// without gaps.
mrpt::img::CImage plain_image(const mrpt::img::CImage& image) {
    const auto pixels = image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
    return mrpt::img::CImage(
        pixels, pixels.isContinuous() ? mrpt::img::SHALLOW_COPY : mrpt::img::DEEP_COPY);
}

mrpt::maps::CPointsMapXYZI::Ptr copy_points(const mrpt::maps::CPointsMapXYZI& from,
                                            std::size_t begin, std::size_t end) {
    auto points = mrpt::maps::CPointsMapXYZI::Create();
    points->reserve(end - begin);
    const auto& xs = from.getPointsBufferRef_x();
    const auto& ys = from.getPointsBufferRef_y();
    const auto& zs = from.getPointsBufferRef_z();
    for (std::size_t i = begin; i < end; ++i) {
        points->insertPointFast(xs[i], ys[i], zs[i]);
        points->setPointIntensity(i - begin, from.getPointIntensity(i));
    }
    points->mark_as_modified();
    return points;
}

/// The observation itself, or a copy that holds what it keeps in other files.
mrpt::obs::CObservation::Ptr with_its_data(const mrpt::obs::CObservation::Ptr& observation) {
    using namespace mrpt::obs;
    if (const auto* image = dynamic_cast<const CObservationImage*>(observation.get());
        image != nullptr && image->image.isExternallyStored()) {
        const auto copy = CObservationImage::Create(*image);
        copy->image = plain_image(image->image);
        return copy;
    }
    if (const auto* cloud = dynamic_cast<const CObservationPointCloud*>(observation.get());
        cloud != nullptr && cloud->isExternallyStored()) {
        const auto copy = CObservationPointCloud::Create(*cloud);
        copy->load();
        copy->overrideExternalStorageFormatFlag(
            CObservationPointCloud::ExternalStorageFormat::None);
        return copy;
    }
    if (const auto* range = dynamic_cast<const CObservation3DRangeScan*>(observation.get());
        range != nullptr &&
        (range->points3D_isExternallyStored() || range->rangeImage_isExternallyStored()))
        throw Error("sensor '" + observation->sensorLabel +
                    "' keeps its range images in files of their own; put them into the rawlog "
                    "with `rawlog-edit --de-externalize` first");
    return observation;
}

}  // namespace

GzipOutput::GzipOutput(const std::filesystem::path& file, int level) : file_(file) {
    handle_ = gzopen(file.c_str(), ("wb" + std::to_string(level)).c_str());
    if (handle_ == nullptr)
        throw Error("cannot write " + file.string() + "; check that its folder is writable");
    gzbuffer(handle_, 1U << 17U);
}

GzipOutput::~GzipOutput() {
    if (handle_ != nullptr) gzclose_w(handle_);
}

void GzipOutput::close() {
    const int code = gzclose_w(handle_);
    handle_ = nullptr;
    if (code != Z_OK) throw Error("cannot write " + file_.string() + "; is the disk full?");
}

size_t GzipOutput::Write(const void* buffer, size_t count) {
    const auto* from = static_cast<const char*>(buffer);
    for (size_t done = 0; done < count;) {
        const auto step = static_cast<unsigned>(std::min<size_t>(count - done, 1U << 30U));
        const int written = gzwrite(handle_, from + done, step);
        if (written <= 0) throw Error("cannot write " + file_.string() + "; is the disk full?");
        done += static_cast<size_t>(written);
    }
    return count;
}

size_t GzipOutput::Read(void*, size_t) {
    throw Error(file_.string() + " is open for writing");
}

uint64_t GzipOutput::Seek(int64_t, TSeekOrigin) {
    throw Error(file_.string() + " is written as a stream");
}

uint64_t GzipOutput::getTotalBytesCount() const {
    throw Error(file_.string() + " is written as a stream");
}

uint64_t GzipOutput::getPosition() const {
    throw Error(file_.string() + " is written as a stream");
}

std::string GzipOutput::getStreamDescription() const {
    return file_.string();
}

RawlogWriter::RawlogWriter(const std::filesystem::path& file, int level)
    : pending_(file), stream_(pending_.path(), level) {
    // A switch of the whole process; changing it here would race with other stages. MRPT 2.5 has it
    // on.
    if (!mrpt::img::CImage::DISABLE_JPEG_COMPRESSION())
        throw Error(
            "MRPT is set to store colour images as JPEG, which loses detail; do not call "
            "CImage::DISABLE_JPEG_COMPRESSION(false) in this process");
}

void RawlogWriter::serialize(const mrpt::serialization::CSerializable& object,
                             const std::string& whose) {
    try {
        auto archive = mrpt::serialization::archiveFrom(stream_);
        archive << object;
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {
        throw Error(whose + " (" + object.GetRuntimeClass()->className + ") cannot be written to " +
                    pending_.final_path().string() + ": " + e.what());
    }
}

void RawlogWriter::serialize(const mrpt::obs::CObservation& observation) {
    serialize(observation, "sensor '" + observation.sensorLabel + "'");
    ++observations_;
}

void RawlogWriter::end_frame() {
    if (frame_.size() == 0) return;
    serialize(frame_, "the sensory frame of sensor '" + (*frame_.begin())->sensorLabel + "'");
    observations_ += frame_.size();
    frame_.clear();
}

void RawlogWriter::write(const Observation& observation) {
    const RawlogPlace& place = observation.place;
    const auto self_contained = with_its_data(observation.observation);
    if (!place.in_frame || !place.before.empty()) end_frame();
    for (const auto& object : place.before) serialize(*object, "what is no observation");
    if (place.in_frame)
        frame_.insert(self_contained);
    else
        serialize(*self_contained);
    if (place.ends_frame) end_frame();
    for (const auto& object : place.after) serialize(*object, "what is no observation");
}

void RawlogWriter::write_other(const mrpt::serialization::CSerializable& object) {
    end_frame();
    serialize(object, "what is no observation");
}

void RawlogWriter::write_image(const CameraImage& camera) {
    mrpt::obs::CObservationImage observation;
    observation.sensorLabel = camera.label;
    observation.timestamp = camera.stamp;
    observation.cameraPose = camera.sensor_pose;
    observation.cameraParams = camera.camera;
    observation.image = plain_image(camera.image);
    serialize(observation);
}

void RawlogWriter::write_scene(const Cloud* cloud, const Images* images, double stamp) {
    std::vector<const CameraImage*> waiting;
    if (images != nullptr)
        for (const auto* list : {&images->cameras, &images->others})
            for (const CameraImage& camera : *list) waiting.push_back(&camera);
    std::stable_sort(
        waiting.begin(), waiting.end(),
        [](const CameraImage* a, const CameraImage* b) { return a->stamp < b->stamp; });
    auto next = waiting.begin();

    std::vector<Cloud::Part> parts;
    if (cloud != nullptr) parts = cloud->parts;
    if (parts.empty() && cloud != nullptr && cloud->size() > 0)
        parts.push_back(
            {0, stamp > 0.0 ? mrpt::Clock::fromDouble(stamp) : mrpt::Clock::time_point{}});
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const std::size_t end = k + 1 < parts.size() ? parts[k + 1].begin : cloud->size();
        if ((k == 0 && parts[k].begin != 0) || parts[k].begin > end || end > cloud->size())
            throw Error("the messages of cloud '" + cloud->sensor_label +
                        "' do not cover its points in their order");
        for (; next != waiting.end() && (*next)->stamp <= parts[k].stamp; ++next)
            write_image(**next);
        mrpt::obs::CObservationPointCloud observation;
        observation.sensorLabel = cloud->sensor_label;
        observation.timestamp = parts[k].stamp;
        observation.sensorPose = cloud->sensor_pose;
        observation.pointcloud = copy_points(*cloud->points, parts[k].begin, end);
        serialize(observation);
    }
    for (; next != waiting.end(); ++next) write_image(**next);
}

void RawlogWriter::commit() {
    end_frame();
    stream_.close();
    pending_.commit();
}

}  // namespace petal
