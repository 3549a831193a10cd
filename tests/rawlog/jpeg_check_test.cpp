// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>
#include <mrpt/obs/CObservationImage.h>

#include <string>

#include "petal/rawlog/rawlog_reader.hpp"
#include "plugins/sources/temporary_folder.hpp"
#include "rawlog_bytes.hpp"

// Images that MRPT packs as JPEG, damaged. Without a look at them first libjpeg would end the
// process, and this test program with it.
namespace petal::testing {
namespace {

using namespace mrpt::obs;
using ::testing::AllOf;
using ::testing::HasSubstr;

class JpegInARawlog : public TemporaryFolder {
   protected:
    void SetUp() override {
        TemporaryFolder::SetUp();
        // A switch of the whole process: how recorders of 2020 wrote colour images.
        mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(false);
        auto observation = CObservationImage::Create();
        observation->sensorLabel = "CAMERA";
        observation->timestamp = at(1.0);
        observation->image.resize(160, 120, mrpt::img::CH_RGB);
        for (unsigned row = 0; row < 120; ++row)
            for (unsigned column = 0; column < 160; ++column)
                for (unsigned channel = 0; channel < 3; ++channel)
                    *observation->image.ptr<std::uint8_t>(column, row, channel) =
                        static_cast<std::uint8_t>((row * 3 + column * (channel + 1)) % 256);
        bytes_ = bytes_of_objects({observation});
        begin_ = bytes_.find("\xFF\xD8\xFF");
        end_ = bytes_.rfind("\xFF\xD9") + 2;
        ASSERT_NE(begin_, std::string::npos);
        ASSERT_GT(end_, begin_ + 600);
    }
    void TearDown() override {
        mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(true);
        TemporaryFolder::TearDown();
    }

    /// What the reader says of these bytes; "accepted" where it reads them.
    std::string said_of(const std::string& bytes) const {
        return refusal([&] {
            RawlogReader reader(write("a.rawlog", bytes));
            while (reader.next()) continue;
        });
    }

    std::string bytes_;
    std::size_t begin_ = 0, end_ = 0;  ///< of the JPEG in bytes_
};

TEST_F(JpegInARawlog, AWholeOneIsRead) {
    EXPECT_EQ(said_of(bytes_), "accepted");
}

TEST_F(JpegInARawlog, ADamagedOneIsTold) {
    std::string damaged = bytes_;
    damaged[begin_] = 'x';
    EXPECT_THAT(said_of(damaged), AllOf(HasSubstr("a.rawlog"), HasSubstr("CObservationImage"),
                                        HasSubstr("Not a JPEG file")));
    // A marker of a table behind the picture's data, which libjpeg looks at last of all.
    damaged = bytes_;
    damaged.replace(end_ - 6, 6, "\xFF\xC4\x7F\x7F\xFF\xD9");
    EXPECT_THAT(said_of(damaged), HasSubstr("an image in it is no JPEG"));
}

// Bytes all over it take several values: all are read or told. (MRPT takes 50 ms for an exception.)
TEST_F(JpegInARawlog, NoByteEndsTheProcess) {
    int told = 0;
    const auto step = [this](std::size_t i) -> std::size_t {
        if (i < begin_ + 24 || i + 8 > end_) return 1;
        return i < begin_ + 640 ? 7 : 17;
    };
    for (std::size_t i = begin_; i < end_; i += step(i))
        for (const int value : {0x00, 0x7F, 0xC4, 0xFF}) {
            std::string damaged = bytes_;
            damaged[i] = static_cast<char>(value);
            if (said_of(damaged) != "accepted") ++told;
        }
    EXPECT_GT(told, 30) << "the lengths of tables alone";
}

}  // namespace
}  // namespace petal::testing
