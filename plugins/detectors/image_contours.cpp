// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/image_contours.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "detectors/detail/image_input.hpp"
#include "petal/error.hpp"
#include "petal/printed.hpp"

namespace petal {

namespace {

/// Groups looked at closely in one photo; far more than there can be boards.
constexpr int kMaxGroups = 200;

std::string short_number(double value) {
    return printed("%.3g", value);
}

ImageBoard to_image_board(const RefinedBoard& refined, const std::string& target,
                          const std::string& camera, int holes_seen) {
    ImageBoard board;
    board.target = target;
    board.camera = camera;
    board.corners = refined.corners;
    board.covariance = refined.covariance;
    board.joint_covariance = refined.joint_covariance;
    const int sides = static_cast<int>(refined.side_measured.size());
    board.quality["holes_seen"] = holes_seen;
    board.quality["sides_measured"] = refined.sides_measured;
    board.quality["sides_from_geometry"] = sides - refined.sides_measured;
    board.quality["line_rms_px"] = refined.line_rms_px;
    board.quality["geometry_rms_px"] = refined.board_rms_px;
    board.quality["hole_inset_m"] = refined.hole_inset;
    board.quality["contrast"] = refined.contrast;
    board.quality["plate_fraction"] = refined.plate_fraction;
    double variance = 0.0;
    for (const auto& covariance : refined.covariance) variance += 0.5 * covariance.trace();
    board.quality["mean_sigma_px"] =
        std::sqrt(variance / static_cast<double>(refined.corners.size()));
    return board;
}

}  // namespace

ImageContours::ImageContours(Params params)
    : params_(std::move(params)), layout_(load_target(params_.target)) {
    const auto refuse = [this](const char* name, int value, std::size_t most, const char* what) {
        if (value < 0 || static_cast<std::size_t>(value) > most)
            throw Error(std::string(name) + " is " + std::to_string(value) + ", but target '" +
                        layout_.target().name + "' has only " + std::to_string(most) + " " + what +
                        ": lower it");
    };
    refuse("min_holes", params_.min_holes, layout_.holes(), "holes");
    refuse("min_sides", params_.min_sides, layout_.sides().size(), "hole sides");
}

void ImageContours::run(Run& run) {
    write_image_boards(run, params_.target, [&](const CameraImage& image, ImageBoards& found) {
        detect(run, image, found);
    });
}

void ImageContours::detect(Run& run, const CameraImage& image, ImageBoards& found) const {
    const CameraModel camera = model_of(image);
    ImageSearchPicture picture;
    picture.image = pixels_of(image);
    const cv::Mat grey = grey_of(picture.image);

    const SquareSearch search = find_squares(grey, params_, [&run] { run.check_cancelled(); });
    const Grouping grouping = group_squares(search.squares, layout_, camera, params_.min_holes);
    for (const SquareCandidate& square : search.squares) picture.squares.push_back(square.corners);

    const EdgeSampler edges(grey);
    const BoardRefiner refiner(edges, layout_, camera, params_);
    struct Accepted {
        RefinedBoard refined;
        int holes_seen = 0;
        Eigen::Vector2d center;
        double size = 0.0;  ///< px, half the board's width
    };
    std::vector<Accepted> accepted;
    int looked_at = 0;
    for (const BoardHypothesis& hypothesis : grouping.hypotheses) {
        run.check_cancelled();
        const Eigen::Vector2d center = map_point(hypothesis.board_to_image, layout_.center());
        const bool known = std::any_of(
            accepted.begin(), accepted.end(),
            [&](const Accepted& board) { return (board.center - center).norm() < board.size; });
        if (known || ++looked_at > kMaxGroups) continue;
        RefinedBoard refined = refiner.refine(hypothesis.board_to_image);
        const Homography& h = refined.board_to_image;
        if (refined.rejected.empty()) {
            const double scale = std::sqrt(map_jacobian(h, layout_.center()).determinant());
            accepted.push_back({std::move(refined), hypothesis.holes_seen, center,
                                0.5 * scale * layout_.target().width()});
            continue;
        }
        RejectedGroup group;
        group.reason = refined.rejected;
        const double x = layout_.target().width(), y = layout_.target().height();
        const std::array<Eigen::Vector2d, 4> outline{{{0.0, 0.0}, {x, 0.0}, {x, y}, {0.0, y}}};
        for (std::size_t i = 0; i < 4; ++i) {
            const Eigen::Vector2d ideal = map_point(hypothesis.board_to_image, outline[i]);
            group.outline[i] = camera.distort(ideal).value_or(ideal);
        }
        picture.rejected.push_back(std::move(group));
    }
    // From left to right, as one counts boards in a photo; by the first corner where they are
    // stacked.
    std::sort(accepted.begin(), accepted.end(), [](const Accepted& a, const Accepted& b) {
        return a.center.x() != b.center.x() ? a.center.x() < b.center.x()
                                            : a.center.y() < b.center.y();
    });
    for (const Accepted& board : accepted) {
        picture.boards.push_back(
            to_image_board(board.refined, layout_.target().name, image.label, board.holes_seen));
        std::vector<bool> measured(layout_.corners().size(), true);
        for (std::size_t s = 0; s < layout_.sides().size(); ++s) {
            if (board.refined.side_measured[s]) continue;
            measured[layout_.sides()[s].from_corner] = false;
            measured[layout_.sides()[s].to_corner] = false;
        }
        picture.corner_measured.push_back(std::move(measured));
    }
    tell(run, image.label, picture, search, grouping);
    for (ImageBoard& board : picture.boards) found.boards.push_back(std::move(board));
}

void ImageContours::tell(Run& run, const std::string& camera, const ImageSearchPicture& picture,
                         const SquareSearch& search, const Grouping& grouping) const {
    const std::string squares = std::to_string(search.squares.size()) + " dark squares";
    if (picture.boards.empty()) {
        Note note;
        note.looked_for =
            "boards '" + layout_.target().name + "' in the image of camera '" + camera + "'";
        const std::string holes = std::to_string(layout_.holes());
        if (!picture.rejected.empty()) {
            note.nearest_miss = squares + "; the best group of holes is no board: " +
                                picture.rejected.front().reason;
            note.hint = "look at the saved picture: is a whole board in view, lit and in focus?";
        } else if (grouping.best_holes > 1) {
            note.nearest_miss = squares + "; the best group has " +
                                std::to_string(grouping.best_holes) + " of " + holes +
                                " holes where the target has them";
            note.threshold = "min_holes " + std::to_string(params_.min_holes);
            note.hint =
                "check that the target file is that of your board, and that no hole is covered";
        } else {
            note.nearest_miss =
                squares + " of " + std::to_string(search.borders) +
                " hole borders in the area range; no two lie as the target's holes do";
            note.threshold = "min_area " + short_number(params_.min_area) + ", max_area " +
                             short_number(params_.max_area) + " of the image";
            note.hint = "the holes need about 5 pixels a side: move closer, or lower min_area";
        }
        run.note(note);
    } else {
        run.log(LogLevel::info, "camera '" + camera +
                                    "': " + std::to_string(picture.boards.size()) +
                                    " boards from " + squares);
    }
    save_pictures(run, "squares", camera, picture);
}

}  // namespace petal
