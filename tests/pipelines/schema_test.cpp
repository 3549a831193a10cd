// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "schema.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

#include "built_plugins.hpp"
#include "comparison_reader.hpp"
#include "petal_process.hpp"

// The shipped schemas are those of the stages, and an independent validator and `petal check`
// agree.

namespace petal::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const fs::path kPipelines = fs::path(PETAL_SOURCE_DIR) / "pipelines";

/// The pipelines or variants of a folder, without the schemas that lie beside them.
std::vector<fs::path> documents_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& file : fs::directory_iterator(folder))
        if (file.path().extension() == ".json" && file.path().stem().extension() != ".schema")
            files.push_back(file.path());
    std::sort(files.begin(), files.end());
    return files;
}

const fs::path kPipelineSchema = kPipelines / "petal.schema.json";
const fs::path kPatchSchema = kPipelines / "petal.patch.schema.json";
const fs::path kComparisonSchema = kPipelines / "petal.compare.schema.json";

TEST(Schema, TheShippedOnesAreUpToDate) {
    const Registry& stages = built_plugins().registry;
    EXPECT_EQ(read_text(kPipelineSchema), pipeline_schema(stages)) << "run scripts/update_docs.sh";
    EXPECT_EQ(read_text(kPatchSchema), patch_schema(stages)) << "run scripts/update_docs.sh";
    EXPECT_EQ(read_text(kComparisonSchema), compare::comparison_schema(stages))
        << "run scripts/update_docs.sh";
}

TEST(Schema, EveryPipelineAndVariantNamesItsOwn) {
    for (const fs::path& file : documents_in(kPipelines))
        EXPECT_EQ(json::parse(read_text(file)).value("$schema", ""), "petal.schema.json") << file;
    for (const fs::path& file : documents_in(kPipelines / "variants"))
        EXPECT_EQ(json::parse(read_text(file)).value("$schema", ""), "../petal.patch.schema.json")
            << file;
    for (const fs::path& file : documents_in(kPipelines / "compare"))
        EXPECT_EQ(json::parse(read_text(file)).value("$schema", ""), "../petal.compare.schema.json")
            << file;
}

class SchemaCommand : public PetalProcess {
   protected:
    fs::path write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
        return folder_ / name;
    }
    static bool validator_missing() {
        return std::system("python3 -c 'import jsonschema' >/dev/null 2>&1") != 0;
    }
    /// What the validator says of the files; ends the test where the schema itself is wrong.
    std::string validated(const fs::path& schema, const std::vector<fs::path>& files) const {
        std::string command = "python3 '" PETAL_SOURCE_DIR "/tests/pipelines/validate_json.py' '" +
                              schema.string() + "'";
        for (const fs::path& file : files) command += " '" + file.string() + "'";
        const fs::path told = folder_ / ".told";
        EXPECT_EQ(std::system((command + " >'" + told.string() + "' 2>&1").c_str()), 0)
            << read_text(told);
        return read_text(told);
    }
    /// The lines that tell of something wrong.
    static std::vector<std::string> faults(const std::string& told) {
        std::vector<std::string> lines;
        std::istringstream stream(told);
        for (std::string line; std::getline(stream, line);)
            if (line.find(": valid") == std::string::npos) lines.push_back(line);
        return lines;
    }
};

#define PETAL_NEEDS_VALIDATOR() \
    if (validator_missing()) GTEST_SKIP() << "python3-jsonschema is not installed"

TEST_F(SchemaCommand, PrintsOrWritesTheSameBytesEveryTime) {
    const Ended printed = petal("schema");
    EXPECT_EQ(printed.exit_code, 0);
    EXPECT_EQ(printed.out, read_text(kPipelineSchema)) << "run scripts/update_docs.sh";
    EXPECT_EQ(petal("schema --out new/p.json").exit_code, 0);
    EXPECT_EQ(read_text(folder_ / "new" / "p.json"), printed.out);
    EXPECT_EQ(petal("schema --patch").out, read_text(kPatchSchema));
    const Ended nowhere = petal("schema --out /proc/petal/p.json");
    EXPECT_EQ(nowhere.exit_code, 1);
    EXPECT_THAT(nowhere.err, HasSubstr("/proc/petal"));
}

TEST_F(SchemaCommand, OfAPipelineOrPatchIsNoPartOfTheEffectivePipeline) {
    const std::string p = pipeline("letter_indoor.json");
    const std::string plain = petal("show --json " + p).out;
    EXPECT_THAT(plain, Not(HasSubstr("$schema")));
    write("v.json", R"({"$schema": "elsewhere.json"})");
    EXPECT_EQ(petal("show --json " + p + " --with v.json").out, plain);
}

TEST_F(SchemaCommand, AcceptsEveryPipelineAndVariant) {
    PETAL_NEEDS_VALIDATOR();
    EXPECT_THAT(faults(validated(kPipelineSchema, documents_in(kPipelines))), IsEmpty());
    EXPECT_THAT(faults(validated(kPatchSchema, documents_in(kPipelines / "variants"))), IsEmpty());
    EXPECT_THAT(faults(validated(kComparisonSchema, documents_in(kPipelines / "compare"))),
                IsEmpty());
}

TEST_F(SchemaCommand, OfComparisonsRefusesWhatTheCheckRefuses) {
    PETAL_NEEDS_VALIDATOR();
    const auto comparison = [&](const std::string& name, const std::string& more,
                                const std::string& metric = R"("better": "lower")") {
        const std::string base = (kPipelines / "letter.json").string();
        return write(name + ".json", "{\"petal_compare\": 1, \"base\": \"" + base +
                                         "\", \"metrics\": {\"m\": {" + metric + "}}" + more + "}");
    };
    const std::vector<fs::path> right{
        comparison("plain", ""),
        comparison("seeds", R"(, "seeds": "1..3,7")"),
        comparison("list", R"(, "seeds": [1, 2], "confidence": 0.9)"),
        comparison("patch", R"(, "variants": {"a": {"patch": {"stages": {"overlay": null}}}})"),
        comparison("sweep", R"(, "sweep": {"margins.margin_step_deg": [0.1]})"),
        comparison("margin", "", R"("better": "none", "margin": 0.5, "unit": "m")"),
    };
    EXPECT_THAT(faults(validated(kComparisonSchema, right)), IsEmpty());
    const std::vector<fs::path> wrong{
        comparison("key", R"(, "sedes": "1..3")"),
        comparison("range", R"(, "seeds": "1-3")"),
        comparison("name", R"(, "variants": {"a b": {}})"),
        comparison("patsh", R"(, "variants": {"a": {"patsh": {}}})"),
        comparison("in_patch", R"(, "variants": {"a": {"patch": {"stagse": {}}}})"),
        comparison("no_list", R"(, "sweep": {"margins.margin_step_deg": 0.1})"),
        comparison("better", "", R"("better": "small")"),
        comparison("no_better", "", R"("unit": "m")"),
        comparison("margins", "", R"("better": "lower", "margin": 1, "margin_share": 0.1)"),
    };
    const std::string told = validated(kComparisonSchema, wrong);
    for (const fs::path& file : wrong) EXPECT_THAT(told, Not(HasSubstr(file.string() + ": valid")));
    const std::string data = " --data '" + folder_.string() + "'";
    for (const fs::path& file : right)
        EXPECT_EQ(petal("compare --check '" + file.string() + "'" + data).exit_code, 0) << file;
    for (const fs::path& file : wrong)
        EXPECT_EQ(petal("compare --check '" + file.string() + "'" + data).exit_code, 2) << file;
}

TEST_F(SchemaCommand, AcceptsEveryEffectivePipeline) {
    PETAL_NEEDS_VALIDATOR();
    std::vector<fs::path> effective;
    const auto show = [&](const std::string& arguments) {
        const Ended shown = petal("show --json " + arguments);
        if (shown.exit_code != 0) return false;
        effective.push_back(write(std::to_string(effective.size()) + ".json", shown.out));
        return true;
    };
    for (const fs::path& variant : documents_in(kPipelines / "variants")) {
        bool fits_one = false;
        for (const fs::path& file : documents_in(kPipelines))
            if (show("'" + file.string() + "' --with '" + variant.string() + "'")) fits_one = true;
        EXPECT_TRUE(fits_one) << variant << " fits no pipeline";
    }
    for (const fs::path& file : documents_in(kPipelines))
        EXPECT_TRUE(show("'" + file.string() + "'")) << file;
    EXPECT_THAT(faults(validated(kPipelineSchema, effective)), IsEmpty());
}

/// A pipeline of one source and one reader, whose parts a case replaces.
struct Parts {
    std::string top = R"("petal": 1)";
    std::string scene = R"("type": "source.files", "params": {"cloud": "${data}/c.csv"})";
    std::string planes = R"("type": "detector.planes_ransac", "in": {"cloud": "scene.cloud"})";
    std::string id = "planes";
    std::string text() const {
        return "{" + top + R"(, "stages": {"scene": {)" + scene + R"(}, ")" + id + R"(": {)" +
               planes + "}}}";
    }
};

Parts planes_with(const std::string& rest) {
    Parts parts;
    parts.planes = R"("type": "detector.planes_ransac", )" + rest;
    return parts;
}

Parts planes_params(const std::string& params) {
    return planes_with(R"("in": {"cloud": "scene.cloud"}, "params": {)" + params + "}");
}

// Each of them is refused by the schema and by the check: an editor says what petal will say.
TEST_F(SchemaCommand, RefusesWhatTheCheckRefuses) {
    PETAL_NEEDS_VALIDATOR();
    Parts unknown_type, version, top_key, bad_id, no_stage_type, bad_expansion, negative_seed;
    unknown_type.planes = R"("type": "detector.planes_ransak", "in": {"cloud": "scene.cloud"})";
    version.top = R"("petal": 2)";
    top_key.top = R"("petal": 1, "sed": 3)";
    negative_seed.top = R"("petal": 1, "seed": -1)";
    bad_id.id = "Planes";
    no_stage_type.planes = R"("in": {"cloud": "scene.cloud"})";
    bad_expansion.scene = R"("type": "source.files", "params": {"cloud": "${dat}/c.csv"})";
    const std::vector<std::pair<std::string, Parts>> cases{
        {"unknown_type", unknown_type},
        {"unknown_version", version},
        {"unknown_top_key", top_key},
        {"negative_seed", negative_seed},
        {"bad_id", bad_id},
        {"no_stage_type", no_stage_type},
        {"bad_expansion", bad_expansion},
        {"unknown_stage_key", planes_with(R"("in": {"cloud": "scene.cloud"}, "parms": {})")},
        {"no_inputs", planes_with(R"("about": "x")")},
        {"missing_input", planes_with(R"("in": {})")},
        {"unknown_input", planes_with(R"("in": {"cloud": "scene.cloud", "x": "scene.cloud"})")},
        {"no_wire", planes_with(R"("in": {"cloud": "scene"})")},
        {"wrong_port", planes_with(R"("in": {"cloud": "scene.images"})")},
        {"list_of_wires", planes_with(R"("in": {"cloud": ["scene.cloud"]})")},
        {"unknown_param", planes_params(R"("distanse_threshold": 0.1)")},
        {"integer_with_fraction", planes_params(R"("max_planes": 3.7)")},
        {"integer_too_small", planes_params(R"("max_planes": 0)")},
        {"number_too_large", planes_params(R"("plane_threshold": 1e6)")},
        {"wrong_kind", planes_params(R"("plane_threshold": "0.02")")},
        {"null", planes_params(R"("plane_threshold": null)")},
    };
    std::vector<fs::path> files;
    for (const auto& [name, parts] : cases) files.push_back(write(name + ".json", parts.text()));
    const std::string told = validated(kPipelineSchema, files);
    for (const fs::path& file : files) {
        EXPECT_THAT(told, HasSubstr(file.string() + ": "));
        EXPECT_THAT(told, Not(HasSubstr(file.string() + ": valid"))) << read_text(file);
        const Ended ended = petal("check '" + file.string() + "'");
        EXPECT_EQ(ended.exit_code, 2) << file << ended.out << ended.err;
    }
}

TEST_F(SchemaCommand, AcceptsWhatTheCheckAccepts) {
    PETAL_NEEDS_VALIDATOR();
    Parts texts, top, choice;
    texts.scene = R"("type": "source.files", "params": {"cloud": "$5/${out}/${env:HOME}/é{}.csv"})";
    top.top = R"("petal": 1, "$schema": "x", "about": "", "seed": 18446744073709551615)";
    choice.planes = R"("type": "solver.pnp", "in": {"correspondences": ["match.correspondences"]}},
        "image_boards": {"type": "detector.image_contours", "in": {"images": "scene.images"}},
        "p": {"type": "detector.planes_ransac", "in": {"cloud": "scene.cloud"}, "params": {}},
        "lidar": {"type": "detector.board_lines", "in": {"cloud": "scene.cloud", "planes": "p.planes"}},
        "match": {"type": "solver.board_matcher",
                  "in": {"lidar": "lidar.boards", "image": "image_boards.boards"})";
    const std::vector<std::pair<std::string, Parts>> cases{
        {"plain", Parts{}},
        {"texts", texts},
        {"top", top},
        {"gathered", choice},
        {"whole_number", planes_params(R"("plane_threshold": 1e-2)")}};
    std::vector<fs::path> files;
    for (const auto& [name, parts] : cases) files.push_back(write(name + ".json", parts.text()));
    EXPECT_THAT(faults(validated(kPipelineSchema, files)), IsEmpty());
    for (const fs::path& file : files) {
        const Ended ended = petal("check '" + file.string() + "'");
        EXPECT_EQ(ended.exit_code, 0) << file << ended.err;
    }
}

TEST_F(SchemaCommand, OfPatchesKnowsNullAndTypes) {
    PETAL_NEEDS_VALIDATOR();
    const auto patch = [&](const std::string& name, const std::string& stages) {
        return write(name + ".json", R"({"stages": {)" + stages + "}}");
    };
    const std::vector<fs::path> right{
        write("empty.json", "{}"),
        write("keys.json", R"({"petal": 1, "about": null, "seed": 3})"),
        patch("removes", R"("overlay": null, "result": {"in": {"metrics": null}})"),
        patch("params", R"("solve": {"params": {"robust_loss": "none", "x": null}})"),
        patch("type", R"("solve": {"type": "solver.pnp", "in": {"old": null}})"),
    };
    EXPECT_THAT(faults(validated(kPatchSchema, right)), IsEmpty());
    const std::vector<fs::path> wrong{
        write("key.json", R"({"stagse": {}})"),
        write("stages.json", R"({"stages": null})"),
        patch("null_type", R"("solve": {"type": null})"),
        patch("other_type", R"("solve": {"type": "solver.pnq"})"),
        patch("param_of_type",
              R"("solve": {"type": "solver.pnp", "params": {"robust_loss": "none"}})"),
        patch("input_of_type",
              R"("solve": {"type": "solver.pnp", "in": {"pairs": "match.pairs"}})"),
        patch("object_as_param", R"("solve": {"params": {"x": {}}})"),
        patch("no_wire", R"("solve": {"in": {"correspondences": "match"}})"),
    };
    const std::string told = validated(kPatchSchema, wrong);
    for (const fs::path& file : wrong) EXPECT_THAT(told, Not(HasSubstr(file.string() + ": valid")));
}

}  // namespace
}  // namespace petal::testing
