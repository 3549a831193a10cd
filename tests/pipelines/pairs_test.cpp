// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include "petal_process.hpp"
#include "real_data.hpp"

namespace petal::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class Pairs : public PetalProcess {};

json first_pose(const json& result) {
    return result["extrinsics"][0]["T_camera_lidar"];
}

// The published pose is rounded to six digits; a plain least-squares fit gives it again to 0.03 deg
// and 0.2 mm, with the RMS of 1.055 px that the data's README tells.
TEST_F(Pairs, IndoorPairsGiveThePublishedPoseAgain) {
    PETAL_NEEDS_REAL_DATA();
    const fs::path data = real_data() / "sjtu_indoor";
    const Ended ended =
        petal("run " + pipeline("pairs.json") + " --data '" + data.string() + "' --out run");
    EXPECT_EQ(ended.exit_code, 4) << ended.err;
    const json result = json::parse(read_text(folder_ / "run" / "result.json"));
    EXPECT_EQ(result["orientation"]["decided_by"], "given");
    EXPECT_NEAR(result["residuals"]["rms_px"].get<double>(), 1.055, 0.002);
    EXPECT_NEAR(result["metrics"]["reprojection.rms_px"].get<double>(),
                result["residuals"]["rms_px"].get<double>(), 1e-9);
    std::ifstream in(data / "published_extrinsic.txt");
    in.imbue(std::locale::classic());
    std::string title;
    in >> title;
    const json pose = first_pose(result);
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 4; ++c) {
            double published = 0.0;
            in >> published;
            // 0.03 deg of rotation; 0.2 mm of translation.
            EXPECT_NEAR(pose[r][c].get<double>(), published, c < 3 ? 5.2e-4 : 2e-4);
        }
}

TEST_F(Pairs, TheSolverIsSwappedByAPatch) {
    PETAL_NEEDS_REAL_DATA();
    const std::string run = "run " + pipeline("pairs.json") + " --data '" +
                            (real_data() / "sjtu_indoor").string() + "' ";
    EXPECT_EQ(petal(run + "--out own").exit_code, 4);
    const Ended ended = petal(run + "--out pnp --with " + pipeline("variants/solver_pnp.json"));
    EXPECT_EQ(ended.exit_code, 4) << ended.err;
    EXPECT_NE(read_text(folder_ / "own" / "result.json"),
              read_text(folder_ / "pnp" / "result.json"));
    const json one = json::parse(read_text(folder_ / "own" / "run.json"));
    const json two = json::parse(read_text(folder_ / "pnp" / "run.json"));
    EXPECT_EQ(one["pipeline"]["stages"]["solve"]["type"], "solver.reprojection");
    EXPECT_EQ(two["pipeline"]["stages"]["solve"]["type"], "solver.pnp");
    EXPECT_EQ(one["data"], two["data"]);
}

TEST_F(Pairs, MissingDataAreNamed) {
    const std::string run = "run " + pipeline("pairs.json") + " --out run --data ";
    const Ended no_folder = petal(run + "nowhere");
    EXPECT_EQ(no_folder.exit_code, 2);
    EXPECT_THAT(no_folder.err, HasSubstr("--data nowhere is no folder"));
    fs::create_directory(folder_ / "empty");
    const Ended no_file = petal(run + "empty");
    EXPECT_EQ(no_file.exit_code, 1);
    EXPECT_THAT(no_file.err, HasSubstr("intrinsics.yaml does not exist"));
}

}  // namespace
}  // namespace petal::testing
