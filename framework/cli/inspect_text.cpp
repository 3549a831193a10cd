// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "inspect.hpp"

namespace petal::cli {

namespace {

/// Rounded to significant digits, whatever the locale.
std::string figure(double value, int digits = 4) {
    std::array<char, 64> text = {};
    const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value,
                                            std::chars_format::general, digits);
    return error == std::errc() ? std::string(text.data(), end) : "?";
}

std::string bytes_text(std::uint64_t bytes) {
    if (bytes < 10000) return std::to_string(bytes) + " bytes";
    double amount = static_cast<double>(bytes);
    std::size_t unit = 0;
    constexpr std::array<const char*, 5> kUnits = {"bytes", "kB", "MB", "GB", "TB"};
    while (amount >= 999.5 && unit + 1 < kUnits.size()) {
        amount /= 1000.0;
        ++unit;
    }
    return figure(amount, 3) + " " + kUnits[unit];
}

std::string duration_text(double seconds) {
    if (seconds < 120.0) return figure(seconds) + " s";
    if (seconds < 7200.0) return figure(seconds / 60.0, 3) + " min";
    return figure(seconds / 3600.0, 3) + " h";
}

std::string plural(std::size_t count, const std::string& word) {
    return std::to_string(count) + " " + word + (count == 1 ? "" : "s");
}

std::string short_class(const std::string& name) {
    const std::size_t colons = name.rfind("::");
    return colons == std::string::npos ? name : name.substr(colons + 2);
}

/// What came from the file, without what could move a terminal's cursor.
std::string shown(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
    return text;
}

std::string shown_label(const std::string& label) {
    return label.empty() ? "(no label)" : shown(label);
}

/// Lines under one head, broken at blanks where they would be wider than the terminal.
class Page {
   public:
    explicit Page(int width) : width_(static_cast<std::size_t>(std::max(width, 0))) {}

    void line(const std::string& text = "") { text_ += text + "\n"; }
    void item(std::size_t indent, const std::string& head, const std::string& text) {
        constexpr std::size_t kHead = 10;
        const std::size_t begin = indent + kHead;
        std::string current = std::string(indent, ' ') + head;
        current.resize(std::max(begin, current.size() + 1), ' ');
        std::size_t from = 0;
        bool fresh = true;
        while (from < text.size()) {
            std::size_t to = text.find(' ', from);
            if (to == std::string::npos) to = text.size();
            const std::size_t needed = current.size() + (fresh ? 0 : 1) + (to - from);
            if (!fresh && width_ > 40 && needed > width_) {
                line(current);
                current = std::string(begin, ' ');
                fresh = true;
            }
            current += (fresh ? "" : " ") + text.substr(from, to - from);
            fresh = false;
            from = to + 1;
        }
        line(current);
    }
    const std::string& text() const { return text_; }

   private:
    std::size_t width_;
    std::string text_;
};

std::string layout_text(const Inspection& found) {
    const RawlogInventory& inventory = found.inventory;
    switch (inventory.layout()) {
        case RawlogInventory::Layout::empty:
            return "no object";
        case RawlogInventory::Layout::observations:
            return "observations only";
        case RawlogInventory::Layout::sensory_frames:
            return "actions and sensory frames";
        case RawlogInventory::Layout::mixed:
            return "mixed: actions and sensory frames, and observations outside of them";
    }
    return "";
}

std::string time_text(const RawlogInventory& inventory) {
    const auto time = inventory.time();
    if (!time) return "no stamps";
    if (time->first == time->second) return iso_time(time->first) + ", one moment";
    return iso_time(time->first) + " to " + iso_time(time->second) + ", " +
           duration_text(std::chrono::duration<double>(time->second - time->first).count());
}

std::string holds_text(const RawlogInventory& inventory) {
    std::string text = plural(inventory.observations(), "observation");
    if (inventory.sensory_frames() > 0)
        text += " in " + plural(inventory.sensory_frames(), "sensory frame");
    for (const auto& [name, count] : inventory.actions())
        text += ", " + plural(count, "action") + " (" + short_class(name) + ")";
    return text;
}

std::string rate_text(const StampInventory& stamps) {
    if (stamps.rate() <= 0.0) return "";
    std::string text = figure(stamps.rate()) + " Hz";
    if (stamps.unsteady()) text += ", unsteady";
    const auto [count, longest] = stamps.gaps();
    if (count > 0) text += ", " + plural(count, "gap") + " up to " + duration_text(longest);
    return text;
}

std::string points_text(const PointsInventory& points) {
    Extent each;
    for (const double count : points.per_message) each.add(count);
    std::string text = std::to_string(points.total);
    if (each.count > 1)
        text +=
            ", a message " +
            (each.min == each.max
                 ? std::to_string(static_cast<std::size_t>(each.min))
                 : std::to_string(static_cast<std::size_t>(each.min)) + " to " +
                       std::to_string(static_cast<std::size_t>(each.max)) + " (median " +
                       std::to_string(static_cast<std::size_t>(median(points.per_message))) + ")");
    if (points.range.count > 0)
        text += "; range " + figure(points.range.min) + " to " + figure(points.range.max) + " m";
    if (!points.has_intensity) return text + "; no intensity";
    if (points.intensity.count > 0 && points.intensity.min == points.intensity.max)
        text += "; intensity " + figure(points.intensity.min) + " throughout";
    else if (points.intensity.count > 0)
        text +=
            "; intensity " + figure(points.intensity.min) + " to " + figure(points.intensity.max);
    return text;
}

std::string camera_text(const mrpt::img::TCamera& camera) {
    if (!(camera.fx() > 0.0 || camera.fy() > 0.0)) return "no intrinsics";
    std::string text = "fx " + figure(camera.fx(), 6) + " fy " + figure(camera.fy(), 6) + " cx " +
                       figure(camera.cx(), 6) + " cy " + figure(camera.cy(), 6) + ", " +
                       distortion_name(camera);
    for (const double value : coefficients(camera)) text += " " + figure(value, 6);
    return text;
}

std::string images_text(const std::string& eye, const ImagesInventory& images) {
    std::string text = eye.empty() ? "" : eye + ": ";
    if (images.width == 0) return text + "empty";
    text += std::to_string(images.width) + " x " + std::to_string(images.height) + ", " +
            (images.channels == 1 ? std::string("grey")
                                  : std::to_string(images.channels) + " channels");
    return text + "; " + camera_text(images.camera);
}

std::string pose_text(const mrpt::poses::CPose3D& pose) {
    const auto metres = [](double value) { return figure(value, 4); };
    const auto degrees = [](double value) {
        const double rounded = std::round(mrpt::RAD2DEG(value) * 100.0) / 100.0;
        return figure(rounded == 0.0 ? 0.0 : rounded, 6);
    };
    return "x " + metres(pose.x()) + " y " + metres(pose.y()) + " z " + metres(pose.z()) +
           " m, yaw " + degrees(pose.yaw()) + " pitch " + degrees(pose.pitch()) + " roll " +
           degrees(pose.roll()) + " deg on the vehicle";
}

void add_sensor(Page& page, const SensorInventory& sensor) {
    if (sensor.points && !sensor.points->per_message.empty())
        page.item(4, "points", points_text(*sensor.points));
    for (const auto& [eye, images] : sensor.images) page.item(4, "image", images_text(eye, images));
    if (sensor.external > 0)
        page.item(4, "files",
                  plural(sensor.external, "message") + (sensor.external == 1 ? " keeps" : " keep") +
                      " data in files of their own" +
                      (sensor.unloaded > 0
                           ? ", of which " + std::to_string(sensor.unloaded) + " cannot be loaded"
                           : std::string()));
    if (sensor.pose && (sensor.points || !sensor.images.empty()))
        page.item(4, "pose", pose_text(*sensor.pose));
}

}  // namespace

std::string inspection_text(const Inspection& found, int width) {
    Page page(width);
    page.line(found.file.string());
    if (!found.opened) return page.text();
    const RawlogInventory& inventory = found.inventory;
    page.item(2, "layout", layout_text(found));
    page.item(2, "size",
              bytes_text(found.file_bytes) + (found.compressed
                                                  ? ", compressed from " + bytes_text(found.bytes)
                                                  : std::string(", not compressed")));
    page.item(2, "time", time_text(inventory));
    page.item(2, "holds", holds_text(inventory));

    std::vector<std::array<std::string, 4>> rows = {{"sensor", "class", "messages", "rate"}};
    for (const auto& [key, sensor] : inventory.sensors())
        rows.push_back({shown_label(sensor.label), short_class(sensor.class_name),
                        std::to_string(sensor.messages), rate_text(sensor.stamps)});
    std::array<std::size_t, 3> columns = {0, 0, 0};
    for (const auto& row : rows)
        for (std::size_t i = 0; i < columns.size(); ++i)
            columns[i] = std::max(columns[i], row[i].size());
    const auto table_row = [&](std::array<std::string, 4> row) {
        row[0].resize(columns[0], ' ');
        row[1].resize(columns[1], ' ');
        row[2].insert(0, columns[2] - row[2].size(), ' ');
        std::string line = "  " + row[0] + "  " + row[1] + "  " + row[2] + "  " + row[3];
        line.erase(line.find_last_not_of(' ') + 1);
        page.line(line);
    };
    if (rows.size() > 1) {
        page.line();
        table_row(rows.front());
    }
    std::size_t next = 1;
    for (const auto& [key, sensor] : inventory.sensors()) {
        table_row(rows[next++]);
        add_sensor(page, sensor);
    }
    if (!found.warnings.empty()) page.line();
    for (const std::string& warning : found.warnings) page.item(2, "warning", shown(warning));
    return page.text();
}

}  // namespace petal::cli
