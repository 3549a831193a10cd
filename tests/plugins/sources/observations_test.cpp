// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/observations.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include "petal/testing/stage_harness.hpp"
#include "plugins/sources/temporary_folder.hpp"
#include "rawlog_objects.hpp"
#include "real_data.hpp"

namespace petal {
namespace {

using namespace mrpt::obs;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::object_bytes;
using testing::StageHarness;
namespace fs = std::filesystem;

template <class T>
std::shared_ptr<T> named(const std::string& label, double seconds) {
    auto observation = T::Create();
    observation->sensorLabel = label;
    observation->timestamp = mrpt::Clock::fromDouble(1.7e9 + seconds);
    return observation;
}

CObservation::Ptr imu(const std::string& label, double seconds) {
    return named<CObservationIMU>(label, seconds);
}

mrpt::serialization::CSerializable::Ptr action(double x) {
    CActionRobotMovement2D move;
    move.rawOdometryIncrementReading = mrpt::poses::CPose2D(x, 0.0, 0.0);
    auto all = CActionCollection::Create();
    all->insert(move);
    return all;
}

mrpt::serialization::CSerializable::Ptr frame_of(const std::vector<CObservation::Ptr>& all) {
    auto frame = CSensoryFrame::Create();
    for (const auto& each : all) frame->insert(each);
    return frame;
}

class ObservationsStage : public testing::TemporaryFolder {
   protected:
    fs::path log(const std::string& name, const testing::RawlogObjects& objects) const {
        testing::write_rawlog(folder_ / name, objects);
        return folder_ / name;
    }
    static StageHarness stage(const std::vector<fs::path>& files) {
        std::vector<std::string> names;
        for (const auto& file : files) names.push_back(file.string());
        StageHarness harness = StageHarness::of<ObservationsSource>();
        harness.set("files", Value(names));
        return harness;
    }
    /// What came, and what stood around it: "a" is an observation of sensor a, "x" an object that
    /// is none, "(a b)" a sensory frame.
    static std::string layout(const StageHarness& harness) {
        std::string text;
        bool open = false;
        for (const auto& packet : harness.all<Observation>("observation")) {
            const RawlogPlace& place = packet->place;
            text += std::string(place.before.size(), 'x');
            if (place.in_frame && !open) text += "(";
            text += packet->observation->sensorLabel;
            if (place.ends_frame) text += ")";
            open = place.in_frame && !place.ends_frame;
            text += std::string(place.after.size(), 'x');
        }
        return text;
    }
};

TEST_F(ObservationsStage, EachObservationIsAFrameWithItsLabelAndStamp) {
    auto timeless = named<CObservationComment>("", 0.0);
    timeless->timestamp = {};
    StageHarness harness =
        stage({log("1.rawlog", {imu("a", 1.0), imu("b", 0.5)}), log("2.rawlog", {timeless})});
    harness.fire();
    const auto all = harness.all<Observation>("observation");
    ASSERT_EQ(all.size(), 3U);
    EXPECT_EQ(all[0].frame.number, 0U);
    EXPECT_EQ(all[0].frame.name, "a");
    EXPECT_EQ(all[1].frame.name, "b");
    // A double of 1.7e9 s resolves 240 ns.
    EXPECT_NEAR(all[0].frame.stamp, 1.7e9 + 1.0, 5e-7);
    EXPECT_NEAR(all[1].frame.stamp, 1.7e9 + 0.5, 5e-7);
    EXPECT_EQ(all[2].frame.stamp, 0.0);
    EXPECT_TRUE(all[2].frame.name.empty());
    EXPECT_EQ(harness.used_files().size(), 2U);
    EXPECT_TRUE(harness.notes().empty());
}

TEST_F(ObservationsStage, ActionsAndFramesGoAlong) {
    StageHarness harness = stage(
        {log("a.rawlog", {action(1), frame_of({imu("a", 0), imu("b", 0)}), action(2), frame_of({}),
                          imu("c", 0), action(3), frame_of({imu("d", 0)}), action(4)})});
    harness.fire();
    EXPECT_EQ(layout(harness), "x(ab)xxcx(d)x");
    EXPECT_TRUE(harness.notes().empty());
}

TEST_F(ObservationsStage, ActionsGoAlongAcrossFiles) {
    const auto with = log("1.rawlog", {imu("a", 0), action(1)});
    const auto without = log("2.rawlog", {action(2)});
    StageHarness harness = stage({without, with, without, with, without});
    harness.fire();
    EXPECT_EQ(layout(harness), "xaxxaxx");
    // Only where there is no observation at all they are lost, and that is told.
    StageHarness lost = stage({without, without});
    lost.fire();
    ASSERT_EQ(lost.notes().size(), 2U);
    EXPECT_THAT(lost.notes()[0].nearest_miss, HasSubstr("2 actions are left out"));
    EXPECT_EQ(lost.notes()[1].nearest_miss, "there is none");
}

TEST_F(ObservationsStage, ChosenObservationsComeAlone) {
    const auto file =
        log("a.rawlog", {action(1), frame_of({imu("left", 0), named<CObservationImage>("cam", 0)}),
                         action(2), frame_of({imu("right", 0)})});
    StageHarness by_label = stage({file});
    by_label.set("labels", Value(std::vector<std::string>{"l*t", "right"}));
    by_label.fire();
    EXPECT_EQ(layout(by_label), "leftright");
    ASSERT_EQ(by_label.notes().size(), 1U);
    EXPECT_THAT(by_label.notes()[0].nearest_miss, HasSubstr("2 actions are left out"));
    StageHarness by_class = stage({file});
    by_class.set("classes", Value(std::vector<std::string>{"CObservationIMU"}));
    by_class.set("labels", Value(std::vector<std::string>{"left", "cam"}));
    by_class.fire();
    EXPECT_EQ(layout(by_class), "left");
}

TEST_F(ObservationsStage, AChoiceThatFitsNothingListsWhatIsThere) {
    const auto file = log("a.rawlog", {imu("left", 0)});
    StageHarness harness = stage({file});
    harness.set("labels", Value(std::vector<std::string>{"left", "rihgt"}));
    EXPECT_THAT(refusal([&] { harness.fire(); }),
                AllOf(HasSubstr("'rihgt'"), HasSubstr("'left' (CObservationIMU)")));
    StageHarness other = stage({file});
    other.set("classes", Value(std::vector<std::string>{"CObservationGPS"}));
    EXPECT_THAT(refusal([&] { other.fire(); }), HasSubstr("in classes"));
}

TEST_F(ObservationsStage, DataInOtherFilesArePutIn) {
    auto image = named<CObservationImage>("cam", 0);
    image->image.resize(8, 4, mrpt::img::CH_GRAY);
    image->image.filledRectangle(0, 0, 7, 3, mrpt::img::TColor(9, 9, 9));
    fs::create_directories(folder_ / "a_Images");
    ASSERT_TRUE(image->image.saveToFile((folder_ / "a_Images" / "picture.png").string()));
    image->image.setExternalStorage("picture.png");
    const auto file = log("a.rawlog", {image, frame_of({image})});
    StageHarness harness = stage({file});
    harness.fire();
    EXPECT_EQ(harness.used_files().size(), 3U);
    for (const auto& packet : harness.all<Observation>("observation")) {
        const auto& read = dynamic_cast<const CObservationImage&>(*packet->observation);
        EXPECT_FALSE(read.image.isExternallyStored());
        EXPECT_EQ(read.image.getWidth(), 8U);
    }
    fs::remove_all(folder_ / "a_Images");
    EXPECT_THAT(refusal([&] { stage({file}).fire(); }), HasSubstr("picture.png"));
}

TEST_F(ObservationsStage, ACloudWithoutAMapPasses) {
    StageHarness harness = stage({log("a.rawlog", {named<CObservationPointCloud>("L", 0)})});
    harness.fire();
    EXPECT_EQ(harness.all<Observation>("observation").size(), 1U);
}

TEST_F(ObservationsStage, DamageEndsTheRun) {
    const auto file = log("a.rawlog", {imu("a", 0), imu("b", 0)});
    const std::string bytes = bytes_of(file);
    for (const std::size_t cut : {bytes.size() - 4, bytes.size() / 2})
        EXPECT_THAT(
            refusal([&] { stage({write("cut.rawlog", bytes.substr(0, cut))}).fire(); }),
            AllOf(HasSubstr("cut.rawlog"), HasSubstr("cut off"), HasSubstr("were read whole")));
    EXPECT_THAT(refusal([&] { stage({folder_ / "none.rawlog"}).fire(); }),
                HasSubstr("does not exist"));
}

/// Every observation of the MRPT authors' rawlogs, sealed, as it stands in the file.
TEST(RealObservations, OfTheMrptAuthors) {
    PETAL_NEEDS_REAL_DATA();
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(testing::real_data() / "mrpt_rawlogs")) {
        if (entry.path().extension() != ".rawlog") continue;
        ++files;
        StageHarness harness = StageHarness::of<ObservationsSource>();
        harness.set("files", Value(std::vector<std::string>{entry.path().string()}));
        harness.fire();
        const auto expected = testing::observations_of(testing::read_rawlog(entry.path()));
        const auto all = harness.all<Observation>("observation");
        ASSERT_EQ(all.size(), expected.size()) << entry.path();
        for (std::size_t i = 0; i < all.size(); ++i)
            ASSERT_EQ(object_bytes(*all[i]->observation), object_bytes(*expected[i]))
                << entry.path() << ", observation " << i;
    }
    EXPECT_EQ(files, 6U);
}

}  // namespace
}  // namespace petal
