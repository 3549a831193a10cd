// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include <string>

#include "run_progress.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

RunProgress ten_of_forty() {
    RunProgress progress;
    progress.at_work = {"planes", "image_boards"};
    progress.frames_emitted = 12;
    progress.frames_done = 10;
    progress.elapsed_s = 5.0;
    progress.source = {12.0, 40.0, "files"};
    return progress;
}

TEST(Progress, TellsStagesFramesRateShareAndRemainingTime) {
    // 10 frames in 5 s; 12 / 40 of the files are read and 10 / 12 of those passed: a quarter, so
    // 15 s are left.
    EXPECT_EQ(progress_text(ten_of_forty(), 120),
              "planes image_boards, 10 frames, 2.0 frames/s, 30 % of 40 files, 15 s left");
}

TEST(Progress, BytesAreToldInUnitsOfTheirSize) {
    RunProgress progress = ten_of_forty();
    progress.source = {6.0e8, 1.2e9, "B"};
    EXPECT_THAT(progress_text(progress, 120), HasSubstr("50 % of 1.2 GB"));
    progress.source = {1.0, 512.0, "B"};
    EXPECT_THAT(progress_text(progress, 120), HasSubstr("0 % of 512 B"));
    progress.source = {1.0, 999.7e3, "B"};
    EXPECT_THAT(progress_text(progress, 120), HasSubstr("of 1.0 MB"));
}

TEST(Progress, WithoutATotalNoShareAndNoRemainingTime) {
    RunProgress progress = ten_of_forty();
    progress.source = {};
    EXPECT_EQ(progress_text(progress, 120), "planes image_boards, 10 frames, 2.0 frames/s");
    EXPECT_LT(remaining_s(progress), 0.0);
}

TEST(Progress, NoFrameYetHasNoRateAndNoRemainingTime) {
    RunProgress progress;
    progress.at_work = {"scene"};
    progress.elapsed_s = 3.0;
    progress.source = {0.0, 1.0, "scenes"};
    EXPECT_EQ(progress_text(progress, 120), "scene, 0 frames, 0 % of 1 scenes");
    // The only scene is read, no stage has worked on it: how long that takes nobody knows.
    progress.frames_emitted = 1;
    progress.source.done = 1.0;
    EXPECT_THAT(progress_text(progress, 120), Not(HasSubstr("left")));
    progress.frames_done = 1;
    EXPECT_THAT(progress_text(progress, 120), Not(HasSubstr("left")));
    EXPECT_THAT(progress_text(progress, 120), HasSubstr("1 frame,"));
}

TEST(Progress, SlowRatesAreToldAMinute) {
    RunProgress progress = ten_of_forty();
    progress.elapsed_s = 200.0;
    EXPECT_THAT(progress_text(progress, 120), HasSubstr("3.0 frames/min"));
    progress.elapsed_s = 0.01;
    EXPECT_THAT(progress_text(progress, 120), HasSubstr("1000 frames/s"));
}

TEST(Progress, NeverIsWiderThanTheTerminal) {
    RunProgress progress = ten_of_forty();
    progress.at_work = {"a_stage_with_a_name_that_is_far_too_long_for_any_terminal", "another_one"};
    for (std::size_t width = 0; width <= 200; ++width)
        EXPECT_LE(progress_text(progress, width).size(), width);
    // Names give way first, then what stands at the end.
    EXPECT_EQ(progress_text(progress, 79),
              "a_stage_with_a_name_tha.., 10 frames, 2.0 frames/s, 30 % of 40 files, 15 s left");
    EXPECT_EQ(progress_text(progress, 30), "a_stag.., 10 frames");
    EXPECT_EQ(progress_text(progress, 0), "");
}

TEST(Progress, NobodyAtWorkIsSaidToo) {
    EXPECT_THAT(progress_text(RunProgress{}, 80), StartsWith("waiting, 0 frames"));
}

TEST(Progress, DurationsAreRoundedUp) {
    EXPECT_EQ(duration_text(0.0), "0 s");
    EXPECT_EQ(duration_text(0.2), "1 s");
    EXPECT_EQ(duration_text(59.5), "1 min 0 s");
    EXPECT_EQ(duration_text(200.0), "3 min 20 s");
    EXPECT_EQ(duration_text(7500.0), "2 h 5 min");
    EXPECT_EQ(duration_text(-1.0), "0 s");
}

}  // namespace
}  // namespace petal
