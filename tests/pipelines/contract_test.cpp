// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>
#include "built_plugins.hpp"
#include "petal/calibration/testing/contract_samples.hpp"
#include "petal/testing/contract_suite.hpp"

namespace petal::testing {
namespace {

class StageContract : public ::testing::TestWithParam<std::string> {};

TEST_P(StageContract, IsKept) {
    static const ContractInputs inputs = [] {
        ContractInputs samples = calibration_samples();
        samples.params["source.simulator"] = {
            {"scenes",
             Value(std::vector<std::string>{PETAL_SOURCE_DIR "/tests/data/small_scene.json"})},
            {"duration", Value(0.05)}};
        return samples;
    }();
    const StageSpec* stage = built_plugins().registry.find(GetParam());
    ASSERT_NE(stage, nullptr);
    for (const Violation& violation : contract_violations(*stage, inputs))
        ADD_FAILURE() << violation.rule << ": " << violation.what;
}

INSTANTIATE_TEST_SUITE_P(AllStages, StageContract, ::testing::ValuesIn(built_types()), test_name);

TEST(StageContracts, AllPluginsOfTheBuildTreeAreLoaded) {
    for (const Refusal& refusal : built_plugins().refused)
        ADD_FAILURE() << refusal.library << ": " << refusal.reason;
    EXPECT_GE(built_types().size(), 13U);
}

}  // namespace
}  // namespace petal::testing
