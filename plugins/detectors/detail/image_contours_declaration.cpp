// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/image_contours.hpp"

namespace petal {

void ImageContours::describe(Spec<Params>& spec) {
    spec.summary(
        "Finds boards with square holes in images by the contours of the holes, as the letter "
        "does.");
    spec.doc(
        R"(Algorithm 2 and section III.C of the letter, in six steps. Pixels are raw; the board's
geometry is computed in ideal pixels (distortion taken out point by point), where its lines are
straight. The letter rectifies the whole image first: that resamples it, and corners then no
longer belong to the raw image and its K.

1. **Binary images without a hand-set threshold.** `levels` global thresholds at quantiles of the
   grey values, and local means at three scales (1/64, 1/24 and 1/10 of the image's longer side)
   less the image's own noise. No grey level is special, so brightness and gamma do not matter.
   The letter does not say how it binarises.
2. **Contours with hierarchy**, hole borders only, kept by area and by equations (6) and (7):
   rectangularity = S_MER / S_hull, circularity = 4 pi S_area / length^2. A region seen in several
   binary images counts once.
3. **Four corners by maximum distances.** The letter starts from a random point of the contour;
   here the start is the point farthest from the centroid, so every run gives the same. The fourth
   corner is the farthest on the other side of the first diagonal, which holds on skewed squares
   too.
4. **Groups by mutual geometry.** Every square is tried as every hole; its affine map predicts the
   other holes, squares found there join, and their corners must fit one homography. The number of
   boards is not given. `min_holes` squares suffice for a guess: a hole that is no clean square
   still gets its corners in step 5.
5. **Sub-pixel sides, one board at a time.** Edge points (derivative of a Gaussian along the
   side's normal, parabola through the largest rise) of all hole sides fit one homography,
   reweighted until it settles, with one common inset of all holes. Seen obliquely, one of two
   opposite walls of a hole shows, and the dark begins at the back edge: how far that lies inwards follows
   from the pose and the target's thickness, how much of it the image shows from how narrow the holes look
   (`model_walls`). A side that does not lie where
   the others put it (0.5 px, or four times the board's usual misfit), or that has hardly an edge,
   is something behind the hole - a kerb, a window - and is replaced by the board's geometry;
   `sides_from_geometry` counts them and their corners' covariances are larger. The other sides
   are lines through their own edge points, with the board's geometry as a prior of width
   `tolerance`; corners are where they meet.
6. **Evidence for a board**: holes darker than the plate (`min_contrast`), the plate uniformly
   bright up to the outline (`min_plate_fraction`), edges at `min_sides` hole sides and at two of
   every hole.

Corners come row by row from the top left as the image shows the board. Their covariances follow
from the scatter of the edge points (neighbours counted half), the prior and the homography, plus
`sigma_floor_px`. Corners of one side are correlated: the joint covariance of all holds that, and
that a plate's bright thickness, seen obliquely in a hole, may have shifted its sides by more or less than modelled.

Quality of a board: `holes_seen` (as squares), `sides_measured`, `sides_from_geometry`,
`line_rms_px` (edge points about their lines), `geometry_rms_px` (sides about the board's
geometry), `hole_inset_m` (positive: holes look smaller than the target says), `contrast`,
`plate_fraction`, `mean_sigma_px`.

Limits: bright board, dark holes; the whole board in view (half of its margin may be hidden);
holes of about 5 pixels a side or more; tilts to about 60 deg. A hole whose two or more sides are
all hidden by a bright background loses the board. With `--debug`, and always when no board was
found, the stage saves a picture of squares and groups.)");
    spec.role("image_board_detector");
    spec.reads<Images>("images", "the photos of a scene, each with its camera's intrinsics");
    spec.writes<ImageBoards>(
        "boards", "every camera that looked, and the boards that each saw, from left to right");

    spec.param("target", &Params::target).doc("target file, or the name of a shipped target");
    spec.param("min_area", &Params::min_area)
        .unit("1")
        .within(1e-6, 0.5)
        .doc("smallest area of a hole, over the image's area; never below 9 pixels");
    spec.param("max_area", &Params::max_area)
        .unit("1")
        .within(1e-6, 0.5)
        .doc("largest area of a hole, over the image's area");
    spec.param("max_rectangularity", &Params::max_rectangularity)
        .unit("1")
        .within(1.0, 3.0)
        .doc("equation (6): 1 for a rectangle, more for a square seen askew");
    spec.param("min_circularity", &Params::min_circularity)
        .unit("1")
        .within(0.0, 1.0)
        .doc("equation (7): pi/4 for a square, less for slender or ragged regions");
    spec.param("max_circularity", &Params::max_circularity)
        .unit("1")
        .within(0.0, 1.5)
        .doc("equation (7): 1 for a circle");
    spec.param("levels", &Params::levels)
        .within(1, 100)
        .doc("global thresholds of the sweep; more find fainter holes and take longer");
    spec.param("min_holes", &Params::min_holes)
        .within(2, 100)
        .doc("holes of a board that must be seen as squares; the others must show their edges");
    spec.param("model_walls", &Params::model_walls)
        .doc(
            "take out the shift of edges where the plate's thickness shows as a bright wall of a "
            "hole; off: corners are those of the dark that is seen (the letter)");
    spec.param("tolerance", &Params::tolerance)
        .unit("m")
        .within(1e-5, 0.1)
        .doc(
            "1 sigma: how straight and in place the hole sides of the real board are. Large: every "
            "side by itself "
            "(the letter); small: all corners from the board's geometry");
    spec.param("min_contrast", &Params::min_contrast)
        .unit("1")
        .within(0.0, 1.0)
        .doc("(plate - holes) / plate, of the median grey values");
    spec.param("min_plate_fraction", &Params::min_plate_fraction)
        .unit("1")
        .within(0.0, 1.0)
        .doc("part of the plate that must be brighter than midway between holes and plate");
    spec.param("min_hole_fraction", &Params::min_hole_fraction)
        .unit("1")
        .within(0.0, 1.0)
        .doc("part of the holes that must be darker than that");
    spec.param("min_sides", &Params::min_sides)
        .within(0, 1000)
        .doc(
            "hole sides of a board that edges in the image must confirm (16 has the four-hole "
            "board)");
    spec.param("sigma_floor_px", &Params::sigma_floor_px)
        .unit("px")
        .within(0.0, 10.0)
        .doc(
            "1 sigma added to every corner in each direction: what repeats in all edge points of a "
            "photo, such "
            "as compression and sharpening");
    spec.check([](const Params& p) {
        return p.min_area < p.max_area ? std::string()
                                       : std::string("min_area must be smaller than max_area");
    });
    spec.check([](const Params& p) {
        return p.min_circularity < p.max_circularity
                   ? std::string()
                   : std::string("min_circularity must be smaller than max_circularity");
    });
}

}  // namespace petal
