// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include "petal_process.hpp"

namespace petal::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class Simulate : public PetalProcess {
   protected:
    /// The letter's calibration behind another source, with one more figure: of the points' labels.
    static json calibration_behind(const json& source) {
        const json labels = {
            {"type", "metric.labels"},
            {"in",
             {{"truth", "scene.truth"}, {"before", "scene.cloud"}, {"after", "scene.cloud"}}}};
        const json result = {{"in", {{"metrics", {"reprojection.metrics", "labels.metrics"}}}}};
        return {{"stages", {{"scene", source}, {"labels", labels}, {"result", result}}}};
    }
    json result_of(const json& source, const std::string& out) {
        std::ofstream(folder_ / (out + ".json")) << calibration_behind(source);
        const Ended ended = petal("run " + pipeline("letter_indoor.json") + " --with " + out +
                                  ".json --out " + out);
        EXPECT_THAT(ended.exit_code, ::testing::AnyOf(0, 4)) << ended.err;
        return json::parse(read_text(folder_ / out / "result.json"));
    }
    const std::string small_ = PETAL_SOURCE_DIR "/tests/data/small_scene.json";
};

TEST_F(Simulate, ThePipelineMakesARecording) {
    const Ended ended =
        petal("run " + pipeline("simulate.json") + " --set scene.duration=0.2 --out made");
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    for (const char* name : {"scene.rawlog", "truth.json", "labels.u8"})
        EXPECT_TRUE(fs::exists(folder_ / "made" / name)) << name;
    const Ended inspected = petal("inspect made/scene.rawlog --json");
    ASSERT_EQ(inspected.exit_code, 0) << inspected.err;
    EXPECT_THAT(inspected.out, HasSubstr("CObservationPointCloud"));
    EXPECT_THAT(inspected.out, HasSubstr("CObservationImage"));
    const json truth = json::parse(read_text(folder_ / "made" / "truth.json"));
    EXPECT_EQ(truth["boards"].size(), 1U);
    EXPECT_EQ(truth["boards"][0]["corners_image"].size(), 16U);
    std::size_t points = 0;
    for (const auto& count : truth["label_counts"]) points += count.get<std::size_t>();
    EXPECT_EQ(fs::file_size(folder_ / "made" / "labels.u8"), points);
    const Ended again = petal("run " + pipeline("simulate.json") +
                              " --set scene.duration=0.2 --threads 1 --out again");
    ASSERT_EQ(again.exit_code, 0) << again.err;
    for (const char* name : {"scene.rawlog", "truth.json", "labels.u8"})
        EXPECT_TRUE(read_text(folder_ / "made" / name) == read_text(folder_ / "again" / name))
            << name;
}

// A pipeline must not see whether its scene was recorded first.
TEST_F(Simulate, DirectlyOrThroughARawlogTheResultIsTheSame) {
    const json simulator = {{"type", "source.simulator"}, {"params", {{"scenes", {small_}}}}};
    const json direct = result_of(simulator, "direct");
    std::ofstream(folder_ / "small.json")
        << json{{"seed", 3},
                {"stages",
                 {{"scene", {{"params", {{"scenes", {small_}}}}}},
                  {"record", {{"params", {{"file", "{scene}/{scene}.rawlog"}}}}}}}};
    const Ended recorded =
        petal("run " + pipeline("simulate.json") + " --seed 7 --with small.json --out recorded");
    ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
    json files;
    for (const char* scene : {"small_scene_near", "small_scene_far"})
        files.push_back((folder_ / "recorded" / scene / (std::string(scene) + ".rawlog")).string());
    const json source = {{"type", "source.rawlog"}, {"params", {{"files", files}}}};
    const json through = result_of(source, "through");
    EXPECT_EQ(direct, through);
    // That proves something only where there was something to see.
    EXPECT_GT(direct["metrics"]["labels.before.board_share"].get<double>(), 0.02);
    ASSERT_EQ(direct["scenes"].size(), 2U);
    EXPECT_FALSE(direct["scenes"][0]["boards"][0]["corners_image"].is_null());
}

TEST_F(Simulate, AWrongKeyOfASceneFileIsToldWithItsLine) {
    std::ofstream(folder_ / "mine.json")
        << "{ \"petal_scene\": 1, \"name\": \"mine\",\n  \"based_on\": \"indoor_floor_3m\",\n"
           "  \"lihgt\": {} }\n";
    const Ended ended = petal("run " + pipeline("simulate.json") +
                              " --set 'scene.scenes=[\"mine.json\"]' --out made");
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_THAT(ended.err, HasSubstr("mine.json:3"));
    EXPECT_THAT(ended.err, HasSubstr("did you mean 'light'"));
    EXPECT_FALSE(fs::exists(folder_ / "made" / "scene.rawlog"));
}

}  // namespace
}  // namespace petal::testing
