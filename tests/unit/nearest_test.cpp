// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "nearest.hpp"

#include <gtest/gtest.h>

namespace petal {
namespace {

TEST(Nearest, FindsOneEdit) {
    EXPECT_EQ(nearest("raduis", {"min_neighbours", "radius"}), "radius");   // neighbours swapped
    EXPECT_EQ(nearest("radus", {"min_neighbours", "radius"}), "radius");    // left out
    EXPECT_EQ(nearest("raddius", {"min_neighbours", "radius"}), "radius");  // put in
    EXPECT_EQ(nearest("redius", {"min_neighbours", "radius"}), "radius");   // replaced
}

TEST(Nearest, CountsASwapAsOneEdit) {
    // Three letters allow one edit; two would be needed without the swap.
    EXPECT_EQ(nearest("pno", {"pon", "zzz"}), "pon");
}

TEST(Nearest, AllowsAThirdOfTheLength) {
    EXPECT_EQ(nearest("abcdef", {"abcdxy"}), "abcdxy");  // 2 of 6
    EXPECT_EQ(nearest("abcdef", {"abcxyz"}), "");        // 3 of 6
    EXPECT_EQ(nearest("ab", {"ac"}), "ac");              // at least 1
    EXPECT_EQ(nearest("a", {"b"}), "");  // but not of a word without a common letter
}

TEST(Nearest, TakesTheSmallestAndTheFirstOfEqualOnes) {
    EXPECT_EQ(nearest("margin_pionts", {"margin_paints", "margin_points"}), "margin_points");
    EXPECT_EQ(nearest("clod", {"cloud", "clone", "cold"}), "cloud");
    EXPECT_EQ(nearest("", {"cloud"}), "");
    EXPECT_EQ(nearest("cloud", {}), "");
}

TEST(Nearest, Words) {
    EXPECT_EQ(did_you_mean("radus", {"radius"}), "; did you mean 'radius'?");
    EXPECT_EQ(did_you_mean("weight", {"radius"}), "");
    EXPECT_EQ(join({}), "");
    EXPECT_EQ(join({"a"}), "a");
    EXPECT_EQ(join({"a", "b", "c"}), "a, b, c");
    EXPECT_EQ(join({"a", "b"}, "; "), "a; b");
}

}  // namespace
}  // namespace petal
