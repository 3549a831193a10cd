// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/truth_json.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "petal/error.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;
using TruthJson = nlohmann::ordered_json;

constexpr std::array<const char*, 4> kLabels = {"background", "board", "vacant", "other"};

class TruthReader {
   public:
    explicit TruthReader(const fs::path& file) : file_(file) {}

    Truth read() const {
        std::ifstream stream(file_, std::ios::binary);
        if (!stream) fail("cannot be read; check its permissions");
        TruthJson json;
        try {
            json = TruthJson::parse(stream);
        } catch (const TruthJson::exception& e) {
            fail(std::string("is no JSON: ") + e.what());
        }
        if (!json.is_object()) fail("must be a JSON object");
        Truth truth;
        if (json.contains("T_camera_lidar"))
            truth.T_camera_lidar = pose(json["T_camera_lidar"], "T_camera_lidar");
        if (json.contains("boards")) {
            if (!json["boards"].is_array()) fail("boards must be a list");
            for (const TruthJson& board : json["boards"])
                truth.boards.push_back(
                    read_board(board, "boards[" + std::to_string(truth.boards.size()) + "]"));
        }
        return truth;
    }

   private:
    [[noreturn]] void fail(const std::string& text) const {
        throw Error("truth file " + file_.string() + ": " + text);
    }

    Truth::Board read_board(const TruthJson& json, const std::string& key) const {
        if (!json.is_object()) fail(key + " must be an object");
        Truth::Board board;
        if (!json.contains("target") || !json["target"].is_string())
            fail(key + ".target must be the target's name");
        board.target = json["target"].get<std::string>();
        if (!json.contains("T_lidar_board")) fail(key + ".T_lidar_board is missing");
        board.T_lidar_board = pose(json["T_lidar_board"], key + ".T_lidar_board");
        board.corners_lidar = points<3>(json, "corners_lidar", key);
        board.corners_image = points<2>(json, "corners_image", key);
        return board;
    }

    double number(const TruthJson& json, const std::string& key) const {
        if (!json.is_number()) fail(key + " must be a number, not " + json.dump());
        return json.get<double>();
    }

    template <int Size>
    std::vector<Eigen::Matrix<double, Size, 1>> points(const TruthJson& json,
                                                       const std::string& name,
                                                       const std::string& parent) const {
        std::vector<Eigen::Matrix<double, Size, 1>> all;
        if (!json.contains(name) || json[name].is_null()) return all;
        const std::string key = parent + "." + name;
        if (!json[name].is_array()) fail(key + " must be a list of points");
        for (const TruthJson& point : json[name]) {
            if (!point.is_array() || point.size() != static_cast<std::size_t>(Size))
                fail(key + " must be a list of points of " + std::to_string(Size) + " numbers");
            Eigen::Matrix<double, Size, 1> value;
            for (int i = 0; i < Size; ++i)
                value(i) = number(point[static_cast<std::size_t>(i)], key);
            all.push_back(value);
        }
        return all;
    }

    Eigen::Isometry3d pose(const TruthJson& json, const std::string& key) const {
        Eigen::Matrix4d matrix;
        if (!json.is_array() || json.size() != 4) fail(key + " must be a 4 x 4 matrix");
        for (std::size_t row = 0; row < 4; ++row) {
            if (!json[row].is_array() || json[row].size() != 4)
                fail(key + " must be a 4 x 4 matrix");
            for (std::size_t column = 0; column < 4; ++column)
                matrix(static_cast<int>(row), static_cast<int>(column)) =
                    number(json[row][column], key);
        }
        const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
        // Loose enough for a matrix written with six digits.
        constexpr double tolerance = 1e-4;
        if (!(rotation * rotation.transpose()).isIdentity(tolerance) ||
            rotation.determinant() < 0.0 ||
            !matrix.row(3).isApprox(Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0), tolerance))
            fail(key + " is no rigid transform");
        Eigen::Isometry3d transform;
        transform.matrix() = matrix;
        return transform;
    }

    const fs::path& file_;
};

template <class Derived>
TruthJson to_json(const Eigen::MatrixBase<Derived>& vector) {
    TruthJson json = TruthJson::array();
    for (const double value : vector) {
        if (!std::isfinite(value)) throw Error("the truth holds a number that is not finite");
        json.push_back(value);
    }
    return json;
}

TruthJson to_json(const Eigen::Isometry3d& transform) {
    TruthJson json = TruthJson::array();
    for (int row = 0; row < 4; ++row)
        json.push_back(to_json(transform.matrix().row(row).transpose()));
    return json;
}

template <class Point>
TruthJson to_json(const std::vector<Point>& points) {
    TruthJson json = TruthJson::array();
    for (const Point& point : points) json.push_back(to_json(point));
    return json;
}

void write(const fs::path& file, const char* bytes, std::size_t size) {
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    stream.write(bytes, static_cast<std::streamsize>(size));
    stream.close();
    if (!stream) throw Error("cannot write " + file.string() + "; is the disk full?");
}

}  // namespace

Truth read_truth(const fs::path& folder, std::optional<std::size_t> points) {
    const fs::path file = folder / "truth.json";
    if (!fs::exists(file)) return {};
    Truth truth = TruthReader(file).read();
    const fs::path labels = folder / "labels.u8";
    if (!fs::exists(labels)) return truth;
    std::ifstream stream(labels, std::ios::binary);
    if (!stream) throw Error("labels file " + labels.string() + " cannot be read");
    truth.labels.assign(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    if (points && truth.labels.size() != *points)
        throw Error("labels file " + labels.string() + " has " +
                    std::to_string(truth.labels.size()) + " bytes, but the scene has " +
                    std::to_string(*points) + " points; there must be one byte a point");
    for (std::size_t i = 0; i < truth.labels.size(); ++i)
        if (truth.labels[i] >= kLabels.size())
            throw Error("labels file " + labels.string() + ": point " + std::to_string(i) +
                        " has label " + std::to_string(truth.labels[i]) + "; known are 0 to 3");
    return truth;
}

void write_truth_json(const Truth& truth, const fs::path& file) {
    TruthJson json;
    if (truth.T_camera_lidar) json["T_camera_lidar"] = to_json(*truth.T_camera_lidar);
    json["boards"] = TruthJson::array();
    for (const Truth::Board& board : truth.boards)
        json["boards"].push_back({{"target", board.target},
                                  {"T_lidar_board", to_json(board.T_lidar_board)},
                                  {"corners_lidar", to_json(board.corners_lidar)},
                                  {"corners_image", to_json(board.corners_image)}});
    std::array<std::size_t, kLabels.size()> counts{};
    for (const std::uint8_t label : truth.labels) ++counts.at(label);
    json["label_counts"] = TruthJson::object();
    for (std::size_t i = 0; i < kLabels.size(); ++i) json["label_counts"][kLabels[i]] = counts[i];
    const std::string text = json.dump(2) + "\n";
    write(file, text.data(), text.size());
}

void write_truth_labels(const Truth& truth, const fs::path& file) {
    const std::string bytes(truth.labels.begin(), truth.labels.end());
    write(file, bytes.data(), bytes.size());
}

}  // namespace petal
