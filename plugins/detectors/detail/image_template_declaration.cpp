// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/image_template.hpp"

namespace petal {

void ImageTemplate::describe(Spec<Params>& spec) {
    spec.summary(
        "Finds boards in images by fitting the target's outline and holes, of any shape, to the "
        "edges of the raw image.");
    spec.doc(R"(Takes the target file as one rigid template and asks for its pose in the camera.)");
    spec.role("image_board_detector");
    spec.reads<Images>("images", "the photos of a scene, each with its camera's intrinsics");
    spec.writes<ImageBoards>(
        "boards", "every camera that looked, and the boards that each saw, from left to right");
    spec.param("target", &Params::target).doc("target file, or the name of a shipped target");
    spec.param("levels", &Params::levels)
        .within(1, 100)
        .doc("global thresholds of the sweep; more find fainter holes and take longer");
    spec.param("min_holes", &Params::min_holes)
        .within(1, 100)
        .doc(
            "holes that must be seen as regions for a guess, where the plate itself is not; all "
            "must show their edges afterwards");
    spec.param("model_walls", &Params::model_walls)
        .doc(
            "take out the shift of edges where the plate's thickness shows as a wall of a hole or "
            "of the plate");
    spec.param("tolerance", &Params::tolerance)
        .unit("m")
        .within(1e-5, 0.1)
        .doc(
            "1 sigma, what is expected before the board is seen: how well in place its hole sides "
            "are; counts as two sides beside those of the board");
    spec.param("min_edges", &Params::min_edges)
        .unit("1")
        .within(0.0, 1.0)
        .doc("share of the holes' edges that must lie where the pose puts them");
    spec.param("min_outline", &Params::min_outline)
        .unit("1")
        .within(0.0, 1.0)
        .doc("share of the outline that must; and half of two sides of it");
    spec.param("min_plate", &Params::min_plate)
        .unit("1")
        .within(0.0, 1.0)
        .doc("share of the plate that must be evenly bright");
    spec.param("min_evidence", &Params::min_evidence)
        .unit("1")
        .within(0.0, 1.0)
        .doc("product of these three shares: a board may be weak in one of them, not in all");
    spec.param("max_scatter", &Params::max_scatter)
        .unit("1")
        .within(1e-4, 1.0)
        .doc("how far the hole sides may lie off the pose, 1 sigma, over a hole's size");
    spec.param("max_inset", &Params::max_inset)
        .unit("1")
        .within(0.0, 1.0)
        .doc("how much smaller or larger the holes may look on each side, over a hole's size");
    spec.param("min_hole_px", &Params::min_hole_px)
        .unit("px")
        .within(2.0, 1000.0)
        .doc("least size of a hole in the image: below about 5 px anything looks like a hole");
    spec.param("sigma_floor_px", &Params::sigma_floor_px)
        .unit("px")
        .within(0.0, 10.0)
        .doc(
            "1 sigma added to every corner in each direction by itself, as much as a pose can take "
            "up of it: what the camera model leaves");
}

}  // namespace petal
