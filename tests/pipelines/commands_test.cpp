// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include "petal_process.hpp"

namespace petal::testing {
namespace {

using ::testing::HasSubstr;

/// petal NAME, where petal-NAME lies beside petal.
class Commands : public PetalProcess {};

TEST_F(Commands, TargetDrawsAShippedTarget) {
    const Ended ended =
        petal("target four_square_holes_500mm --svg a.svg --pdf sub/a.pdf --dxf a.dxf");
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("a.svg: "));
    EXPECT_THAT(read_text(folder_ / "a.svg"), HasSubstr("0,0 500,0 500,500 0,500"));
    EXPECT_THAT(read_text(folder_ / "sub" / "a.pdf"), HasSubstr("0 0 m 500 0 l 500 500 l 0 500 l"));
    EXPECT_THAT(read_text(folder_ / "a.dxf"), HasSubstr("AC1009"));
}

TEST_F(Commands, TargetTellsWhatIsWrong) {
    EXPECT_EQ(petal("target checkerboard").exit_code, 2);  // no format
    const Ended unknown = petal("target nothing --svg a.svg");
    EXPECT_EQ(unknown.exit_code, 1);
    EXPECT_THAT(unknown.err, HasSubstr("no target 'nothing'"));
    EXPECT_FALSE(fs::exists(folder_ / "a.svg"));
}

TEST_F(Commands, DiffComparesTwoResults) {
    const std::string pose = R"("camera": "C", "lidar": "L", "T_camera_lidar": [[1,0,0,)" +
                             std::string("%") +
                             R"(],[0,1,0,0],[0,0,1,0],[0,0,0,1]], "covariance":
        [[1e-6,0,0,0,0,0],[0,1e-6,0,0,0,0],[0,0,1e-6,0,0,0],
         [0,0,0,1e-6,0,0],[0,0,0,0,1e-6,0],[0,0,0,0,0,1e-6]])";
    for (const char* x : {"0.1", "0.102", "0.2"}) {
        std::string text = pose;
        text.replace(text.find('%'), 1, x);
        std::ofstream(folder_ / (std::string(x) + ".json"))
            << R"({"verdict": "usable", "reasons": [], "extrinsics": [{)" << text << "}]}";
    }
    const Ended alike = petal("diff 0.1.json 0.102.json");
    EXPECT_EQ(alike.exit_code, 0) << alike.err;
    EXPECT_THAT(alike.out, HasSubstr("2.00 mm     1.41 mm       1.4"));
    const Ended other = petal("diff 0.1.json 0.2.json --json");
    EXPECT_EQ(other.exit_code, 4) << other.err;
    EXPECT_EQ(nlohmann::json::parse(other.out)["agree"], false);
    EXPECT_EQ(petal("diff 0.1.json").exit_code, 2);
    EXPECT_EQ(petal("diff 0.1.json none.json").exit_code, 1);
}

TEST_F(Commands, AreListedAndNotFoundElsewhere) {
    EXPECT_THAT(petal("--help").out, HasSubstr("petal diff, petal target"));
    // Neither the working folder nor PATH gives petal a command.
    std::ofstream(folder_ / "petal-evil") << "#!/bin/sh\necho evil\n";
    fs::permissions(folder_ / "petal-evil", fs::perms::owner_all);
    const Ended evil = petal("evil");
    EXPECT_EQ(evil.exit_code, 2);
    EXPECT_EQ(evil.out.find("evil\n"), std::string::npos);
}

}  // namespace
}  // namespace petal::testing
