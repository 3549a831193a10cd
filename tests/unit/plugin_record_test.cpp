// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <cstring>

#include "loader.hpp"

namespace petal {
namespace {

BuildKey host() {
    return BuildKey{1017, 1, 0, 0, 30400, 16, 0x258, 0x460};
}

PluginRecord record_with(const BuildKey& key) {
    PluginRecord record = detail::make_record("toys", "1.0.0", "", 0);
    record.build = key;
    return record;
}

TEST(PluginRecord, HoldsWhatTheMacroWrites) {
    constexpr PluginRecord record = detail::make_record("toys", "1.0.0", "calibration", 3);
    EXPECT_EQ(std::memcmp(record.magic, "PETALPLG", 8), 0);
    EXPECT_EQ(record.size, sizeof(PluginRecord));
    EXPECT_EQ(record.framework_abi, kFrameworkAbi);
    EXPECT_EQ(record.types_abi, 3U);
    EXPECT_STREQ(record.types_name, "calibration");
    EXPECT_EQ(mismatch(record, build_key()), "");
}

// The order of these is what a plugin of any version starts with: it must never change.
TEST(PluginRecord, StartsWithMagicSizeAndAbi) {
    EXPECT_EQ(offsetof(PluginRecord, magic), 0U);
    EXPECT_EQ(offsetof(PluginRecord, size), 8U);
    EXPECT_EQ(offsetof(PluginRecord, framework_abi), 12U);
}

TEST(Mismatch, TellsEachFieldInWords) {
    const auto changed = [](std::uint32_t BuildKey::*member, std::uint32_t value) {
        BuildKey key = host();
        key.*member = value;
        return mismatch(record_with(key), host());
    };
    EXPECT_EQ(mismatch(record_with(host()), host()), "");
    EXPECT_EQ(changed(&BuildKey::eigen_max_align, 32),
              "Eigen alignment: plugin 32 bytes, petal 16 bytes");
    EXPECT_EQ(changed(&BuildKey::eigen_version, 30390),
              "Eigen version: plugin 3.3.90, petal 3.4.0");
    EXPECT_EQ(changed(&BuildKey::mrpt_version, 0x24a), "MRPT version: plugin 2.4.10, petal 2.5.8");
    EXPECT_EQ(changed(&BuildKey::mrpt_opencv, 0x454),
              "MRPT's OpenCV version: plugin 4.5.4, petal 4.6.0");
    EXPECT_EQ(changed(&BuildKey::sanitizers, 1), "sanitizers: plugin address, petal none");
    EXPECT_EQ(changed(&BuildKey::sanitizers, 3), "sanitizers: plugin address+thread, petal none");
    EXPECT_EQ(changed(&BuildKey::debug_stl, 1),
              "debug mode of the standard library (_GLIBCXX_DEBUG): plugin on, petal off");
    EXPECT_EQ(changed(&BuildKey::cxx_abi, 1002),
              "C++ ABI version (__GXX_ABI_VERSION): plugin 1002, petal 1017");
    EXPECT_EQ(changed(&BuildKey::cxx11_strings, 0),
              "std::string ABI: plugin old (_GLIBCXX_USE_CXX11_ABI=0), petal new "
              "(_GLIBCXX_USE_CXX11_ABI=1)");
}

TEST(Mismatch, TellsAllFieldsAtOnce) {
    BuildKey key = host();
    key.sanitizers = 1;
    key.eigen_max_align = 64;
    EXPECT_EQ(
        mismatch(record_with(key), host()),
        "sanitizers: plugin address, petal none; Eigen alignment: plugin 64 bytes, petal 16 bytes");
}

TEST(Mismatch, OfTheFrameworkAbiHidesTheRest) {
    PluginRecord record = record_with(BuildKey{});
    record.framework_abi = kFrameworkAbi + 1;
    EXPECT_EQ(mismatch(record, host()), "framework ABI: plugin " +
                                            std::to_string(kFrameworkAbi + 1) + ", petal " +
                                            std::to_string(kFrameworkAbi));
}

}  // namespace
}  // namespace petal
