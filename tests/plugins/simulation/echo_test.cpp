// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/lidar/echo.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace petal::simulation {
namespace {

/// A part of a footprint on a surface that would send back `whole` if it were met by all of it.
Patch part(double range, double share, double whole = 0.01) {
    return {nullptr, range, share * whole, share, range, range};
}

class EchoTest : public ::testing::Test {
   protected:
    EchoTest() : profile_(load_lidar_profile("livox_mid70")) {}
    LidarProfile profile_;
};

TEST_F(EchoTest, OneSurfaceGivesOneEchoAtItsRange) {
    const Receiver receiver(profile_);
    const auto echoes = receiver.echoes({part(5.0, 1.0)});
    ASSERT_EQ(echoes.size(), 1U);
    EXPECT_DOUBLE_EQ(echoes[0].range, 5.0);
    EXPECT_DOUBLE_EQ(echoes[0].energy, 0.01);
    EXPECT_DOUBLE_EQ(echoes[0].share, 1.0);
    EXPECT_DOUBLE_EQ(receiver.lateness(echoes[0]), 0.0);
    EXPECT_TRUE(receiver.echoes({}).empty());
    EXPECT_FALSE(receiver.told({}).has_value());
}

// Far inside the pulse's width the peak of a sum of Gaussians lies at the mean by energy.
TEST_F(EchoTest, SurfacesNearerThanThePulseBlend) {
    const Receiver receiver(profile_);
    for (const double share : {0.2, 0.5, 0.7}) {
        auto echoes = receiver.echoes({part(5.0, share), part(5.02, 1.0 - share)});
        ASSERT_EQ(echoes.size(), 1U);
        EXPECT_NEAR(echoes[0].range, 5.0 + 0.02 * (1.0 - share), 1e-4);
        // At 0.2 m, 0.8 sigma of the pulse, the peak leans to the stronger one by the third order:
        // a tenth of the distance at most.
        echoes = receiver.echoes({part(5.0, share), part(5.2, 1.0 - share)});
        ASSERT_EQ(echoes.size(), 1U);
        EXPECT_NEAR(echoes[0].range, 5.0 + 0.2 * (1.0 - share), 0.02);
        EXPECT_NEAR(echoes[0].share, 1.0, 0.1);
    }
    // Energies weigh, not areas.
    const auto echoes = receiver.echoes({part(5.0, 0.5, 0.03), part(5.02, 0.5, 0.01)});
    EXPECT_NEAR(echoes.at(0).range, 5.005, 1e-4);
}

// Two equal Gaussians have two peaks once they are more than two sigma apart; 0.6 m at half the
// height are 0.51 m there.
TEST_F(EchoTest, TwoPeaksPartAtTwoSigma) {
    const Receiver receiver(profile_);
    EXPECT_EQ(receiver.echoes({part(5.0, 0.5), part(5.50, 0.5)}).size(), 1U);
    EXPECT_EQ(receiver.echoes({part(5.0, 0.5), part(5.53, 0.5)}).size(), 2U);
}

TEST_F(EchoTest, OfTwoSurfacesFarApartTheFirstOrTheStrongestIsTold) {
    const std::vector<Patch> patches = {part(5.0, 0.3), part(10.0, 0.7)};
    const auto first = Receiver(profile_).told(patches);
    ASSERT_TRUE(first.has_value());
    EXPECT_NEAR(first->range, 5.0, 1e-6);
    EXPECT_NEAR(first->share, 0.3, 1e-6);
    profile_.returned = LidarProfile::Return::strongest;
    const auto strongest = Receiver(profile_).told(patches);
    ASSERT_TRUE(strongest.has_value());
    EXPECT_NEAR(strongest->range, 10.0, 1e-6);
    EXPECT_NEAR(strongest->energy, 0.007, 1e-6);
}

TEST_F(EchoTest, AnEchoBelowTheLimitIsPassedOver) {
    const double limit = profile_.detection_energy();
    const Receiver receiver(profile_);
    const auto told = receiver.told({part(5.0, 0.5, 1.9 * limit), part(10.0, 0.5, 2.1 * limit)});
    ASSERT_TRUE(told.has_value());
    EXPECT_NEAR(told->range, 10.0, 1e-6);
    EXPECT_FALSE(receiver.told({part(5.0, 1.0, 0.9 * limit)}).has_value());
}

TEST_F(EchoTest, APartialEchoComesLate) {
    const Receiver receiver(profile_);
    const auto echoes = receiver.echoes({part(5.0, 0.1), part(15.0, 0.9)});
    ASSERT_EQ(echoes.size(), 2U);
    EXPECT_NEAR(receiver.lateness(echoes[0]), profile_.late_error * std::log(10.0), 1e-6);
    EXPECT_NEAR(receiver.lateness(echoes[1]), profile_.late_error * std::log(1.0 / 0.9), 1e-6);
}

TEST_F(EchoTest, ManyPatchesOfASlantedSurfaceAreOneEcho) {
    std::vector<Patch> patches;
    for (int i = 0; i < 15; ++i) patches.push_back(part(20.0 + 0.05 * i, 1.0 / 15.0));
    const auto echoes = Receiver(profile_).echoes(patches);
    ASSERT_EQ(echoes.size(), 1U);
    EXPECT_NEAR(echoes[0].range, 20.35, 1e-3);
}

}  // namespace
}  // namespace petal::simulation
