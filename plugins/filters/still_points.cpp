// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/still_points.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/cloud_subset.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/error.hpp"
#include "petal/printed.hpp"

namespace petal {
namespace {

const char* const kStillSought = "the part of the capture in which no board moved";

constexpr double kRounding = 1e-6;  // s: splits begin at whole messages

/// From the first message's stamp, s.
struct StillPart {
    double from = 0.0, until = std::numeric_limits<double>::infinity();
    bool told = false;  ///< of a board at least
};

bool ends_with(const std::string& name, const std::string& end) {
    return name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
}

/// The time that the still parts of all boards have in common.
StillPart common_part(const Metrics& metrics) {
    StillPart part;
    for (const Metric& metric : metrics.values) {
        if (metric.name.rfind("stillness.board_", 0) != 0) continue;
        if (ends_with(metric.name, ".still_from_s")) {
            part.from = std::max(part.from, metric.value);
            part.told = true;
        } else if (ends_with(metric.name, ".still_until_s")) {
            part.until = std::min(part.until, metric.value);
            part.told = true;
        }
    }
    return part;
}

/// The messages whose stamps lie in a part: first, and one behind the last.
std::pair<std::size_t, std::size_t> messages_in(const Cloud& cloud, const StillPart& part) {
    const double begin = mrpt::Clock::toDouble(cloud.parts.front().stamp);
    std::size_t first = cloud.parts.size(), last = 0;
    for (std::size_t i = 0; i < cloud.parts.size(); ++i) {
        const double at = mrpt::Clock::toDouble(cloud.parts[i].stamp) - begin + kRounding;
        if (at < part.from || at >= part.until) continue;
        first = std::min(first, i);
        last = i + 1;
    }
    return {std::min(first, last), last};
}

/// The points of messages `first` to `last`, which lie side by side, with these messages.
Cloud points_of(const Cloud& cloud, std::size_t first, std::size_t last) {
    const std::size_t begin = cloud.parts[first].begin;
    const std::size_t end = last < cloud.parts.size() ? cloud.parts[last].begin : cloud.size();
    std::vector<std::uint32_t> indices(end - begin);
    std::iota(indices.begin(), indices.end(), static_cast<std::uint32_t>(begin));
    Cloud still = subset(cloud, indices);
    for (std::size_t i = first; i < last; ++i)
        still.parts.push_back({cloud.parts[i].begin - begin, cloud.parts[i].stamp});
    return still;
}

}  // namespace

void StillPoints::describe(Spec<Params>& s) {
    s.summary("Keeps the points of the part of a capture in which no board moved.");
    s.doc(
        R"(`metric.stillness` compares splits of the capture and tells, board by board, the longest run of them
without motion (`still_from_s`, `still_until_s`: the whole capture unless a board moved by more than its
`sigmas` and its `min_motion`). What all boards have in common of these is kept, message by message; the others'
points go. Where nothing moved the very same packet goes on: nothing is copied.

Boards must be found before their motion can be measured, so the pipeline finds them twice: in the whole capture, and in
what this stage keeps (`pipelines/variants/still_points.json`).

Where too little would stay (`min_still`), or the boards were never still together, all points stay and a note says so: the
finding of `metric.stillness` makes the result weak in any case. The image that is used is not chosen anew: where
`metric.stillness` tells of a shift between images, record again.)");
    s.reads<Cloud>("cloud", "the raw points of a scene, with the messages that they came in");
    s.reads<Metrics>("metrics", "those of metric.stillness for the same cloud");
    s.writes<Cloud>("cloud", "the points of the still part, in their order, with their messages");
    s.param("min_still", &Params::min_still)
        .unit("s")
        .within(0.0, 3600.0)
        .doc("all points stay where the still part is shorter");
}

void StillPoints::run(Run& run) {
    const auto cloud = run.in_ptr<Cloud>("cloud");
    const StillPart part = common_part(run.in<Metrics>("metrics"));
    const auto keep_all = [&](const std::string& why, const std::string& advice) {
        if (!why.empty()) run.note({kStillSought, why, "", advice});
        run.forward("cloud", cloud);
    };
    if (!part.told)
        return keep_all("the metrics tell of no board", "see the notes of metric.stillness");
    if (cloud->parts.empty())
        throw Error(
            "the cloud on 'cloud' has lost the messages that it came in; wire the cloud "
            "of the source, as metric.stillness has it");
    const auto [first, last] = messages_in(*cloud, part);
    if (first == 0 && last == cloud->parts.size()) return keep_all("", "");
    if (first == last || part.until - part.from < p_.min_still)
        return keep_all(part.until > part.from
                            ? printed("only %.1f s, from %.1f s on (min_still %.1f s)",
                                      part.until - part.from, part.from, p_.min_still)
                            : std::string("the boards were never still at the same time"),
                        "all points stay; fasten boards and sensors and record again");
    Cloud still = points_of(*cloud, first, last);
    run.log(LogLevel::info, printed("%zu of %zu points stay: those from %.1f s to %.1f s",
                                    still.size(), cloud->size(), part.from, part.until));
    run.write("cloud", std::move(still));
}

}  // namespace petal
