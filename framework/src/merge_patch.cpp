// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "merge_patch.hpp"

#include <utility>

namespace petal {
namespace {

void remove_member(JsonNode& target, const JsonMember& patch, const std::string& path,
                   ProblemList& problems) {
    if (target.find(patch.key)) {
        target.erase(patch.key);
        target.removed.push_back({patch.key, patch.origin});
        return;
    }
    const std::vector<std::string> keys = target.keys();
    problems.add(
        patch.origin, path,
        "null removes '" + printable(patch.key) + "', which is not there" +
            (keys.empty() ? "; expected nothing to remove" : expected_one_of(patch.key, keys)));
}

void merge_member(JsonNode& target, const JsonMember& patch, const std::string& path,
                  ProblemList& problems) {
    const std::string place = path_join(path, patch.key);
    if (patch.value.is(NodeKind::null)) {
        remove_member(target, patch, place, problems);
    } else if (patch.value.is(NodeKind::object)) {
        JsonMember* old = target.find(patch.key);
        if (!old || !old->value.is(NodeKind::object)) {
            JsonNode empty;
            empty.kind = NodeKind::object;
            empty.origin = patch.value.origin;
            target.put(patch.key, patch.origin, std::move(empty));
            old = target.find(patch.key);
        }
        merge_object(old->value, patch.value, place, problems);
    } else {
        target.put(patch.key, patch.origin, patch.value);
    }
}

void patch_stage(JsonNode& stages, const JsonMember& patch, ProblemList& problems) {
    if (patch.value.is(NodeKind::invalid))
        return;  // told already; the old stage is checked as it is
    if (patch.value.is(NodeKind::object)) {
        JsonMember* old = stages.find(patch.key);
        const bool sets_type = patch.value.find("type") != nullptr;
        if (!old && !sets_type) {
            problems.add(
                patch.origin, path_join("stages", patch.key),
                "no stage '" + printable(patch.key) +
                    "' to change; expected a type for a new stage, or an id of the pipeline" +
                    suggestion(patch.key, stages.keys()));
            return;
        }
        if (old && sets_type && old->value.is(NodeKind::object)) old->value.erase("params");
    }
    merge_member(stages, patch, "stages", problems);
}

}  // namespace

void merge_object(JsonNode& target, const JsonNode& patch, const std::string& path,
                  ProblemList& problems) {
    for (const JsonMember& member : patch.members) merge_member(target, member, path, problems);
}

void apply_patch(JsonNode& pipeline, const JsonNode& patch, ProblemList& problems) {
    for (const JsonMember& member : patch.members) {
        if (member.key == "petal" || member.key == "$schema") continue;
        if (member.value.is(NodeKind::invalid)) continue;
        JsonMember* stages = pipeline.find("stages");
        if (member.key != "stages") {
            merge_member(pipeline, member, "", problems);
        } else if (stages && stages->value.is(NodeKind::object)) {
            for (const JsonMember& stage : member.value.members)
                patch_stage(stages->value, stage, problems);
        }
        // A pipeline without stages has been told so: a patch of them would add only noise.
    }
}

}  // namespace petal
