// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

namespace petal::compare {

/// A figure with the ends of its interval. In what counts failures all may be infinite.
struct Interval {
    double value = 0.0;
    double low = 0.0;
    double high = 0.0;
};

/// The middle value, or the mean of the two; may be infinite where the values are. Between
/// -infinity and +infinity it is 0. \pre not empty.
double median_of(std::vector<double> values);

double mean_of(const std::vector<double>& values);

/// Percentile intervals from kResamples resamples with replacement. The same seed and values give
/// the same bytes on every machine: std::mt19937_64 is fixed by the standard, and no distribution
/// of the library is used.
class Bootstrap {
   public:
    static constexpr int kResamples = 2000;

    Bootstrap(std::uint64_t seed, std::string_view name, double confidence);

    /// Of the median. \pre values not empty.
    Interval median(const std::vector<double>& values);
    /// Of the mean. \pre values not empty, finite.
    Interval mean(const std::vector<double>& values);

   private:
    /// 0 to count - 1, as good as evenly. \pre count < 2^32.
    std::size_t draw(std::size_t count);
    template <class Statistic>
    Interval interval(const std::vector<double>& values, Statistic statistic);

    std::mt19937_64 rng_;
    double confidence_;
};

}  // namespace petal::compare
