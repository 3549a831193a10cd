// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/image_template.hpp"

#include <algorithm>
#include <utility>

#include "detectors/detail/image_board_overlay.hpp"
#include "detectors/detail/image_input.hpp"
#include "detectors/detail/image_template_search.hpp"
#include "petal/error.hpp"
#include "petal/printed.hpp"

namespace petal {

namespace {

Note nothing_found(const TemplateSearch& search, const TemplateModel& model,
                   const std::string& camera, const ImageTemplateParams& params) {
    Note note;
    note.looked_for =
        "boards '" + model.target().name + "' in the image of camera '" + camera + "'";
    const std::string regions = std::to_string(search.regions.size()) + " dark regions";
    if (!search.rejected.empty()) {
        note.nearest_miss = regions + ", " + std::to_string(search.guesses) +
                            " places; the likeliest is no board: " + search.rejected.front().reason;
        note.hint = "look at the saved picture: is a whole board in view, lit and in focus?";
    } else if (search.guesses > 0) {
        note.nearest_miss = regions + ", " + std::to_string(search.guesses) +
                            " places; at none are a third of the holes' edges in place";
        note.threshold = printed("min_edges %.2f", params.min_edges);
        note.hint = "check that the target file is that of your board, and the camera's intrinsics";
    } else {
        note.nearest_miss = regions + " of " + std::to_string(search.borders) +
                            " borders; the best group has " + std::to_string(search.best_holes) +
                            " of " + std::to_string(model.holes()) +
                            " holes where the target has them";
        note.threshold = "min_holes " + std::to_string(params.min_holes);
        note.hint = "the holes need about 5 pixels a side: move closer, or raise levels";
    }
    return note;
}

std::vector<bool> corners_measured(const TemplateBoard& board, const TemplateModel& model) {
    std::vector<bool> measured(model.corners().size(), true);
    for (std::size_t s = 0; s < model.sides().size(); ++s)
        if (!model.sides()[s].outline && !board.fit.sides[s].measured)
            for (std::size_t c = 0; c < measured.size(); ++c)
                if (model.corners()[c] == model.sides()[s].from ||
                    model.corners()[c] == model.sides()[s].to)
                    measured[c] = false;
    return measured;
}

}  // namespace

ImageTemplate::ImageTemplate(Params params)
    : params_(std::move(params)), model_(load_target(params_.target)) {
    if (static_cast<std::size_t>(params_.min_holes) > model_.holes()) {
        if (params_.min_holes != Params().min_holes)
            throw Error("min_holes is " + std::to_string(params_.min_holes) + ", but target '" +
                        model_.target().name + "' has only " + std::to_string(model_.holes()) +
                        " holes: lower it");
        params_.min_holes = static_cast<int>(model_.holes());
    }
}

void ImageTemplate::run(Run& run) {
    write_image_boards(run, params_.target, [&](const CameraImage& image, ImageBoards& found) {
        detect(run, image, found);
    });
}

void ImageTemplate::detect(Run& run, const CameraImage& image, ImageBoards& found) const {
    const CameraModel camera = model_of(image);
    ImageSearchPicture picture;
    picture.image = pixels_of(image);
    const cv::Mat grey = grey_of(picture.image);
    TemplateSearch search =
        search_boards(grey, model_, camera, params_, [&run] { run.check_cancelled(); });
    picture.squares = search.regions;
    picture.rejected = search.rejected;
    for (const TemplateBoard& board : search.boards) {
        picture.boards.push_back(
            to_packet(board, model_, camera, image.label, params_.sigma_floor_px));
        picture.corner_measured.push_back(corners_measured(board, model_));
    }
    if (picture.boards.empty())
        run.note(nothing_found(search, model_, image.label, params_));
    else
        run.log(LogLevel::info, "camera '" + image.label +
                                    "': " + std::to_string(picture.boards.size()) + " boards, " +
                                    std::to_string(search.guesses) + " places");
    save_pictures(run, "boards", image.label, picture);
    for (ImageBoard& board : picture.boards) found.boards.push_back(std::move(board));
}

}  // namespace petal
