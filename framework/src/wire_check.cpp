// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "wire_check.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace petal {
namespace {

std::vector<std::string> names_of(const std::vector<PortSpec>& ports) {
    std::vector<std::string> names;
    names.reserve(ports.size());
    for (const PortSpec& port : ports) names.push_back(port.name);
    return names;
}

class WireCheck {
   public:
    WireCheck(Draft& draft, const JsonNode& stages, ProblemList& problems)
        : draft_(draft), stages_(stages), problems_(problems) {}

    void check(DraftStage& stage) {
        const std::string path = path_join(path_join("stages", stage.id), "in");
        const JsonMember* in = stage.json->find("in");
        if (in && !in->value.is(NodeKind::object)) {
            stage.inputs_known = false;  // told already
            return;
        }
        if (in) {
            for (const JsonMember& member : in->value.members)
                check_input(stage, member, path_join(path, member.key));
        }
        if (stage.spec) check_required(stage, in, path);
    }

   private:
    void check_input(DraftStage& stage, const JsonMember& member, const std::string& path) {
        DraftInput input;
        input.name = member.key;
        if (stage.spec) {
            input.port = stage.spec->find_input(member.key);
            if (!input.port) {
                stage.inputs_known = false;
                const auto known = names_of(stage.spec->inputs);
                problems_.add(member.origin, path,
                              "unknown input '" + printable(member.key) + "' of " +
                                  stage.spec->type + expected_one_of(member.key, known));
                return;
            }
        }
        const JsonNode& value = member.value;
        if (value.is(NodeKind::array)) {
            check_list(stage, input, value, path);
        } else {
            add_wire(stage, input, value, path);
        }
        stage.inputs.push_back(std::move(input));
    }

    void check_list(DraftStage& stage, DraftInput& input, const JsonNode& list,
                    const std::string& path) {
        if (input.port && !input.port->gathers) {
            stage.inputs_known = false;
            problems_.add(list.origin, path,
                          "input '" + input.name + "' takes one wire, not a list (it gathers " +
                              "nothing); expected \"STAGE.PORT\"");
            return;
        }
        if (list.elements.empty()) {
            stage.inputs_known = false;
            problems_.add(list.origin, path,
                          "the list has no wire; expected [\"STAGE.PORT\", ...]");
        }
        for (std::size_t i = 0; i < list.elements.size(); ++i)
            add_wire(stage, input, list.elements[i], path_join(path, i));
    }

    void add_wire(DraftStage& stage, DraftInput& input, const JsonNode& node,
                  const std::string& path) {
        auto wire = node.is(NodeKind::text) ? read_wire(input, node, path) : std::nullopt;
        if (!wire) {
            stage.inputs_known = false;
            return;
        }
        const bool twice =
            std::any_of(input.wires.begin(), input.wires.end(), [&](const DraftWire& other) {
                return other.stage == wire->stage && other.port == wire->port;
            });
        if (twice) {
            stage.inputs_known = false;
            problems_.add(node.origin, path,
                          "'" + printable(node.text) + "' is wired to '" + printable(input.name) +
                              "' already; expected each wire once");
            return;
        }
        input.wires.push_back(std::move(*wire));
    }

    std::optional<DraftWire> read_wire(const DraftInput& input, const JsonNode& node,
                                       const std::string& path) {
        const std::string& text = node.text;
        const std::size_t dot = text.find('.');
        if (dot == std::string::npos || dot == 0 || dot + 1 == text.size() ||
            text.find('.', dot + 1) != std::string::npos) {
            problems_.add(node.origin, path,
                          "'" + printable(text) + "' is no wire; expected \"STAGE.PORT\"" +
                              completion(text, input));
            return std::nullopt;
        }
        DraftWire wire{text.substr(0, dot), text.substr(dot + 1), node.origin, path, 0, nullptr};
        const auto found = draft_.number.find(wire.stage);
        if (found == draft_.number.end()) {
            tell_no_stage(wire);
            return std::nullopt;
        }
        wire.from = found->second;
        const DraftStage& source = draft_.stages[wire.from];
        if (!source.spec) return wire;
        wire.output = source.spec->find_output(wire.port);
        if (!wire.output) {
            problems_.add(node.origin, path,
                          "unknown output '" + printable(wire.port) + "' of '" +
                              printable(source.id) + "' (" + source.spec->type + ")" +
                              expected_one_of(wire.port, names_of(source.spec->outputs)));
            return std::nullopt;
        }
        if (input.port && input.port->type != wire.output->type) {
            problems_.add(node.origin, path,
                          "two types on one wire: '" + printable(text) + "' writes " +
                              wire.output->type + ", '" + input.name + "' reads " +
                              input.port->type + "; expected " + wires_of_type(input.port->type));
            return std::nullopt;
        }
        return wire;
    }

    void tell_no_stage(const DraftWire& wire) {
        std::string message = "no stage '" + printable(wire.stage) + "'";
        if (const auto* removed = stages_.find_removed(wire.stage))
            message += " (removed in " + problems_.where(removed->origin) + ")";
        problems_.add(wire.origin, wire.path, message + expected_one_of(wire.stage, draft_.ids()));
    }

    /// For "scene" where "scene.cloud" was meant: the stage's output that fits, if there is just
    /// one.
    std::string completion(const std::string& text, const DraftInput& input) const {
        const auto found = draft_.number.find(text);
        if (found == draft_.number.end() || !input.port) return "";
        const StageSpec* spec = draft_.stages[found->second].spec;
        if (!spec) return "";
        std::vector<std::string> fitting;
        for (const PortSpec& port : spec->outputs)
            if (port.type == input.port->type) fitting.push_back(port.name);
        return fitting.size() == 1
                   ? "; did you mean '" + printable(text) + "." + fitting.front() + "'?"
                   : "";
    }

    /// "a wire of type Cloud: one of scene.cloud, margins.cloud", from the pipeline's own stages.
    std::string wires_of_type(const std::string& type) const {
        std::vector<std::string> wires;
        for (const DraftStage& stage : draft_.stages) {
            if (!stage.spec) continue;
            for (const PortSpec& port : stage.spec->outputs)
                if (port.type == type) wires.push_back(printable(stage.id) + "." + port.name);
        }
        if (wires.empty()) return "a stage that writes " + type;
        std::string text = "a wire of type " + type + ", as ";
        constexpr std::size_t kMost = 6;
        for (std::size_t i = 0; i < std::min(kMost, wires.size()); ++i)
            text += (i > 0 ? " or " : "") + wires[i];
        return text;
    }

    void check_required(DraftStage& stage, const JsonMember* in, const std::string& path) {
        std::vector<const PortSpec*> missing;
        for (const PortSpec& port : stage.spec->inputs)
            if (!port.optional && !(in && in->value.find(port.name))) missing.push_back(&port);
        // An input under a wrong name has been told: it is not missing too.
        if (in) excuse_misspelt(*stage.spec, in->value, missing);
        for (const PortSpec* port : missing) {
            stage.inputs_known = false;
            problems_.add(origin_of_absence(stage, in, port->name), path_join(path, port->name),
                          "required input '" + port->name + "' (" + port->type +
                              ") is not wired; expected " + wires_of_type(port->type));
        }
    }

    /// The patch that took the wire away, else the stage.
    static Origin origin_of_absence(const DraftStage& stage, const JsonMember* in,
                                    const std::string& port) {
        const auto* removed = in ? in->value.find_removed(port) : stage.json->find_removed("in");
        if (removed) return removed->origin;
        return in ? in->origin : stage.origin;
    }

    /// Each unknown key of `in` stands for one missing input: the nearest, else any.
    static void excuse_misspelt(const StageSpec& spec, const JsonNode& in,
                                std::vector<const PortSpec*>& missing) {
        for (const JsonMember& member : in.members) {
            if (spec.find_input(member.key) || missing.empty()) continue;
            const auto near =
                std::find_if(missing.begin(), missing.end(), [&](const PortSpec* port) {
                    return !suggestion(member.key, {port->name}).empty();
                });
            missing.erase(near != missing.end() ? near : missing.begin());
        }
    }

    Draft& draft_;
    const JsonNode& stages_;
    ProblemList& problems_;
};

}  // namespace

std::vector<std::string> Draft::ids() const {
    std::vector<std::string> names;
    for (const DraftStage& stage : stages) names.push_back(stage.id);
    return names;
}

void check_wires(Draft& draft, const JsonNode& stages, ProblemList& problems) {
    WireCheck check(draft, stages, problems);
    for (DraftStage& stage : draft.stages) check.check(stage);
}

}  // namespace petal
