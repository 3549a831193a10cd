// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/image_template.hpp"

namespace petal {

void ImageTemplate::describe(Spec<Params>& spec) {
    spec.summary(
        "Finds boards in images by fitting the target's outline and holes, of any shape, to the "
        "edges of the raw image.");
    spec.doc(
        R"(Takes the target file as one rigid plate - its outline, and holes that are polygons or round - and asks where it must
stand for its edges to lie on those of the raw image, under the camera's own distortion. No code is made for one target. The
model with its formulas, and what was measured, stand in docs/image_template.md.

1. **Regions.** Global thresholds at quantiles, local means at three scales, and for faint things local means of the smoothed
   image, less the noise that is measured in it. Kept are dark regions with the moments of a hole, and bright ones with the moments
   of the outline, up to an affine map.
2. **Guesses.** Two regions give an affine map and with it the places of the other holes; a plate gives one by itself, and so does
   one whole hole with corners (`min_holes` 1). A look at some fifty grey values drops most: is the plate even there, are the holes darker?
   Each of the others allows two poses. A glance at edges and plate puts the likeliest first.
3. **Fit.** The pose, six numbers, by generalised least squares over sub-pixel edge points all along the holes and the
   outline. The points of a side share an offset, whose size the board itself tells; so a side that is not where the geometry puts
   it - a kerb behind a hole, a shadow - loses its weight. Fitted along: how much smaller holes and larger plates look, and how
   bright the walls of the plate's thickness are (`model_walls`).
4. **Evidence.** Which share of the edges is in place beyond chance, of the holes and of the outline; whether the plate is evenly
   bright between them. Windows and tiles have holes in place but no outline. A print that looks like the target is a board here: the
   LiDAR tells that it has no holes.

Corners are those of the template under the pose, row by row from the top left as the image shows the board. `joint_covariance` is
that of the pose, of rank six: all corners of a board move together.

Quality of a board: `holes_seen` (as regions; 0: by its plate), `sides_measured` (that the fit relies on, with the outline's),
`edges_in_place`, `outline_in_place`, `plate_even` (1 is all), `contrast` (edge over plate), `edge_sigma_px` (of one edge point),
`hole_scatter_m` and `outline_scatter_m` (1 sigma of the sides about the pose), `hole_inset_m`, `mean_sigma_px` (of a corner).

Limits: bright plate, darker holes; holes of 5 px or more (`min_hole_px`); half of the plate in the image; tilts to about 70
deg. One hole must be whole and dark, or the plate a region of its own. Where more than half of a hole's rim shows something as bright as
the plate, in most of its holes, the board is lost. The camera's intrinsics must be right: a wrong focal length becomes a wrong distance. With `--debug`, and always when no board was found, the
stage saves a picture of regions, refused places with the reason, and boards.)");
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
            "holes that must be seen as regions for a guess, where the plate itself is not; 1: one "
            "with corners suffices; all must show their edges afterwards");
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
        .doc(
            "product of the last two shares: a board may be hidden in part, but that does not look "
            "like "
            "one in both");
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
