// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "bootstrap.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace petal::compare {

namespace {

/// FNV-1a, so that each name draws numbers of its own.
std::uint64_t hash_of(std::uint64_t seed, std::string_view name) {
    std::uint64_t hash = 14695981039346656037ULL ^ (seed * 0x9E3779B97F4A7C15ULL);
    for (const char c : name) {
        hash ^= static_cast<unsigned char>(c);
        hash *= 1099511628211ULL;
    }
    return hash;
}

double middle(double lower, double upper) {
    if (lower == upper) return lower;  // also where both are infinite
    if (std::isinf(lower) && std::isinf(upper)) return 0.0;
    return 0.5 * (lower + upper);
}

double median_in_place(std::vector<double>& values) {
    const auto half = static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), values.begin() + half, values.end());
    const double upper = values[static_cast<std::size_t>(half)];
    if (values.size() % 2 == 1) return upper;
    return middle(*std::max_element(values.begin(), values.begin() + half), upper);
}

}  // namespace

double median_of(std::vector<double> values) {
    return median_in_place(values);
}

double mean_of(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

Bootstrap::Bootstrap(std::uint64_t seed, std::string_view name, double confidence)
    : rng_(hash_of(seed, name)), confidence_(confidence) {}

std::size_t Bootstrap::draw(std::size_t count) {
    return static_cast<std::size_t>(((rng_() >> 32U) * count) >> 32U);
}

template <class Statistic>
Interval Bootstrap::interval(const std::vector<double>& values, Statistic statistic) {
    std::vector<double> found(kResamples);
    std::vector<double> sample(values.size());
    for (double& one : found) {
        for (double& value : sample) value = values[draw(values.size())];
        one = statistic(sample);
    }
    std::sort(found.begin(), found.end());
    const double tail = 0.5 * (1.0 - confidence_) * kResamples;
    const auto out = static_cast<std::size_t>(std::floor(tail));
    sample = values;
    return {statistic(sample), found[out], found[found.size() - 1 - out]};
}

Interval Bootstrap::median(const std::vector<double>& values) {
    return interval(values, [](std::vector<double>& sample) { return median_in_place(sample); });
}

Interval Bootstrap::mean(const std::vector<double>& values) {
    return interval(values, [](const std::vector<double>& sample) { return mean_of(sample); });
}

}  // namespace petal::compare
