// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <string>

#include "pipeline.hpp"

namespace petal {
namespace {

/// A double-quoted string of the DOT language; "\n" breaks a label's line.
std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '\n') {
            result += "\\n";
            continue;
        }
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return result + "\"";
}

}  // namespace

std::string to_dot(const Pipeline& pipeline) {
    std::string dot = "digraph " + quoted(pipeline.name) + " {\n";
    dot += "  rankdir=LR;\n";
    dot += "  node [shape=box, fontname=\"sans-serif\"];\n";
    dot += "  edge [fontname=\"sans-serif\", fontsize=10];\n";
    for (const StageNode& stage : pipeline.stages) {
        dot += "  " + quoted(stage.id) + " [label=" + quoted(stage.id + "\n" + stage.spec->type);
        // A double frame: fires once, after the last frame.
        dot += stage.once ? ", peripheries=2];\n" : "];\n";
    }
    for (const StageNode& stage : pipeline.stages) {
        for (const PortSpec& port : stage.spec->inputs) {
            const auto wires = stage.inputs.find(port.name);
            if (wires == stage.inputs.end()) continue;
            for (const Wire& wire : wires->second) {
                const StageNode* from = pipeline.find(wire.stage);
                dot += "  " + quoted(wire.stage) + " -> " + quoted(stage.id) +
                       " [label=" + quoted(port.type);
                dot += from && from->once ? ", style=bold];\n" : "];\n";
            }
        }
    }
    return dot + "}\n";
}

}  // namespace petal
