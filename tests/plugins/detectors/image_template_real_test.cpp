// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include "detectors/image_template.hpp"
#include "image_render.hpp"
#include "petal/testing/stage_harness.hpp"
#include "real_data.hpp"
#include "real_scenes.hpp"

namespace petal {
namespace {

using testing::Photo;
using testing::StageHarness;

ImageBoards find_real_templates(const testing::RealScene& scene) {
    StageHarness stage = StageHarness::of<ImageTemplate>("detector.image_template");
    stage.set("target", PETAL_SOURCE_DIR "/datasets/targets/four_square_holes_500mm.json");
    stage.give<Images>("images", Images{{Photo::wrap(scene.pixels, scene.camera)}});
    stage.fire();
    return stage.out<ImageBoards>("boards");
}

// Bounds as those of image_contours, although six numbers a board place all corners here: the
// reference itself is good to about 0.3 px.
TEST(ImageTemplateReal, CampusHas32CornersAndNoFalseBoard) {
    PETAL_NEEDS_REAL_DATA();
    const testing::RealScene scene = testing::campus_scene();
    const ImageBoards found = find_real_templates(scene);
    ASSERT_EQ(found.boards.size(), 2u);
    const auto corners = testing::all_corners(found);
    const auto off = testing::distances_to_nearest(scene.reference, corners);
    EXPECT_LT(testing::median_of_sorted(off), 0.3);
    EXPECT_LT(off.back(), 0.7);
    RecordProperty("median_px", std::to_string(testing::median_of_sorted(off)));
    RecordProperty("max_px", std::to_string(off.back()));
    for (std::size_t i = 0; i < corners.size(); ++i)
        EXPECT_LT((corners[i] - scene.reference[i]).norm(), 0.7) << i;
}

TEST(ImageTemplateReal, IndoorHas64CornersAndNoFalseBoard) {
    PETAL_NEEDS_REAL_DATA();
    const testing::RealScene scene = testing::indoor_scene();
    const ImageBoards found = find_real_templates(scene);
    ASSERT_EQ(found.boards.size(), 4u);
    const auto off = testing::distances_to_nearest(
        scene.reference, testing::in_published_picture(scene, testing::all_corners(found)));
    EXPECT_LE(testing::median_of_sorted(off), 1.0);
    EXPECT_LE(off.back(), 3.0);
    RecordProperty("median_px", std::to_string(testing::median_of_sorted(off)));
    RecordProperty("max_px", std::to_string(off.back()));
}

}  // namespace
}  // namespace petal
