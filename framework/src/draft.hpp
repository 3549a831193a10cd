// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "json_tree.hpp"
#include "param_check.hpp"
#include "petal/spec.hpp"

namespace petal {

/// One wire of a pipeline that is being checked.
struct DraftWire {
    std::string stage;
    std::string port;
    Origin origin;
    std::string path;
    std::size_t from = 0;              ///< number of the stage it comes from
    const PortSpec* output = nullptr;  ///< null where that stage's type is unknown
};

struct DraftInput {
    const PortSpec* port = nullptr;  ///< null where the stage's type is unknown
    std::string name;
    std::vector<DraftWire> wires;  ///< those that are right as far as it can be known
};

/// One stage of a pipeline that is being checked.
struct DraftStage {
    std::string id;
    const JsonNode* json = nullptr;
    Origin origin;                    ///< of its id
    const StageSpec* spec = nullptr;  ///< null where its type is unknown
    CheckedParams params;
    std::vector<DraftInput> inputs;
    bool inputs_known = true;  ///< false once something was wrong with them
};

/// The stages, sorted by id.
struct Draft {
    std::vector<DraftStage> stages;
    std::map<std::string, std::size_t> number;  ///< of a stage, by id

    std::vector<std::string> ids() const;
};

}  // namespace petal
