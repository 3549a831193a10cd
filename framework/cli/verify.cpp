// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <nlohmann/json.hpp>
#include <system_error>

#include "command.hpp"
#include "host_errors.hpp"
#include "petal/error.hpp"

namespace petal::cli {

namespace {

namespace fs = std::filesystem;

struct VerifyOptions : PipelineOptions {
    fs::path result;
};

/// <prefix>/share/petal/pipelines/verify.json beside <prefix>/bin/petal, in the build tree too.
fs::path shipped_pipeline() {
    std::error_code failed;
    const fs::path program = fs::canonical("/proc/self/exe", failed);
    fs::path file =
        program.parent_path().parent_path() / "share" / "petal" / "pipelines" / "verify.json";
    if (failed || !fs::is_regular_file(file, failed))
        throw Error("the pipeline " + file.string() +
                    " is not there, which petal verify runs; install petal whole, or give a copy "
                    "with --pipeline");
    return file;
}

int verify(VerifyOptions options, const GlobalOptions& global) {
    std::error_code ignored;
    fs::path result = options.result;
    if (fs::is_directory(result, ignored)) result /= "result.json";
    if (!fs::is_regular_file(result, ignored))
        throw UsageError("there is no result " + result.string() +
                         "; name the result.json of a calibration, or its run folder");
    if (!options.out.empty() &&
        fs::weakly_canonical(options.out, ignored) ==
            fs::weakly_canonical(fs::absolute(result).parent_path(), ignored))
        throw UsageError("--out " + options.out +
                         " is the folder of the result itself; give another one");
    if (options.pipeline.empty()) options.pipeline = shipped_pipeline();
    // First, so that the user's own --set comes last and wins.
    options.set.insert(options.set.begin(),
                       "known.file=" + nlohmann::json(fs::absolute(result).string()).dump());
    return run_pipeline_file(options, global);
}

}  // namespace

void add_verify(CLI::App& app, const GlobalOptions& global, Action& action) {
    auto options = std::make_shared<VerifyOptions>();
    CLI::App* command = app.add_subcommand(
        "verify",
        "hold an earlier result against new data, without solving (pipelines/verify.json)");
    command->add_option("RESULT", options->result, "a result.json, or the run folder that holds it")
        ->required();
    options->add_options_to(*command);
    command->get_option("--data")->required();
    command->add_option("--pipeline", options->pipeline,
                        "in place of the shipped verify.json: the file of the result is the "
                        "parameter known.file");
    command->callback([options, &global, &action] {
        action = [options, &global] { return verify(*options, global); };
    });
}

}  // namespace petal::cli
