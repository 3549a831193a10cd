// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

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

}  // namespace petal
