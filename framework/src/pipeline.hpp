// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "petal/spec.hpp"
#include "registry.hpp"

namespace petal {

/// Something wrong in a pipeline or a patch, where it stands.
struct Problem {
    std::string file;           ///< as the user named it; "--set" for the command line
    int line = 0;               ///< 1-based; 0 where there is none
    std::string path;           ///< JSON path: stages.margins.params.radius
    std::string message;        ///< what is wrong, what was expected, the nearest right name
    bool missing_type = false;  ///< an unknown stage type: perhaps a refused library has it
};
/// "FILE:LINE: PATH: MESSAGE".
std::string to_string(const Problem& problem);

/// The other end of a wire.
struct Wire {
    std::string stage;
    std::string port;
};

/// A stage of a checked pipeline.
struct StageNode {
    std::string id;
    const StageSpec* spec = nullptr;
    std::map<std::string, Value> values;  ///< every parameter, defaults included, expanded
    std::shared_ptr<void> params;         ///< the stage's Params struct
    std::map<std::string, std::vector<Wire>>
        inputs;         ///< by port; several wires on gathering ports only
    bool once = false;  ///< fires once, after the last frame
};

struct Pipeline {
    std::string name;  ///< the file's stem
    std::string about;
    std::uint64_t seed = 0;
    std::vector<StageNode> stages;  ///< in topological order; ties by id
    std::string effective_json;     ///< every default written out, stable order, indented

    const StageNode* find(const std::string& id) const;
};

struct PipelineRequest {
    std::filesystem::path file;
    std::vector<std::filesystem::path> patches;  ///< --with, applied in order
    std::vector<std::string> sets;               ///< --set STAGE.PARAM=JSON, applied last
    std::optional<std::filesystem::path> data;   ///< ${data}; where absent, ${data} stays as it is
    std::optional<std::filesystem::path> out;    ///< ${out}; likewise
    std::optional<std::uint64_t> seed;
    bool need_data = false;  ///< a pipeline that uses ${data} without `data` is a problem
};

/// A pipeline, or everything that is wrong with it: exactly one of the two.
struct CheckedPipeline {
    std::optional<Pipeline> pipeline;
    std::vector<Problem> problems;  ///< sorted by file (pipeline, patches, --set) and line
};

/// Reads, patches and checks; never throws for what the user wrote (unreadable files are problems).
CheckedPipeline read_pipeline(const PipelineRequest& request, const Registry& registry);

/// The graph in Graphviz's language: stages as boxes, wires labelled with their type.
std::string to_dot(const Pipeline& pipeline);

}  // namespace petal
