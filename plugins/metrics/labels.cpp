// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/labels.hpp"

#include "metrics/detail/scene_name.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/truth.hpp"

namespace petal {

void LabelsMetric::describe(Spec<Params>& s) {
    s.summary("What a filter takes and what it leaves: shares of vacant, edge and other points.");
    s.doc(
        R"(Compares the points before and after a filter (or several) with the labels of a simulated scene, which tell
of each point what it really is: background, board, vacant (between surfaces that shared the beam, on
neither of them) or other foreground. Each figure is told for every scene and (without a scene's name) in
total: a share of the total is one of all points of all scenes.

| name | what |
|---|---|
| labels.before.count, labels.after.count | points |
| labels.before.vacant_share, board_share, background_share, other_share | of the points before; these four sum to 1 |
| labels.before.edge_share | board points near an edge, of all points before; they count as board too |
| labels.after.vacant_share, ... | the same, of the points after |
| labels.vacant_removed_share | of the vacant points before, those that are gone: 1 is best |
| labels.edge_kept_share | of the edge points before, those that stayed: 1 is best |
| labels.board_kept_share | of the board points before, those that stayed: 1 is best |

A filter for vacant points that takes the board's rim with it makes holes look larger than they are: the
first figure counts only together with the second.

An edge point is a board point that lies at most `edge_distance` from a side of the outline or of a hole,
measured in the plane of the board that is nearest to it, with the target's file and the board's true pose.
Its place is the measured one, before the filter. While the rig moves, that pose holds at the scene's time 0
only.

A point's label is found by Cloud::scene_index, which every filter writes: `before` need not be the scene's
own cloud. A cloud without it must have one point for each label. A share of nothing (no vacant point
before, no point after) is left out.

Scenes without labels (real data) give no figures, and a note at the end of the run says so; so it does
where there are board points but no boards, which leaves the edge figures out. Each packet holds the figures
of its scene and the totals so far: the last packet holds the totals.)");
    s.role("metric");
    s.reads<Truth>("truth", "labels, one for each point of the scene's own cloud, and the boards");
    s.reads<Cloud>("before", "points before the filter");
    s.reads<Cloud>("after", "points after the filter, with their scene_index");
    s.writes<Metrics>("metrics", "counts and shares, for the scene and in total so far");
    s.param("edge_distance", &Params::edge_distance)
        .unit("m")
        .within(0.0, 1.0)
        .doc(
            "board points at most so far from a true edge are edge points; half the footprint of "
            "a Mid-70 (0.28 deg) at 5 m is 12 mm");
    s.param("targets", &Params::targets)
        .doc("files of targets that petal does not ship, found by the name that the truth tells");
}

void LabelsMetric::run(Run& run) {
    const auto& truth = run.in<Truth>("truth");
    const std::string name = scene_name(run.frame());
    Metrics metrics;
    ++scenes_;
    if (truth.labels.empty()) {
        without_labels_.push_back(name);
    } else {
        const BoardEdges edges(truth.boards, targets_, run);
        const LabelCounts counts =
            count_labels(truth, run.in<Cloud>("before"), run.in<Cloud>("after"), edges,
                         edge_distance_, name, run);
        if (!counts.edges_known) without_boards_.push_back(name);
        total_.add(counts);
        metrics.values = label_figures(counts, name);
    }
    if (without_labels_.size() < scenes_)
        for (Metric& figure : label_figures(total_, ""))
            metrics.values.push_back(std::move(figure));
    run.write("metrics", std::move(metrics));
}

void LabelsMetric::finish(Run& run) {
    if (!without_labels_.empty())
        run.note({"labels of points",
                  "no truth: " + std::to_string(without_labels_.size()) + " of " +
                      std::to_string(scenes_) +
                      " scenes have no labels and do not count: " + listed(without_labels_),
                  "",
                  "labels are known of simulated scenes only: source.simulator gives them, "
                  "sink.rawlog writes them as labels.u8 beside truth.json"});
    if (!without_boards_.empty())
        run.note({"edge points",
                  "board points, but no boards in the truth of " + listed(without_boards_) +
                      ": no edge figures there, nor in total",
                  "", "boards with target and T_lidar_board belong into truth.json"});
}

}  // namespace petal
