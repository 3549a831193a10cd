// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "loader.hpp"
#include "petal/output.hpp"
#include "petal/printed.hpp"
#include "petal/stage.hpp"
#include "runner_fakes.hpp"

/// A source, a filter and a sink whose result.json has metrics: pipelines to compare.
namespace compare_fakes {

using runner_fakes::Number;

struct DrawParams {
    int frames = 3;
    std::filesystem::path file;  ///< told as used
};

/// Random numbers below 1000.
class Draw final : public petal::Stage {
   public:
    using Params = DrawParams;
    static void describe(petal::Spec<Params>& s) {
        s.summary("Draws numbers.");
        s.writes<Number>("number", "a number");
        s.param("frames", &Params::frames).within(0, 1000).doc("how many");
        s.param("file", &Params::file).doc("a file that is told as used");
    }
    explicit Draw(Params params) : params_(std::move(params)) {}
    void run(petal::Run& run) override {
        if (next_++ == params_.frames) return run.end_of_data();
        ++fired();
        if (!params_.file.empty()) run.used_file(params_.file);
        run.write("number", Number{static_cast<std::int64_t>(run.rng()() % 1000U)});
    }
    /// Firings in this process.
    static int& fired() {
        static int count = 0;
        return count;
    }

   private:
    Params params_;
    int next_ = 0;
};

struct ShiftParams {
    int by = 0;
    int fail_below = -1;
    std::string note;
};

class Shift final : public petal::Stage {
   public:
    using Params = ShiftParams;
    static void describe(petal::Spec<Params>& s) {
        s.summary("Adds to a number.");
        s.reads<Number>("number", "in");
        s.writes<Number>("number", "out");
        s.param("by", &Params::by).doc("what is added");
        s.param("fail_below", &Params::fail_below).doc("throws on smaller numbers");
        s.param("note", &Params::note).doc("told as a note, and saved as a file");
    }
    explicit Shift(Params params) : params_(std::move(params)) {}
    void run(petal::Run& run) override {
        const std::int64_t value = run.in<Number>("number").value;
        if (value < params_.fail_below) throw petal::Error("a number that is too small");
        if (!params_.note.empty()) {
            run.note({params_.note, "", "", ""});
            run.save("note.txt", [&](const std::filesystem::path& path) {
                petal::write_file(path, params_.note);
            });
        }
        run.write("number", Number{value + params_.by});
    }

   private:
    Params params_;
};

struct TellParams {
    int weak_above = 1000000;
    int not_usable_above = 1000000;
    bool write_fails = false;
};

/// result.json with the mean, and the verdict.
class Tell final : public petal::Stage {
   public:
    using Params = TellParams;
    static void describe(petal::Spec<Params>& s) {
        s.summary("Writes the mean.");
        s.gathers<Number>("numbers", "of all frames");
        s.param("weak_above", &Params::weak_above).doc("a mean above is weak");
        s.param("not_usable_above", &Params::not_usable_above).doc("a mean above is not usable");
        s.param("write_fails", &Params::write_fails).doc("as on a full disk");
    }
    explicit Tell(Params params) : params_(params) {}
    void finish(petal::Run& run) override {
        double sum = 0.0;
        const auto all = run.all<Number>("numbers");
        for (const auto& packet : all) sum += static_cast<double>(packet->value);
        const double mean = all.empty() ? 0.0 : sum / static_cast<double>(all.size());
        const petal::Level level = mean > params_.not_usable_above ? petal::Level::not_usable
                                   : mean > params_.weak_above     ? petal::Level::weak
                                                                   : petal::Level::usable;
        run.verdict(level, {"the mean is " + petal::printed("%.6f", mean)});
        run.output("result.json", [&](const std::filesystem::path& path) {
            if (params_.write_fails) throw petal::WriteError("no space is left");
            petal::write_file(
                path, "{\"metrics\": {\"mean.value\": " + petal::printed("%.6f", mean) +
                          "}, \"list\": [1, {\"count\": " + std::to_string(all.size()) + "}]}\n");
        });
    }

   private:
    Params params_;
};

inline petal::PluginSet plugins() {
    petal::PluginSet set;
    set.registry.add(petal::describe_stage<Draw>("fake.draw"));
    set.registry.add(petal::describe_stage<Shift>("fake.shift"));
    set.registry.add(petal::describe_stage<Tell>("fake.tell"));
    return set;
}

/// Draws, shifts twice, and tells.
inline const char* const kPipeline = R"({
  "petal": 1,
  "stages": {
    "draw": { "type": "fake.draw" },
    "first": { "type": "fake.shift", "in": { "number": "draw.number" } },
    "second": { "type": "fake.shift", "in": { "number": "first.number" } },
    "tell": { "type": "fake.tell", "in": { "numbers": "second.number" } }
  }
})";

/// A folder of its own, gone at the end.
class TestFolder {
   public:
    TestFolder() {
        std::string name =
            (std::filesystem::temp_directory_path() / "petal-compare-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw petal::Error("cannot make " + name);
        path_ = std::filesystem::canonical(name);
    }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;
    ~TestFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        std::ofstream(path_ / name) << text;
        return path_ / name;
    }

   private:
    std::filesystem::path path_;
};

}  // namespace compare_fakes
