// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/rawlog/sensor_label.hpp"

#include <fnmatch.h>

#include <algorithm>

namespace petal {

bool label_fits(const std::string& pattern, const std::string& label) {
    return pattern == label || fnmatch(pattern.c_str(), label.c_str(), 0) == 0;
}

bool label_fits_any(const std::vector<std::string>& patterns, const std::string& label) {
    return std::any_of(patterns.begin(), patterns.end(),
                       [&](const std::string& pattern) { return label_fits(pattern, label); });
}

}  // namespace petal
