// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/findings.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace petal {
namespace {

void add_reason(std::vector<std::string>& reasons, const std::string& reason) {
    if (std::find(reasons.begin(), reasons.end(), reason) == reasons.end())
        reasons.push_back(reason);
}

template <class Boards>
void add_findings(const std::vector<Packet<Boards>>& scenes, Judgement& found) {
    for (const auto& scene : scenes)
        for (const std::string& finding : scene->findings) {
            const bool named = scenes.size() > 1 && !scene.frame.name.empty();
            found.level = std::max(found.level, Level::weak);
            add_reason(found.reasons, named ? scene.frame.name + ": " + finding : finding);
        }
}

}  // namespace

Judgement found_by_checks(const ResultInput& input) {
    Judgement found;
    for (const auto& packet : input.metrics)
        for (const Finding& finding : packet->findings) {
            found.level = std::max(found.level, finding.level);
            add_reason(found.reasons, finding.reason);
        }
    add_findings(input.lidar_boards, found);
    add_findings(input.image_boards, found);
    return found;
}

Judgement judge(ResultInput& input) {
    Judgement found = found_by_checks(input);
    if (found.reasons.empty()) return found;
    auto judged = std::make_shared<Extrinsics>(*input.extrinsics);
    lower(*judged, found);
    input.extrinsics = std::move(judged);
    return found;
}

void lower(Extrinsics& extrinsics, const Judgement& found) {
    extrinsics.level = std::max(extrinsics.level, found.level);
    for (const std::string& reason : found.reasons) add_reason(extrinsics.reasons, reason);
}

}  // namespace petal
