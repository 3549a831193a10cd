// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <gmock/gmock.h>

#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "petal_child.hpp"
#include "petal_process.hpp"

namespace petal::testing {

/// Runs of slow stages (plugins/slow.cpp) in the test's own folder.
class SlowRuns : public PetalProcess {
   protected:
    /// source -> work -> writer, with these parameters as JSON members.
    void write_pipeline(const std::string& source, const std::string& work,
                        const std::string& writer) const {
        std::ofstream(folder_ / "p.json") << R"({"petal": 1, "stages": {
  "ticks": {"type": "slow.source", "params": {)"
                                          << source << R"(}},
  "work": {"type": "slow.work", "in": {"tick": "ticks.tick"}, "params": {)"
                                          << work << R"(}},
  "writer": {"type": "slow.writer", "in": {"tick": "work.tick"}, "params": {)"
                                          << writer << "}}}}\n";
    }

    std::unique_ptr<PetalChild> start(const std::vector<std::string>& more = {},
                                      rlim_t largest_file = RLIM_INFINITY, int terminal = -1,
                                      const std::string& loading_s = "0") const {
        std::vector<std::string> words{
            "--plugin-path", PETAL_SLOW_PLUGINS + loading_s, "run", "p.json", "--out", "out"};
        words.insert(words.end(), more.begin(), more.end());
        return std::make_unique<PetalChild>(words,
                                            PetalChild::Options{folder_, terminal, largest_file});
    }

    bool appears(const std::string& name) const {
        return PetalChild::until(30.0, [&] { return fs::exists(folder_ / name); });
    }

    nlohmann::json run_json() const {
        return nlohmann::json::parse(read_text(folder_ / "out" / "run.json"), nullptr, false);
    }
    std::string err() const { return read_text(folder_ / ".stderr"); }

    /// Names of all files below out/, sorted.
    std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out"))
            if (entry.is_regular_file())
                names.push_back(fs::relative(entry.path(), folder_ / "out").string());
        std::sort(names.begin(), names.end());
        return names;
    }
};

}  // namespace petal::testing
