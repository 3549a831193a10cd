// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/pairs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sources/detail/intrinsics.hpp"
#include "sources/detail/scene_name.hpp"
#include "sources/detail/text_numbers.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;

/// The side of a square of `corners`; 0 where they make none.
int square_side(int corners) {
    const int side = static_cast<int>(std::lround(std::sqrt(static_cast<double>(corners))));
    return side * side == corners ? side : 0;
}

TextTable read_table(Run& run, const fs::path& file, const std::string& what, std::size_t columns) {
    TextTable table = read_text_table(file, what, columns);
    if (table.columns > columns)
        throw Error(what + " " + file.string() + " has " + std::to_string(table.columns) +
                    " columns; " + std::to_string(columns) + " are expected");
    run.used_file(file);
    return table;
}

/// Numbers the side * side corners of one upright board row by row: rows by v, within a row by u.
void number_from_image(PointPair* corners, int side) {
    std::vector<PointPair*> order;
    order.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (int i = 0; i < side * side; ++i) order.push_back(corners + i);
    const auto by = [](int axis) {
        return [axis](const PointPair* a, const PointPair* b) {
            return a->image(axis) < b->image(axis);
        };
    };
    std::stable_sort(order.begin(), order.end(), by(1));
    for (int row = 0; row < side; ++row)
        std::stable_sort(order.begin() + row * side, order.begin() + (row + 1) * side, by(0));
    for (std::size_t k = 0; k < order.size(); ++k) order[k]->corner = static_cast<int>(k);
}

}  // namespace

void PairsSource::describe(Spec<Params>& spec) {
    spec.summary("Reads given pairs of LiDAR points and image points.");
    spec.doc(
        R"(The pairs come from one file (`pairs`: x, y, z in metres in the LiDAR's frame and
u, v in raw pixels, five columns), or from two files with a row each (`lidar_points`: x y z;
`image_points`: u v). Commas, semicolons, blanks or tabs separate the columns; `#` begins a
comment. Row i of the one belongs to row i of the other: nothing is matched, the order is decided
by what is given, and a result says so.

`first` and `count` pick a range of rows. Of these the first `leading_points` are single points;
the rest are boards in blocks of `corners_per_board` rows. A board's corners are numbered row by
row from the top left, as everywhere in petal; where the file lists them column by column, say so
with `corner_order`, or let `from_image` number them by where they lie in the image (for boards that are
rolled by less than about 15 deg there: rows are told apart by v). A solver needs to know which pairs are corners of boards, because the 32
numbers of a four-hole board come from about 8 lines, so they weigh less than 32 measurements.

The intrinsics are read as `source.files` reads them. Where the file gives no image size, give
`image_size`. Rows that are not finite are an error; image points outside the image are told in
the log.

Used for the letter's published pairs, and to try a solver on one's own.)");
    spec.writes<Correspondences>("correspondences", "the pairs, of one camera");
    spec.param("pairs", &Params::pairs)
        .doc("file with x, y, z, u, v; empty where lidar_points and image_points are given");
    spec.param("lidar_points", &Params::lidar_points).doc("file with x y z, in place of pairs");
    spec.param("image_points", &Params::image_points).doc("file with u v, in place of pairs");
    spec.param("intrinsics", &Params::intrinsics).doc("intrinsics of the camera; always needed");
    spec.param("image_size", &Params::image_size)
        .unit("px")
        .within(1, 1000000)
        .doc("width and height, for intrinsics without a size; empty: as the intrinsics say");
    spec.param("distortion_model", &Params::distortion_model)
        .choices({"auto", "none", "plumb_bob", "kannala_brandt"})
        .doc("what the coefficients mean; none: leave the distortion out");
    spec.param("camera", &Params::camera).doc("the camera's label");
    spec.param("lidar", &Params::lidar).doc("the LiDAR's label");
    spec.param("first", &Params::first).at_least(0).doc("rows to pass over");
    spec.param("count", &Params::count).at_least(0).doc("rows to take from there; 0: all");
    spec.param("leading_points", &Params::leading_points)
        .at_least(0)
        .doc("so many of the rows taken are single points, before the boards");
    spec.param("corners_per_board", &Params::corners_per_board)
        .within(0, 1000)
        .doc("rows of one board; 16 for the four-hole board; 0: all are single points");
    spec.param("corner_order", &Params::corner_order)
        .choices({"rows", "columns", "from_image"})
        .doc(
            "how the file lists the corners of a board, from its top left; from_image: in any "
            "order");
    spec.check([](const Params& p) {
        const bool one = !p.pairs.empty();
        const bool two = !p.lidar_points.empty() || !p.image_points.empty();
        if (one && two)
            return "give either pairs, or lidar_points and image_points and set pairs to \"\"";
        if (!one && !two) return "pairs is empty, and so are lidar_points and image_points";
        if (two && (p.lidar_points.empty() || p.image_points.empty()))
            return "lidar_points and image_points belong together; give both";
        return "";
    });
    spec.check([](const Params& p) {
        return p.intrinsics.empty() ? "intrinsics is empty; name the camera's intrinsics file" : "";
    });
    spec.check([](const Params& p) {
        return p.image_size.empty() || p.image_size.size() == 2
                   ? ""
                   : "image_size must be two numbers, width and height, or empty";
    });
    spec.check([](const Params& p) {
        return p.corner_order != "rows" && square_side(p.corners_per_board) == 0
                   ? "corner_order columns and from_image need corners_per_board to be a square, "
                     "like 16"
                   : "";
    });
    spec.check([](const Params& p) {
        return p.camera.empty() || p.lidar.empty() ? "camera and lidar are labels: not empty" : "";
    });
}

std::vector<PointPair> PairsSource::read_pairs(Run& run) const {
    TextTable lidar, image;
    const bool one_file = !params_.pairs.empty();
    if (one_file) {
        lidar = read_table(run, params_.pairs, "pairs file", 5);
    } else {
        lidar = read_table(run, params_.lidar_points, "LiDAR points file", 3);
        image = read_table(run, params_.image_points, "image points file", 2);
        if (lidar.rows() != image.rows())
            throw Error(params_.lidar_points.string() + " has " + std::to_string(lidar.rows()) +
                        " rows, but " + params_.image_points.string() + " has " +
                        std::to_string(image.rows()) +
                        "; row i of the one belongs to row i of the "
                        "other");
    }
    const std::size_t rows = lidar.rows();
    const auto first = static_cast<std::size_t>(params_.first);
    const auto count =
        params_.count > 0 ? static_cast<std::size_t>(params_.count) : rows - std::min(rows, first);
    if (first + count > rows || (first > 0 && first >= rows))
        throw Error("rows " + std::to_string(first) + " to " +
                    std::to_string(first + std::max<std::size_t>(count, 1) - 1) +
                    " are asked for by first and count, but " +
                    (one_file ? params_.pairs : params_.lidar_points).string() + " has " +
                    std::to_string(rows) + " rows (they count from 0)");
    std::vector<PointPair> pairs;
    for (std::size_t row = first; row < first + count; ++row) {
        PointPair pair;
        pair.lidar = {lidar.at(row, 0), lidar.at(row, 1), lidar.at(row, 2)};
        pair.image = one_file ? Eigen::Vector2d(lidar.at(row, 3), lidar.at(row, 4))
                              : Eigen::Vector2d(image.at(row, 0), image.at(row, 1));
        if (!pair.lidar.allFinite() || !pair.image.allFinite())
            throw Error("pair " + std::to_string(row) + " (counted from 0) of " +
                        (one_file ? params_.pairs : params_.lidar_points).string() +
                        " is not finite; leave that row out");
        pairs.push_back(pair);
    }
    return pairs;
}

void PairsSource::mark_boards(std::vector<PointPair>& pairs) const {
    const int each = params_.corners_per_board;
    if (each == 0) return;
    const int singles = std::min(params_.leading_points, static_cast<int>(pairs.size()));
    const int corners = static_cast<int>(pairs.size()) - singles;
    if (corners % each != 0)
        throw Error(std::to_string(corners) + " rows are left for boards of " +
                    std::to_string(each) +
                    " corners, which is no whole number of boards; see "
                    "first, count and leading_points");
    const int side = square_side(each);
    for (int i = 0; i < corners; ++i) {
        PointPair& pair = pairs[static_cast<std::size_t>(singles) + static_cast<std::size_t>(i)];
        const int k = i % each;
        pair.board = i / each;
        pair.corner = params_.corner_order == "columns" ? (k % side) * side + k / side : k;
    }
    if (params_.corner_order == "from_image")
        for (int begin = singles; begin < singles + corners; begin += each)
            number_from_image(&pairs[static_cast<std::size_t>(begin)], side);
}

mrpt::img::TCamera PairsSource::read_camera(Run& run) const {
    Intrinsics intrinsics = read_intrinsics(params_.intrinsics, params_.distortion_model);
    run.used_file(params_.intrinsics);
    if (params_.image_size.size() == 2)
        apply_image_size(
            intrinsics, params_.intrinsics, static_cast<std::uint32_t>(params_.image_size[0]),
            static_cast<std::uint32_t>(params_.image_size[1]), "the image of image_size");
    if (!intrinsics.has_size())
        throw Error("intrinsics file " + params_.intrinsics.string() +
                    " gives no image size; give it with image_size, [width, height]");
    intrinsics.camera.cameraName = params_.camera;
    return intrinsics.camera;
}

void PairsSource::run(Run& run) {
    if (std::exchange(done_, true)) return run.end_of_data();
    CameraPairs camera;
    camera.scene_name = scene_name(params_.pairs.empty() ? params_.lidar_points : params_.pairs);
    run.set_frame(camera.scene_name, 0.0);
    camera.scene = run.frame().number;
    camera.camera = params_.camera;
    camera.lidar = params_.lidar;
    camera.model = read_camera(run);
    camera.pairs = read_pairs(run);
    mark_boards(camera.pairs);
    camera.order.by = DecidedBy::given;
    camera.order.reason = "the pairs were given";
    // The centre of the top-left pixel is (0, 0), so the image reaches half a pixel further.
    const auto outside =
        std::count_if(camera.pairs.begin(), camera.pairs.end(), [&](const PointPair& pair) {
            return pair.image.minCoeff() < -0.5 || pair.image.x() > camera.model.ncols - 0.5 ||
                   pair.image.y() > camera.model.nrows - 0.5;
        });
    if (outside > 0)
        run.log(LogLevel::warning, std::to_string(outside) + " image points lie outside the image");
    if (camera.pairs.empty())
        run.note(
            {"pairs in " + (params_.pairs.empty() ? params_.lidar_points : params_.pairs).string(),
             "the file has no row", "", "check the path"});
    run.log(LogLevel::info, std::to_string(camera.pairs.size()) + " pairs");
    Correspondences correspondences;
    correspondences.cameras.push_back(std::move(camera));
    run.write("correspondences", std::move(correspondences));
    run.progress(1, 1, "scenes");
}

}  // namespace petal
