// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "seed_range.hpp"

#include <charconv>
#include <set>

#include "json_tree.hpp"

namespace petal::compare {

namespace {

bool read_seed(const std::string& text, std::uint64_t& seed) {
    const char* end = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, seed);
    return read.ec == std::errc() && read.ptr == end;
}

/// One of the parts between commas, put at the end of `seeds`.
std::string add_part(const std::string& part, std::vector<std::uint64_t>& seeds) {
    const std::size_t dots = part.find("..");
    std::uint64_t first = 0;
    std::uint64_t last = 0;
    if (!read_seed(part.substr(0, dots), first) ||
        !read_seed(dots == std::string::npos ? part : part.substr(dots + 2), last))
        return "'" + printable(part) + "' is no seed range; expected 1..20, or 1..5,8";
    if (last < first)
        return "'" + printable(part) + "' runs backwards; expected FIRST..LAST with FIRST <= LAST";
    if (last - first >= kMostSeeds)
        return "'" + printable(part) + "' has more than " + std::to_string(kMostSeeds) + " seeds";
    for (std::uint64_t seed = first;; ++seed) {
        seeds.push_back(seed);
        if (seed == last) return {};
    }
}

}  // namespace

std::vector<std::uint64_t> read_seeds(const std::string& text, std::string& why) {
    std::vector<std::uint64_t> seeds;
    std::size_t at = 0;
    while (true) {
        const std::size_t comma = text.find(',', at);
        why = add_part(text.substr(at, comma == std::string::npos ? comma : comma - at), seeds);
        if (!why.empty()) return {};
        if (comma == std::string::npos) break;
        at = comma + 1;
    }
    if (seeds.size() > kMostSeeds) {
        why = "has more than " + std::to_string(kMostSeeds) + " seeds";
        return {};
    }
    if (std::set<std::uint64_t>(seeds.begin(), seeds.end()).size() != seeds.size()) {
        why = "'" + printable(text) + "' has a seed twice; expected each once";
        return {};
    }
    return seeds;
}

}  // namespace petal::compare
