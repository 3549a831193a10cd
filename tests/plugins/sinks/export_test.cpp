// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/export.hpp"

#include <gmock/gmock.h>
#include <mrpt/config/CConfigFile.h>
#include <mrpt/containers/yaml.h>
#include <mrpt/poses/CPose3D.h>

#include <clocale>
#include <fstream>
#include <iterator>
#include <locale>
#include <map>
#include <opencv2/core.hpp>
#include <sstream>

#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

using mrpt::img::DistortionModel;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::StageHarness;

/// Nine decimals of a matrix's elements, quaternions or angles: half a unit of the last, times what
/// the way back makes of it.
constexpr double kRounding = 5e-9;

mrpt::img::TCamera exported_model(DistortionModel distortion) {
    mrpt::img::TCamera model;
    model.ncols = 1280;
    model.nrows = 720;
    model.setIntrinsicParamsFromValues(915.25, 914.75, 640.5, 360.25);
    model.distortion = distortion;
    model.k1(0.11);
    model.k2(-0.22);
    if (distortion == DistortionModel::kannala_brandt) {
        model.k3(0.03);
        model.k4(-0.004);
    } else {
        model.p1(0.001);
        model.p2(-0.002);
    }
    return model;
}

/// A camera that looks along the LiDAR's x axis, a little turned: yaw, pitch and roll of the
/// optical frame stand at their singularity.
CameraExtrinsics exported_camera(const std::string& label, double turn = 0.01) {
    CameraExtrinsics camera;
    camera.camera = label;
    camera.lidar = "LIDAR";
    Eigen::Matrix3d axes;
    axes << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    camera.T_camera_lidar.linear() =
        (Eigen::AngleAxisd(turn, Eigen::Vector3d(1, 2, 3).normalized()) * axes).eval();
    camera.T_camera_lidar.translation() << 0.0412345678, -0.11, -0.0300000004;
    return camera;
}

Extrinsics exported(std::vector<CameraExtrinsics> cameras) {
    Extrinsics extrinsics;
    extrinsics.cameras = std::move(cameras);
    extrinsics.level = Level::usable;
    return extrinsics;
}

CameraImage photo_of(const std::string& label, DistortionModel distortion) {
    CameraImage image;
    image.label = label;
    image.image = mrpt::img::CImage(4, 3, mrpt::img::CH_GRAY);
    image.camera = exported_model(distortion);
    return image;
}

/// With a point, whatever the locale of the process.
double number_in(const std::string& text) {
    std::istringstream in(text);
    in.imbue(std::locale::classic());
    double number = 0.0;
    EXPECT_TRUE(in >> number) << text;
    return number;
}

Eigen::Isometry3d quaternion_pose(const std::vector<double>& v) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::Quaterniond(v[6], v[3], v[4], v[5]).normalized().toRotationMatrix();
    pose.translation() << v[0], v[1], v[2];
    return pose;
}

void expect_pose(const Eigen::Isometry3d& found, const Eigen::Isometry3d& expected) {
    EXPECT_LT((found.matrix() - expected.matrix()).cwiseAbs().maxCoeff(), kRounding)
        << found.matrix() << "\nexpected\n"
        << expected.matrix();
}

/// MRPT's readers go by the locale of the process; what was written must not.
class PlainLocale {
   public:
    PlainLocale() : c_(std::setlocale(LC_ALL, nullptr)), cpp_(std::locale()) {
        std::locale::global(std::locale::classic());  // and that of C
    }
    PlainLocale(const PlainLocale&) = delete;
    PlainLocale& operator=(const PlainLocale&) = delete;
    ~PlainLocale() {
        std::locale::global(cpp_);
        std::setlocale(LC_ALL, c_.c_str());
    }

   private:
    std::string c_;
    std::locale cpp_;
};

class ExportTest : public ::testing::Test {
   protected:
    void give(const CameraExtrinsics& camera,
              DistortionModel distortion = DistortionModel::plumb_bob) {
        stage_.give<Extrinsics>("extrinsics", exported({camera}));
        stage_.give<Images>("images", Images{{photo_of(camera.camera, distortion)}}, "hall");
    }
    std::string text(const std::string& name) {
        std::ifstream in(stage_.folder() / "export" / name);
        EXPECT_TRUE(in) << name;
        return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    }
    /// The words of the n-th args="..." of a launch file.
    static std::vector<std::string> args(const std::string& launch) {
        const std::size_t begin = launch.find("args=\"") + 6;
        std::istringstream in(launch.substr(begin, launch.find('"', begin) - begin));
        return {std::istream_iterator<std::string>(in), {}};
    }

    StageHarness stage_ = StageHarness::of<Export>();
    CameraExtrinsics camera_ = exported_camera("CAMERA");
};

TEST_F(ExportTest, Ros1GivesThePoseOfTheOpticalFrameInTheLidar) {
    give(camera_);
    stage_.fire();
    const auto words = args(text("static_transforms.launch"));
    ASSERT_EQ(words.size(), 9u);
    std::vector<double> numbers;
    for (std::size_t i = 0; i < 7; ++i) numbers.push_back(number_in(words[i]));
    EXPECT_EQ(words[7], "LIDAR");
    EXPECT_EQ(words[8], "CAMERA_optical_frame");
    expect_pose(quaternion_pose(numbers), camera_.T_camera_lidar.inverse());
}

TEST_F(ExportTest, Ros2NamesEachNumber) {
    give(camera_);
    stage_.set("parent", "camera").fire();
    const auto words = args(text("static_transforms.launch.xml"));
    std::map<std::string, std::string> named;
    for (std::size_t i = 0; i + 1 < words.size(); i += 2) named[words[i]] = words[i + 1];
    std::vector<double> numbers;
    for (const char* key : {"--x", "--y", "--z", "--qx", "--qy", "--qz", "--qw"})
        numbers.push_back(number_in(named.at(key)));
    EXPECT_EQ(named.at("--frame-id"), "CAMERA_optical_frame");
    EXPECT_EQ(named.at("--child-frame-id"), "LIDAR");
    expect_pose(quaternion_pose(numbers), camera_.T_camera_lidar);
}

TEST_F(ExportTest, AutowareHasTheBodyFrameOfTheCamera) {
    give(camera_);
    stage_.fire();
    const PlainLocale plain;
    const auto yaml = mrpt::containers::yaml::FromText(text("sensor_kit_calibration.yaml"));
    const auto pose = yaml["LIDAR"]["CAMERA/camera_link"];
    const auto number = [&](const char* key) { return pose[key].as<double>(); };
    // The optical frame on camera_link, as Autoware's own description has it.
    const mrpt::poses::CPose3D body(number("x"), number("y"), number("z"), number("yaw"),
                                    number("pitch"), number("roll"));
    const mrpt::poses::CPose3D optical(0, 0, 0, -M_PI / 2, 0, -M_PI / 2);
    const Eigen::Isometry3d found(
        (body + optical).getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen());
    expect_pose(found, camera_.T_camera_lidar.inverse());
    // It looks along the LiDAR's x axis, so there is little to turn.
    EXPECT_LT(std::abs(number("roll")) + std::abs(number("pitch")) + std::abs(number("yaw")), 0.02);
}

TEST_F(ExportTest, KalibrChainsTheCameras) {
    const CameraExtrinsics second = exported_camera("RIGHT", 0.3);
    stage_.give<Extrinsics>("extrinsics", exported({camera_, second}));
    stage_.give<Images>("images", Images{{photo_of("CAMERA", DistortionModel::plumb_bob),
                                          photo_of("RIGHT", DistortionModel::kannala_brandt)}});
    stage_.fire();
    const PlainLocale plain;
    const auto yaml = mrpt::containers::yaml::FromText(text("camchain.yaml"));
    const auto matrix = [&](const char* camera, const char* key) {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        const auto rows = yaml[camera][key];
        for (int r = 0; r < 4; ++r)
            for (int c = 0; c < 4; ++c)
                pose.matrix()(r, c) = rows.asSequence()
                                          .at(static_cast<std::size_t>(r))
                                          .asSequence()
                                          .at(static_cast<std::size_t>(c))
                                          .as<double>();
        return pose;
    };
    expect_pose(matrix("cam0", "T_cam_lidar"), camera_.T_camera_lidar);
    expect_pose(matrix("cam1", "T_cam_lidar"), second.T_camera_lidar);
    expect_pose(matrix("cam1", "T_cn_cnm1"),
                second.T_camera_lidar * camera_.T_camera_lidar.inverse());
    EXPECT_EQ(yaml["cam0"]["distortion_model"].as<std::string>(), "radtan");
    EXPECT_EQ(yaml["cam1"]["distortion_model"].as<std::string>(), "equidistant");
    EXPECT_EQ(yaml["cam0"]["intrinsics"].asSequence().at(0).as<double>(), 915.25);
    EXPECT_EQ(yaml["cam1"]["distortion_coeffs"].asSequence().at(3).as<double>(), -0.004);
    EXPECT_EQ(yaml["cam0"]["resolution"].asSequence().at(1).as<int>(), 720);
    // FAST-LIVO2 has one camera: a file each.
    EXPECT_THAT(text("fast_livo2_RIGHT_LIDAR.yaml"), HasSubstr("EquidistantCamera"));
    EXPECT_THAT(text("fast_livo2_CAMERA_LIDAR.yaml"), HasSubstr("cam_d3: -0.002"));
}

TEST_F(ExportTest, FastLivo2ReadsRclAndPcl) {
    give(camera_);
    stage_.fire();
    const PlainLocale plain;
    const auto yaml = mrpt::containers::yaml::FromText(text("fast_livo2.yaml"));
    const auto number = [&](const char* key, std::size_t i) {
        return yaml["extrin_calib"][key].asSequence().at(i).as<double>();
    };
    Eigen::Isometry3d found = Eigen::Isometry3d::Identity();
    for (std::size_t i = 0; i < 9; ++i)
        found.linear()(static_cast<int>(i / 3), static_cast<int>(i % 3)) = number("Rcl", i);
    for (std::size_t i = 0; i < 3; ++i) found.translation()[static_cast<int>(i)] = number("Pcl", i);
    expect_pose(found, camera_.T_camera_lidar);
    EXPECT_EQ(yaml["cam_model"].as<std::string>(), "Pinhole");
    EXPECT_EQ(yaml["cam_width"].as<int>(), 1280);
    EXPECT_EQ(yaml["cam_cy"].as<double>(), 360.25);
    EXPECT_EQ(yaml["cam_d2"].as<double>(), 0.001);
}

TEST_F(ExportTest, OpenCvReadsItsOwn) {
    give(exported_camera("[odd] {label}"));
    stage_.fire();
    const cv::FileStorage file((stage_.folder() / "export" / "opencv.yaml").string(),
                               cv::FileStorage::READ);
    const cv::FileNode camera = file["cameras"][0];
    EXPECT_EQ(static_cast<std::string>(camera["camera"]), "[odd] {label}");
    const auto matrix = [&](const char* key) {
        cv::Mat mat;
        camera[key] >> mat;
        Eigen::MatrixXd found(mat.rows, mat.cols);
        for (int r = 0; r < mat.rows; ++r)
            for (int c = 0; c < mat.cols; ++c) found(r, c) = mat.at<double>(r, c);
        return found;
    };
    expect_pose(Eigen::Isometry3d(Eigen::Matrix4d(matrix("T_camera_lidar"))),
                camera_.T_camera_lidar);
    expect_pose(Eigen::Isometry3d(Eigen::Matrix4d(matrix("T_lidar_camera"))),
                camera_.T_camera_lidar.inverse());
    const Eigen::Vector3d rvec = matrix("rvec");
    Eigen::Isometry3d by_vectors = Eigen::Isometry3d::Identity();
    by_vectors.linear() = Eigen::AngleAxisd(rvec.norm(), rvec.normalized()).toRotationMatrix();
    by_vectors.translation() = matrix("tvec");
    expect_pose(by_vectors, camera_.T_camera_lidar);
    EXPECT_EQ(matrix("camera_matrix")(1, 2), 360.25);
    EXPECT_EQ(matrix("distortion_coefficients")(1, 0), -0.22);
}

TEST_F(ExportTest, MrptReadsPosesAndCameras) {
    for (const auto distortion :
         {DistortionModel::plumb_bob, DistortionModel::kannala_brandt, DistortionModel::none}) {
        StageHarness stage = StageHarness::of<Export>();
        stage.give<Extrinsics>("extrinsics", exported({camera_}));
        stage.give<Images>("images", Images{{photo_of("CAMERA", distortion)}});
        stage.fire();
        const PlainLocale plain;
        const mrpt::config::CConfigFile file((stage.folder() / "export" / "mrpt.ini").string());
        const auto pose = [&](const char* key) {
            const auto read =
                mrpt::poses::CPose3D::FromString(file.read_string("CAMERA", key, "", true));
            return Eigen::Isometry3d(
                read.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen());
        };
        expect_pose(pose("camera_on_lidar"), camera_.T_camera_lidar.inverse());
        expect_pose(pose("lidar_on_camera"), camera_.T_camera_lidar);
        mrpt::img::TCamera model;
        model.loadFromConfigFile("CAMERA", file);
        mrpt::img::TCamera expected = exported_model(distortion);
        if (distortion == DistortionModel::none) expected.dist.fill(0.0);
        EXPECT_EQ(model.distortion, distortion);
        EXPECT_EQ(model.ncols, 1280u);
        EXPECT_EQ(model.fx(), expected.fx());
        EXPECT_EQ(model.cy(), expected.cy());
        EXPECT_EQ(model.dist, expected.dist);
    }
}

TEST_F(ExportTest, EachFileTellsFramesDirectionsAndAVerdictThatIsNotUsable) {
    Extrinsics weak = exported({camera_});
    weak.level = Level::weak;
    weak.reasons = {"one placement -- only", "two\nlines"};
    stage_.give<Extrinsics>("extrinsics", weak);
    stage_.give<Metrics>("metrics", Metrics{{}, {{Level::not_usable, "the board moved"}}});
    stage_.fire();
    EXPECT_EQ(stage_.verdict(), Level::not_usable);
    for (const char* name :
         {"static_transforms.launch", "static_transforms.launch.xml", "sensor_kit_calibration.yaml",
          "camchain.yaml", "fast_livo2.yaml", "opencv.yaml", "mrpt.ini"}) {
        const std::string file = text(name);
        EXPECT_THAT(file, HasSubstr("VERDICT: not_usable")) << name;
        EXPECT_THAT(file, HasSubstr("the board moved")) << name;
        EXPECT_THAT(file, HasSubstr("two lines")) << name;
        EXPECT_THAT(file, HasSubstr("T_camera_lidar, p_camera = R p_lidar + t")) << name;
        EXPECT_THAT(file, HasSubstr("T_lidar_camera, p_lidar = R p_camera + t")) << name;
        EXPECT_THAT(file, HasSubstr("quaternion x y z w")) << name;
        EXPECT_THAT(file, HasSubstr("x right, y down, z forward")) << name;
        EXPECT_THAT(file, HasSubstr("the LiDAR sits 4.1 cm right of")) << name;
    }
    // Two hyphens would end the comment of XML.
    const std::string xml = text("static_transforms.launch");
    EXPECT_EQ(xml.find("--", 4), xml.find("-->"));
}

TEST_F(ExportTest, AUsableOneHasNoVerdict) {
    give(camera_);
    stage_.set("formats", std::vector<std::string>{"mrpt"}).fire();
    EXPECT_THAT(text("mrpt.ini"), Not(HasSubstr("VERDICT")));
    EXPECT_EQ(stage_.verdict(), Level::usable);
    EXPECT_FALSE(std::filesystem::exists(stage_.folder() / "export" / "opencv.yaml"));
}

TEST_F(ExportTest, IntrinsicsThatNobodyToldAreLeftOutAndTold) {
    stage_.give<Extrinsics>("extrinsics", exported({camera_}));
    stage_.fire();
    EXPECT_THAT(text("camchain.yaml"), HasSubstr("Intrinsics are left out"));
    EXPECT_THAT(text("camchain.yaml"), Not(HasSubstr("distortion_coeffs")));
    EXPECT_EQ(stage_.notes().size(), 4u);  // kalibr, fast_livo2, opencv, mrpt
}

TEST_F(ExportTest, AThirdRadialCoefficientIsNotCutOff) {
    CameraImage image = photo_of("CAMERA", DistortionModel::plumb_bob);
    image.camera.k3(0.5);
    stage_.give<Extrinsics>("extrinsics", exported({camera_}));
    stage_.give<Images>("images", Images{{image}}).fire();
    EXPECT_THAT(text("camchain.yaml"), HasSubstr("a k3 or more"));
    EXPECT_THAT(text("opencv.yaml"), HasSubstr("distortion_coefficients"));
}

TEST_F(ExportTest, AnEstimatedFocalLengthGoesWithTheIntrinsics) {
    camera_.diagnosis.emplace();
    camera_.diagnosis->focal = Diagnosis::FocalScale{1.01, 1e-4, true};
    give(camera_);
    stage_.fire();
    const PlainLocale plain;
    const auto yaml = mrpt::containers::yaml::FromText(text("fast_livo2.yaml"));
    EXPECT_NEAR(yaml["cam_fx"].as<double>(), 1.01 * 915.25, 1e-8);
}

TEST_F(ExportTest, FrameNamesHaveNoBlanks) {
    give(exported_camera("front left"));
    stage_.fire();
    EXPECT_EQ(args(text("static_transforms.launch")).at(8), "front_left_optical_frame");
    stage_.set("lidar_frame", "my lidar");
    EXPECT_THROW(stage_.fire(), Error);
}

TEST_F(ExportTest, AFrameHasOneParent) {
    stage_.give<Extrinsics>("extrinsics", exported({camera_, exported_camera("RIGHT")}));
    stage_.set("parent", "camera");
    try {
        stage_.fire();
        FAIL() << "the LiDAR got two parents";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("frame 'LIDAR' would have two parents"));
    }
}

TEST_F(ExportTest, NothingSolvedIsNothingExported) {
    stage_.give<Extrinsics>("extrinsics", Extrinsics{}).fire();
    EXPECT_EQ(stage_.verdict(), Level::not_usable);
    EXPECT_EQ(stage_.notes().size(), 1u);
    EXPECT_FALSE(std::filesystem::exists(stage_.folder() / "export"));
}

}  // namespace
}  // namespace petal
