// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "nearest.hpp"

#include <algorithm>
#include <cstddef>

namespace petal {
namespace {

/// Insertions, deletions, substitutions and swaps of neighbours, no substring edited twice (the
/// restricted form, "optimal string alignment": it needs three rows only).
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> before(b.size() + 1);
    std::vector<std::size_t> previous(b.size() + 1);
    std::vector<std::size_t> current(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) previous[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        current[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t substitution = a[i - 1] == b[j - 1] ? 0 : 1;
            current[j] =
                std::min({previous[j] + 1, current[j - 1] + 1, previous[j - 1] + substitution});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                current[j] = std::min(current[j], before[j - 2] + 1);
        }
        before.swap(previous);
        previous.swap(current);
    }
    return previous[b.size()];
}

}  // namespace

std::string nearest(const std::string& typo, const std::vector<std::string>& known) {
    const std::size_t allowed = std::max<std::size_t>(1, typo.size() / 3);
    std::size_t smallest = allowed + 1;
    std::string best;
    for (const std::string& name : known) {
        const std::size_t distance = edit_distance(typo, name);
        // Words that share no letter are not near, however short they are.
        if (distance >= std::max(typo.size(), name.size())) continue;
        if (distance < smallest) {
            smallest = distance;
            best = name;
        }
    }
    return best;
}

std::string did_you_mean(const std::string& typo, const std::vector<std::string>& known) {
    const std::string name = nearest(typo, known);
    return name.empty() ? std::string() : "; did you mean '" + name + "'?";
}

std::string join(const std::vector<std::string>& words, const std::string& separator) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) text += separator;
        text += words[i];
    }
    return text;
}

}  // namespace petal
