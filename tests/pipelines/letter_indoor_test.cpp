// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/se3.hpp"
#include "petal_process.hpp"
#include "real_data.hpp"

namespace petal::testing {
namespace {

using nlohmann::json;
using ::testing::AnyOf;
using ::testing::HasSubstr;

Eigen::Isometry3d pose_of(const json& rows) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c)
            pose.matrix()(r, c) = rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
    return pose;
}

Eigen::Isometry3d published_pose(const fs::path& file) {
    std::ifstream in(file);
    in.imbue(std::locale::classic());
    std::string title;
    in >> title;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c) in >> pose.matrix()(r, c);
    return pose;
}

/// Every form that result.json promises, whatever the result.
void expect_contract(const json& result) {
    EXPECT_THAT(result["verdict"].get<std::string>(), AnyOf("usable", "weak", "not_usable"));
    EXPECT_TRUE(result["reasons"].is_array());
    for (const json& camera : result["extrinsics"]) {
        const Eigen::Isometry3d T = pose_of(camera["T_camera_lidar"]);
        EXPECT_TRUE(
            (T * pose_of(camera["T_lidar_camera"])).isApprox(Eigen::Isometry3d::Identity(), 1e-9));
        EXPECT_NEAR(T.linear().determinant(), 1.0, 1e-9);
        EXPECT_EQ(camera["covariance"].size(), 6U);
        EXPECT_EQ(camera["covariance"][5].size(), 6U);
        EXPECT_EQ(camera["sigma_translation_m"].size(), 3U);
        EXPECT_EQ(camera["sigma_rotation_deg"].size(), 3U);
        EXPECT_FALSE(camera["weakest_direction"].get<std::string>().empty());
        EXPECT_THAT(camera["sentence"].get<std::string>(), HasSubstr("the LiDAR sits"));
    }
    for (const char* key : {"count", "rms_px", "mean_px", "max_px"})
        EXPECT_TRUE(result["residuals"][key].is_number()) << key;
    for (const json& scene : result["scenes"])
        for (const json& board : scene["boards"]) {
            EXPECT_TRUE(board["corners_lidar"].is_null() || board["corners_lidar"].size() == 16U);
            EXPECT_TRUE(board["corners_image"].is_null() || board["corners_image"].size() == 16U);
        }
    EXPECT_TRUE(result["metrics"].is_object());
}

class LetterIndoor : public PetalProcess {
   protected:
    /// Runs the pipeline on the real indoor data.
    Ended run_real(const std::string& out, const std::string& more = "") {
        return petal("run " + pipeline("letter_indoor.json") + " --data '" +
                     (real_data() / "sjtu_indoor").string() + "' --out " + out + " " + more);
    }
};

// The published pose is the authors' own fit; 2 deg and 8 cm hold it (issue's figures): three
// boards at 2.3 to 3 m alone move it by 0.6 deg and 3 cm.
TEST_F(LetterIndoor, RealSceneIsWeakAndNearThePublishedPose) {
    PETAL_NEEDS_REAL_DATA();
    const Ended ended = run_real("run");
    EXPECT_EQ(ended.exit_code, 4) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("verdict: weak"));
    const json result = json::parse(read_text(folder_ / "run" / "result.json"));
    expect_contract(result);
    EXPECT_EQ(result["verdict"], "weak");
    ASSERT_EQ(result["extrinsics"].size(), 1U);
    const Eigen::Isometry3d T = pose_of(result["extrinsics"][0]["T_camera_lidar"]);
    const Eigen::Isometry3d published =
        published_pose(real_data() / "sjtu_indoor" / "published_extrinsic.txt");
    EXPECT_LT(rotation_angle(T.linear().transpose() * published.linear()) * kDegrees, 2.0);
    EXPECT_LT((T.translation() - published.translation()).norm(), 0.08);
    EXPECT_EQ(result["residuals"]["count"], 48);
    EXPECT_LE(result["residuals"]["rms_px"].get<double>(), 1.5);

    // The LiDAR sees three of the four boards: the fourth is told with null for the LiDAR.
    ASSERT_EQ(result["scenes"].size(), 1U);
    int only_image = 0;
    for (const json& board : result["scenes"][0]["boards"])
        only_image += board["corners_lidar"].is_null() ? 1 : 0;
    EXPECT_EQ(result["scenes"][0]["boards"].size(), 4U);
    EXPECT_EQ(only_image, 1);

    const json run = json::parse(read_text(folder_ / "run" / "run.json"));
    EXPECT_EQ(run["status"], "done");
    EXPECT_EQ(run["data"].size(), 3U) << "image, intrinsics and cloud, each with its checksum";
    EXPECT_GT(run["peak_memory_bytes"].get<std::uint64_t>(), 0U);
    EXPECT_TRUE(fs::exists(folder_ / "run" / "log.txt"));
    bool overlay = false;
    for (const auto& file : fs::directory_iterator(folder_ / "run" / "stages" / "overlay"))
        overlay = overlay || file.path().extension() == ".png";
    EXPECT_TRUE(overlay);
}

TEST_F(LetterIndoor, SameBytesOnOneAndTwoThreads) {
    PETAL_NEEDS_REAL_DATA();
    run_real("one", "--threads 1");
    run_real("two", "--threads 2 --debug all");
    const std::string one = read_text(folder_ / "one" / "result.json");
    EXPECT_FALSE(one.empty());
    EXPECT_EQ(one, read_text(folder_ / "two" / "result.json"));
}

TEST_F(LetterIndoor, VariantsRun) {
    PETAL_NEEDS_REAL_DATA();
    for (const std::string name :
         {"solver_pnp", "solver_joint", "plain_lines", "image_template", "lidar_template"}) {
        const Ended ended = run_real(name, "--with " + pipeline("variants/" + name + ".json"));
        EXPECT_EQ(ended.exit_code, 4) << name << ": " << ended.err;
        expect_contract(json::parse(read_text(folder_ / name / "result.json")));
    }
}

// Known truth: edges at 3 mm noise and 10 mm inflation that the spacing takes out, photo noise 2.5
// grey levels. The bound is five of the 1-sigma that the result itself tells, so it also says that
// sigma is honest.
TEST_F(LetterIndoor, SyntheticSceneIsNearItsTruth) {
    ASSERT_EQ(run_program("petal_synthetic_scene", "data").exit_code, 0);
    const Ended ended = petal("run " + pipeline("letter_indoor.json") + " --data data --out run");
    EXPECT_THAT(ended.exit_code, AnyOf(0, 4)) << ended.err;
    const json result = json::parse(read_text(folder_ / "run" / "result.json"));
    expect_contract(result);
    ASSERT_EQ(result["extrinsics"].size(), 1U);
    EXPECT_EQ(result["residuals"]["count"], 64);
    const json& camera = result["extrinsics"][0];
    const Eigen::Isometry3d T = pose_of(camera["T_camera_lidar"]);
    const json truth = json::parse(read_text(folder_ / "data" / "truth.json"));
    const Eigen::Isometry3d T_true = pose_of(truth["T_camera_lidar"]);
    for (std::size_t i = 0; i < 3; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        EXPECT_LT(std::abs(T.translation()(k) - T_true.translation()(k)),
                  5.0 * camera["sigma_translation_m"][i].get<double>());
        const Eigen::AngleAxisd off(T.linear() * T_true.linear().transpose());
        EXPECT_LT(std::abs((off.angle() * off.axis())(k)) * kDegrees,
                  5.0 * camera["sigma_rotation_deg"][i].get<double>());
    }
    EXPECT_LT((T.translation() - T_true.translation()).norm(), 0.02);
}

TEST_F(LetterIndoor, APhotoWithoutABoardIsNotUsableAndSaysWhatWasSeen) {
    ASSERT_EQ(run_program("petal_synthetic_scene", "data").exit_code, 0);
    // The floor of the scene: no board in it. Python or ImageMagick may be absent, so the crop is
    // made by OpenCV.
    const cv::Mat photo =
        cv::imread((folder_ / "data" / "image.jpg").string(), cv::IMREAD_GRAYSCALE);
    cv::Mat floor = photo.clone();
    floor.setTo(60);
    ASSERT_TRUE(cv::imwrite((folder_ / "data" / "image.jpg").string(), floor));
    const Ended ended = petal("run " + pipeline("letter_indoor.json") + " --data data --out run");
    EXPECT_EQ(ended.exit_code, 4) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("verdict: not_usable"));
    EXPECT_THAT(ended.err, HasSubstr("[image_boards]"));
    const json result = json::parse(read_text(folder_ / "run" / "result.json"));
    expect_contract(result);
    EXPECT_EQ(result["extrinsics"].size(), 0U);
    EXPECT_FALSE(fs::is_empty(folder_ / "run" / "stages" / "image_boards")) << "an overlay is kept";
}

TEST_F(LetterIndoor, AnEmptyCloudIsNotUsable) {
    ASSERT_EQ(run_program("petal_synthetic_scene", "data").exit_code, 0);
    std::ofstream(folder_ / "data" / "lidar_margin_points.csv") << "# nothing\n";
    const Ended ended = petal("run " + pipeline("letter_indoor.json") + " --data data --out run");
    EXPECT_EQ(ended.exit_code, 4) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("verdict: not_usable"));
}

TEST_F(LetterIndoor, AnImageOfAnotherSizeThanKIsRefused) {
    ASSERT_EQ(run_program("petal_synthetic_scene", "data").exit_code, 0);
    const fs::path image = folder_ / "data" / "image.jpg";
    cv::Mat photo = cv::imread(image.string(), cv::IMREAD_GRAYSCALE);
    ASSERT_TRUE(cv::imwrite(image.string(), photo(cv::Rect(0, 0, 640, 480)).clone()));
    const Ended ended = petal("run " + pipeline("letter_indoor.json") + " --data data --out run");
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_THAT(ended.err, HasSubstr("640"));
    EXPECT_THAT(ended.err, HasSubstr("960"));
    EXPECT_FALSE(fs::exists(folder_ / "run" / "result.json")) << "nothing half done is left";
    EXPECT_EQ(json::parse(read_text(folder_ / "run" / "run.json"))["status"], "failed");
}

}  // namespace
}  // namespace petal::testing
