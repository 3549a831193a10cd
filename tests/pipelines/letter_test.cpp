// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include "petal_process.hpp"

namespace petal::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// The letter's calibration from raw points, on a simulated recording of four boards.
class Letter : public PetalProcess {
   protected:
    void SetUp() override {
        PetalProcess::SetUp();
        const Ended ended = petal(
            "run " + pipeline("simulate.json") +
            " --set 'scene.scenes=[\"indoor_four_boards\"]' --set scene.duration=6 --out data");
        ASSERT_EQ(ended.exit_code, 0) << ended.err;
    }
    json calibrated(const std::string& options, const std::string& out) {
        const Ended ended =
            petal("run " + pipeline("letter.json") + " --data data --out " + out + " " + options);
        // weak (4) is the honest verdict: one placement, four boards.
        EXPECT_THAT(ended.exit_code, ::testing::AnyOf(0, 4)) << ended.err;
        return json::parse(read_text(folder_ / out / "result.json"));
    }
};

TEST_F(Letter, FindsThePoseFromRawPoints) {
    const json result = calibrated("--threads 2", "two");
    const json& metrics = result["metrics"];
    EXPECT_EQ(metrics["reprojection.count"], 64.0) << "four boards, all of their corners";
    // One placement leaves the pose weak: a tenth of a degree and some millimetres are what was
    // seen over seeds; three times that would be a fault.
    EXPECT_LT(metrics["truth.rotation_deg"].get<double>(), 0.3);
    EXPECT_LT(metrics["truth.translation_m"].get<double>(), 0.02);
    EXPECT_LT(metrics["truth.drift_px"].get<double>(), 1.0);
    EXPECT_EQ(metrics["normalised_reprojection.below_1px_share"], 1.0);
    EXPECT_LT(metrics["labels.after.vacant_share"].get<double>(), 0.06);
    EXPECT_GT(metrics["labels.after.edge_share"].get<double>(), 0.5);

    calibrated("--threads 1", "one");
    EXPECT_TRUE(read_text(folder_ / "two" / "result.json") ==
                read_text(folder_ / "one" / "result.json"));
}

TEST_F(Letter, TableIAtThreeMetresFindsBoardsAndAtEightNone) {
    const json near = calibrated("--with " + pipeline("variants/table1_3m.json"), "three");
    EXPECT_GE(near["metrics"]["reprojection.count"].get<double>(), 16.0);
    const json middle = calibrated("--with " + pipeline("variants/table1_5m.json"), "five");
    const json far = calibrated("--with " + pipeline("variants/table1_8m.json"), "eight");
    // Thresholds of 0.4 and 0.5 m of depth: the wall is nearer than that behind the boards.
    for (const json* result : {&middle, &far}) EXPECT_EQ((*result)["verdict"], "not_usable");
}

}  // namespace
}  // namespace petal::testing
