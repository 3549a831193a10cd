// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "pipeline_shape.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace petal {
namespace {

const std::vector<std::string> kDocumentKeys{"petal", "$schema", "about", "seed", "stages"};
const std::vector<std::string> kStageKeys{"type", "about", "in", "params"};

bool is_id(const std::string& text) {
    return !text.empty() && text.front() >= 'a' && text.front() <= 'z' &&
           std::all_of(text.begin(), text.end(), [](char c) {
               return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
           });
}

class ShapeCheck {
   public:
    ShapeCheck(DocumentKind kind, ProblemList& problems)
        : patch_(kind == DocumentKind::patch), problems_(problems) {}

    void document(JsonNode& node) {
        drop_unknown_keys(node, "", kDocumentKeys, patch_ ? "a patch" : "a pipeline");
        version(node);
        for (const char* key : {"$schema", "about"}) text(node, key, "");
        if (JsonMember* seed = node.find("seed"); seed && !removes(seed->value)) {
            if (!seed->value.as_uint64())
                wrong_kind(seed->value, "seed", "seed; expected an integer from 0");
        }
        JsonMember* all = node.find("stages");
        if (!all) {
            if (!patch_) {
                problems_.add(node.origin, "stages",
                              "missing; expected an object of stages by their ids");
                node.put("stages", node.origin, JsonNode{});
            }
        } else if (!all->value.is(NodeKind::object)) {
            wrong_kind(all->value, "stages", "object; expected the stages by their ids");
        } else {
            for (JsonMember& member : all->value.members) stage(member);
        }
    }

   private:
    bool removes(const JsonNode& node) const { return patch_ && node.is(NodeKind::null); }

    /// "3.7 is no integer; ...": a value that is invalid already has been told.
    void wrong_kind(JsonNode& node, const std::string& path, const std::string& no_what) {
        if (node.is(NodeKind::invalid)) return;
        problems_.add(node.origin, path, describe(node) + " is no " + no_what);
        node = JsonNode{};
    }

    void drop_unknown_keys(JsonNode& node, const std::string& path,
                           const std::vector<std::string>& known, const std::string& where) {
        for (const std::string& key : node.keys()) {
            if (std::find(known.begin(), known.end(), key) != known.end()) continue;
            problems_.add(
                node.find(key)->origin, path_join(path, key),
                "unknown key '" + printable(key) + "' in " + where + expected_one_of(key, known));
            node.erase(key);
        }
    }

    void version(JsonNode& node) {
        const std::string expected = "; expected \"petal\": " + std::to_string(kPipelineFormat) +
                                     ", the format that this program reads";
        const JsonMember* petal = node.find("petal");
        if (!petal) {
            if (!patch_) problems_.add(node.origin, "petal", "missing" + expected);
            return;
        }
        const JsonNode& value = petal->value;
        if (value.is(NodeKind::invalid) || value.as_int64() == kPipelineFormat) return;
        problems_.add(value.origin, "petal",
                      "unknown format version: " + describe(value) + expected);
    }

    void text(JsonNode& node, const std::string& key, const std::string& path) {
        JsonMember* member = node.find(key);
        if (!member || removes(member->value) || member->value.is(NodeKind::text)) return;
        wrong_kind(member->value, path_join(path, key), "string; expected one");
    }

    void stage(JsonMember& member) {
        const std::string path = path_join("stages", member.key);
        if (!is_id(member.key))
            problems_.add(member.origin, path,
                          "'" + printable(member.key) +
                              "' is no stage id; expected lower case letters, digits and '_', "
                              "beginning with a letter");
        JsonNode& node = member.value;
        if (removes(node)) return;
        if (!node.is(NodeKind::object)) {
            wrong_kind(node, path, "object; expected a stage with type, in, params");
            return;
        }
        drop_unknown_keys(node, path, kStageKeys, "a stage");
        type(node, path);
        text(node, "about", path);
        inputs(node, path_join(path, "in"));
        if (JsonMember* params = node.find("params");
            params && !removes(params->value) && !params->value.is(NodeKind::object))
            wrong_kind(params->value, path_join(path, "params"),
                       "object; expected the parameters by their names");
    }

    void type(JsonNode& node, const std::string& path) {
        JsonMember* member = node.find("type");
        const std::string place = path_join(path, "type");
        if (!member) {
            if (patch_) return;
            problems_.add(node.origin, place, "missing; expected the stage's type, KIND.NAME");
            node.put("type", node.origin, JsonNode{});
        } else if (!member->value.is(NodeKind::text)) {
            wrong_kind(member->value, place, "string; expected the stage's type, KIND.NAME");
        }
    }

    void inputs(JsonNode& node, const std::string& path) {
        JsonMember* in = node.find("in");
        if (!in || removes(in->value)) return;
        if (!in->value.is(NodeKind::object)) {
            wrong_kind(in->value, path, "object; expected \"PORT\": \"STAGE.PORT\" for each input");
            return;
        }
        for (JsonMember& port : in->value.members) {
            if (removes(port.value)) continue;
            const std::string place = path_join(path, port.key);
            if (port.value.is(NodeKind::array)) {
                for (std::size_t i = 0; i < port.value.elements.size(); ++i)
                    wire(port.value.elements[i], path_join(place, i));
            } else {
                wire(port.value, place);
            }
        }
    }

    void wire(JsonNode& node, const std::string& path) {
        if (!node.is(NodeKind::text)) wrong_kind(node, path, "wire; expected \"STAGE.PORT\"");
    }

    bool patch_;
    ProblemList& problems_;
};

}  // namespace

bool check_shape(JsonNode& document, DocumentKind kind, ProblemList& problems) {
    if (!document.is(NodeKind::object)) {
        if (!document.is(NodeKind::invalid))
            problems.add(document.origin, "",
                         describe(document) + " is no " +
                             (kind == DocumentKind::patch ? "patch" : "pipeline") +
                             "; expected an object, { ... }");
        return false;
    }
    ShapeCheck(kind, problems).document(document);
    return true;
}

}  // namespace petal
