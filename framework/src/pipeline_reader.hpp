// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "json_tree.hpp"
#include "pipeline.hpp"

namespace petal {

/// A pipeline or patch that is in memory already.
struct PipelineText {
    std::string name;  ///< as the user named it
    std::string text;
};

/// read_pipeline() on texts instead of files; `request.file` gives the name, `request.patches` are
/// not read. For tests and fuzzing.
CheckedPipeline read_pipeline_texts(const PipelineText& pipeline,
                                    const std::vector<PipelineText>& patches,
                                    const PipelineRequest& request, const Registry& registry);

/// One change to a pipeline, of any kind.
struct PipelineChange {
    std::string file;               ///< patch file; or where `patch` stands, for messages
    std::optional<JsonNode> patch;  ///< a patch that stands inside another file
    std::string set;                ///< STAGE.PARAM=JSON

    static PipelineChange of_file(std::string name) { return {std::move(name), {}, {}}; }
    static PipelineChange of_patch(std::string name, JsonNode node) {
        return {std::move(name), std::move(node), {}};
    }
    static PipelineChange of_set(std::string option) { return {"--set", {}, std::move(option)}; }
};

/// read_pipeline() with these changes, in order, in place of the request's own. Problems of a patch
/// that stands inside another file have its line there.
CheckedPipeline read_changed_pipeline(const PipelineRequest& request,
                                      const std::vector<PipelineChange>& changes,
                                      const Registry& registry);

}  // namespace petal
