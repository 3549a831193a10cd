// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "petal_process.hpp"

namespace petal::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class CommandLine : public PetalProcess {
   protected:
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
    }
};

TEST_F(CommandLine, HelpAndVersionAreNoErrors) {
    EXPECT_EQ(petal("--help").exit_code, 0);
    const Ended version = petal("--version");
    EXPECT_EQ(version.exit_code, 0);
    EXPECT_THAT(version.out, HasSubstr("petal 0."));
}

TEST_F(CommandLine, WrongUsageIsTwo) {
    EXPECT_EQ(petal("").exit_code, 2);
    EXPECT_EQ(petal("rum x.json").exit_code, 2);
    EXPECT_EQ(petal("run").exit_code, 2);
    EXPECT_EQ(petal("check no_such_file.json").exit_code, 2);
    EXPECT_EQ(petal("check " + pipeline("letter_indoor.json") + " --threads 0").exit_code, 2);
    const Ended debug = petal("check " + pipeline("letter_indoor.json") + " --debug image_board");
    EXPECT_EQ(debug.exit_code, 2);
    EXPECT_THAT(debug.err, HasSubstr("image_boards"));
}

TEST_F(CommandLine, CheckNeedsNoDataAndRunDoes) {
    EXPECT_EQ(petal("check " + pipeline("letter_indoor.json")).exit_code, 0);
    const Ended ended = petal("run " + pipeline("letter_indoor.json") + " --out out");
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_THAT(ended.err, HasSubstr("--data"));
    EXPECT_FALSE(fs::exists(folder_ / "out")) << "a refused pipeline makes no folder";
}

TEST_F(CommandLine, AMissingWireIsToldWithoutData) {
    write("no_planes.json", R"({"stages": {"lidar_boards": {"in": {"planes": null}}}})");
    const Ended ended = petal("check " + pipeline("letter_indoor.json") + " --with no_planes.json");
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_THAT(ended.err,
                AllOf(HasSubstr("no_planes.json:1: stages.lidar_boards"), HasSubstr("'planes'")));
}

// Five mistakes of five kinds, told at once: each with path, line, what was expected, the nearest
// name.
TEST_F(CommandLine, FiveMistakesAreToldAtOnce) {
    write("bad.json", R"({ "petal": 1,
  "stages": {
    "scene": { "type": "source.file", "params": { "image": "a.jpg" } },
    "planes": { "type": "detector.planes_ransac", "in": { "clouds": "boards.boards" } },
    "boards": { "type": "detector.image_contours", "in": { "images": "camera.images" } },
    "solve": { "type": "solver.reprojection", "in": { "correspondences": "match.correspondences" },
               "params": { "robust_los": "huber" } },
    "match": { "type": "solver.board_matcher", "in": { "image": "boards.boards", "lidar": "planes.planes" } }
  } })");
    const Ended ended = petal("run bad.json --out out");
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_THAT(ended.err,
                AllOf(HasSubstr("bad.json:3: stages.scene.type"), HasSubstr("source.files")));
    EXPECT_THAT(ended.err,
                AllOf(HasSubstr("bad.json:4: stages.planes.in.clouds"), HasSubstr("'cloud'")));
    EXPECT_THAT(ended.err, HasSubstr("bad.json:5: stages.boards.in.images"));
    EXPECT_THAT(ended.err, AllOf(HasSubstr("bad.json:7: stages.solve.params.robust_los"),
                                 HasSubstr("'robust_loss'")));
    EXPECT_THAT(ended.err,
                AllOf(HasSubstr("bad.json:8: stages.match.in.lidar"), HasSubstr("LidarBoards")));
    EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(CommandLine, ARefusedLibraryIsToldWhereATypeIsMissing) {
    fs::create_directory(folder_ / "plugins");
    write("plugins/mine.so", "this is no library");
    write("p.json", R"({"petal": 1, "stages": {"a": {"type": "source.mine"}}})");
    const Ended ended = petal("--plugin-path plugins check p.json");
    EXPECT_EQ(ended.exit_code, 3);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("source.mine"), HasSubstr("mine.so")));
    // The same library does not stop a pipeline that does not need it.
    EXPECT_EQ(petal("--plugin-path plugins check " + pipeline("letter_indoor.json")).exit_code, 0);
    const Ended plugins = petal("--plugin-path plugins plugins");
    EXPECT_EQ(plugins.exit_code, 0);
    EXPECT_THAT(plugins.out,
                AllOf(HasSubstr("refused:"), HasSubstr("mine.so"), HasSubstr("detectors")));
    EXPECT_THAT(petal("plugins --probe").out,
                AllOf(HasSubstr("ok"), HasSubstr("petal_detectors.so")));
}

TEST_F(CommandLine, ShowGivesAPipelineThatReadsBack) {
    const Ended shown = petal("show --json " + pipeline("letter_indoor.json"));
    EXPECT_EQ(shown.exit_code, 0);
    write("again.json", shown.out);
    EXPECT_EQ(petal("show --json again.json").out, shown.out);
    EXPECT_THAT(petal("show --dot " + pipeline("letter_indoor.json")).out, HasSubstr("digraph"));
    const Ended text = petal("show " + pipeline("letter_indoor.json"));
    EXPECT_THAT(text.out,
                AllOf(HasSubstr("use_target_spacing = true"), HasSubstr("cloud <- scene.cloud")));
}

TEST_F(CommandLine, StagesAreListedAndExplained) {
    const Ended all = petal("stages");
    EXPECT_EQ(all.exit_code, 0);
    EXPECT_THAT(all.out, AllOf(HasSubstr("detector.image_contours"), HasSubstr("sink.result")));
    const Ended solvers = petal("stages --role solver");
    EXPECT_THAT(solvers.out, AllOf(HasSubstr("solver.pnp"), Not(HasSubstr("sink.result"))));
    const Ended one = petal("stages solver.reprojection");
    EXPECT_THAT(one.out, AllOf(HasSubstr("parameters:"), HasSubstr("loss")));
    const Ended typo = petal("stages solver.reprojecton");
    EXPECT_EQ(typo.exit_code, 2);
    EXPECT_THAT(typo.err, HasSubstr("solver.reprojection"));
    EXPECT_TRUE(nlohmann::json::accept(petal("stages --json").out));
}

TEST_F(CommandLine, AnOutFolderThatHoldsARunOrCannotBeWrittenIsRefused) {
    ASSERT_EQ(run_program("petal_synthetic_scene", "data").exit_code, 0);
    const std::string run = "run " + pipeline("letter_indoor.json") + " --data data ";
    EXPECT_NE(petal(run + "--out out").exit_code, 1);
    const std::string before = read_text(folder_ / "out" / "result.json");
    const Ended again = petal(run + "--out out");
    EXPECT_EQ(again.exit_code, 2);
    EXPECT_THAT(again.err, HasSubstr("--force"));
    EXPECT_NE(petal(run + "--out out --force").exit_code, 1);
    EXPECT_EQ(read_text(folder_ / "out" / "result.json"), before);
    write("file", "x");
    const Ended file = petal(run + "--out file/below");
    EXPECT_EQ(file.exit_code, 1);
    EXPECT_THAT(file.err, HasSubstr("file"));
    EXPECT_EQ(petal(run + "--out data").exit_code, 2) << "never into the data";
}

TEST_F(CommandLine, TheDefaultFolderIsBelowRuns) {
    ASSERT_EQ(run_program("petal_synthetic_scene", "data").exit_code, 0);
    petal("run " + pipeline("letter_indoor.json") + " --data data --quiet");
    ASSERT_TRUE(fs::is_directory(folder_ / "runs"));
    const fs::path made = fs::directory_iterator(folder_ / "runs")->path();
    EXPECT_THAT(made.filename().string(), HasSubstr("letter_indoor-20"));
    EXPECT_TRUE(fs::exists(made / "result.json"));
}

}  // namespace
}  // namespace petal::testing
