// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <exception>
#include <iostream>

#include "command.hpp"
#include "external.hpp"
#include "host_errors.hpp"
#include "run_report.hpp"

/// petal: see the README, or petal --help.
int main(int argc, char** argv) {
    using namespace petal::cli;
    CLI::App app(
        "petal: camera-LiDAR calibration and other pipelines of exchangeable stages over MRPT "
        "rawlogs");
    app.set_version_flag("--version", std::string("petal ") + petal::version());
    app.require_subcommand(1);
    std::string further;
    for (const std::string& name : external_commands())
        further += (further.empty() ? "Programs of their own: petal " : ", petal ") + name;
    if (!further.empty()) further += " (each with --help)\n\n";
    app.footer(further +
               "Exit codes: 0 done, 1 failed, 2 wrong pipeline or usage, 3 plugin trouble, 4 weak "
               "or not usable, 130 cancelled");
    app.fallthrough();

    GlobalOptions global;
    app.add_option("--plugin-path", global.plugin_path,
                   "folder to search for plugins first; repeatable")
        ->allow_extra_args(false);
    auto* quiet = app.add_flag("--quiet", global.quiet, "errors and the result only");
    app.add_flag("--verbose", global.verbose, "debug messages too")->excludes(quiet);

    Action action;
    add_run(app, global, action);
    add_check(app, global, action);
    add_show(app, global, action);
    add_stages(app, global, action);
    add_plugins(app, global, action);
    add_inspect(app, global, action);
    add_verify(app, global, action);
    add_compare(app, global, action);
    add_schema(app, global, action);
    try {
        run_external(argc, argv);
    } catch (const petal::Error& failure) {
        std::cerr << "petal: " << failure.what() << "\n";
        return kRunFailed;
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? kDone : kWrongUsage;
    }
    try {
        const int code = action();
        std::cout.flush();
        if (!std::cout)
            throw petal::Error("cannot write to the standard output; is the disk full?");
        return code;
    } catch (const petal::UsageError& failure) {
        std::cerr << "petal: " << failure.what() << "\n";
        return kWrongUsage;
    } catch (const petal::PluginError& failure) {
        std::cerr << "petal: " << failure.what() << "\n";
        return kMissingPlugin;
    } catch (const std::exception& failure) {
        std::cerr << "petal: " << failure.what() << "\n";
        return kRunFailed;
    }
}
