// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/detail/intrinsics.hpp"

#include <mrpt/containers/yaml.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <vector>

#include "petal/error.hpp"
#include "petal/rawlog/input_file.hpp"
#include "sources/detail/text_numbers.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;
using mrpt::containers::yaml;

/// The keys of the distortion's coefficients in YAML.
constexpr std::initializer_list<const char*> kDistortionKeys = {
    "DistCoeff", "distortion_coefficients", "Distortion_Coefficients", "distCoeffs", "D", "D1"};

/// The keys of the distortion's model in YAML.
constexpr std::initializer_list<const char*> kModelKeys = {"DistModel", "distortion_model",
                                                           "camera_model"};

std::string listed(std::initializer_list<const char*> words) {
    std::string text;
    for (const char* word : words) text += (text.empty() ? "" : ", ") + std::string(word);
    return text;
}

/// Keys that look like the distortion's but are none that are read; empty, or a part of a sentence.
std::string unknown_distortion_keys(const yaml& root) {
    std::string text;
    for (const auto& [name, value] : root.asMap()) {
        if (!name.isScalar()) continue;
        const auto key = name.as<std::string>();
        const auto is_key = [&](const char* known) { return key == known; };
        if (lower_case(key).rfind("dist", 0) == 0 &&
            std::none_of(kDistortionKeys.begin(), kDistortionKeys.end(), is_key) &&
            std::none_of(kModelKeys.begin(), kModelKeys.end(), is_key))
            text += "; " + in_quotes(key) + " is none of them";
    }
    return text;
}

/// The file's content, not judged yet.
struct Raw {
    std::vector<double> matrix;
    std::vector<double> coefficients;
    std::vector<double> size;  ///< width, height; or empty
    std::string model;
    std::string looked_for;  ///< where the coefficients were looked for, for messages
};

/// Every message names the file.
class IntrinsicsReader {
   public:
    explicit IntrinsicsReader(const fs::path& file) : file_(file) {}

    Intrinsics read(const std::string& model) const {
        const std::string ending = file_.extension().string();
        Raw raw =
            ending == ".yaml" || ending == ".yml" || ending == ".YAML" ? read_yaml() : read_text();
        if (model != "auto") raw.model = model;
        Intrinsics intrinsics;
        fill_matrix(raw, intrinsics.camera);
        fill_size(raw, intrinsics.camera);
        fill_distortion(raw, intrinsics.camera);
        return intrinsics;
    }

   private:
    [[noreturn]] void fail(const std::string& text) const {
        throw Error("intrinsics file " + file_.string() + ": " + text);
    }

    /// OpenCV's "%YAML:1.0" and its "!!opencv-matrix" are no YAML: they go before parsing.
    static std::string plain_yaml(const std::string& bytes) {
        std::string plain;
        for (std::size_t begin = 0; begin < bytes.size();) {
            const std::size_t end = std::min(bytes.find('\n', begin), bytes.size());
            std::string line = bytes.substr(begin, end - begin);
            begin = end + 1;
            if (!line.empty() && line.back() == '\r') line.pop_back();
            if (line.rfind("%YAML", 0) == 0 || line.rfind("---", 0) == 0) line.clear();
            constexpr std::string_view tag = "!!opencv-matrix";
            if (const std::size_t at = line.find(tag); at != std::string::npos)
                line.erase(at, tag.size());
            plain += line + "\n";
        }
        return plain;
    }

    /// MRPT's parser takes a list that never ends for one that does, and tells of it on stderr
    /// only.
    void require_closed_brackets(const std::string& text) const {
        int open = 0;
        char quote = '\0';
        bool comment = false;
        for (const char c : text) {
            if (c == '\n') {
                comment = false;
                quote = '\0';
            } else if (comment) {
                continue;
            } else if (quote != '\0') {
                if (c == quote) quote = '\0';
            } else if (c == '"') {
                quote = c;
            } else if (c == '#') {
                comment = true;
            } else if (c == '[' || c == '{') {
                ++open;
            } else if (c == ']' || c == '}') {
                --open;
            }
        }
        if (open != 0) fail("is no YAML: a bracket is not closed; is the file cut off?");
    }

    Raw read_yaml() const {
        const std::string text = plain_yaml(read_whole_file(file_, "intrinsics file"));
        require_closed_brackets(text);
        yaml root;
        try {
            root = yaml::FromText(text);
        } catch (const std::exception&) {
            fail("is no YAML");
        }
        if (!root.isMap() || root.empty()) fail("is no YAML, or holds no keys");
        Raw raw;
        raw.matrix = numbers(
            root, {"CameraMat", "camera_matrix", "Camera_Matrix", "cameraMatrix", "K", "M1"});
        if (raw.matrix.empty())
            fail("no camera matrix; its key must be CameraMat, camera_matrix, cameraMatrix or K");
        raw.coefficients = numbers(root, kDistortionKeys);
        raw.looked_for =
            "looked for are the keys " + listed(kDistortionKeys) + unknown_distortion_keys(root);
        raw.size = numbers(root, {"ImageSize", "image_size"});
        if (raw.size.empty()) {
            const auto width = numbers(root, {"image_width", "image_Width", "width"});
            const auto height = numbers(root, {"image_height", "image_Height", "height"});
            if (width.size() == 1 && height.size() == 1) raw.size = {width[0], height[0]};
        }
        for (const char* key : kModelKeys)
            if (raw.model.empty() && root.has(key) && root[key].isScalar())
                raw.model = root[key].as<std::string>();
        return raw;
    }

    double number(const yaml& node, const std::string& key) const {
        const auto text = node.as<std::string>();
        const auto value = parse_number(text);
        if (!value) fail(key + ": " + in_quotes(text) + " is no number");
        return *value;
    }

    /// The numbers of the first of these keys that is there: a scalar, a list, a matrix with
    /// `data`, a list of rows. Empty when none is there.
    std::vector<double> numbers(const yaml& root, std::initializer_list<const char*> keys) const {
        for (const char* key : keys) {
            if (!root.has(key)) continue;
            std::vector<double> values;
            const yaml node = root[key];
            if (node.isMap()) {
                if (!node.has("data") || !node["data"].isSequence())
                    fail(std::string(key) + " has no list `data`");
                append(node["data"], key, values);
                if (node.has("rows") && node.has("cols")) {
                    const double expected = number(node["rows"], key) * number(node["cols"], key);
                    if (expected != static_cast<double>(values.size()))
                        fail(std::string(key) + " has " + std::to_string(values.size()) +
                             " numbers, its rows and cols say " +
                             std::to_string(static_cast<long>(expected)));
                }
            } else {
                append(node, key, values);
            }
            return values;
        }
        return {};
    }

    void append(const yaml& node, const std::string& key, std::vector<double>& values) const {
        if (node.isScalar()) {
            values.push_back(number(node, key));
        } else if (node.isSequence()) {
            for (std::size_t i = 0; i < node.size(); ++i)
                append(node(static_cast<int>(i)), key, values);
        } else {
            fail(key + " must be numbers");
        }
    }

    Raw read_text() const {
        const std::string bytes = read_whole_file(file_, "intrinsics file");
        Raw raw;
        raw.looked_for = "looked for is the word `distortion` with its coefficients";
        std::vector<double>* block = nullptr;
        std::size_t line_number = 0;
        for (std::size_t begin = 0; begin < bytes.size();) {
            const std::size_t end = std::min(bytes.find('\n', begin), bytes.size());
            std::string_view line = std::string_view(bytes).substr(begin, end - begin);
            begin = end + 1;
            ++line_number;
            for (const std::string_view word : split_words(line.substr(0, line.find('#')))) {
                if (word == "intrinsic" || word == "distortion") {
                    block = word == "intrinsic" ? &raw.matrix : &raw.coefficients;
                } else if (const auto value = parse_number(word); value && block != nullptr) {
                    block->push_back(*value);
                } else {
                    throw Error("intrinsics file " + file_.string() + ":" +
                                std::to_string(line_number) + ": " + in_quotes(word) +
                                (value ? " stands before the word `intrinsic`" : " is no number") +
                                "; expected is `intrinsic` with nine numbers, then `distortion` "
                                "with its coefficients, or YAML in a .yaml file");
                }
            }
        }
        return raw;
    }

    void fill_matrix(const Raw& raw, mrpt::img::TCamera& camera) const {
        const auto& m = raw.matrix;
        if (m.size() != 9)
            fail("the camera matrix must have nine numbers, not " + std::to_string(m.size()));
        for (const double value : m)
            if (!std::isfinite(value)) fail("the camera matrix has a NaN or an infinity");
        if (!(m[0] > 0.0 && m[4] > 0.0))
            fail("the focal lengths must be positive, not " + std::to_string(m[0]) + " and " +
                 std::to_string(m[4]) + " px");
        if (m[1] != 0.0 || m[3] != 0.0)
            fail("the camera matrix has a skew, which no model here can hold");
        if (m[6] != 0.0 || m[7] != 0.0 || m[8] != 1.0)
            fail("the last row of the camera matrix must be 0 0 1");
        camera.setIntrinsicParamsFromValues(m[0], m[4], m[2], m[5]);
    }

    void fill_size(const Raw& raw, mrpt::img::TCamera& camera) const {
        camera.ncols = camera.nrows = 0;
        if (raw.size.empty()) return;
        const auto valid = [](double v) { return v >= 1.0 && v <= 1e6 && std::floor(v) == v; };
        if (raw.size.size() != 2 || !valid(raw.size[0]) || !valid(raw.size[1]))
            fail("the image size must be two positive integers, width and height");
        camera.ncols = static_cast<std::uint32_t>(raw.size[0]);
        camera.nrows = static_cast<std::uint32_t>(raw.size[1]);
    }

    void fill_distortion(const Raw& raw, mrpt::img::TCamera& camera) const {
        const std::string model = lower_case(raw.model);
        const auto& d = raw.coefficients;
        const auto is = [&](std::initializer_list<const char*> names) {
            return std::find(names.begin(), names.end(), model) != names.end();
        };
        for (const double value : d)
            if (!std::isfinite(value)) fail("the distortion has a NaN or an infinity");
        if (is({"none", "ideal"})) return;
        // A key that is not recognised must not mean a camera without distortion.
        if (d.empty())
            fail("no distortion coefficients (" + raw.looked_for +
                 "); give the coefficients, or set distortion_model to none");
        if (is({"kannala_brandt", "equidistant", "fisheye", "kannala-brandt"})) {
            if (d.size() != 4)
                fail("the Kannala-Brandt (fisheye) model has 4 coefficients, not " +
                     std::to_string(d.size()));
            // MRPT's vector setter would put k3 and k4 where p1 and p2 lie.
            camera.setDistortionKannalaBrandt(d[0], d[1], d[2], d[3]);
            return;
        }
        if (!is({"", "plumb_bob", "rational_polynomial", "radtan", "pinhole", "opencv"}))
            fail("unknown distortion model " + in_quotes(raw.model) +
                 "; known are none, plumb_bob, rational_polynomial, equidistant and fisheye");
        if (d.size() > 8)
            fail(std::to_string(d.size()) +
                 " distortion coefficients; at most 8 can be held (k1 k2 p1 p2 k3 k4 k5 k6). "
                 "Calibrate the camera with the plumb bob or the rational model");
        if (d.size() != 4 && d.size() != 5 && d.size() != 8)
            fail("the plumb bob model has 4, 5 or 8 coefficients, not " + std::to_string(d.size()));
        camera.distortion = mrpt::img::DistortionModel::plumb_bob;
        std::copy(d.begin(), d.end(), camera.dist.begin());
    }

    const fs::path& file_;
};

}  // namespace

Intrinsics read_intrinsics(const fs::path& file, const std::string& model) {
    return IntrinsicsReader(file).read(model);
}

bool apply_image_size(Intrinsics& intrinsics, const fs::path& file, std::uint32_t width,
                      std::uint32_t height, const std::string& image) {
    mrpt::img::TCamera& camera = intrinsics.camera;
    if (!intrinsics.has_size()) {
        camera.ncols = width;
        camera.nrows = height;
        return true;
    }
    if (camera.ncols != width || camera.nrows != height)
        throw Error(image + " measures " + std::to_string(width) + " x " + std::to_string(height) +
                    " px, but the intrinsics in " + file.string() + " are for " +
                    std::to_string(camera.ncols) + " x " + std::to_string(camera.nrows) +
                    " px; use the intrinsics of this image's size");
    return false;
}

}  // namespace petal
