// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "run_progress.hpp"

#include <algorithm>
#include <cmath>

#include "petal/printed.hpp"

namespace petal {

namespace {

constexpr std::size_t kLongestNames = 40;  // columns, where the line is wide
constexpr std::size_t kShortestNames = 8;

std::string number(double value, int decimals) {
    return printed("%.*f", decimals, value);
}

std::string shortened(const std::string& text, std::size_t width) {
    if (text.size() <= width) return text;
    return width < 3 ? std::string(width, '.') : text.substr(0, width - 2) + "..";
}

std::string names_text(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
    return text.empty() ? "waiting" : text;
}

std::string rate_text(double per_second) {
    if (per_second >= 0.095) return number(per_second, per_second < 9.95 ? 1 : 0) + " frames/s";
    return number(per_second * 60.0, 1) + " frames/min";
}

std::string source_text(const SourceProgress& source) {
    if (source.total <= 0.0) return "";
    const double percent = std::clamp(100.0 * source.done / source.total, 0.0, 100.0);
    std::string total = number(source.total, 0) + " " + source.unit;
    if (source.unit == "B") {
        static constexpr const char* kUnits[] = {"B", "kB", "MB", "GB", "TB"};
        double value = source.total;
        std::size_t unit = 0;
        for (; value >= 999.5 && unit + 1 < std::size(kUnits); ++unit) value /= 1000.0;
        total = number(value, unit > 0 && value < 9.95 ? 1 : 0) + " " + kUnits[unit];
    }
    return number(std::floor(percent), 0) + " % of " + total;
}

}  // namespace

std::string duration_text(double seconds) {
    // Rounded up: what is said to take 0 s is done.
    const auto total = static_cast<long long>(std::ceil(std::clamp(seconds, 0.0, 1e9)));
    if (total < 60) return std::to_string(total) + " s";
    if (total < 3600)
        return std::to_string(total / 60) + " min " + std::to_string(total % 60) + " s";
    return std::to_string(total / 3600) + " h " + std::to_string(total / 60 % 60) + " min";
}

double remaining_s(const RunProgress& progress) {
    const SourceProgress& source = progress.source;
    if (source.total <= 0.0 || progress.frames_emitted == 0 || progress.frames_done == 0) return -1;
    // The source is some frames ahead of the stages.
    const double passed = source.done / source.total * static_cast<double>(progress.frames_done) /
                          static_cast<double>(progress.frames_emitted);
    if (passed <= 0.0 || passed >= 1.0) return -1;
    return progress.elapsed_s * (1.0 - passed) / passed;
}

std::string progress_text(const RunProgress& progress, std::size_t width) {
    std::vector<std::string> parts;
    parts.push_back(std::to_string(progress.frames_done) +
                    (progress.frames_done == 1 ? " frame" : " frames"));
    if (progress.frames_done > 0 && progress.elapsed_s > 0.0)
        parts.push_back(rate_text(static_cast<double>(progress.frames_done) / progress.elapsed_s));
    if (const std::string source = source_text(progress.source); !source.empty())
        parts.push_back(source);
    if (const double left = remaining_s(progress); left >= 0.0)
        parts.push_back(duration_text(left) + " left");

    std::size_t rest = 0;
    for (const std::string& part : parts) rest += 2 + part.size();
    const std::size_t room = width > rest ? width - rest : 0;
    std::string line =
        shortened(names_text(progress.at_work), std::clamp(room, kShortestNames, kLongestNames));
    for (const std::string& part : parts) {
        if (line.size() + 2 + part.size() > width) break;
        line += ", " + part;
    }
    return shortened(line, width);
}

}  // namespace petal
