// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "petal/spec.hpp"
#include "petal/stage.hpp"
#include "pipeline_reader.hpp"

namespace petal::pipeline_fakes {

struct Cloud {};
struct Images {};
struct Pose {};

}  // namespace petal::pipeline_fakes

namespace petal {

template <>
struct PacketTraits<pipeline_fakes::Cloud> {
    static constexpr const char* name = "Cloud";
};
template <>
struct PacketTraits<pipeline_fakes::Images> {
    static constexpr const char* name = "Images";
};
template <>
struct PacketTraits<pipeline_fakes::Pose> {
    static constexpr const char* name = "Pose";
};

namespace pipeline_fakes {

struct SceneParams {
    std::vector<std::filesystem::path> files{"${data}/scene.rawlog"};
};
/// Emits a cloud and images for each frame.
class Scene final : public Stage {
   public:
    using Params = SceneParams;
    static void describe(Spec<Params>& s) {
        s.summary("Emits scenes.");
        s.writes<Cloud>("cloud", "points");
        s.writes<Images>("images", "pictures");
        s.param("files", &Params::files).doc("files");
    }
    explicit Scene(const Params&) {}
};

struct RadiusParams {
    double radius = 0.15;
    double outer_radius = 0.5;
    int min_neighbours = 6;
    std::string loss = "huber";
};
/// One in, one out, with a relation between two parameters.
class Radius final : public Stage {
   public:
    using Params = RadiusParams;
    static void describe(Spec<Params>& s) {
        s.summary("Drops points.");
        s.role("outlier_remover");
        s.reads<Cloud>("cloud", "points");
        s.writes<Cloud>("cloud", "points");
        s.param("radius", &Params::radius).unit("m").within(0.001, 10.0).doc("radius");
        s.param("outer_radius", &Params::outer_radius).unit("m").within(0.001, 10.0).doc("radius");
        s.param("min_neighbours", &Params::min_neighbours).at_least(1).doc("count");
        s.param("loss", &Params::loss).choices({"none", "huber", "cauchy"}).doc("loss");
        s.check([](const Params& p) {
            return p.radius < p.outer_radius ? std::string()
                                             : std::string("radius must be less than outer_radius");
        });
    }
    explicit Radius(const Params&) {}
};

struct NoParams {};

/// Two inputs, one of them optional.
class Boards final : public Stage {
   public:
    using Params = NoParams;
    static void describe(Spec<Params>& s) {
        s.summary("Finds boards.");
        s.reads<Cloud>("cloud", "points");
        s.reads<Images>("images", "pictures").optional();
        s.writes<Pose>("pose", "pose");
    }
    explicit Boards(const Params&) {}
};

/// Gathers poses; may read one that is there once.
class Mean final : public Stage {
   public:
    using Params = NoParams;
    static void describe(Spec<Params>& s) {
        s.summary("Averages poses.");
        s.gathers<Pose>("poses", "poses");
        s.reads<Pose>("prior", "pose").optional();
        s.writes<Pose>("pose", "pose");
    }
    explicit Mean(const Params&) {}
};

/// Two inputs of one rate.
class Overlay final : public Stage {
   public:
    using Params = NoParams;
    static void describe(Spec<Params>& s) {
        s.summary("Draws.");
        s.reads<Pose>("pose", "pose");
        s.reads<Cloud>("cloud", "points").optional();
    }
    explicit Overlay(const Params&) {}
};

/// Optional inputs only.
class Viewer final : public Stage {
   public:
    using Params = NoParams;
    static void describe(Spec<Params>& s) {
        s.summary("Shows.");
        s.reads<Cloud>("cloud", "points").optional();
        s.reads<Images>("images", "pictures").optional();
    }
    explicit Viewer(const Params&) {}
};

struct KindsParams {
    bool flag = false;
    int count = 1;
    std::int64_t big = 2;
    double length = 0.5;
    std::string text = "plain";
    std::string mode = "slow";
    std::filesystem::path path = "a/b";
    std::vector<bool> flags{true, false};
    std::vector<int> counts{1, 2};
    std::vector<double> lengths{0.25, 1e-7};
    std::vector<std::string> texts{"x"};
    std::vector<std::string> modes{"fast"};
    std::vector<std::filesystem::path> paths;
};
/// A source with a parameter of every kind.
class Kinds final : public Stage {
   public:
    using Params = KindsParams;
    static void describe(Spec<Params>& s) {
        s.summary("Has parameters.");
        s.writes<Cloud>("cloud", "points");
        s.param("flag", &Params::flag).doc("bool");
        s.param("count", &Params::count).doc("int");
        s.param("big", &Params::big).doc("int of 64 bits");
        s.param("length", &Params::length).unit("m").within(0, 1).doc("double");
        s.param("text", &Params::text).doc("string");
        s.param("mode", &Params::mode).choices({"slow", "fast"}).doc("choice");
        s.param("path", &Params::path).doc("path");
        s.param("flags", &Params::flags).doc("bools");
        s.param("counts", &Params::counts).within(0, 9).doc("ints");
        s.param("lengths", &Params::lengths).unit("1").within(0, 1).doc("doubles");
        s.param("texts", &Params::texts).doc("strings");
        s.param("modes", &Params::modes).choices({"slow", "fast"}).doc("choices");
        s.param("paths", &Params::paths).doc("paths");
    }
    explicit Kinds(const Params&) {}
};

inline const Registry& registry() {
    static const Registry all = [] {
        Registry r;
        r.add(describe_stage<Scene>("source.scene"));
        r.add(describe_stage<Kinds>("source.kinds"));
        r.add(describe_stage<Radius>("filter.radius"));
        r.add(describe_stage<Boards>("detector.boards"));
        r.add(describe_stage<Mean>("solver.mean"));
        r.add(describe_stage<Overlay>("sink.overlay"));
        r.add(describe_stage<Viewer>("sink.viewer"));
        return r;
    }();
    return all;
}

/// What one reading is made of; the pipeline is called "p.json", the patches "v1.json", "v2.json".
struct Input {
    std::string pipeline;
    std::vector<std::string> patches;
    std::vector<std::string> sets;
};

inline CheckedPipeline read(const Input& input, PipelineRequest request = {}) {
    request.file = "p.json";
    request.sets = input.sets;
    std::vector<PipelineText> patches;
    for (const std::string& text : input.patches)
        patches.push_back({"v" + std::to_string(patches.size() + 1) + ".json", text});
    return read_pipeline_texts({"p.json", input.pipeline}, patches, request, registry());
}

/// "FILE:LINE: PATH: MESSAGE" of everything that is wrong.
inline std::vector<std::string> problems(const Input& input, const PipelineRequest& request = {}) {
    const CheckedPipeline checked = read(input, request);
    std::vector<std::string> texts;
    for (const Problem& problem : checked.problems) texts.push_back(to_string(problem));
    // exactly one of the two
    if (checked.pipeline.has_value() != texts.empty()) texts.push_back("both or neither");
    return texts;
}

/// A pipeline of the given stages, one a line from line 2 on.
inline std::string pipeline(const std::vector<std::string>& stages) {
    std::string text = "{ \"petal\": 1, \"stages\": {";
    for (std::size_t i = 0; i < stages.size(); ++i) text += (i > 0 ? ",\n" : "\n") + stages[i];
    return text + "\n} }\n";
}

inline const std::string kScene = R"("scene": {"type": "source.scene"})";
inline const std::string kFilter =
    R"("clean": {"type": "filter.radius", "in": {"cloud": "scene.cloud"}})";

}  // namespace pipeline_fakes
}  // namespace petal
