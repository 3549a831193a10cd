// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "built_plugins.hpp"
#include "petal/calibration/observation.hpp"
#include "petal_process.hpp"
#include "pipeline.hpp"
#include "rawlog_objects.hpp"
#include "real_data.hpp"
#include "runner.hpp"

namespace petal::testing {
namespace {

using namespace mrpt::obs;
using nlohmann::json;
using ::testing::HasSubstr;

template <class T>
std::shared_ptr<T> named(const std::string& label, int tick) {
    auto observation = T::Create();
    observation->sensorLabel = label;
    observation->timestamp = mrpt::Clock::fromDouble(1.7e9) + mrpt::Clock::duration(tick);
    return observation;
}

/// 100 points at 0.1, 0.2, ... 10 m, then one that is not finite.
CObservation::Ptr cloud_at(int tick) {
    auto points = mrpt::maps::CPointsMapXYZI::Create();
    for (int i = 1; i <= 100; ++i) {
        points->insertPointFast(0.0F, 0.0F, 0.1F * static_cast<float>(i));
        points->setPointIntensity(points->size() - 1, 0.01F * static_cast<float>(i));
    }
    points->insertPointFast(std::numeric_limits<float>::quiet_NaN(), 0.0F, 1.0F);
    auto observation = named<CObservationPointCloud>("LIDAR", tick);
    observation->pointcloud = points;
    return observation;
}

RawlogObjects some_of_each(int rounds) {
    RawlogObjects all;
    for (int i = 0; i < rounds; ++i) {
        auto image = named<CObservationImage>("CAMERA", 4 * i + 1);
        image->image.resize(64, 48, mrpt::img::CH_RGB);
        image->image.filledRectangle(0, 0, 63, 47,
                                     mrpt::img::TColor(static_cast<std::uint8_t>(i % 255), 10, 20));
        auto imu = named<CObservationIMU>("IMU", 4 * i + 2);
        imu->set(IMU_X_ACC, 0.1 * i);
        all.push_back(cloud_at(4 * i));
        all.push_back(image);
        all.push_back(imu);
        all.push_back(named<CObservationGPS>("GPS", 4 * i + 3));
    }
    return all;
}

class FilterRawlog : public PetalProcess {
   protected:
    void SetUp() override {
        PetalProcess::SetUp();
        fs::create_directories(data());
    }
    fs::path data() const { return folder_ / "data"; }
    Ended stream(const std::string& options) const {
        return petal("run " + pipeline("filter_rawlog.json") + " --data data --out out --force " +
                     options);
    }
    RawlogObjects written() const { return read_rawlog(folder_ / "out" / "filtered.rawlog"); }
};

TEST_F(FilterRawlog, PointsAreFilteredAndTheRestIsUntouched) {
    const RawlogObjects in = some_of_each(20);
    write_rawlog(data() / "scene.rawlog", in);
    const Ended ended = stream("--set filter.min_range=1.05 --set filter.max_range=5.05");
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const RawlogObjects out = written();
    ASSERT_EQ(out.size(), in.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        const auto filtered = std::dynamic_pointer_cast<CObservationPointCloud>(out[i]);
        if (!filtered) {
            EXPECT_EQ(object_bytes(*out[i]), object_bytes(*in[i])) << i;
            continue;
        }
        EXPECT_EQ(filtered->timestamp, std::dynamic_pointer_cast<CObservation>(in[i])->timestamp);
        EXPECT_EQ(filtered->sensorLabel, "LIDAR");
        const auto points =
            std::dynamic_pointer_cast<mrpt::maps::CPointsMapXYZI>(filtered->pointcloud);
        ASSERT_TRUE(points);
        ASSERT_EQ(points->size(), 40U);  // 1.1 to 5.0 m
        EXPECT_EQ(points->getPointsBufferRef_z()[0], 0.1F * 11.0F);
        EXPECT_EQ(points->getPointIntensity(39), 0.01F * 50.0F);
    }
    const json report = json::parse(read_text(folder_ / "out" / "run.json"));
    EXPECT_EQ(report["frames"], 80);
    EXPECT_THAT(read_text(folder_ / "out" / "log.txt"),
                HasSubstr("800 of 2020 points stay (20 were not finite)"));
}

TEST_F(FilterRawlog, TheVoxelGridTakesThePlaceOfTheRange) {
    write_rawlog(data() / "scene.rawlog", some_of_each(2));
    const Ended ended = stream("--with '" PETAL_SOURCE_DIR
                               "/pipelines/variants/voxel_grid.json' --set filter.size=5.05");
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const auto filtered = std::dynamic_pointer_cast<CObservationPointCloud>(written().at(0));
    ASSERT_TRUE(filtered);
    EXPECT_EQ(filtered->pointcloud->size(), 2U);  // up to 5.05 m, and beyond
}

TEST_F(FilterRawlog, AnyNumberOfThreadsWritesTheSameBytes) {
    write_rawlog(data() / "scene.rawlog", some_of_each(30));
    ASSERT_EQ(stream("--threads 1").exit_code, 0);
    const std::string one = read_text(folder_ / "out" / "filtered.rawlog");
    ASSERT_EQ(stream("--threads 4").exit_code, 0);
    EXPECT_TRUE(one == read_text(folder_ / "out" / "filtered.rawlog"));
}

TEST_F(FilterRawlog, ActionsAndSensoryFramesAreCopied) {
    RawlogObjects in;
    for (int i = 0; i < 3; ++i) {
        auto frame = CSensoryFrame::Create();
        for (const auto& object : some_of_each(1))
            frame->insert(std::dynamic_pointer_cast<CObservation>(object));
        in.push_back(CActionCollection::Create());
        in.push_back(frame);
    }
    write_rawlog(data() / "scene.rawlog", in);
    ASSERT_EQ(stream("").exit_code, 0);
    const RawlogObjects out = written();
    ASSERT_EQ(out.size(), 6U);
    EXPECT_EQ(object_bytes(*out[4]), object_bytes(*in[4]));
    const auto frame = std::dynamic_pointer_cast<CSensoryFrame>(out[5]);
    ASSERT_TRUE(frame);
    ASSERT_EQ(frame->size(), 4U);
    const auto filtered =
        std::dynamic_pointer_cast<CObservationPointCloud>(frame->getObservationByIndex(0));
    ASSERT_TRUE(filtered);
    EXPECT_EQ(filtered->pointcloud->size(), 96U);  // 0.5 to 10 m
}

TEST_F(FilterRawlog, ADamagedRawlogLeavesNothingHalfWritten) {
    const fs::path log = data() / "scene.rawlog";
    write_rawlog(log, some_of_each(200));
    fs::resize_file(log, fs::file_size(log) / 2);
    const Ended ended = stream("");
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_THAT(ended.err, HasSubstr("scene.rawlog"));
    EXPECT_THAT(ended.err, HasSubstr("were read whole"));
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out"))
        EXPECT_EQ(entry.path().string().find("filtered"), std::string::npos) << entry.path();
}

TEST_F(FilterRawlog, MrptsOwnProgramOpensIt) {
    if (std::system("command -v rawlog-edit >/dev/null 2>&1") != 0)
        GTEST_SKIP() << "rawlog-edit (Debian's mrpt-apps) is not installed";
    write_rawlog(data() / "scene.rawlog", some_of_each(5));
    ASSERT_EQ(stream("").exit_code, 0);
    const fs::path told = folder_ / "told";
    const std::string command = "rawlog-edit --info -i '" +
                                (folder_ / "out" / "filtered.rawlog").string() + "' >'" +
                                told.string() + "' 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_THAT(read_text(told), HasSubstr("Overall number of objects         : 20"));
}

// All points are let through: a streamed copy is, object by object, what MRPT itself would write.
TEST_F(FilterRawlog, RealRawlogsComeOutAsTheyAre) {
    PETAL_NEEDS_REAL_DATA();
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(real_data() / "mrpt_rawlogs")) {
        if (entry.path().extension() != ".rawlog") continue;
        ++files;
        const Ended ended = stream("--set 'log.files=[\"" + entry.path().string() +
                                   "\"]' --set filter.min_range=0.0 --set filter.max_range=1e6");
        ASSERT_EQ(ended.exit_code, 0) << ended.err;
        EXPECT_TRUE(object_bytes(written()) == object_bytes(read_rawlog(entry.path())))
            << entry.path();
    }
    EXPECT_EQ(files, 6U);
}

/// Passes observations on and counts how many of those that came this way are alive.
class Census final : public Stage {
   public:
    struct Params {};
    static void describe(Spec<Params>& spec) {
        spec.summary("Counts the observations that are alive.");
        spec.reads<Observation>("observation", "any");
        spec.writes<Observation>("observation", "the same");
    }
    explicit Census(Params) {}
    void run(Run& run) override {
        auto packet = run.in_ptr<Observation>("observation");
        seen_.push_back(packet->observation);
        seen_.erase(std::remove_if(seen_.begin(), seen_.end(),
                                   [](const auto& each) { return each.expired(); }),
                    seen_.end());
        most_alive = std::max(most_alive, seen_.size());
        ++frames;
        run.forward("observation", std::move(packet));
    }

    static std::size_t most_alive;
    static std::size_t frames;

   private:
    std::vector<std::weak_ptr<CObservation>> seen_;
};
std::size_t Census::most_alive = 0;
std::size_t Census::frames = 0;

// Memory is that of the frames in flight, however slow the sink and however long the log.
TEST_F(FilterRawlog, FewObservationsAreAliveAtATime) {
    write_rawlog(data() / "scene.rawlog", some_of_each(250));
    Registry registry = built_plugins().registry;
    registry.add(describe_stage<Census>("test.census"));
    std::ofstream(folder_ / "census.json") << R"({"stages": {
        "census": {"type": "test.census", "in": {"observation": "log.observation"}},
        "filter": {"in": {"observation": "census.observation"}},
        "out": {"params": {"compression": 9}}}})";
    PipelineRequest request;
    request.file = PETAL_SOURCE_DIR "/pipelines/filter_rawlog.json";
    request.patches = {folder_ / "census.json"};
    request.data = data();
    const CheckedPipeline read = read_pipeline(request, registry);
    ASSERT_TRUE(read.pipeline);
    RunSettings settings;
    settings.threads = 2;
    settings.folder = folder_;
    RunLog log(folder_, Verbosity::quiet);
    const RunReport report = run_pipeline(*read.pipeline, settings, log);
    EXPECT_EQ(report.status, RunStatus::done);
    EXPECT_EQ(Census::frames, 1000U);
    // The runner allows threads + 2 frames behind the source; one more is on its way out.
    EXPECT_LE(Census::most_alive, 5U);
}

}  // namespace
}  // namespace petal::testing
