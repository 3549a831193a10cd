// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plan.hpp"

#include <link.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <utility>

#include "expand.hpp"
#include "petal/error.hpp"
#include "run_report.hpp"

namespace petal::compare {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

/// 128 bits are enough for a name that nobody may guess into another.
constexpr std::size_t kKeyLength = 32;

/// petal's own libraries of this process: what the plugins' results depend on besides themselves.
std::set<std::string> own_libraries() {
    std::set<std::string> found;
    dl_iterate_phdr(
        [](dl_phdr_info* info, std::size_t, void* data) {
            const std::string name = info->dlpi_name;
            if (fs::path(name).filename().string().rfind("libpetal", 0) == 0)
                static_cast<std::set<std::string>*>(data)->insert(name);
            return 0;
        },
        &found);
    return found;
}

void describe_build(const Pipeline& pipeline, const std::set<std::string>& own, FileSums& sums,
                    PlannedPipeline& planned) {
    std::set<std::string> libraries = own;
    for (const StageNode& stage : pipeline.stages) {
        planned.versions[stage.spec->plugin] = stage.spec->plugin_version;
        if (!stage.spec->library.empty()) libraries.insert(stage.spec->library);
    }
    planned.build = std::string("petal ") + version() + "\n";
    for (const auto& [plugin, its_version] : planned.versions)
        planned.build += "plugin " + plugin + " " + its_version + "\n";
    std::set<std::string> library_sums;  // where they lie does not matter
    for (const std::string& library : libraries)
        library_sums.insert(fs::path(library).filename().string() + " " + sums.of(library) + "\n");
    for (const std::string& line : library_sums) planned.build += line;
}

/// The effective pipeline without what does not change its result.
std::string without_words(const std::string& effective) {
    Json json = Json::parse(effective);
    json.erase("about");
    json.erase("seed");
    for (auto& [id, stage] : json["stages"].items()) stage.erase("about");
    return json.dump(2) + "\n";
}

std::string sums_of_folder(const fs::path& folder, FileSums& sums) {
    std::set<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files.insert(entry.path());
    std::string lines;
    for (const fs::path& file : files)
        lines += file.lexically_relative(folder).string() + " " + sums.of(file) + "\n";
    return lines;
}

class Planner {
   public:
    Planner(const Comparison& comparison, const PluginSet& plugins, FileSums& sums)
        : comparison_(comparison), plugins_(plugins), sums_(sums) {}

    Plan make() {
        for (const DataItem& item : comparison_.data) plan_.data.push_back(data_of(item));
        if (!plan_.problems.empty()) return std::move(plan_);
        const auto own = own_libraries();
        plan_.pipelines.resize(comparison_.variants.size());
        for (std::size_t v = 0; v < comparison_.variants.size(); ++v)
            for (std::size_t d = 0; d < comparison_.data.size(); ++d)
                plan_.pipelines[v].push_back(pipeline_of(v, d, own));
        if (!plan_.problems.empty()) return std::move(plan_);
        for (std::size_t d = 0; d < comparison_.data.size(); ++d)
            if (!plan_.data[d].folder.empty())
                plan_.data[d].sums = sums_of_folder(plan_.data[d].folder, sums_);
        add_units();
        return std::move(plan_);
    }

   private:
    PlannedData data_of(const DataItem& item) {
        PlannedData data;
        if (item.folder.empty()) return data;
        Expansions none;
        const Expanded expanded = expand(item.folder, none);
        const auto problem = [&](const std::string& message) {
            plan_.problems.push_back(
                {item.where, 0, "data." + item.name + ".folder", message, false});
        };
        if (!expanded.fault.empty()) {
            problem(expanded.fault);
            return data;
        }
        std::error_code error;
        const fs::path folder = fs::path(item.relative_to) / expanded.text;
        if (!fs::is_directory(folder, error)) {
            problem(folder.string() + " is no folder; expected the folder that holds the data");
            return data;
        }
        data.folder = fs::canonical(folder, error);
        return data;
    }

    PlannedPipeline pipeline_of(std::size_t v, std::size_t d, const std::set<std::string>& own) {
        const Variant& variant = comparison_.variants[v];
        PipelineRequest request;
        request.file = variant.pipeline;
        request.need_data = true;
        if (!plan_.data[d].folder.empty()) request.data = plan_.data[d].folder;
        std::vector<PipelineChange> changes = variant.base_changes;
        const auto add = [&](const std::vector<PipelineChange>& more) {
            changes.insert(changes.end(), more.begin(), more.end());
        };
        add(comparison_.data[d].changes);
        add(variant.changes);
        const auto read = read_changed_pipeline(request, changes, plugins_.registry);
        PlannedPipeline planned;
        planned.name = variant.pipeline.string();
        for (const Problem& problem : read.problems) tell(problem, variant, comparison_.data[d]);
        if (!read.pipeline) return planned;
        planned.text = without_words(read.pipeline->effective_json);
        describe_build(*read.pipeline, own, sums_, planned);
        return planned;
    }

    /// The same mistake of the same line is told once.
    void tell(Problem problem, const Variant& variant, const DataItem& item) {
        plan_.missing_type = plan_.missing_type || problem.missing_type;
        if (!told_.insert(to_string(problem)).second) return;
        problem.message += " (variant " + variant.name + ", data " + item.name + ")";
        plan_.problems.push_back(std::move(problem));
    }

    std::string key_of(const Unit& unit) const {
        const PlannedPipeline& pipeline = plan_.pipelines[unit.variant][unit.data];
        return blake2b_of_text("petal unit 1\n" + pipeline.build + pipeline.text + "seed " +
                               std::to_string(unit.seed) + "\n" + plan_.data[unit.data].sums)
            .substr(0, kKeyLength);
    }

    void add_units() {
        std::size_t most_seeds = 0;
        for (const DataItem& item : comparison_.data)
            most_seeds = std::max(most_seeds, comparison_.seeds_of(item).size());
        for (std::size_t s = 0; s < most_seeds; ++s)
            for (std::size_t d = 0; d < comparison_.data.size(); ++d) {
                const auto& seeds = comparison_.seeds_of(comparison_.data[d]);
                if (s < seeds.size()) add_group(d, seeds[s]);
            }
    }

    void add_group(std::size_t data, std::uint64_t seed) {
        Group group;
        group.data = data;
        group.seed = seed;
        for (std::size_t v = 0; v < comparison_.variants.size(); ++v) {
            Unit unit;
            unit.variant = v;
            unit.data = data;
            unit.seed = seed;
            unit.key = key_of(unit);
            if (keys_.insert(unit.key).second) group.units.push_back(plan_.units.size());
            plan_.units.push_back(std::move(unit));
        }
        plan_.groups.push_back(std::move(group));
    }

    const Comparison& comparison_;
    const PluginSet& plugins_;
    FileSums& sums_;
    Plan plan_;
    std::set<std::string> told_;
    std::set<std::string> keys_;  ///< of all groups: data items may be alike too
};

}  // namespace

const std::string& FileSums::of(const fs::path& file) {
    const auto found = sums_.find(file);
    return found != sums_.end() ? found->second
                                : sums_.emplace(file, blake2b_of(file)).first->second;
}

std::string FileSums::of_any(const fs::path& file) {
    try {
        return of(file);
    } catch (const Error&) {
        return {};
    }
}

Plan make_plan(const Comparison& comparison, const PluginSet& plugins, FileSums& sums) {
    return Planner(comparison, plugins, sums).make();
}

}  // namespace petal::compare
