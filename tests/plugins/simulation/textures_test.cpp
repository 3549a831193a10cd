// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <cmath>

#include "petal/error.hpp"
#include "simulation/scene/materials.hpp"
#include "simulation/world/marker_texture.hpp"
#include "simulation/world/noise_texture.hpp"
#include "simulation/world/overlay_texture.hpp"
#include "simulation/world/stripe_texture.hpp"
#include "simulation/world/tile_texture.hpp"
#include "simulation/world/window_texture.hpp"

namespace petal::simulation {
namespace {

Look grey_look(float value) {
    return {Eigen::Vector3f::Constant(value), value};
}

TEST(Textures, NoiseIsTheSameAgainSmoothAndBetweenItsLooks) {
    const NoiseTexture noise(grey_look(0.2F), grey_look(0.6F), 0.3, 4, 7);
    const NoiseTexture same(grey_look(0.2F), grey_look(0.6F), 0.3, 4, 7);
    const NoiseTexture other(grey_look(0.2F), grey_look(0.6F), 0.3, 4, 8);
    double low = 1.0, high = 0.0, sum = 0.0;
    int different = 0;
    constexpr int kPlaces = 2000;
    for (int i = 0; i < kPlaces; ++i) {
        const Eigen::Vector2d place(0.137 * i - 90.0, 33.0 - 0.071 * i);
        const float value = noise.at(place).reflectivity;
        EXPECT_EQ(value, same.at(place).reflectivity);
        EXPECT_EQ(value, noise.at(place).colour.x());
        different += value != other.at(place).reflectivity;
        // The finest cells are 0.3 / 8 m and hold 1 / 15 of the range of 0.4; smooth steps rise by
        // at most 1.5 a cell, and so do the coarser ones with twice the share and half the slope.
        const float beside = noise.at(place + Eigen::Vector2d(1e-4, 0.0)).reflectivity;
        EXPECT_LT(std::abs(beside - value), 4 * 1.5 * 0.4 / 15.0 * 1e-4 / (0.3 / 8.0) + 1e-6);
        low = std::min(low, static_cast<double>(value));
        high = std::max(high, static_cast<double>(value));
        sum += static_cast<double>(value);
    }
    EXPECT_GE(low, 0.2);
    EXPECT_LE(high, 0.6);
    EXPECT_GT(high - low, 0.2) << "half of the range is used";
    EXPECT_NEAR(sum / kPlaces, 0.4, 0.02);
    EXPECT_GT(different, kPlaces * 9 / 10);
}

TEST(Textures, TilesHaveJointsAndShiftedRows) {
    TileTexture::Layout layout;
    layout.width = 0.25;
    layout.height = 0.1;
    layout.joint = 0.01;
    layout.shift = 0.5;
    layout.variation = 0.2;
    const TileTexture tiles(grey_look(0.5F), grey_look(0.9F), layout, 3);
    EXPECT_FLOAT_EQ(tiles.at({0.005, 0.05}).reflectivity, 0.9F) << "a joint across";
    EXPECT_FLOAT_EQ(tiles.at({0.13, 0.105}).reflectivity, 0.9F) << "a joint along";
    EXPECT_FLOAT_EQ(tiles.at({0.13, 0.15}).reflectivity, 0.9F) << "half a tile on in the next row";
    EXPECT_LT(tiles.at({0.005, 0.15}).reflectivity, 0.61F);
    const float tile = tiles.at({0.1, 0.05}).reflectivity;
    EXPECT_GE(tile, 0.4F);
    EXPECT_LE(tile, 0.6F);
    EXPECT_EQ(tile, tiles.at({0.2, 0.08}).reflectivity) << "one tile has one look";
    EXPECT_NE(tile, tiles.at({0.35, 0.05}).reflectivity);
}

TEST(Textures, WindowsHaveFramesPanesAndDarkGlass) {
    const auto wall = std::make_shared<PlainTexture>(grey_look(0.5F));
    WindowTexture::Layout layout;  // 1.2 m by 1.7 m in cells of 2.4 m by 3.2 m, frames of 0.08 m
    const WindowTexture windows(wall, grey_look(0.8F), grey_look(0.02F), layout, 1);
    for (const double cell : {0.0, -2.4, 4.8}) {
        const auto at = [&](double x, double y) {
            return windows.at({cell + 0.6 + x, 0.75 + y}).reflectivity;  // from the upper left
        };
        EXPECT_FLOAT_EQ(at(-0.05, 0.5), 0.5F) << "the wall";
        EXPECT_FLOAT_EQ(at(0.04, 0.5), 0.8F) << "the frame";
        EXPECT_FLOAT_EQ(at(0.6, 0.5), 0.8F) << "the bar between two panes";
        EXPECT_LT(at(0.3, 0.4), 0.031F) << "glass";
        EXPECT_LT(at(0.9, 1.3), 0.031F) << "glass";
        EXPECT_FLOAT_EQ(at(1.17, 0.5), 0.8F) << "the frame's other side";
    }
}

TEST(Textures, StripesAndOverlays) {
    const StripeTexture stripes(grey_look(0.1F), grey_look(0.9F), 0.05, 0.0);
    EXPECT_FLOAT_EQ(stripes.at({0.02, 5.0}).reflectivity, 0.1F);
    EXPECT_FLOAT_EQ(stripes.at({0.07, 5.0}).reflectivity, 0.9F);
    EXPECT_FLOAT_EQ(stripes.at({-0.02, 5.0}).reflectivity, 0.9F);
    EXPECT_FLOAT_EQ(stripes.at({-0.07, 5.0}).reflectivity, 0.1F);

    const auto ground = std::make_shared<PlainTexture>(grey_look(0.5F));
    const auto part = std::make_shared<StripeTexture>(grey_look(0.1F), grey_look(0.9F), 0.05, 0.0);
    const Eigen::AlignedBox2d box(Eigen::Vector2d(1.0, 1.0), Eigen::Vector2d(1.2, 1.3));
    const OverlayTexture overlay(ground, {{box, part}});
    EXPECT_FLOAT_EQ(overlay.at({0.99, 1.1}).reflectivity, 0.5F);
    EXPECT_FLOAT_EQ(overlay.at({1.02, 1.1}).reflectivity, 0.1F) << "counts from the box's corner";
    EXPECT_FLOAT_EQ(overlay.at({1.07, 1.1}).reflectivity, 0.9F);
    EXPECT_FLOAT_EQ(overlay.at({1.02, 1.31}).reflectivity, 0.5F);
}

TEST(Textures, MarkersHaveABlackBorderAndTheirOwnBits) {
    const MarkerTexture one("6x6_250", 1, 0.08, grey_look(0.0F), grey_look(1.0F));
    const MarkerTexture two("6x6_250", 2, 0.08, grey_look(0.0F), grey_look(1.0F));
    int light = 0, different = 0;
    for (int row = 0; row < 8; ++row)
        for (int column = 0; column < 8; ++column) {
            const Eigen::Vector2d place(0.01 * column + 0.005, 0.01 * row + 0.005);
            const float value = one.at(place).reflectivity;
            if (row == 0 || row == 7 || column == 0 || column == 7) {
                EXPECT_FLOAT_EQ(value, 0.0F);
            }
            light += value > 0.5F;
            different += value != two.at(place).reflectivity;
        }
    EXPECT_GT(light, 8);
    EXPECT_LT(light, 28);
    // Markers of that dictionary differ in at least 11 of their 36 bits.
    EXPECT_GE(different, 11);
    EXPECT_THROW(MarkerTexture("6x6_25", 1, 0.1, Look{}, Look{}), Error);
    EXPECT_THROW(MarkerTexture("4x4_50", 50, 0.1, Look{}, Look{}), Error);
}

TEST(Textures, MaterialsAreWithinPhysicalBounds) {
    for (const std::string& name : material_names()) {
        const auto texture = material(name);
        for (int i = 0; i < 200; ++i) {
            const Look look = texture->at({0.173 * i - 11.0, 0.219 * i - 20.0});
            EXPECT_GE(look.colour.minCoeff(), 0.0F) << name;
            EXPECT_LE(look.colour.maxCoeff(), 0.9F) << name;
            EXPECT_GE(look.reflectivity, 0.0F) << name;
            EXPECT_LE(look.reflectivity, 0.9F) << name;
        }
    }
    EXPECT_LT(material("glass")->at({0, 0}).reflectivity, 0.05F);
}

}  // namespace
}  // namespace petal::simulation
