// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "bootstrap.hpp"
#include "judge.hpp"
#include "rank_tests.hpp"

namespace petal::compare {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(SignedRank, HasTheExactTailOfSmallSamples) {
    // 2^5 signs; one of them gives the sum 0 and one 15.
    EXPECT_DOUBLE_EQ(signed_rank({1, 2, 3, 4, 5}).p, 2.0 / 32.0);
    EXPECT_EQ(signed_rank({1, 2, 3, 4, 5}).direction, 1);
    EXPECT_DOUBLE_EQ(signed_rank({-1, -2, -3, -4, -5, -6}).p, 2.0 / 64.0);
    EXPECT_EQ(signed_rank({-1, -2, -3, -4, -5, -6}).direction, -1);
    // Negative ranks sum to 3 = {3} = {1, 2}; sums 0, 1, 2, 3, 3 of 64 sign patterns.
    EXPECT_DOUBLE_EQ(signed_rank({1, 2, -3, 4, 5, 6}).p, 2.0 * 5.0 / 64.0);
}

TEST(SignedRank, LeavesZerosOutAndSharesRanksOfTies) {
    EXPECT_DOUBLE_EQ(signed_rank({0, 0, 1, 2, 3, 4, 5, 0}).p, 2.0 / 32.0);
    EXPECT_DOUBLE_EQ(signed_rank({0, 0}).p, 1.0);
    EXPECT_DOUBLE_EQ(signed_rank({}).p, 1.0);
    // All ties: ranks 2, 2, 2 each; both tails hold 1 + 3 of 8 patterns, so p is 1.
    EXPECT_DOUBLE_EQ(signed_rank({1, -1, 1}).p, 1.0);
    EXPECT_DOUBLE_EQ(signed_rank({kInf, kInf, kInf, kInf, 1, 2}).p, 2.0 / 64.0);
}

TEST(SignedRank, TheNormalApproximationMeetsTheExactOne) {
    std::mt19937_64 rng(5);
    std::vector<double> differences;
    // 200 is the last exact size; one more is approximated. 0.35 of them negative.
    for (int i = 0; i < 200; ++i)
        differences.push_back((rng() % 100 < 42 ? -1.0 : 1.0) * static_cast<double>(rng() % 1000));
    const double exact = signed_rank(differences).p;
    differences.push_back(0.25);
    const double normal = signed_rank(differences).p;
    EXPECT_GT(exact, 1e-6);
    // One small difference more changes little.
    EXPECT_NEAR(std::log(normal), std::log(exact), 0.1);
}

TEST(SignTest, IsTheFairCoins) {
    EXPECT_DOUBLE_EQ(sign_p(0, 0), 1.0);
    EXPECT_DOUBLE_EQ(sign_p(3, 3), 1.0);
    EXPECT_NEAR(sign_p(0, 6), 2.0 / 64.0, 1e-12);
    EXPECT_NEAR(sign_p(8, 1), 2.0 * 10.0 / 512.0, 1e-12);
}

TEST(Holm, StepsDown) {
    const auto adjusted = holm({0.01, 0.04, 0.03});
    EXPECT_DOUBLE_EQ(adjusted[0], 0.03);
    EXPECT_DOUBLE_EQ(adjusted[1], 0.06);  // not below the one before it
    EXPECT_DOUBLE_EQ(adjusted[2], 0.06);
    EXPECT_TRUE(holm({}).empty());
}

TEST(MedianOf, KnowsInfinity) {
    EXPECT_DOUBLE_EQ(median_of({3, 1, 2}), 2.0);
    EXPECT_DOUBLE_EQ(median_of({4, 1, 2, 3}), 2.5);
    EXPECT_EQ(median_of({1, kInf}), kInf);
    EXPECT_EQ(median_of({kInf, kInf, 1}), kInf);
    EXPECT_EQ(median_of({-kInf, kInf}), 0.0);
}

TEST(Bootstrap, GivesTheSameForTheSameSeedAndHoldsTheFigure) {
    const std::vector<double> values{5.13, 1.29, 4.71, 2.37, 3.91, 9.67, 7.43, 8.89};
    Bootstrap first(1, "a", 0.95);
    Bootstrap second(1, "a", 0.95);
    Bootstrap other(1, "b", 0.95);
    const Interval mean = first.mean(values);
    EXPECT_EQ(second.mean(values).low, mean.low);
    EXPECT_NE(other.mean(values).low, mean.low);
    EXPECT_DOUBLE_EQ(mean.value, 43.4 / 8.0);
    EXPECT_LT(mean.low, mean.value);
    EXPECT_GT(mean.high, mean.value);
}

TEST(Bootstrap, TheMeansIntervalHoldsTheTruthAboutAsOftenAsItSays) {
    std::mt19937_64 rng(3);
    std::normal_distribution<double> normal(2.0, 1.0);
    int held = 0;
    constexpr int kTimes = 300;
    for (int i = 0; i < kTimes; ++i) {
        std::vector<double> values(40);
        for (double& value : values) value = normal(rng);
        Bootstrap bootstrap(1, std::to_string(i), 0.95);
        const Interval mean = bootstrap.mean(values);
        held += mean.low <= 2.0 && 2.0 <= mean.high ? 1 : 0;
    }
    // 95 % nominal; percentile intervals of 40 values hold about 94 %; 3 sigma of 300 trials: 4 %.
    EXPECT_GE(held, kTimes * 90 / 100);
    EXPECT_LE(held, kTimes * 98 / 100);
}

/// Judges one metric as the only one.
MetricJudgement judged(const std::vector<Pair>& pairs, const MetricSpec& metric,
                       const Comparison& comparison = {}) {
    MetricJudgement judgement = measure(comparison, metric, pairs, metric.name);
    decide(judgement, comparison, metric.better, 1);
    return judgement;
}

MetricSpec error_metric(double margin = 0.0) {
    MetricSpec metric;
    metric.name = "error";
    metric.better = Direction::lower;
    metric.margin = margin;
    return metric;
}

std::vector<Pair> shifted(double shift, std::size_t count) {
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < count; ++i) {
        const double value = 1.0 + 0.1 * static_cast<double>(i);
        pairs.push_back({0, value, value + shift + 0.001 * static_cast<double>(i % 3)});
    }
    return pairs;
}

TEST(Judge, FollowsTheDirectionOfTheMetric) {
    MetricSpec metric = error_metric();
    EXPECT_EQ(judged(shifted(0.5, 10), metric).verdict, Verdict::worse);
    EXPECT_EQ(judged(shifted(-0.5, 10), metric).verdict, Verdict::better);
    metric.better = Direction::higher;
    EXPECT_EQ(judged(shifted(0.5, 10), metric).verdict, Verdict::better);
    EXPECT_DOUBLE_EQ(judged(shifted(0.5, 10), metric).win_share, 1.0);
    metric.better = Direction::none;
    EXPECT_EQ(judged(shifted(0.5, 10), metric).verdict, Verdict::differs);
}

TEST(Judge, CallsEquivalentWhatStaysInsideTheMargin) {
    EXPECT_EQ(judged(shifted(0.01, 10), error_metric(0.02)).verdict, Verdict::equivalent);
    EXPECT_EQ(judged(shifted(0.01, 10), error_metric(0.005)).verdict, Verdict::worse);
    EXPECT_EQ(judged(shifted(0.0, 10), error_metric(0.0)).verdict, Verdict::undecided);
    MetricSpec share = error_metric(0.05);
    share.margin_is_share = true;
    const MetricJudgement judgement = judged(shifted(0.01, 11), share);
    EXPECT_DOUBLE_EQ(judgement.margin, 0.05 * 1.5);
    EXPECT_EQ(judgement.verdict, Verdict::equivalent);
}

TEST(Judge, FewPairsDecideNothing) {
    const MetricJudgement judgement = judged(shifted(0.5, 5), error_metric(10.0));
    EXPECT_EQ(judgement.verdict, Verdict::undecided);
    EXPECT_EQ(judgement.reason, "only 5 pairs tell something; 6 are needed at least");
    EXPECT_EQ(judgement.more_pairs, 1U);
}

TEST(Judge, OfDataWithoutChanceOnePairCounts) {
    std::vector<Pair> pairs(20, Pair{0, 1.0, 2.0});
    pairs.insert(pairs.end(), 3, Pair{1, 1.0, 2.0});
    EXPECT_EQ(independent_pairs(pairs, {}).size(), 23U);
    EXPECT_EQ(independent_pairs(pairs, {0}).size(), 4U);
    EXPECT_EQ(independent_pairs(pairs, {0, 1}).size(), 2U);
}

TEST(Judge, AFailureIsWorseThanAnyValue) {
    std::vector<Pair> pairs = shifted(0.0, 4);
    for (int i = 0; i < 20; ++i) pairs.push_back({0, 1.0 + i, std::nullopt});
    for (const Direction better : {Direction::lower, Direction::higher}) {
        MetricSpec metric = error_metric();
        metric.better = better;
        const MetricJudgement judgement = judged(pairs, metric);
        EXPECT_EQ(judgement.verdict, Verdict::worse);
        EXPECT_EQ(judgement.only_variant_failed, 20U);
        EXPECT_EQ(judgement.neither_failed, 4U);
        EXPECT_EQ(std::abs(judgement.median.value), kInf);
        ASSERT_TRUE(judgement.mean);
        EXPECT_TRUE(std::isfinite(judgement.mean->high));
    }
}

TEST(Judge, WhereBothFailNobodyWins) {
    std::vector<Pair> pairs;
    for (int i = 0; i < 10; ++i) pairs.push_back({static_cast<std::size_t>(i), {}, {}});
    const MetricJudgement judgement = judged(pairs, error_metric(0.1));
    EXPECT_EQ(judgement.both_failed, 10U);
    EXPECT_DOUBLE_EQ(judgement.win_share, 0.5);
    EXPECT_FALSE(judgement.mean);
    EXPECT_EQ(judgement.verdict, Verdict::undecided) << "no accuracy was seen";
}

TEST(Judge, TellsHowManyMoreWouldDecide) {
    std::mt19937_64 rng(11);
    std::normal_distribution<double> normal(0.3, 1.0);
    const auto draw = [&](std::size_t count) {
        std::vector<Pair> pairs;
        for (std::size_t i = 0; i < count; ++i) pairs.push_back({i, 1.0, 1.0 + normal(rng)});
        return pairs;
    };
    int decided = 0;
    int asked = 0;
    for (int i = 0; i < 60; ++i) {
        const auto first = draw(20);
        const MetricJudgement before = judged(first, error_metric());
        if (before.verdict != Verdict::undecided || !before.more_pairs ||
            before.median.value < 0.25 || before.median.value > 0.35)
            continue;  // only where the spread was seen about right
        ++asked;
        decided += judged(draw(20 + *before.more_pairs), error_metric()).verdict == Verdict::worse;
    }
    ASSERT_GE(asked, 3);
    // 80 % by the formula; its inputs are rough and the samples few.
    EXPECT_GE(decided * 2, asked);
}

}  // namespace
}  // namespace petal::compare
