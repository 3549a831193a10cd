// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "petal/calibration/shipped_file.hpp"
#include "plugins/sources/temporary_folder.hpp"
#include "simulation/scene/scene_file.hpp"

namespace petal::simulation {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

class SceneErrors : public testing::TemporaryFolder {
   protected:
    fs::path scene(const std::string& rest, const std::string& name = "mine") const {
        return write(name + ".json", R"({"petal_scene": 1, "name": ")" + name + "\"" +
                                         (rest.empty() ? "" : ",\n" + rest) + "}");
    }
    /// Of a scene whose other keys are `rest`.
    std::string refused(const std::string& rest) const {
        const fs::path file = scene(rest);
        return refusal([&] {
            Rng rng(1);
            SceneFile::load(file).make_scene(0, rng);
        });
    }
    static std::string with_board(const std::string& keys) {
        return R"("boards": [{"centre": [3.0, 0.0, 0.0])" + (keys.empty() ? "" : ", " + keys) +
               "}]";
    }
    static std::string with_object(const std::string& object) {
        return with_board("") + R"(, "objects": {"thing": )" + object + "}";
    }
};

TEST_F(SceneErrors, TheLeastSceneHasOneBoard) {
    const SceneFile file = SceneFile::load(scene(with_board("")));
    Rng rng(1);
    const Scene made = file.make_scene(0, rng);
    EXPECT_EQ(made.name, "mine");
    EXPECT_EQ(made.boards[0].target.name, "four_square_holes_500mm");
    EXPECT_DOUBLE_EQ(made.duration, 10.0);
    EXPECT_EQ(made.images, 3);
    // The middle of its front is where it was put, and it faces the LiDAR.
    const Eigen::Vector3d middle = made.boards[0].T_world_board * Eigen::Vector3d(0.25, 0.25, 0.0);
    EXPECT_LT((middle - Eigen::Vector3d(3.0, 0.0, 0.0)).norm(), 1e-12);
    EXPECT_LT((made.boards[0].T_world_board.linear().col(2) - Eigen::Vector3d::UnitX()).norm(),
              1e-12);
}

TEST_F(SceneErrors, AnUnknownKeyIsToldWithTheNearest) {
    EXPECT_THAT(refused(R"("durations": 3, )" + with_board("")),
                AllOf(HasSubstr("mine.json:2"), HasSubstr("durations"),
                      HasSubstr("did you mean 'duration'")));
    EXPECT_THAT(refused(with_board(R"("yaw_degs": 3)")),
                AllOf(HasSubstr("boards[0].yaw_degs"), HasSubstr("did you mean 'yaw_deg'")));
    EXPECT_THAT(refused(with_object(R"({"kind": "wall", "distanse": 4})")),
                AllOf(HasSubstr("objects.thing.distanse"), HasSubstr("did you mean 'distance'")));
    EXPECT_THAT(refused(R"("lidar": {"profil": "livox_avia"}, )" + with_board("")),
                HasSubstr("did you mean 'profile'"));
    EXPECT_THAT(refused(R"("light": {"amb": 1}, )" + with_board("")), HasSubstr("light.amb"));
}

TEST_F(SceneErrors, ValuesOutOfRangeAreToldWithTheirUnit) {
    EXPECT_THAT(refused(with_board(R"("yaw_deg": 200)")),
                HasSubstr("boards[0].yaw_deg is 200 deg; expected -180 to 180 deg"));
    EXPECT_THAT(refused(R"("duration": 0, )" + with_board("")), HasSubstr("0.1 to 600 s"));
    EXPECT_THAT(refused(R"("boards": [{"centre": [3000, 0, 0]}])"), HasSubstr("0.2 to 60 m"));
    EXPECT_THAT(refused(R"("boards": [{"distance": 3000}])"), HasSubstr("0.2 to 60 m"));
    EXPECT_THAT(refused(with_object(R"({"kind": "wall", "gap": [0.5, 0.1]})")),
                AllOf(HasSubstr("objects.thing.gap"), HasSubstr("smaller number")));
    EXPECT_THAT(refused(with_object(R"({"kind": "wall", "gap": -0.1})")), HasSubstr("0 to 500 m"));
    EXPECT_THAT(refused(R"("motion": {"velocity": [100, 0, 0]}, )" + with_board("")),
                HasSubstr("50 m/s"));
    EXPECT_THAT(refused(R"("cameras": [{"fx": -3}], )" + with_board("")),
                HasSubstr("cameras[0].fx"));
    EXPECT_THAT(refused(R"("cameras": [{"model": "kannala_brandt", "distortion": [1,2,3,4,5]}], )" +
                        with_board("")),
                HasSubstr("5 coefficients; this model has 4"));
    EXPECT_THAT(refused(with_object(R"({"kind": "panel", "centre": [4,0,0], "width": 1, "height": 1,
                        "texture": {"kind": "plain", "colour": 200, "reflectivity": 0.5}})")),
                HasSubstr("expected 0 to 1"));
}

TEST_F(SceneErrors, UnknownNamesListTheKnown) {
    EXPECT_THAT(refused(with_board(R"("target": "four_square_hole_500mm")")),
                AllOf(HasSubstr("boards[0].target"), HasSubstr("four_square_holes_500mm")));
    EXPECT_THAT(refused(with_object(R"({"kind": "hause"})")),
                AllOf(HasSubstr("objects.thing.kind"), HasSubstr("building")));
    EXPECT_THAT(refused(with_object(R"({"kind": "wall", "gap": 1, "texture": "bricks"})")),
                AllOf(HasSubstr("objects.thing.texture"), HasSubstr("did you mean 'brick'")));
    EXPECT_THAT(refused(R"("lidar": {"profile": "livox_mid71"}, )" + with_board("")),
                AllOf(HasSubstr("lidar.profile"), HasSubstr("livox_mid70")));
    EXPECT_THAT(refused(R"("based_on": "indoor_floor_4m")"),
                AllOf(HasSubstr("based_on"), HasSubstr("indoor_floor_3m")));
    EXPECT_THAT(refusal([] { SceneFile::load("indoor_flor_3m"); }), HasSubstr("indoor_floor_3m"));
}

TEST_F(SceneErrors, BoardsAreNeededOnce) {
    EXPECT_THAT(refused(""), HasSubstr("needs boards"));
    EXPECT_THAT(refused(R"("boards": [])"), HasSubstr("at least one board"));
    EXPECT_THAT(refused(R"("captures": [])"), HasSubstr("at least one capture"));
    EXPECT_THAT(refused(R"("captures": [{"name": "a"}])"), HasSubstr("boards"));
    EXPECT_THAT(refused(with_board("") + R"(, "captures": [{"boards": []}])"),
                HasSubstr("both boards and captures"));
    EXPECT_THAT(refused(R"("captures": [{"name": "a", "boards": [{"distance": 3}]},
                                        {"name": "a", "boards": [{"distance": 3}]}])"),
                HasSubstr("name of another capture"));
}

TEST_F(SceneErrors, KeysThatDoNotGoTogether) {
    EXPECT_THAT(refused(R"("boards": [{}])"), HasSubstr("either centre, or distance"));
    EXPECT_THAT(refused(R"("boards": [{"centre": [3, 0, 0], "azimuth_deg": 3}])"),
                HasSubstr("goes with distance"));
    EXPECT_THAT(refused(R"("boards": [{"centre": [3, 0, 0], "stands": "floor"}])"),
                HasSubstr("must be [x, y]"));
    EXPECT_THAT(refused(with_object(R"({"kind": "wall"})")), HasSubstr("either distance"));
    EXPECT_THAT(refused(with_object(R"({"kind": "wall", "gap": 1, "behind": 1})")),
                HasSubstr("objects.thing.behind"));
    EXPECT_THAT(refused(with_object(R"({"kind": "panel", "centre": [3,0,0], "width": 1,
                                "look_alike": "four_square_holes_500mm"})")),
                HasSubstr("both look_alike and width"));
    EXPECT_THAT(refused(R"("floor": -0.2, )" + with_board("")),
                AllOf(HasSubstr("boards[0]"), HasSubstr("under the floor")));
}

TEST_F(SceneErrors, ABoardThatSomeRigMissesIsNamed) {
    EXPECT_THAT(refused(R"("boards": [{"distance": 3, "azimuth_deg": 0},
                                      {"distance": 3, "azimuth_deg": 30}])"),
                AllOf(HasSubstr("boards[1]"), HasSubstr("px"), HasSubstr("5"), HasSubstr("0.2")));
    // A stiffer rig makes it possible.
    const fs::path file = scene(R"("rig": {"rotation_deg": 0, "translation": 0},
                                   "boards": [{"distance": 3, "azimuth_deg": 28}])");
    Rng rng(1);
    EXPECT_EQ(SceneFile::load(file).make_scene(0, rng).boards.size(), 1U);
}

TEST_F(SceneErrors, TheNameIsThatOfTheFile) {
    const fs::path file = write("other.json", R"({"petal_scene": 1, "name": "mine"})");
    EXPECT_THAT(refusal([&] { SceneFile::load(file); }), HasSubstr("'other'"));
    const fs::path future = write("future.json", R"({"petal_scene": 2, "name": "future"})");
    EXPECT_THAT(refusal([&] { SceneFile::load(future); }), HasSubstr("must be 1"));
}

TEST_F(SceneErrors, ScenesBasedOnEachOtherAreRefused) {
    scene(R"("based_on": "b.json")", "a");
    const fs::path file = scene(R"("based_on": "a.json")", "b");
    EXPECT_THAT(refusal([&] { SceneFile::load(file); }), HasSubstr("circle"));
    const fs::path self = scene(R"("based_on": "self.json")", "self");
    EXPECT_THAT(refusal([&] { SceneFile::load(self); }), HasSubstr("circle"));
}

TEST_F(SceneErrors, AFileLaysItsKeysOverWhatItIsBasedOn) {
    scene(R"("duration": 4, "images": 5, "objects": {
        "wall": {"kind": "wall", "gap": 0.3, "texture": "brick"}, "pole": {"kind": "pole",
        "place": [5, 3]}}, )" +
              with_board(""),
          "base");
    const fs::path file = scene(R"("based_on": "base.json", "duration": 2,
        "objects": {"wall": {"gap": 0.6}, "pole": null})");
    const SceneFile scene_file = SceneFile::load(file);
    Rng rng(1);
    const Scene made = scene_file.make_scene(0, rng);
    EXPECT_DOUBLE_EQ(made.duration, 2.0);
    EXPECT_EQ(made.images, 5);
    EXPECT_EQ(scene_file.files().size(), 4U);  // both scenes, the LiDAR, the target
    const Hit wall = made.world.cast({{3.5, 0.0, 0.0}, Eigen::Vector3d::UnitX()}, 10.0);
    EXPECT_NEAR(wall.range, 3.0 + 0.005 + 0.6 - 3.5, 1e-9);
    // Board: front, back, four sides, four walls of each of four holes; and the wall.
    EXPECT_EQ(made.world.size(), 6U + 16U + 1U);
    // A mistake in a base is told with the base's name.
    scene(R"("duration": -4, )" + with_board(""), "base");
    EXPECT_THAT(refusal([&] { SceneFile::load(scene(R"("based_on": "base.json", "images": 2)")); }),
                HasSubstr("base.json:2: duration"));
}

TEST_F(SceneErrors, CapturesHaveKeysOfTheirOwn) {
    const fs::path file = scene(R"("duration": 4, "captures": [
        {"name": "near", "boards": [{"distance": 2.5}], "duration": 6},
        {"boards": [{"distance": 4, "yaw_deg": 20}, {"distance": 3, "azimuth_deg": 15}]}])");
    const SceneFile scene_file = SceneFile::load(file);
    ASSERT_EQ(scene_file.captures(), 2U);
    Rng rng(1);
    const Scene near = scene_file.make_scene(0, rng), second = scene_file.make_scene(1, rng);
    EXPECT_EQ(near.name, "mine_near");
    EXPECT_DOUBLE_EQ(near.duration, 6.0);
    EXPECT_EQ(second.name, "mine_2");
    EXPECT_DOUBLE_EQ(second.duration, 4.0);
    EXPECT_EQ(second.boards.size(), 2U);
    EXPECT_THAT(refusal([&] { scene_file.make_scene(2, rng); }), HasSubstr("2 captures"));
}

}  // namespace
}  // namespace petal::simulation
