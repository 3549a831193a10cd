// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/world/marker_texture.hpp"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/core/version.hpp>
#if CV_VERSION_MAJOR > 4 || (CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR >= 7)
#include <opencv2/objdetect/aruco_dictionary.hpp>
#else
#include <opencv2/aruco.hpp>
#endif

#include "petal/error.hpp"

namespace petal::simulation {
namespace {

/// The numbers of OpenCV's predefined dictionaries: 4x4 to 7x7, four sizes of each.
int dictionary_number(const std::string& name) {
    int number = 0;
    for (const char* bits : {"4x4_", "5x5_", "6x6_", "7x7_"})
        for (const char* count : {"50", "100", "250", "1000"}) {
            if (name == std::string(bits) + count) return number;
            ++number;
        }
    throw Error("no ArUco dictionary '" + name + "': 4x4_50 to 7x7_1000 are known");
}

/// One pixel a cell, 0 or 255. The only place that uses OpenCV's ArUco, which moved in 4.7.
cv::Mat draw_cells(const std::string& name, int id) {
    const int number = dictionary_number(name);
    cv::Mat cells;
#if CV_VERSION_MAJOR > 4 || (CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR >= 7)
    const cv::aruco::Dictionary dictionary = cv::aruco::getPredefinedDictionary(number);
    const int side = dictionary.markerSize + 2, count = dictionary.bytesList.rows;
    if (id >= 0 && id < count) cv::aruco::generateImageMarker(dictionary, id, side, cells, 1);
#else
    const cv::Ptr<cv::aruco::Dictionary> dictionary = cv::aruco::getPredefinedDictionary(number);
    const int side = dictionary->markerSize + 2, count = dictionary->bytesList.rows;
    if (id >= 0 && id < count) cv::aruco::drawMarker(dictionary, id, side, cells, 1);
#endif
    if (cells.empty())
        throw Error("ArUco dictionary " + name + " has markers 0 to " + std::to_string(count - 1) +
                    ", not " + std::to_string(id));
    return cells;
}

}  // namespace

MarkerTexture::MarkerTexture(const std::string& dictionary, int id, double size, const Look& dark,
                             const Look& light)
    : size_(size), dark_(dark), bright_(light) {
    const cv::Mat cells = draw_cells(dictionary, id);
    side_ = cells.cols;
    for (int row = 0; row < side_; ++row)
        for (int column = 0; column < side_; ++column)
            light_.push_back(cells.at<unsigned char>(row, column) > 127);
}

Look MarkerTexture::at(const Eigen::Vector2d& place) const {
    const auto cell = [&](double p) {
        return std::clamp(static_cast<int>(std::floor(p / size_ * side_)), 0, side_ - 1);
    };
    const int index = cell(place.y()) * side_ + cell(place.x());
    return light_[static_cast<std::size_t>(index)] ? bright_ : dark_;
}

}  // namespace petal::simulation
