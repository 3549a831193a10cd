// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include "compare_fakes.hpp"
#include "comparison_reader.hpp"
#include "group_runner.hpp"
#include "host_errors.hpp"
#include "unit_outcomes.hpp"
#include "unit_store.hpp"

namespace petal::compare {
namespace {

using compare_fakes::Draw;
using compare_fakes::kPipeline;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class CompareUnits : public ::testing::Test {
   protected:
    CompareUnits() : plugins_(compare_fakes::plugins()) { folder_.write("p.json", kPipeline); }

    /// Plans a comparison whose file has these members beside the base and one metric.
    const Plan& plan(const std::string& members) {
        const auto file = folder_.path() / "c.json";
        auto read = read_comparison_text(R"({"petal_compare": 1, "base": "p.json",
  "metrics": {"mean.value": {"better": "lower"}}, )" +
                                             members + "}",
                                         file);
        for (const Problem& problem : read.problems) ADD_FAILURE() << to_string(problem);
        comparison_ = read.comparison.value();
        FileSums sums;
        plan_ = make_plan(comparison_, plugins_, sums);
        return plan_;
    }
    std::vector<UnitRecord> run_group(std::size_t group, bool share = true) {
        std::vector<UnitRecord> records;
        GroupRunner runner(comparison_, plan_, plugins_, folder_.path() / "work", share);
        runner.run(plan_.groups[group].units,
                   [&](const UnitRecord& record) { records.push_back(record); });
        return records;
    }

    compare_fakes::TestFolder folder_;
    PluginSet plugins_;
    Comparison comparison_;
    Plan plan_;
};

TEST_F(CompareUnits, AGroupIsOneDataItemAndSeedWithAllVariants) {
    plan(R"("variants": {"a": {}, "b": {"set": {"first.by": 3}}, "same": {"set": {"first.by": 0}}},
            "data": {"few": {}, "many": {"set": {"draw.frames": 5}, "seeds": [9]}}, "seeds": "1..3")");
    ASSERT_THAT(plan_.problems, IsEmpty());
    EXPECT_EQ(plan_.units.size(), 12U);
    ASSERT_EQ(plan_.groups.size(), 4U);
    EXPECT_EQ(plan_.groups[0].data, 0U) << "the first seed of every data item comes first";
    EXPECT_EQ(plan_.groups[1].data, 1U);
    EXPECT_EQ(plan_.groups[1].seed, 9U);
    EXPECT_EQ(plan_.groups[0].units.size(), 2U) << "a and same are one unit";
    EXPECT_EQ(plan_.units[0].key, plan_.units[2].key);
    EXPECT_NE(plan_.units[0].key, plan_.units[1].key);
    EXPECT_NE(plan_.units[0].key, plan_.units[plan_.groups[2].units[0]].key) << "another seed";
}

TEST_F(CompareUnits, DataThatAreAlikeAreRunOnce) {
    plan(R"("variants": {"a": {}, "b": {"set": {"first.by": 3}}}, "data": {"x": {}, "y": {}})");
    EXPECT_EQ(plan_.units.size(), 4U);
    EXPECT_EQ(plan_.groups[0].units.size(), 2U);
    EXPECT_THAT(plan_.groups[1].units, IsEmpty());
}

TEST_F(CompareUnits, WhatVariantsShareIsExecutedOnce) {
    plan(R"("variants": {"a": {}, "b": {"set": {"second.by": 3}}, "c": {"set": {"first.by": 3}},
                         "d": {"set": {"second.by": 4}}}, "seeds": "1..2")");
    Draw::fired() = 0;
    const auto shared = run_group(0);
    EXPECT_EQ(Draw::fired(), 3) << "three frames, once";
    ASSERT_EQ(shared.size(), 4U);
    EXPECT_THAT(shared[0].executed, ElementsAre("draw", "first", "second", "tell"));
    EXPECT_THAT(shared[1].executed, ElementsAre("second", "tell"));
    EXPECT_THAT(shared[1].shared, ElementsAre("draw", "first"));
    EXPECT_THAT(shared[2].executed, ElementsAre("first", "second", "tell"));
    EXPECT_THAT(shared[3].shared, ElementsAre("draw", "first"));
    const auto alone = run_group(0, false);
    EXPECT_EQ(Draw::fired(), 15);
    for (std::size_t i = 0; i < alone.size(); ++i) {
        EXPECT_EQ(shared[i].result, alone[i].result);
        EXPECT_THAT(alone[i].shared, IsEmpty());
    }
    EXPECT_NE(shared[0].result, shared[1].result);
    EXPECT_NE(shared[0].result, run_group(1)[0].result) << "another seed";
}

TEST_F(CompareUnits, AStageOfAnotherIdDrawsOtherNumbersAndIsNotShared) {
    folder_.write("q.json", R"({"petal": 1, "stages": {
        "other": {"type": "fake.draw"},
        "tell": {"type": "fake.tell", "in": {"numbers": "other.number"}}}})");
    plan(R"("variants": {"a": {}, "b": {"pipeline": "q.json"}})");
    const auto records = run_group(0);
    EXPECT_THAT(records[1].shared, IsEmpty());
    EXPECT_NE(records[0].result, records[1].result);
}

TEST_F(CompareUnits, AStageThatWroteFilesFiresAgain) {
    plan(R"("patch": {"stages": {"first": {"params": {"note": "nothing"}}}},
            "variants": {"a": {}, "b": {"set": {"second.by": 3}}})");
    const auto records = run_group(0);
    EXPECT_THAT(records[1].shared, ElementsAre("draw"));
}

TEST_F(CompareUnits, AFailureStaysWithItsUnit) {
    plan(R"("variants": {"a": {"set": {"first.fail_below": 1000}}, "b": {},
                         "c": {"set": {"second.fail_below": 1000}}})");
    const auto records = run_group(0);
    ASSERT_EQ(records.size(), 3U);
    EXPECT_EQ(records[0].status, "error");
    ASSERT_EQ(records[0].reasons.size(), 1U);
    EXPECT_THAT(records[0].reasons[0], HasSubstr("first (fake.shift), frame 0: a number that is"));
    EXPECT_EQ(records[1].status, "done");
    EXPECT_EQ(records[2].status, "error");
    EXPECT_THAT(records[2].result, IsEmpty());
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "work" / records[0].key));
}

TEST_F(CompareUnits, AFullDiskIsNoFailureOfTheUnit) {
    plan(R"("variants": {"a": {"set": {"tell.write_fails": true}}})");
    EXPECT_THROW(run_group(0), WriteError);
}

TEST_F(CompareUnits, VerdictsFailByTheComparisonsRule) {
    for (const auto& [rule, failures] :
         std::map<std::string, std::vector<std::string>>{{"error", {"", ""}},
                                                         {"not_usable", {"", "not_usable"}},
                                                         {"weak", {"weak", "not_usable"}}}) {
        plan(R"("variants": {"weak": {"set": {"tell.weak_above": -1}},
                             "unusable": {"set": {"tell.not_usable_above": -1}}},
                "failure": ")" +
             rule + "\"");
        std::map<std::string, UnitRecord> records;
        for (const UnitRecord& record : run_group(0)) records[record.key] = record;
        const auto outcomes = make_outcomes(comparison_, plan_, records);
        ASSERT_EQ(outcomes.size(), 2U);
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(outcomes[i].failure, failures[i]) << rule;
            EXPECT_EQ(outcomes[i].values.count("mean.value"), failures[i].empty() ? 1U : 0U);
        }
    }
}

TEST_F(CompareUnits, MetricsAreNamesOrPointersAndWrongOnesAreTold) {
    plan(R"("variants": {"a": {}}, "data": {"x": {}, "y": {"set": {"draw.frames": 2}}})");
    std::map<std::string, UnitRecord> records;
    records[plan_.units[0].key] = run_group(0)[0];
    const auto metric = [](const char* name) {
        MetricSpec spec;
        spec.name = name;
        return spec;
    };
    comparison_.metrics = {metric("mean.value"), metric("/list/1/count"), metric("/list/7"),
                           metric("/list")};
    const auto outcome = make_outcomes(comparison_, plan_, records).front();
    EXPECT_EQ(outcome.values.size(), 2U);
    EXPECT_EQ(outcome.values.at("/list/1/count"), 3.0);
    const auto told = [&](const char* name) -> std::string {
        comparison_.metrics = {metric(name)};
        try {
            check_metric_names(comparison_, plan_, records, false);
        } catch (const UsageError& error) {
            return error.what();
        }
        return {};
    };
    EXPECT_EQ(told("mean.valeu"), "") << "y has not been seen yet";
    records[plan_.units[1].key] = run_group(1)[0];
    EXPECT_EQ(told("mean.valeu"),
              "no result has a number for the metric 'mean.valeu'; expected mean.value; did you "
              "mean 'mean.value'?");
    EXPECT_THAT(told("/list/1/cuont"), HasSubstr("did you mean '/list/1/count'?"));
    EXPECT_EQ(told("mean.value"), "");
    comparison_.metrics.clear();
    EXPECT_EQ(make_outcomes(comparison_, plan_, records)[0].values.count("mean.value"), 1U);
}

TEST_F(CompareUnits, TheStoreGivesBackWhatItWasGivenAndKnowsDamage) {
    plan(R"("variants": {"a": {"set": {"draw.file": ")" + folder_.write("used.txt", "1").string() +
         "\"}}}");
    const UnitRecord record = run_group(0)[0];
    const UnitStore store(folder_.path() / "units");
    std::string damage;
    EXPECT_FALSE(store.load(record.key, damage));
    EXPECT_EQ(damage, "");
    store.store(record);
    const auto loaded = store.load(record.key, damage);
    ASSERT_TRUE(loaded) << damage;
    EXPECT_EQ(loaded->result, record.result);
    EXPECT_EQ(loaded->executed, record.executed);
    EXPECT_EQ(loaded->files, record.files);
    FileSums sums;
    EXPECT_EQ(UnitStore::changed_file(*loaded, sums), "");
    folder_.write("used.txt", "2");
    FileSums new_sums;
    EXPECT_EQ(UnitStore::changed_file(*loaded, new_sums), (folder_.path() / "used.txt").string());

    const std::string unit = "units/" + record.key;
    folder_.write(unit + "/result.json", "{}");
    EXPECT_FALSE(store.load(record.key, damage));
    EXPECT_THAT(damage, HasSubstr("result.json is not what the unit wrote"));
    std::filesystem::remove(folder_.path() / unit / "result.json");
    EXPECT_FALSE(store.load(record.key, damage));
    EXPECT_THAT(damage, HasSubstr("no such file"));
    for (const char* text : {"", "[]", "{\"petal_unit\": 1}", "{\"key\": 3}"}) {
        folder_.write(unit + "/unit.json", text);
        EXPECT_FALSE(store.load(record.key, damage));
        EXPECT_THAT(damage, HasSubstr("is no whole unit.json"));
    }
    store.store(record);
    EXPECT_TRUE(store.load(record.key, damage));
    std::filesystem::rename(folder_.path() / unit, folder_.path() / "units" / "other");
    EXPECT_FALSE(store.load("other", damage));
    EXPECT_THAT(damage, HasSubstr("is of another unit"));

    folder_.write("units/.half-1/unit.json", "{");
    store.remove_leftovers();
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "units" / ".half-1"));
    EXPECT_TRUE(store.holds("other"));
}

TEST_F(CompareUnits, TheKeyKnowsTheDataAndNotItsPlace) {
    const auto key_with = [&](const std::string& folder, const std::string& text) {
        folder_.write(folder + "/in/a.txt", text);
        return plan("\"variants\": {\"a\": {}}, \"data\": {\"d\": {\"folder\": \"" + folder +
                    "\"}}")
            .units.front()
            .key;
    };
    const std::string key = key_with("one", "1");
    EXPECT_EQ(key_with("two", "1"), key);
    EXPECT_NE(key_with("two", "2"), key);
}

TEST_F(CompareUnits, WhatIsWrongWithPipelinesIsToldWithFileAndLineOnce) {
    plan(R"("variants": {"a": {},
       "b": {"patch": {"stages": {
          "first": {"params": {"bye": 3}}}}}},
       "data": {"x": {"folder": "nowhere"}, "y": {}})");
    ASSERT_EQ(plan_.problems.size(), 1U);
    EXPECT_THAT(to_string(plan_.problems[0]), HasSubstr("nowhere is no folder"));
    EXPECT_THAT(to_string(plan_.problems[0]), HasSubstr("c.json:5"));
    plan(R"("variants": {"a": {},
       "b": {"patch": {"stages": {
          "first": {"params": {"bye": 3}}}}}},
       "data": {"x": {}, "y": {}})");
    ASSERT_EQ(plan_.problems.size(), 1U) << "of both data items, told once";
    const std::string told = to_string(plan_.problems[0]);
    EXPECT_THAT(told, HasSubstr("c.json:4: stages.first.params.bye: "));
    EXPECT_THAT(told, HasSubstr("did you mean 'by'?"));
    EXPECT_THAT(told, HasSubstr("(variant b, data x)"));
}

}  // namespace
}  // namespace petal::compare
