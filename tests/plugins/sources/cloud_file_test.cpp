// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/detail/cloud_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstring>
#include <vector>

#include "plugins/sources/temporary_folder.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;

class CloudFiles : public testing::TemporaryFolder {
   protected:
    static std::vector<float> point(const CloudFile& cloud, std::size_t i) {
        float x = 0.0F, y = 0.0F, z = 0.0F;
        cloud.points->getPoint(i, x, y, z);
        return {x, y, z, cloud.points->getPointIntensity(i)};
    }
    std::string refused(const std::string& name, const std::string& bytes) const {
        const auto file = write(name, bytes);
        return refusal([&] { read_cloud_file(file); });
    }
    static std::string packed(const std::vector<float>& values) {
        std::string bytes(values.size() * sizeof(float), '\0');
        std::memcpy(bytes.data(), values.data(), bytes.size());
        return bytes;
    }
    static std::string pcd(const std::string& points, const std::string& data) {
        return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z ring intensity\nSIZE 4 4 4 2 4\n"
               "TYPE F F F U F\nCOUNT 1 1 1 1 1\nWIDTH " +
               points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " + data +
               "\n";
    }
};

TEST_F(CloudFiles, TextInAllItsSeparators) {
    for (const char* text :
         {"1,2,3\n4,5,6\n", "1 2 3\n4 5 6", "1;2;3\r\n4;5;6\r\n", "1\t2\t3\n\n4\t5\t6\n",
          "# made by hand\n1, 2, 3 # first\n4, +5, 6.0e0,\n", "x,y,z\n1,2,3\n4,5,6\n",
          "\xEF\xBB\xBF//X Y Z\n1 2 3\n4 5 6\n"}) {
        const CloudFile cloud = read_cloud_file(write("a.csv", text));
        ASSERT_EQ(cloud.points->size(), 2U) << text;
        EXPECT_EQ(point(cloud, 0), (std::vector<float>{1, 2, 3, 0})) << text;
        EXPECT_EQ(point(cloud, 1), (std::vector<float>{4, 5, 6, 0})) << text;
        EXPECT_FALSE(cloud.has_intensity);
    }
}

TEST_F(CloudFiles, TextWithIntensityAndMore) {
    const CloudFile four = read_cloud_file(write("a.xyz", "1 2 3 0.5\n"));
    EXPECT_TRUE(four.has_intensity);
    EXPECT_EQ(point(four, 0), (std::vector<float>{1, 2, 3, 0.5F}));
    const CloudFile colours = read_cloud_file(write("a.xyz", "x y z r g b\n1 2 3 9 9 9\n"));
    EXPECT_FALSE(colours.has_intensity);
    EXPECT_THAT(colours.remark, HasSubstr("left out"));
}

TEST_F(CloudFiles, PointsThatAreNotFiniteAreKeptAndCounted) {
    const CloudFile cloud = read_cloud_file(write("a.csv", "1,2,3\nnan,nan,nan\n1,inf,3\n"));
    EXPECT_EQ(cloud.points->size(), 3U);
    EXPECT_EQ(cloud.not_finite, 2U);
    EXPECT_TRUE(std::isnan(point(cloud, 1)[0]));
}

TEST_F(CloudFiles, AnEmptyFileIsAnEmptyCloud) {
    EXPECT_EQ(read_cloud_file(write("a.csv", "")).points->size(), 0U);
    EXPECT_EQ(read_cloud_file(write("a.csv", "# nothing\nx,y,z\n")).points->size(), 0U);
    EXPECT_EQ(read_cloud_file(write("a.pcd", pcd("0", "ascii"))).points->size(), 0U);
}

TEST_F(CloudFiles, TheLocaleDoesNotMatter) {
    const std::string before = std::setlocale(LC_ALL, nullptr);
    for (const char* comma : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"})
        if (std::setlocale(LC_ALL, comma) != nullptr) break;
    const CloudFile cloud = read_cloud_file(write("a.csv", "1.5,2.25,3.125\n"));
    std::setlocale(LC_ALL, before.c_str());
    EXPECT_EQ(point(cloud, 0), (std::vector<float>{1.5F, 2.25F, 3.125F, 0.0F}));
}

TEST_F(CloudFiles, BadTextIsToldWithItsLine) {
    EXPECT_THAT(refused("a.csv", "1,2,3\n1,x,3\n"), HasSubstr("a.csv:2: 'x' is no number"));
    EXPECT_THAT(refused("a.csv", "1,2,3\n1,2\n"), HasSubstr("a.csv:2: 2 columns"));
    EXPECT_THAT(refused("a.csv", "1,2\n"), HasSubstr("at least 3"));
    EXPECT_THAT(refused("a.csv", "1,,3\n"), HasSubstr("'' is no number"));
    EXPECT_THAT(refused("a.csv", "1,5;2,5;3,5\n"), HasSubstr("not a comma"));
    EXPECT_THAT(refused("a.csv", "t,x,y,z\n0,1,2,3\n"),
                HasSubstr("first columns must be x, y and z"));
    EXPECT_THAT(refused("a.las", "x"), HasSubstr("convert it"));
    EXPECT_THAT(refusal([&] { read_cloud_file(folder_ / "none.csv"); }),
                HasSubstr("does not exist"));
    EXPECT_THAT(refusal([&] { read_cloud_file(folder_); }), HasSubstr("is a folder"));
}

TEST_F(CloudFiles, DecimalCommasAreNotTakenForColumns) {
    for (const char* text :
         {"# lidar\n2,215,0,750,-0,350\n2,300,0,751,-0,349\n", "\n2,215, 0,750, -0,350,\n",
          "# lidar\n2,215,0,750,-0,350,0,5\n", "x,y,z\n2,215,0,750,-0,350\n"})
        EXPECT_THAT(refused("a.csv", text),
                    AllOf(HasSubstr("a.csv:2: "), HasSubstr("decimal commas"),
                          HasSubstr("write decimals with points, separate columns by spaces or "
                                    "semicolons")))
            << text;
    for (const char* text : {"2,215 0,750 -0,350\n", "2,215\t0,750\t-0,350\n"})
        EXPECT_THAT(refused("a.csv", text), AllOf(HasSubstr("a.csv:1: "), HasSubstr("is no number"),
                                                  HasSubstr("write decimals with points")))
            << text;
    // One point in the first row, a header, or another separator: numbers as they stand.
    for (const char* text : {"1,2,3,255,0,0.5\n", "x,y,z,r,g,b\n1,2,3,255,0,0\n", "1 2 3 255 0 0\n",
                             "1;2;3;255;0;0\n", "1,2,3,4,5\n"})
        EXPECT_EQ(point(read_cloud_file(write("a.csv", text)), 0)[2], 3.0F) << text;
}

TEST_F(CloudFiles, PcdAscii) {
    const CloudFile cloud =
        read_cloud_file(write("a.pcd", pcd("2", "ascii") + "1 2 3 7 0.5\nnan nan nan 8 0.25\n"));
    ASSERT_EQ(cloud.points->size(), 2U);
    EXPECT_EQ(point(cloud, 0), (std::vector<float>{1, 2, 3, 0.5F}));
    EXPECT_EQ(cloud.not_finite, 1U);
}

TEST_F(CloudFiles, PcdBinary) {
    const std::string record = packed({1, 2, 3}) + std::string("\x07\x00", 2) + packed({0.5F});
    const CloudFile cloud = read_cloud_file(write("a.pcd", pcd("2", "binary") + record + record));
    ASSERT_EQ(cloud.points->size(), 2U);
    EXPECT_EQ(point(cloud, 1), (std::vector<float>{1, 2, 3, 0.5F}));
}

TEST_F(CloudFiles, PcdCompressed) {
    // Two points, field by field; LZF as one run of literals (control byte: length - 1), then a
    // copy.
    const std::string xs = packed({1, 1});
    const std::string plain = xs + packed({2, 2}) + packed({3, 3});
    std::string lzf;
    for (std::size_t i = 0; i < plain.size(); i += 8) {
        lzf += '\x03' + plain.substr(i, 4);  // four literal bytes
        lzf += '\x40';                       // a copy of 2 + 2 bytes ...
        lzf += '\x03';                       // ... from 3 + 1 bytes before
    }
    const auto size = [](std::uint32_t n) {
        std::string bytes(4, '\0');
        std::memcpy(bytes.data(), &n, 4);
        return bytes;
    };
    const std::string head =
        "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\n"
        "POINTS 2\nDATA binary_compressed\n";
    const auto lengths = size(static_cast<std::uint32_t>(lzf.size())) + size(24);
    const CloudFile cloud = read_cloud_file(write("a.pcd", head + lengths + lzf));
    ASSERT_EQ(cloud.points->size(), 2U);
    EXPECT_EQ(point(cloud, 1), (std::vector<float>{1, 2, 3, 0}));
    EXPECT_THAT(refused("b.pcd", head + lengths + lzf.substr(0, 9)), HasSubstr("truncated"));
    lzf[6] = '\x7F';  // a copy from before the begin
    EXPECT_THAT(refused("c.pcd", head + lengths + lzf), HasSubstr("damaged"));
}

TEST_F(CloudFiles, APcdViewpointThatIsNotAppliedIsTold) {
    const auto remark = [&](const std::string& viewpoint) {
        return read_cloud_file(
                   write("a.pcd", "FIELDS x y z\n" + viewpoint + "POINTS 1\nDATA ascii\n1 2 3\n"))
            .remark;
    };
    EXPECT_EQ(remark(""), "");
    EXPECT_EQ(remark("VIEWPOINT 0 0 0 1 0 0 0\n"), "");
    EXPECT_EQ(remark("VIEWPOINT 0.0 -0 0 1.0 0 0 0\n"), "");
    EXPECT_THAT(remark("VIEWPOINT 0 0 1.5 1 0 0 0\n"),
                AllOf(HasSubstr("VIEWPOINT '0 0 1.5 1 0 0 0'"), HasSubstr("not applied")));
    EXPECT_THAT(remark("VIEWPOINT 0 0 0 0 1 0 0\n"), HasSubstr("not applied"));
    EXPECT_THAT(remark("VIEWPOINT here\n"), HasSubstr("not applied"));
}

TEST_F(CloudFiles, BadPcdIsTold) {
    EXPECT_THAT(refused("a.pcd", pcd("3", "binary") + packed({1, 2, 3})),
                AllOf(HasSubstr("truncated"), HasSubstr("54 bytes"), HasSubstr("only 12")));
    EXPECT_THAT(refused("a.pcd", pcd("3", "ascii") + "1 2 3 4 5\n"), HasSubstr("only 1 follow"));
    EXPECT_THAT(refused("a.pcd", pcd("1", "ascii") + "1 2 3\n"), HasSubstr("a.pcd:12: 3 numbers"));
    EXPECT_THAT(refused("a.pcd", "nonsense\n"), HasSubstr("unknown PCD header line"));
    EXPECT_THAT(refused("a.pcd", "FIELDS a b c\nPOINTS 1\nDATA ascii\n1 2 3\n"),
                HasSubstr("no field 'x'"));
    EXPECT_THAT(refused("a.pcd", "FIELDS x y z\nSIZE 4 4\n"), HasSubstr("SIZE has 2 entries"));
    EXPECT_THAT(refused("a.pcd", "VERSION 0.7\n"), HasSubstr("before its DATA line"));
    EXPECT_THAT(refused("a.pcd", "FIELDS x y z\nPOINTS 4000000000\nDATA binary\n"),
                HasSubstr("truncated"));
}

TEST_F(CloudFiles, PlyInItsThreeFormats) {
    const auto header = [](const std::string& format) {
        return "ply\nformat " + format +
               " 1.0\ncomment x\nelement vertex 1\nproperty float x\n"
               "property float y\nproperty float z\nproperty uchar intensity\nelement face 1\n"
               "property list uchar int vertex_indices\nend_header\n";
    };
    std::string big = packed({1, 2, 3});
    for (std::size_t i = 0; i < big.size(); i += 4)
        std::reverse(big.begin() + static_cast<long>(i), big.begin() + static_cast<long>(i) + 4);
    for (const std::string& bytes : {header("ascii") + "1 2 3 9\n3 0 0 0\n",
                                     header("binary_little_endian") + packed({1, 2, 3}) + "\x09",
                                     header("binary_big_endian") + big + "\x09"}) {
        const CloudFile cloud = read_cloud_file(write("a.ply", bytes));
        ASSERT_EQ(cloud.points->size(), 1U);
        EXPECT_EQ(point(cloud, 0), (std::vector<float>{1, 2, 3, 9}));
    }
    EXPECT_THAT(refused("b.ply", "no ply\n"), HasSubstr("first line must be 'ply'"));
    for (const char* count : {"2.7", "-1", "nan", "1e99", "two"})
        EXPECT_THAT(refused("b.ply", std::string("ply\nformat ascii 1.0\nelement vertex ") + count +
                                         "\nproperty float x\n"),
                    HasSubstr("b.ply:3: '" + std::string(count) + "' is no count"));
    EXPECT_THAT(refused("b.ply", header("ascii")), HasSubstr("truncated"));
    EXPECT_THAT(refused("b.ply", header("binary_little_endian") + "abc"),
                HasSubstr("only 3 follow"));
}

}  // namespace
}  // namespace petal
