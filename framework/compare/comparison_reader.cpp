// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "comparison_reader.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "json_reader.hpp"
#include "object_reader.hpp"
#include "text_file.hpp"

namespace petal::compare {

namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Names become parts of tables and of --only.
bool is_name(const std::string& text) {
    return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '-' || c == '.' || c == '+';
    });
}

/// From the tree of one comparison file to a Comparison; mistakes go to the list.
class ComparisonReader {
   public:
    ComparisonReader(const std::filesystem::path& file, ProblemList& problems)
        : file_(file.string()), folder_(file.parent_path()), problems_(problems) {}

    Comparison read(const JsonNode& root) {
        Comparison c;
        c.name = std::filesystem::path(file_).stem().string();
        ObjectReader reader(root, "", file_, problems_);
        version(reader, root);
        static_cast<void>(reader.text("$schema"));
        c.about = reader.text("about").value_or("");
        const auto base = reader.text("base");
        const auto base_changes = patch_of(reader);
        read_variants(reader, root, base, base_changes, c);
        read_sweep(reader, c);
        read_data(reader, c);
        if (auto seeds = reader.seeds("seeds")) c.seeds = std::move(*seeds);
        read_metrics(reader, root, c);
        c.seed = reader.whole_number("seed").value_or(c.seed);
        c.confidence = reader.number("confidence", 0.5, 0.999).value_or(c.confidence);
        c.failure_margin = reader.number("failure_margin", 0.0, 1.0).value_or(c.failure_margin);
        const auto failure = reader.choice("failure", {"error", "not_usable", "weak"});
        if (failure == "error") c.fails_on = FailsOn::error;
        if (failure == "weak") c.fails_on = FailsOn::weak;
        reader.unknown_keys("a comparison");
        if (c.seeds.empty() && root.is(NodeKind::object) && !root.find("seeds")) c.seeds = {1};
        return c;
    }

   private:
    void version(ObjectReader& reader, const JsonNode& root) {
        const std::string expected =
            "; expected \"petal_compare\": " + std::to_string(kComparisonFormat) +
            ", the format that this program reads";
        const JsonMember* member = reader.find("petal_compare");
        if (!member) {
            if (root.is(NodeKind::object))
                reader.problem(root.origin, "petal_compare", "missing" + expected);
        } else if (member->value.as_int64() != kComparisonFormat) {
            reader.problem(member->value.origin, "petal_compare",
                           "unknown format version: " + describe(member->value) + expected);
        }
    }

    std::vector<PipelineChange> patch_of(ObjectReader& reader) {
        std::vector<PipelineChange> changes;
        if (const JsonNode* patch = reader.object("patch"))
            changes.push_back(PipelineChange::of_patch(file_, *patch));
        return changes;
    }

    std::filesystem::path beside(const std::string& name) const {
        return (folder_ / name).lexically_normal();
    }

    bool check_name(ObjectReader& reader, const JsonMember& member, const std::string& key) {
        if (is_name(member.key)) return true;
        reader.problem(member.origin, key,
                       "'" + printable(member.key) +
                           "' is no name; expected letters, digits, '_', '-', '.' and '+'");
        return false;
    }

    void read_variants(ObjectReader& reader, const JsonNode& root,
                       const std::optional<std::string>& base,
                       const std::vector<PipelineChange>& base_changes, Comparison& c) {
        const JsonNode* all = reader.object("variants");
        const auto reference = reader.text("reference");
        if (all)
            for (const JsonMember& member : all->members) {
                check_name(reader, member, "variants");
                ObjectReader one(member.value, path_join("variants", member.key), file_, problems_);
                Variant variant;
                variant.name = member.key;
                static_cast<void>(one.text("about"));
                const auto pipeline = one.text("pipeline");
                if (pipeline) {
                    variant.pipeline = beside(*pipeline);
                } else if (base) {
                    variant.pipeline = beside(*base);
                    variant.base_changes = base_changes;
                } else if (member.value.is(NodeKind::object)) {
                    one.problem(
                        member.origin, "pipeline",
                        "missing, and the comparison has no base; expected a pipeline file");
                }
                variant.changes = one.changes(folder_);
                one.unknown_keys("a variant");
                c.variants.push_back(std::move(variant));
            }
        if (c.variants.empty() && base)
            c.variants.push_back({"base", beside(*base), base_changes, {}, {}});
        if (c.variants.empty() && root.is(NodeKind::object))
            reader.problem(
                root.origin, "variants",
                "none, and no base; expected \"base\": FILE, or variants with pipelines");
        if (!reference) return;
        std::vector<std::string> names;
        for (const Variant& variant : c.variants) names.push_back(variant.name);
        const auto at = std::find(names.begin(), names.end(), *reference);
        if (at == names.end())
            reader.problem(
                root.find("reference")->value.origin, "reference",
                "no variant '" + printable(*reference) + "'" + expected_one_of(*reference, names));
        else
            c.reference = static_cast<std::size_t>(at - names.begin());
    }

    /// One parameter after the other, on top of the reference.
    void read_sweep(ObjectReader& reader, Comparison& c) {
        const JsonNode* sweep = reader.object("sweep");
        if (!sweep || c.variants.empty()) return;
        const Variant reference = c.variants[c.reference];
        for (const JsonMember& member : sweep->members) {
            const std::string path = path_join("sweep", member.key);
            if (!member.value.is(NodeKind::array) || member.value.elements.empty()) {
                problems_.add(member.value.origin, path,
                              describe(member.value) + " is no range; expected a list of values");
                continue;
            }
            for (const JsonNode& value : member.value.elements) {
                auto patch = set_patch(member.key, value.origin, value, path, problems_);
                if (!patch) break;
                Variant variant = reference;
                variant.swept = SweepPoint{member.key, compact_json(value)};
                variant.name = member.key + "=" + variant.swept->value;
                variant.changes.push_back(PipelineChange::of_patch(file_, std::move(*patch)));
                c.variants.push_back(std::move(variant));
            }
        }
    }

    void read_data(ObjectReader& reader, Comparison& c) {
        const JsonNode* all = reader.object("data");
        if (all)
            for (const JsonMember& member : all->members) {
                check_name(reader, member, "data");
                ObjectReader one(member.value, path_join("data", member.key), file_, problems_);
                DataItem item;
                item.name = member.key;
                static_cast<void>(one.text("about"));
                if (const auto folder = one.text("folder")) {
                    item.folder = *folder;
                    item.relative_to = folder_;
                    item.where = problems_.where(member.value.find("folder")->value.origin);
                }
                item.changes = one.changes(folder_);
                if (auto seeds = one.seeds("seeds")) item.seeds = std::move(*seeds);
                one.unknown_keys("a data item");
                c.data.push_back(std::move(item));
            }
        if (c.data.empty()) c.data.push_back({"pipeline", "", {}, "", {}, {}});
    }

    void read_metrics(ObjectReader& reader, const JsonNode& root, Comparison& c) {
        const JsonNode* all = reader.object("metrics");
        if (!all || all->members.empty()) {
            if (root.is(NodeKind::object) && (all || !root.find("metrics")))
                reader.problem(root.origin, "metrics",
                               "none; expected the metrics to compare: { \"NAME\": { \"better\": "
                               "\"lower\" } }");
            return;
        }
        for (const JsonMember& member : all->members) {
            ObjectReader one(member.value, path_join("metrics", member.key), file_, problems_);
            MetricSpec metric;
            metric.name = member.key;
            static_cast<void>(one.text("about"));
            metric.unit = one.text("unit").value_or("");
            const auto better = one.choice("better", {"lower", "higher", "none"});
            if (!better && member.value.is(NodeKind::object) && !member.value.find("better"))
                one.problem(member.origin, "better", "missing; expected lower, higher or none");
            if (better == "lower") metric.better = Direction::lower;
            if (better == "higher") metric.better = Direction::higher;
            const auto margin = one.number("margin", 0.0, kNoLimit);
            const auto share = one.number("margin_share", 0.0, 1.0);
            if (margin && share)
                one.problem(member.value.find("margin_share")->origin, "margin_share",
                            "stands beside margin; expected one of them");
            metric.margin = share.value_or(margin.value_or(0.0));
            metric.margin_is_share = share.has_value();
            one.unknown_keys("a metric");
            c.metrics.push_back(std::move(metric));
        }
    }

    std::string file_;
    std::filesystem::path folder_;
    ProblemList& problems_;
};

}  // namespace

CheckedComparison read_comparison_text(const std::string& text, const std::filesystem::path& file) {
    ProblemList problems;
    const std::size_t number = problems.add_file(file.string());
    CheckedComparison checked;
    if (const auto root = read_json(text, number, "", problems))
        checked.comparison = ComparisonReader(file, problems).read(*root);
    checked.problems = problems.sorted();
    if (!checked.problems.empty()) checked.comparison.reset();
    return checked;
}

CheckedComparison read_comparison(const std::filesystem::path& file) {
    std::string why;
    if (const auto text = read_text_file(file, why)) return read_comparison_text(*text, file);
    CheckedComparison checked;
    checked.problems.push_back({file.string(), 0, "", why, false});
    return checked;
}

}  // namespace petal::compare
