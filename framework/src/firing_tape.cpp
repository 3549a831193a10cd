// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "firing_tape.hpp"

#include <utility>

namespace petal {

void TapingServices::log(const std::string& stage, LogLevel level, const std::string& message) {
    real_.log(stage, level, message);
    told_.emplace_back([=](RunServices& run) { run.log(stage, level, message); });
}

void TapingServices::note(const std::string& stage, const FrameInfo& frame, const Note& note) {
    real_.note(stage, frame, note);
    told_.emplace_back([=](RunServices& run) { run.note(stage, frame, note); });
}

void TapingServices::verdict(const std::string& stage, Level level,
                             const std::vector<std::string>& reasons) {
    real_.verdict(stage, level, reasons);
    told_.emplace_back([=](RunServices& run) { run.verdict(stage, level, reasons); });
}

void TapingServices::progress(const std::string& stage, double done, double total,
                              std::string_view unit) {
    real_.progress(stage, done, total, unit);
}

void TapingServices::used_file(const std::filesystem::path& path) {
    real_.used_file(path);
    told_.emplace_back([=](RunServices& run) { run.used_file(path); });
}

void TapingServices::claim_product(const std::string& stage, const std::filesystem::path& name) {
    tape_.wrote_files = true;
    real_.claim_product(stage, name);
}

const std::filesystem::path& TapingServices::folder() const {
    tape_.wrote_files = true;
    return real_.folder();
}

void TapingServices::add_entry(const OutputPackets& outputs, bool source_ended) {
    tape_.firings.push_back({outputs, source_ended, std::move(told_)});
    told_.clear();
}

}  // namespace petal
