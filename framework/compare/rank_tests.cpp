// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "rank_tests.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace petal::compare {

namespace {

constexpr std::size_t kMostExact = 200;

/// Twice the rank of each magnitude, ties sharing the mean: whole numbers.
std::vector<std::size_t> doubled_ranks(const std::vector<double>& magnitudes) {
    std::vector<std::size_t> order(magnitudes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return magnitudes[a] < magnitudes[b]; });
    std::vector<std::size_t> ranks(magnitudes.size());
    for (std::size_t first = 0; first < order.size();) {
        std::size_t end = first;
        while (end < order.size() && magnitudes[order[end]] == magnitudes[order[first]]) ++end;
        for (std::size_t i = first; i < end; ++i) ranks[order[i]] = first + 1 + end;
        first = end;
    }
    return ranks;
}

/// P(sum of ranks with random signs, positive part <= `smaller`), both tails.
double exact_p(const std::vector<std::size_t>& ranks, std::size_t smaller) {
    const std::size_t total = std::accumulate(ranks.begin(), ranks.end(), std::size_t{0});
    std::vector<double> probability(total + 1, 0.0);
    probability[0] = 1.0;
    std::size_t reach = 0;
    for (const std::size_t rank : ranks) {
        reach += rank;
        for (std::size_t sum = reach + 1; sum-- > 0;)
            probability[sum] =
                0.5 * (probability[sum] + (sum >= rank ? probability[sum - rank] : 0.0));
    }
    double tail = 0.0;
    for (std::size_t sum = 0; sum <= smaller; ++sum) tail += probability[sum];
    return std::min(1.0, 2.0 * tail);
}

double normal_p(const std::vector<std::size_t>& ranks, std::size_t smaller) {
    double mean = 0.0;
    double variance = 0.0;
    for (const std::size_t rank : ranks) {
        const auto value = static_cast<double>(rank);
        mean += 0.5 * value;
        variance += 0.25 * value * value;
    }
    // Half a rank, doubled, for the continuity of the normal.
    const double away = std::max(0.0, mean - static_cast<double>(smaller) - 1.0);
    return std::erfc(away / std::sqrt(2.0 * variance));
}

}  // namespace

SignedRank signed_rank(const std::vector<double>& differences) {
    std::vector<double> magnitudes;
    std::vector<bool> positive;
    for (const double difference : differences) {
        if (difference == 0.0) continue;
        magnitudes.push_back(std::abs(difference));
        positive.push_back(difference > 0.0);
    }
    if (magnitudes.empty()) return {};
    const auto ranks = doubled_ranks(magnitudes);
    std::size_t up = 0;
    std::size_t down = 0;
    for (std::size_t i = 0; i < ranks.size(); ++i) (positive[i] ? up : down) += ranks[i];
    const std::size_t smaller = std::min(up, down);
    const double p =
        ranks.size() <= kMostExact ? exact_p(ranks, smaller) : normal_p(ranks, smaller);
    return {p, up > down ? 1 : (up < down ? -1 : 0)};
}

double sign_p(std::uint64_t a, std::uint64_t b) {
    const std::uint64_t smaller = std::min(a, b);
    const auto n = static_cast<double>(a + b);
    double tail = 0.0;
    for (std::uint64_t k = 0; k <= smaller; ++k) {
        const auto count = static_cast<double>(k);
        tail += std::exp(std::lgamma(n + 1.0) - std::lgamma(count + 1.0) -
                         std::lgamma(n - count + 1.0) - n * std::log(2.0));
    }
    return std::min(1.0, 2.0 * tail);
}

std::vector<double> holm(const std::vector<double>& p_values) {
    std::vector<std::size_t> order(p_values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
    std::vector<double> adjusted(p_values.size());
    double largest = 0.0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const double scaled = static_cast<double>(order.size() - i) * p_values[order[i]];
        largest = std::max(largest, std::min(1.0, scaled));
        adjusted[order[i]] = largest;
    }
    return adjusted;
}

}  // namespace petal::compare
