// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/report_words.hpp"

namespace petal {

std::string verdict_word(const std::string& level) {
    if (level == "usable") return "Usable";
    return level == "weak" ? "Weak" : "Not usable";
}

std::string verdict_style(const std::string& level) {
    if (level == "usable") return "good";
    return level == "weak" ? "fair" : "bad";
}

std::string verdict_sentence(const std::string& level) {
    if (level == "usable")
        return "The pose is known as well as the solver's limits ask for, and the data themselves "
               "say which corner is which.";
    if (level == "weak")
        return "The pose may be right, but something speaks against relying on it:";
    return "There is no pose that could be relied on:";
}

std::string order_sentence(const std::string& decided_by) {
    if (decided_by == "data") return "the data decided.";
    if (decided_by == "prior")
        return "several orders fit alike, and a prior on how the sensors are mounted decided.";
    if (decided_by == "given") return "the input said so.";
    return "several orders fit alike, and nothing could decide.";
}

}  // namespace petal
