// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "inspect.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <iostream>

#include "command.hpp"
#include "interrupt.hpp"
#include "petal/error.hpp"
#include "petal/rawlog/rawlog_reader.hpp"

namespace petal::cli {

namespace {

struct InspectOptions {
    std::vector<std::filesystem::path> files;
    bool json = false;
};

/// Columns of the terminal; 0 where the output is none.
int terminal_width() {
    winsize size = {};
    if (isatty(STDOUT_FILENO) == 0 || ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return 0;
    return size.ws_col;
}

/// \throws Cancelled
Inspection inspect(const std::filesystem::path& file, const std::atomic<bool>& interrupted) {
    Inspection found;
    found.file = file;
    try {
        RawlogReader reader(file);
        found.opened = true;
        found.compressed = reader.stream().compressed();
        found.file_bytes = reader.stream().file_size();
        const auto load = [&](mrpt::obs::CObservation& observation) { reader.load(observation); };
        try {
            while (const auto object = reader.next_object()) {
                if (interrupted.load()) throw Cancelled();
                found.inventory.add(*object, load);
            }
        } catch (const Error& e) {
            found.errors.emplace_back(e.what());
        }
        found.bytes = reader.stream().getPosition();
        found.objects = reader.objects();
    } catch (const Error& e) {
        found.errors.emplace_back(e.what());
    }
    judge(found);
    return found;
}

int run(const InspectOptions& options) {
    const std::atomic<bool>& interrupted = catch_interrupts();
    const int width = terminal_width();
    std::vector<Inspection> inspections;
    bool failed = false;
    try {
        for (const auto& file : options.files) {
            Inspection found = inspect(file, interrupted);
            failed = failed || !found.errors.empty();
            if (options.json) {
                inspections.push_back(std::move(found));
                continue;
            }
            if (&file != &options.files.front()) std::cout << "\n";
            std::cout << inspection_text(found, width) << std::flush;
            for (const std::string& error : found.errors) std::cerr << "petal: " << error << "\n";
        }
    } catch (const Cancelled&) {
        std::cerr << "cancelled\n";
        return kCancelled;
    }
    if (options.json) {
        std::cout << inspection_json(inspections) << std::flush;
        for (const Inspection& found : inspections)
            for (const std::string& error : found.errors) std::cerr << "petal: " << error << "\n";
    }
    return failed ? kRunFailed : kDone;
}

}  // namespace

void add_inspect(CLI::App& app, const GlobalOptions&, Action& action) {
    auto options = std::make_shared<InspectOptions>();
    CLI::App* command =
        app.add_subcommand("inspect", "what rawlogs hold, and whether they are whole");
    command->add_option("RAWLOG", options->files, "rawlog; repeatable")->required();
    command->add_flag("--json", options->json, "for programs");
    command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace petal::cli
