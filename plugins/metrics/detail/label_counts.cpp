// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/label_counts.hpp"

#include <cstdint>

#include "metrics/detail/board_edges.hpp"
#include "petal/error.hpp"

namespace petal {
namespace {

enum Label : std::uint8_t { background, board, vacant, other, label_count };

constexpr std::size_t kBetweenPolls = 4096;  // points

/// A cloud whose points each have a label.
class LabelledCloud {
   public:
    LabelledCloud(const Cloud& cloud, const char* port, std::size_t labels,
                  const std::string& scene)
        : cloud_(cloud) {
        const std::string who = "scene '" + scene + "': the cloud on port '" + port + "' has " +
                                std::to_string(cloud.size()) + " points";
        const auto& index = cloud.scene_index;
        if (!index.empty() && index.size() != cloud.size())
            throw Error(who + ", but " + std::to_string(index.size()) +
                        " entries in scene_index; the stage that wrote it must write one a point");
        // A filter may take all points.
        if (index.empty() && cloud.size() != labels && cloud.size() > 0)
            throw Error(who + " and no scene_index, but there are " + std::to_string(labels) +
                        " labels, one for each point of the scene's own cloud; wire the truth of "
                        "the same scene, and clouds of stages that write Cloud::scene_index");
        for (const std::uint32_t i : index)
            if (i >= labels)
                throw Error(who + ", one of them point " + std::to_string(i) +
                            " of the scene's own cloud, but there are " + std::to_string(labels) +
                            " labels; wire the truth of the same scene");
    }

    std::size_t size() const { return cloud_.size(); }
    std::size_t scene_index(std::size_t i) const {
        return cloud_.scene_index.empty() ? i : cloud_.scene_index[i];
    }
    Eigen::Vector3d point(std::size_t i) const {
        float x = 0.0F, y = 0.0F, z = 0.0F;
        cloud_.points->getPointFast(i, x, y, z);
        return {x, y, z};
    }

   private:
    const Cloud& cloud_;
};

/// The label of each point of the scene, and whether it lies near an edge of a board.
class Kinds {
   public:
    Kinds(const Truth& truth, const BoardEdges& edges, double edge_distance,
          const std::string& scene)
        : labels_(truth.labels),
          edges_(edges),
          edge_distance_(edge_distance),
          edge_(truth.labels.size(), Edge::unknown) {
        for (std::size_t i = 0; i < labels_.size(); ++i)
            if (labels_[i] >= label_count)
                throw Error("scene '" + scene + "': point " + std::to_string(i) + " has label " +
                            std::to_string(labels_[i]) +
                            "; known are 0 background, 1 board, 2 vacant, 3 other");
    }

    /// `point` is asked for where the point was seen for the first time: a filter that moves points
    /// makes no other edges.
    void count(KindCounts& counts, std::size_t i, const Eigen::Vector3d& point) {
        ++counts.all;
        ++counts.label[labels_[i]];
        if (labels_[i] != board) return;
        if (edge_[i] == Edge::unknown)
            edge_[i] = edges_.distance(point) <= edge_distance_ ? Edge::yes : Edge::no;
        if (edge_[i] == Edge::yes) ++counts.edge;
    }

   private:
    enum class Edge : std::uint8_t { unknown, no, yes };
    const std::vector<std::uint8_t>& labels_;
    const BoardEdges& edges_;
    double edge_distance_;
    std::vector<Edge> edge_;
};

void add(KindCounts& sum, const KindCounts& more) {
    sum.all += more.all;
    for (std::size_t i = 0; i < sum.label.size(); ++i) sum.label[i] += more.label[i];
    sum.edge += more.edge;
}

}  // namespace

void LabelCounts::add(const LabelCounts& more) {
    petal::add(before, more.before);
    petal::add(after, more.after);
    petal::add(kept, more.kept);
    edges_known = edges_known && more.edges_known;
}

LabelCounts count_labels(const Truth& truth, const Cloud& before, const Cloud& after,
                         const BoardEdges& edges, double edge_distance, const std::string& name,
                         Run& run) {
    const LabelledCloud all(before, "before", truth.labels.size(), name);
    const LabelledCloud left(after, "after", truth.labels.size(), name);
    Kinds kinds(truth, edges, edge_distance, name);
    std::vector<bool> stays(truth.labels.size(), false);
    for (std::size_t i = 0; i < left.size(); ++i) stays[left.scene_index(i)] = true;

    LabelCounts counts;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (i % kBetweenPolls == 0) run.check_cancelled();
        const std::size_t index = all.scene_index(i);
        kinds.count(counts.before, index, all.point(i));
        if (stays[index]) kinds.count(counts.kept, index, all.point(i));
    }
    for (std::size_t i = 0; i < left.size(); ++i) {
        if (i % kBetweenPolls == 0) run.check_cancelled();
        kinds.count(counts.after, left.scene_index(i), left.point(i));
    }
    counts.edges_known =
        !edges.empty() || counts.before.label[board] + counts.after.label[board] == 0;
    return counts;
}

std::vector<Metric> label_figures(const LabelCounts& counts, const std::string& scene) {
    std::vector<Metric> figures;
    const auto add_share = [&](const std::string& name, std::size_t part, std::size_t whole) {
        if (whole > 0)
            figures.push_back({"labels." + name,
                               static_cast<double>(part) / static_cast<double>(whole), "1", scene});
    };
    const auto add_kinds = [&](const std::string& when, const KindCounts& kinds) {
        figures.push_back(
            {"labels." + when + ".count", static_cast<double>(kinds.all), "1", scene});
        add_share(when + ".vacant_share", kinds.label[vacant], kinds.all);
        add_share(when + ".board_share", kinds.label[board], kinds.all);
        if (counts.edges_known) add_share(when + ".edge_share", kinds.edge, kinds.all);
        add_share(when + ".background_share", kinds.label[background], kinds.all);
        add_share(when + ".other_share", kinds.label[other], kinds.all);
    };
    add_kinds("before", counts.before);
    add_kinds("after", counts.after);
    const KindCounts& before = counts.before;
    add_share("vacant_removed_share", before.label[vacant] - counts.kept.label[vacant],
              before.label[vacant]);
    if (counts.edges_known) add_share("edge_kept_share", counts.kept.edge, before.edge);
    add_share("board_kept_share", counts.kept.label[board], before.label[board]);
    return figures;
}

}  // namespace petal
