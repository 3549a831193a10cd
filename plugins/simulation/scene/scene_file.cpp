// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/scene/scene_file.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "petal/calibration/shipped_file.hpp"
#include "petal/error.hpp"
#include "petal/json_value.hpp"
#include "simulation/scene/capture_plan.hpp"
#include "simulation/scene/rig_plan.hpp"

namespace petal::simulation {
namespace {

namespace fs = std::filesystem;

/// A file with all that it is based on laid under it.
class SceneChain {
   public:
    JsonValue read(const fs::path& file) {
        JsonValue own = JsonValue::read(file, "scene");
        own.only({"petal_scene", "name", "based_on", "duration", "images", "lidar", "cameras",
                  "rig", "floor", "light", "motion", "boards", "captures", "objects"});
        files_.push_back(file);
        const auto base = own.find("based_on");
        if (!base) return own;
        const fs::path base_file = find_base(*base, file.parent_path());
        for (const fs::path& earlier : files_)
            if (fs::equivalent(earlier, base_file))
                base->fail("leads in a circle: " + base_file.string() + " is based on this file");
        return own.over(read(base_file));
    }
    const std::vector<fs::path>& files() const { return files_; }

   private:
    /// A bare name is a shipped scene; a path counts from the file's folder.
    static fs::path find_base(const JsonValue& base, const fs::path& folder) {
        fs::path path = base.text();
        if (path.has_parent_path() || path.has_extension()) path = folder / path;
        try {
            return find_shipped_file("scenes", "scene", path);
        } catch (const Error& error) {
            base.fail(error.what());
        }
    }

    std::vector<fs::path> files_;
};

/// The targets that look-alikes among the objects show. They have been read: the files are there.
void find_look_alikes(const JsonValue& node, std::vector<fs::path>& files) {
    if (node.is_list())
        for (const JsonValue& element : node.list()) find_look_alikes(element, files);
    if (!node.is_object()) return;
    for (const std::string& key : node.keys()) {
        const JsonValue value = node.at(key);
        if (value.is_text() && (key == "look_alike" || key == "target"))
            files.push_back(find_target_file(value.text()));
        else
            find_look_alikes(value, files);
    }
}

}  // namespace

struct SceneFile::Content {
    std::string name;
    std::vector<fs::path> files;
    std::unique_ptr<RigPlan> rig;
    std::vector<CapturePlan> captures;

    void read_captures(const JsonValue& scene) {
        const auto list = scene.find("captures");
        if (list && scene.has("boards"))
            scene.fail(
                "has both boards and captures: boards are those of the only capture. Set one of "
                "them to null where it comes from the scene that this is based on");
        if (!list) {
            if (!scene.has("boards"))
                scene.fail("needs boards: a list of at least one, or captures that have them");
            captures.emplace_back(scene, std::nullopt, name);
            return;
        }
        std::set<std::string> names;
        for (const JsonValue& capture : list->list()) {
            const auto given = capture.find("name");
            const std::string own = given ? given->text() : std::to_string(captures.size() + 1);
            if (!names.insert(own).second)
                capture.fail("has the name of another capture, '" + own + "'");
            captures.emplace_back(scene, capture, name + "_" + own);
        }
        if (captures.empty()) list->fail("must list at least one capture");
    }

    void add_file(const fs::path& file) {
        if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
    }
};

SceneFile::SceneFile() : content_(std::make_unique<Content>()) {}
SceneFile::~SceneFile() = default;
SceneFile::SceneFile(SceneFile&&) noexcept = default;
SceneFile& SceneFile::operator=(SceneFile&&) noexcept = default;

SceneFile SceneFile::load(const fs::path& name_or_path) {
    const fs::path file = find_shipped_file("scenes", "scene", name_or_path);
    SceneFile result;
    Content& content = *result.content_;
    SceneChain chain;
    const JsonValue scene = chain.read(file);

    const JsonValue version = scene.at("petal_scene");
    if (!version.is_number() || version.number() != 1.0)
        version.fail("is the format version and must be 1");
    content.name = scene.at("name").text();
    if (content.name != file.stem().string())
        scene.at("name").fail("must be the file's own name, '" + file.stem().string() + "', not '" +
                              content.name + "'");
    content.files = chain.files();
    content.rig = std::make_unique<RigPlan>(scene);
    content.add_file(content.rig->profile_file());
    content.read_captures(scene);
    for (const CapturePlan& capture : content.captures)
        for (const fs::path& target : capture.target_files()) content.add_file(target);
    std::vector<fs::path> look_alikes;
    find_look_alikes(scene, look_alikes);
    for (const fs::path& target : look_alikes) content.add_file(target);
    return result;
}

const std::string& SceneFile::name() const {
    return content_->name;
}
const std::vector<fs::path>& SceneFile::files() const {
    return content_->files;
}
std::size_t SceneFile::captures() const {
    return content_->captures.size();
}

Rig SceneFile::make_rig(const fs::path& lidar, Rng& rng) const {
    return content_->rig->draw(lidar, rng);
}

Scene SceneFile::make_scene(std::size_t index, Rng& rng, std::uint64_t boards_seed) const {
    if (index >= content_->captures.size())
        throw Error("scene " + content_->name + " has " +
                    std::to_string(content_->captures.size()) + " captures, none with the number " +
                    std::to_string(index));
    return content_->captures[index].draw(*content_->rig, rng, boards_seed);
}

}  // namespace petal::simulation
