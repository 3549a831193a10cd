// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/detail/intrinsics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plugins/sources/temporary_folder.hpp"
#include "real_data.hpp"

namespace petal {
namespace {

using mrpt::img::DistortionModel;
using ::testing::HasSubstr;

class IntrinsicsFiles : public testing::TemporaryFolder {
   protected:
    std::string refused(const std::string& name, const std::string& text,
                        const std::string& model = "auto") const {
        const auto file = write(name, text);
        return refusal([&] { read_intrinsics(file, model); });
    }
    static std::string opencv(const std::string& coefficients, const std::string& more = "") {
        return "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: "
               "!!opencv-matrix\n"
               "   rows: 3\n   cols: 3\n   dt: d\n   data: [ 500., 0., 320.5, 0., 510., 240.5,\n"
               "       0., 0., 1. ]\ndistortion_coefficients:\n   data: [" +
               coefficients + "]\n" + more;
    }
};

TEST_F(IntrinsicsFiles, OpenCvNames) {
    const Intrinsics k = read_intrinsics(write("a.yaml", opencv("0.1, 0.2, 0.3, 0.4, 0.5")));
    EXPECT_EQ(k.camera.ncols, 640U);
    EXPECT_EQ(k.camera.nrows, 480U);
    EXPECT_EQ(k.camera.fx(), 500.0);
    EXPECT_EQ(k.camera.fy(), 510.0);
    EXPECT_EQ(k.camera.cx(), 320.5);
    EXPECT_EQ(k.camera.cy(), 240.5);
    EXPECT_EQ(k.camera.distortion, DistortionModel::plumb_bob);
    EXPECT_EQ(k.camera.k1(), 0.1);
    EXPECT_EQ(k.camera.p2(), 0.4);
    EXPECT_EQ(k.camera.k3(), 0.5);
}

TEST_F(IntrinsicsFiles, FourFiveOrEightCoefficients) {
    for (const char* coefficients : {"1, 2, 3, 4", "1, 2, 3, 4, 5", "1, 2, 3, 4, 5, 6, 7, 8"})
        EXPECT_EQ(read_intrinsics(write("a.yaml", opencv(coefficients))).camera.dist[3], 4.0);
    EXPECT_EQ(read_intrinsics(write("a.yaml", opencv("1, 2, 3, 4, 5, 6, 7, 8"))).camera.k6(), 8.0);
    EXPECT_THAT(refused("a.yaml", opencv("1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12")),
                HasSubstr("12 distortion coefficients; at most 8"));
    EXPECT_THAT(refused("a.yaml", opencv("1, 2, 3")), HasSubstr("4, 5 or 8"));
}

TEST_F(IntrinsicsFiles, FisheyeKeepsAllFourCoefficients) {
    for (const char* word : {"DistModel: equidistant\n", "distortion_model: fisheye\n"}) {
        const auto camera = read_intrinsics(write("a.yaml", opencv("1, 2, 3, 4", word))).camera;
        EXPECT_EQ(camera.distortion, DistortionModel::kannala_brandt);
        EXPECT_EQ(camera.k1(), 1.0);
        EXPECT_EQ(camera.k2(), 2.0);
        EXPECT_EQ(camera.k3(), 3.0);
        EXPECT_EQ(camera.k4(), 4.0);
    }
    const auto said = read_intrinsics(write("a.yaml", opencv("1, 2, 3, 4")), "kannala_brandt");
    EXPECT_EQ(said.camera.distortion, DistortionModel::kannala_brandt);
    EXPECT_THAT(refused("a.yaml", opencv("1, 2, 3, 4, 5", "DistModel: fisheye\n")),
                HasSubstr("4 coefficients"));
    EXPECT_THAT(refused("a.yaml", opencv("1, 2, 3, 4", "DistModel: mirror\n")),
                HasSubstr("'mirror'"));
}

TEST_F(IntrinsicsFiles, RosNames) {
    const auto camera =
        read_intrinsics(write("a.yml",
                              "width: 20\nheight: 10\ndistortion_model: plumb_bob\n"
                              "D: [0.0, 0.0, 0.0, 0.0, 0.0]\nK: [9, 0, 10, 0, 8, 5, 0, 0, 1]\n"))
            .camera;
    EXPECT_EQ(camera.ncols, 20U);
    EXPECT_EQ(camera.fx(), 9.0);
}

TEST_F(IntrinsicsFiles, TextInTwoBlocks) {
    Intrinsics k = read_intrinsics(write(
        "k.txt", "intrinsic\n920 0 645\n0 921 358\n0 0 1\n\ndistortion\n0.1 0.2 0.3 0.4 0\n"));
    EXPECT_FALSE(k.has_size());
    EXPECT_EQ(k.camera.fy(), 921.0);
    EXPECT_EQ(k.camera.p1(), 0.3);
    EXPECT_TRUE(apply_image_size(k, "k.txt", 1280, 720, "image"));
    EXPECT_EQ(k.camera.ncols, 1280U);
}

TEST_F(IntrinsicsFiles, AnotherSizeNamesBoth) {
    Intrinsics k = read_intrinsics(write("a.yaml", opencv("0, 0, 0, 0")));
    EXPECT_FALSE(apply_image_size(k, "a.yaml", 640, 480, "image"));
    EXPECT_THAT(refusal([&] { apply_image_size(k, "a.yaml", 1280, 720, "image"); }),
                AllOf(HasSubstr("1280 x 720"), HasSubstr("640 x 480")));
}

TEST_F(IntrinsicsFiles, NoCoefficientsIsAnErrorUnlessTheModelIsNone) {
    const std::string matrix = "K: [9, 0, 10, 0, 8, 5, 0, 0, 1]\n";
    const auto says = AllOf(HasSubstr("a.yaml"), HasSubstr("DistCoeff"), HasSubstr("D1"),
                            HasSubstr("give the coefficients, or set distortion_model to none"));
    for (const char* more : {"", "D: []\n", "dist_coeffs: [0.1, 0, 0, 0]\n", "distCoeffs: []\n",
                             "distortion_coeffs: [0.1, 0, 0, 0]\n", "distortion_model: radtan\n"}) {
        EXPECT_THAT(refused("a.yaml", matrix + more), says) << more;
        EXPECT_THAT(refused("a.yaml", matrix + more, "plumb_bob"), says) << more;
        EXPECT_THAT(refused("a.yaml", matrix + more, "kannala_brandt"), says) << more;
        EXPECT_EQ(read_intrinsics(write("a.yaml", matrix + more), "none").camera.distortion,
                  DistortionModel::none)
            << more;
    }
    EXPECT_THAT(refused("a.yaml", matrix + "Dist_Coeffs: [0.1, 0, 0, 0]\n"),
                HasSubstr("'Dist_Coeffs' is none of them"));
    EXPECT_THAT(refused("a.yaml", opencv("")), says);
    const auto none = read_intrinsics(write("a.yaml", matrix + "distortion_model: none\n"));
    EXPECT_EQ(none.camera.distortion, DistortionModel::none);

    const std::string text = "intrinsic\n9 0 10\n0 8 5\n0 0 1\n";
    for (const char* more : {"", "distortion\n"}) {
        EXPECT_THAT(refused("k.txt", text + more),
                    AllOf(HasSubstr("k.txt"), HasSubstr("`distortion`"),
                          HasSubstr("give the coefficients, or set distortion_model to none")));
        EXPECT_EQ(read_intrinsics(write("k.txt", text + more), "none").camera.distortion,
                  DistortionModel::none);
    }
}

TEST_F(IntrinsicsFiles, NamesWhatIsWrong) {
    EXPECT_THAT(refused("a.yaml", "a: [1,\n"), HasSubstr("no YAML"));
    EXPECT_THAT(refused("a.yaml", "a: 1\n"), HasSubstr("no camera matrix"));
    EXPECT_THAT(refused("a.yaml", "K: [1, 2, 3]\n"), HasSubstr("nine numbers, not 3"));
    EXPECT_THAT(refused("a.yaml", "K: [0, 0, 1, 0, 0, 1, 0, 0, 1]\n"), HasSubstr("positive"));
    EXPECT_THAT(refused("a.yaml", "K: [5, 1, 1, 0, 5, 1, 0, 0, 1]\n"), HasSubstr("skew"));
    EXPECT_THAT(refused("a.yaml", "K: [5, 0, 1, 0, 5, 1, 0, 1, 1]\n"), HasSubstr("last row"));
    EXPECT_THAT(refused("a.yaml", "K: [5, 0, .nan, 0, 5, 1, 0, 0, 1]\n"), HasSubstr("no number"));
    EXPECT_THAT(refused("k.txt", "1 2 3\n"), HasSubstr("k.txt:1: '1' stands before"));
    EXPECT_THAT(refused("k.txt", "intrinsic\n1 2 abc\n"), HasSubstr("'abc' is no number"));
    EXPECT_THAT(refusal([&] { read_intrinsics(folder_ / "none.yaml"); }),
                HasSubstr("does not exist"));
}

TEST(RealIntrinsics, BothFilesOfTheLettersAuthors) {
    PETAL_NEEDS_REAL_DATA();
    const auto indoor =
        read_intrinsics(testing::real_data() / "sjtu_indoor/intrinsics.yaml").camera;
    EXPECT_EQ(indoor.ncols, 640U);
    EXPECT_EQ(indoor.nrows, 540U);
    EXPECT_EQ(indoor.fx(), 349.77809149183855);
    EXPECT_EQ(indoor.p2(), -0.000996441920808419);
    const auto campus = read_intrinsics(testing::real_data() / "sjtu_campus/intrinsics.txt");
    EXPECT_FALSE(campus.has_size());
    EXPECT_EQ(campus.camera.cx(), 645.0881958);
}

}  // namespace
}  // namespace petal
