// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/target.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "petal/error.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;
using TargetJson = nlohmann::json;
using Polygon = std::vector<Eigen::Vector2d>;

/// Two sides nearer than this are the same line: far below what a saw can do, far above rounding.
constexpr double kSameLine = 1e-6;  // m
constexpr double kSmallest = 0.05;  // m, of an outline
constexpr double kLargest = 5.0;    // m
constexpr double kThickest = 0.5;   // m

// Its address tells which library file this code was loaded from.
const char kHere = 0;

std::vector<fs::path> shipped_folders() {
    Dl_info info{};
    if (dladdr(&kHere, &info) == 0 || info.dli_fname == nullptr) return {};
    std::error_code ignored;
    const fs::path library = fs::canonical(info.dli_fname, ignored);
    if (library.empty()) return {};
    std::vector<fs::path> folders;
    // <prefix>/lib, and Debian's <prefix>/lib/<architecture>.
    for (const char* up : {"..", "../.."}) {
        const fs::path folder = fs::weakly_canonical(
            library.parent_path() / up / "share" / "petal" / "targets", ignored);
        if (fs::is_directory(folder, ignored)) folders.push_back(folder);
    }
    return folders;
}

std::string shipped_names() {
    std::set<std::string> names;
    for (const fs::path& folder : shipped_folders())
        for (const auto& entry : fs::directory_iterator(folder))
            if (entry.path().extension() == ".json") names.insert(entry.path().stem().string());
    if (names.empty()) return "none were found beside petal's libraries";
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

double signed_area(const Polygon& polygon) {
    double twice = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d& a = polygon[i];
        const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
        twice += a.x() * b.y() - b.x() * a.y();
    }
    return twice / 2.0;  // positive when clockwise to the eye: y points down
}

bool inside(const Eigen::Vector2d& p, const Polygon& polygon) {
    bool in = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const Eigen::Vector2d& a = polygon[i];
        const Eigen::Vector2d& b = polygon[j];
        if ((a.y() > p.y()) == (b.y() > p.y())) continue;
        if (p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y())) in = !in;
    }
    return in;
}

std::pair<Eigen::Vector2d, Eigen::Vector2d> bounds(const Polygon& polygon) {
    Eigen::Vector2d low = polygon.front(), high = polygon.front();
    for (const Eigen::Vector2d& p : polygon) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    return {low, high};
}

/// Reads one target file; every message names the file and the key.
class TargetReader {
   public:
    explicit TargetReader(fs::path file) : file_(std::move(file)) {}

    Target read() const {
        const TargetJson json = parse();
        if (!json.is_object()) fail("a target is a JSON object");
        static const std::set<std::string> known = {"$schema",   "petal_target", "name", "about",
                                                    "thickness", "outline",      "holes"};
        for (const auto& item : json.items())
            if (known.count(item.key()) == 0)
                fail("unknown key '" + item.key() +
                     "'; known are petal_target, name, about, thickness, outline, holes");
        const TargetJson& version = at(json, "petal_target");
        if (!version.is_number_integer() || version != 1)
            fail("petal_target is the format version and must be 1, not " + version.dump());
        Target target;
        const TargetJson& name = at(json, "name");
        if (!name.is_string() || name.get<std::string>().empty())
            fail("name must be a string that is not empty");
        target.name = name.get<std::string>();
        target.thickness = number(at(json, "thickness"), "thickness");
        if (target.thickness < 0.0 || target.thickness > kThickest)
            fail("thickness must be 0 to " + std::to_string(kThickest) + " m");
        target.outline = polygon(at(json, "outline"), "outline");
        const TargetJson& holes = at(json, "holes");
        if (!holes.is_array() || holes.empty())
            fail("holes must be a list of at least one polygon");
        for (std::size_t i = 0; i < holes.size(); ++i)
            target.holes.push_back(polygon(holes[i], "holes[" + std::to_string(i) + "]"));
        check(target);
        return target;
    }

   private:
    [[noreturn]] void fail(const std::string& what) const {
        throw Error("target file " + file_.string() + ": " + what);
    }

    TargetJson parse() const {
        std::ifstream stream(file_, std::ios::binary);
        if (!stream) fail("cannot be read (no permission?)");
        std::set<std::string> seen;
        std::string twice;
        const auto watch = [&](int depth, TargetJson::parse_event_t event, TargetJson& parsed) {
            if (depth == 1 && event == TargetJson::parse_event_t::key &&
                !seen.insert(parsed.get<std::string>()).second)
                twice = parsed.get<std::string>();
            return true;
        };
        TargetJson json;
        try {
            json = TargetJson::parse(stream, watch, true, true);
        } catch (const TargetJson::exception& e) {
            fail(std::string("is not JSON: ") + e.what());
        }
        if (!twice.empty()) fail("key '" + twice + "' stands there twice");
        return json;
    }

    const TargetJson& at(const TargetJson& json, const char* key) const {
        const auto found = json.find(key);
        if (found == json.end()) fail(std::string("key '") + key + "' is missing");
        return *found;
    }

    double number(const TargetJson& json, const std::string& key) const {
        if (!json.is_number()) fail(key + " must be a number, not " + json.dump());
        return json.get<double>();
    }

    Polygon polygon(const TargetJson& json, const std::string& key) const {
        if (!json.is_array() || json.size() < 3)
            fail(key + " must be a list of at least three points [x, y]");
        Polygon points;
        for (std::size_t i = 0; i < json.size(); ++i) {
            const std::string place = key + "[" + std::to_string(i) + "]";
            if (!json[i].is_array() || json[i].size() != 2)
                fail(place + " must be a point [x, y], not " + json[i].dump());
            points.emplace_back(number(json[i][0], place), number(json[i][1], place));
        }
        const double area = signed_area(points);
        if (std::abs(area) < kSameLine) fail(key + " has no area");
        if (area < 0.0)
            fail(key +
                 " runs counter-clockwise; list its corners clockwise as seen from the front "
                 "(x right, y down)");
        return points;
    }

    void check(const Target& target) const {
        for (const double side : {target.width(), target.height()})
            if (!(side >= kSmallest && side <= kLargest))
                fail("the outline measures " + std::to_string(target.width()) + " x " +
                     std::to_string(target.height()) +
                     " m; sides of 0.05 to 5 m are expected. Lengths are metres");
        for (std::size_t i = 0; i < target.holes.size(); ++i) {
            const std::string key = "holes[" + std::to_string(i) + "]";
            for (const Eigen::Vector2d& p : target.holes[i]) {
                if (!inside(p, target.outline)) fail(key + " leaves the outline");
                for (std::size_t j = 0; j < target.holes.size(); ++j)
                    if (j != i && inside(p, target.holes[j]))
                        fail(key + " overlaps holes[" + std::to_string(j) + "]");
            }
            if (i == 0) continue;
            const Eigen::Vector2d here = bounds(target.holes[i]).first;
            const Eigen::Vector2d before = bounds(target.holes[i - 1]).first;
            const bool next_row = here.y() > before.y() + kSameLine;
            const bool same_row = std::abs(here.y() - before.y()) <= kSameLine;
            if (!next_row && !(same_row && here.x() > before.x()))
                fail("the holes must be listed row by row from the top left; " + key +
                     " comes before its predecessor");
        }
    }

    fs::path file_;
};

std::vector<double> distinct(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const auto same = [](double a, double b) { return b - a < kSameLine; };
    values.erase(std::unique(values.begin(), values.end(), same), values.end());
    return values;
}

}  // namespace

std::vector<Eigen::Vector2d> Target::corners() const {
    std::vector<Eigen::Vector2d> all;
    for (const Polygon& hole : holes) all.insert(all.end(), hole.begin(), hole.end());
    std::sort(all.begin(), all.end(),
              [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.y() < b.y(); });
    for (auto row = all.begin(); row != all.end();) {
        const auto end = std::find_if(row, all.end(), [&](const Eigen::Vector2d& p) {
            return p.y() - row->y() >= kSameLine;
        });
        std::sort(row, end,
                  [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() < b.x(); });
        row = end;
    }
    return all;
}

std::vector<double> Target::lines_x() const {
    std::vector<double> values;
    for (const Polygon& hole : holes)
        for (const Eigen::Vector2d& p : hole) values.push_back(p.x());
    return distinct(std::move(values));
}

std::vector<double> Target::lines_y() const {
    std::vector<double> values;
    for (const Polygon& hole : holes)
        for (const Eigen::Vector2d& p : hole) values.push_back(p.y());
    return distinct(std::move(values));
}

double Target::width() const {
    if (outline.empty()) return 0.0;
    const auto [low, high] = bounds(outline);
    return high.x() - low.x();
}

double Target::height() const {
    if (outline.empty()) return 0.0;
    const auto [low, high] = bounds(outline);
    return high.y() - low.y();
}

fs::path find_target_file(const fs::path& name_or_path) {
    std::error_code ignored;
    // A bare name means the shipped one, whatever lies in the working folder.
    if (!name_or_path.empty() && !name_or_path.has_parent_path() && !name_or_path.has_extension())
        for (const fs::path& folder : shipped_folders()) {
            fs::path file = folder / (name_or_path.string() + ".json");
            if (fs::is_regular_file(file, ignored)) return file;
        }
    if (fs::is_directory(name_or_path, ignored))
        throw Error("target '" + name_or_path.string() + "' is a folder; name a JSON file in it");
    if (!fs::exists(name_or_path, ignored))
        throw Error("no target '" + name_or_path.string() +
                    "': neither a file nor one that petal ships (" + shipped_names() + ")");
    return name_or_path;
}

Target load_target(const fs::path& name_or_path) {
    return TargetReader(find_target_file(name_or_path)).read();
}

}  // namespace petal
