// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "pipeline_reader.hpp"

#include <algorithm>
#include <utility>

#include "draft.hpp"
#include "effective_json.hpp"
#include "graph_check.hpp"
#include "json_reader.hpp"
#include "merge_patch.hpp"
#include "pipeline_shape.hpp"
#include "set_option.hpp"
#include "text_file.hpp"
#include "wire_check.hpp"

namespace petal {
namespace {

/// What was read of a file, or why it could not be.
struct LoadedText {
    PipelineText document;
    std::string fault;
};

LoadedText load(const std::filesystem::path& file) {
    LoadedText loaded;
    loaded.document.name = file.string();
    if (auto text = read_text_file(file, loaded.fault)) loaded.document.text = std::move(*text);
    return loaded;
}

/// One call of read_pipeline: from texts to a pipeline or its problems.
class PipelineReader {
   public:
    PipelineReader(const PipelineRequest& request, const Registry& registry)
        : request_(request), registry_(registry) {}

    CheckedPipeline read(const LoadedText& pipeline, const std::vector<LoadedText>& patches) {
        JsonNode root;
        bool readable = read_document(pipeline, DocumentKind::pipeline, root);
        std::vector<JsonNode> changes;
        for (const LoadedText& patch : patches) readable = add_text(patch, changes) && readable;
        for (const std::string& option : request_.sets)
            readable = add_set(option, changes) && readable;
        return changed(root, changes, readable);
    }

    CheckedPipeline read(const LoadedText& pipeline, const std::vector<PipelineChange>& all) {
        JsonNode root;
        bool readable = read_document(pipeline, DocumentKind::pipeline, root);
        std::vector<JsonNode> changes;
        for (const PipelineChange& one : all) {
            if (one.patch) {
                readable = add_node(one, changes) && readable;
            } else if (!one.set.empty()) {
                readable = add_set(one.set, changes) && readable;
            } else {
                readable = add_text(load(one.file), changes) && readable;
            }
        }
        return changed(root, changes, readable);
    }

   private:
    bool add_text(const LoadedText& patch, std::vector<JsonNode>& changes) {
        JsonNode change;
        const bool readable = read_document(patch, DocumentKind::patch, change);
        changes.push_back(std::move(change));
        return readable;
    }

    bool add_set(const std::string& option, std::vector<JsonNode>& changes) {
        auto change = read_set_option(option, problems_.add_file("--set"), problems_);
        if (change) changes.push_back(std::move(*change));
        return change.has_value();
    }

    bool add_node(const PipelineChange& one, std::vector<JsonNode>& changes) {
        const std::size_t file = problems_.add_file(one.file);
        JsonNode change = *one.patch;
        const auto relocate = [&](auto&& self, JsonNode& node) -> void {
            node.origin.file = file;
            for (JsonNode& element : node.elements) self(self, element);
            for (JsonMember& member : node.members) {
                member.origin.file = file;
                self(self, member.value);
            }
        };
        relocate(relocate, change);
        const bool right = check_shape(change, DocumentKind::patch, problems_);
        changes.push_back(std::move(change));
        return right;
    }

    CheckedPipeline changed(JsonNode& root, const std::vector<JsonNode>& changes, bool readable) {
        // Without one of the texts, most of what could be said of the rest would be wrong.
        CheckedPipeline checked;
        if (readable) {
            for (const JsonNode& change : changes) apply_patch(root, change, problems_);
            check(root, checked);
        }
        checked.problems = problems_.sorted();
        if (!checked.problems.empty()) checked.pipeline.reset();
        return checked;
    }

    bool read_document(const LoadedText& loaded, DocumentKind kind, JsonNode& root) {
        const std::size_t file = problems_.add_file(loaded.document.name);
        if (!loaded.fault.empty()) {
            problems_.add({file, 0}, "", loaded.fault);
            return false;
        }
        auto node = read_json(loaded.document.text, file, "", problems_);
        if (!node || !check_shape(*node, kind, problems_)) return false;
        root = std::move(*node);
        return true;
    }

    void check(const JsonNode& root, CheckedPipeline& checked) {
        const JsonNode& stages = root.find("stages")->value;  // check_shape() put it there
        if (!stages.is(NodeKind::object)) return;
        if (stages.members.empty())
            problems_.add(stages.origin, "stages", "no stages; expected a source at least");
        Draft draft = make_draft(stages);
        check_wires(draft, stages, problems_);
        const CheckedGraph graph = check_graph(draft, problems_);
        if (problems_.empty()) checked.pipeline = build(root, draft, graph);
    }

    Draft make_draft(const JsonNode& stages) {
        Expansions expansions;
        if (request_.data) expansions.data = request_.data->string();
        if (request_.out) expansions.out = request_.out->string();
        ParamCheck params(expansions, request_.need_data, problems_);
        Draft draft;
        for (const JsonMember& member : stages.members) {
            if (!member.value.is(NodeKind::object)) {
                // Told already; wires from it are no further mistakes.
                static const JsonNode kNothing = empty_object();
                draft.stages.push_back(make_stage(member.key, member.origin, kNothing, params));
            } else {
                draft.stages.push_back(make_stage(member.key, member.origin, member.value, params));
            }
        }
        std::sort(draft.stages.begin(), draft.stages.end(),
                  [](const DraftStage& a, const DraftStage& b) { return a.id < b.id; });
        for (std::size_t i = 0; i < draft.stages.size(); ++i) draft.number[draft.stages[i].id] = i;
        return draft;
    }

    static JsonNode empty_object() {
        JsonNode node;
        node.kind = NodeKind::object;
        return node;
    }

    DraftStage make_stage(const std::string& id, const Origin& origin, const JsonNode& json,
                          ParamCheck& params) {
        DraftStage stage;
        stage.id = id;
        stage.json = &json;
        stage.origin = origin;
        const std::string path = path_join("stages", id);
        const JsonMember* type = json.find("type");
        if (!type || !type->value.is(NodeKind::text)) return stage;  // told already
        stage.spec = registry_.find(type->value.text);
        if (stage.spec) {
            stage.params = params.check(*stage.spec, json, path);
        } else {
            problems_.add_missing_type(type->value.origin, path_join(path, "type"),
                                       "unknown stage type '" + printable(type->value.text) +
                                           "'; expected one that 'petal stages' lists" +
                                           suggestion(type->value.text, registry_.types()));
        }
        return stage;
    }

    Pipeline build(const JsonNode& root, const Draft& draft, const CheckedGraph& graph) const {
        Pipeline pipeline;
        pipeline.name = request_.file.stem().string();
        if (const JsonMember* about = root.find("about")) pipeline.about = about->value.text;
        if (const JsonMember* seed = root.find("seed"))
            pipeline.seed = seed->value.as_uint64().value_or(0);
        if (request_.seed) pipeline.seed = *request_.seed;
        for (const std::size_t number : graph.order) {
            const DraftStage& draft_stage = draft.stages[number];
            StageNode stage;
            stage.id = draft_stage.id;
            stage.spec = draft_stage.spec;
            stage.values = draft_stage.params.expanded;
            stage.params = draft_stage.params.params;
            stage.once = graph.once[number];
            for (const DraftInput& input : draft_stage.inputs)
                for (const DraftWire& wire : input.wires)
                    stage.inputs[input.name].push_back({wire.stage, wire.port});
            pipeline.stages.push_back(std::move(stage));
        }
        pipeline.effective_json = effective_json(pipeline.about, pipeline.seed, draft, graph.order);
        return pipeline;
    }

    const PipelineRequest& request_;
    const Registry& registry_;
    ProblemList problems_;
};

}  // namespace

const StageNode* Pipeline::find(const std::string& id) const {
    const auto at = std::find_if(stages.begin(), stages.end(),
                                 [&](const StageNode& stage) { return stage.id == id; });
    return at == stages.end() ? nullptr : &*at;
}

CheckedPipeline read_pipeline(const PipelineRequest& request, const Registry& registry) {
    std::vector<LoadedText> patches;
    for (const auto& patch : request.patches) patches.push_back(load(patch));
    return PipelineReader(request, registry).read(load(request.file), patches);
}

CheckedPipeline read_pipeline_texts(const PipelineText& pipeline,
                                    const std::vector<PipelineText>& patches,
                                    const PipelineRequest& request, const Registry& registry) {
    std::vector<LoadedText> loaded;
    loaded.reserve(patches.size());
    for (const PipelineText& patch : patches) loaded.push_back({patch, ""});
    return PipelineReader(request, registry).read({pipeline, ""}, loaded);
}

CheckedPipeline read_changed_pipeline(const PipelineRequest& request,
                                      const std::vector<PipelineChange>& changes,
                                      const Registry& registry) {
    return PipelineReader(request, registry).read(load(request.file), changes);
}

}  // namespace petal
