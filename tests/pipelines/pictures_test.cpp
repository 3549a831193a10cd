// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include "petal_process.hpp"

namespace petal::testing {
namespace {

/// A simulated capture in place of the rawlog.
class LetterVariants : public PetalProcess {
   protected:
    Ended run_with(const std::string& pipeline_name, const std::string& variant) const {
        std::ofstream(folder_ / "simulated.json")
            << R"({"petal": 1, "stages": {"scene": {"type": "source.simulator",
                   "params": {"scenes": ["indoor_floor_3m"], "duration": 6.0}}}})";
        return petal("run " + pipeline(pipeline_name) + " --with " + pipeline(variant) +
                     " --with simulated.json --seed 3 --out out");
    }
};

TEST_F(LetterVariants, PicturesComeWithACalibration) {
    const Ended ended = run_with("calibrate.json", "variants/pictures.json");
    EXPECT_EQ(ended.exit_code, 4) << ended.err;  // one placement: weak
    int pictures = 0;
    for (const char* folder : {"colored_cloud", "projection"})
        for (const auto& file : fs::directory_iterator(folder_ / "out" / folder)) {
            ++pictures;
            EXPECT_GT(fs::file_size(file), 100000u) << file;
        }
    EXPECT_EQ(pictures, 3);  // PLY, 3Dscene, PNG
}

TEST_F(LetterVariants, TableThreeStandsAmongTheMetrics) {
    const Ended ended = run_with("letter.json", "variants/table3.json");
    EXPECT_EQ(ended.exit_code, 4) << ended.err;
    const auto metrics =
        nlohmann::json::parse(read_text(folder_ / "out" / "result.json"))["metrics"];
    // Of the pairs that made the pose: the drift is their mean residual.
    EXPECT_NEAR(metrics["board_drift.mean_px"].get<double>(),
                metrics["reprojection.mean_px"].get<double>(), 1e-9);
    EXPECT_EQ(metrics["uncolored_distance.count"], 16);
    // A tenth of a pixel at 3 m is 0.3 mm; more than a centimetre would be another board.
    EXPECT_GT(metrics["uncolored_distance.max"].get<double>(), 0.0);
    EXPECT_LT(metrics["uncolored_distance.max"].get<double>(), 0.01);
}

}  // namespace
}  // namespace petal::testing
