// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/lidar_template.hpp"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "detectors/detail/lidar_template_patches.hpp"
#include "detectors/detail/lidar_template_picture.hpp"
#include "petal/calibration/for_pieces.hpp"
#include "petal/calibration/target.hpp"
#include "petal/printed.hpp"

namespace petal {
namespace {

constexpr double kSameBoard = 0.5;  ///< of the board's lesser side, between middles

/// The better ones of boards that lie on one another.
void take_out_doubles(std::vector<PlateAttempt>& attempts, double least_side) {
    std::vector<std::size_t> boards;
    for (std::size_t i = 0; i < attempts.size(); ++i)
        if (attempts[i].board) boards.push_back(i);
    std::stable_sort(boards.begin(), boards.end(), [&](std::size_t a, std::size_t b) {
        return attempts[a].merit > attempts[b].merit;
    });
    std::vector<Eigen::Vector3d> taken;
    for (const std::size_t i : boards) {
        const bool known = std::any_of(taken.begin(), taken.end(), [&](const Eigen::Vector3d& at) {
            return (at - attempts[i].middle).norm() < kSameBoard * least_side;
        });
        if (known) {
            attempts[i].board.reset();
            attempts[i].miss = "a board that another plate shows too";
        } else {
            taken.push_back(attempts[i].middle);
        }
    }
    // What is no board on the place of one is no doubt about the target.
    for (PlateAttempt& attempt : attempts)
        for (const Eigen::Vector3d& at : taken)
            if (!attempt.board && (at - attempt.middle).norm() < 2.0 * kSameBoard * least_side)
                attempt.finding.clear();
}

}  // namespace

void LidarTemplate::run(Run& run) {
    const Cloud& cloud = run.in<Cloud>("cloud");
    const auto planes = run.find<Planes>("planes");
    const Target names = load_target(p_.target);
    run.used_file(find_target_file(p_.target));
    const PlateTemplate target(names);
    PlateBeam beam{p_.edge_shift_sigma_level, p_.edge_shift_sigma_upright};
    const auto poll = [&run] { run.check_cancelled(); };

    std::vector<PlateAttempt> attempts;
    PlateCandidate nearest;
    if (p_.evidence != "edges") {
        std::vector<PlateCandidate> plates;
        std::optional<CloudDirections> by_direction;
        std::size_t cells = 0;
        const auto find_plates = [&] {
            PlateSearch search(cloud, target.all);
            cells = search.cell_count();
            if (planes)
                for (const Plane& plane : planes->planes)
                    if (const auto centre = centre_of(plane))
                        search.try_patch(*centre, plane.normal);
            plates = search.find(run.rng(), poll);
            nearest = search.nearest_miss();
        };
        on_run_threads(
            run, [&] { tbb::parallel_invoke(find_plates, [&] { by_direction.emplace(cloud); }); });
        const CloudDirections& directions = *by_direction;
        run.log(LogLevel::info,
                printed("%zu plates of the target's size in %zu cells", plates.size(), cells));
        if (plates.size() > static_cast<std::size_t>(p_.max_candidates))
            plates.resize(static_cast<std::size_t>(p_.max_candidates));
        const PlatePlacer placer(target.all, reach_of(target));
        std::vector<PlacedPlate> placed(plates.size());
        for_pieces(run, plates.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                placed[i] = place_on_rays(target, placer, directions, plates[i]);
        });
        std::stable_sort(placed.begin(), placed.end(),
                         [](const auto& a, const auto& b) { return a.score() > b.score(); });
        std::vector<Eigen::Vector3d> middles;
        for (const PlacedPlate& plate : placed) {
            poll();
            attempts.push_back(try_rays(target, beam, p_, directions, plate, middles, names));
            if (attempts.back().board) middles.push_back(attempts.back().middle);
        }
    }
    const bool found = std::any_of(attempts.begin(), attempts.end(),
                                   [](const auto& attempt) { return attempt.board.has_value(); });
    if (p_.evidence == "edges" || (p_.evidence == "auto" && !found &&
                                   cloud.size() <= static_cast<std::size_t>(p_.max_edge_points))) {
        const EdgePatches patches(cloud, planes.get(), target.all, run.rng(), poll);
        for (const PlateCandidate& patch : patches.patches())
            attempts.push_back(
                try_edges(target, beam, p_, p_.max_shift, patches.points(), patch, names));
    }
    take_out_doubles(attempts, target.all.least_side());

    LidarBoards boards;
    boards.lidar = cloud.sensor_label;
    int number = 0;
    for (const PlateAttempt& attempt : attempts) {
        if (!attempt.finding.empty())
            boards.findings.push_back("target '" + names.name + "': " + attempt.finding);
        if (attempt.board)
            boards.boards.push_back(*attempt.board);
        else
            run.log(LogLevel::debug,
                    printed("plate at (%.2f, %.2f, %.2f) m: ", attempt.plate.centre.x(),
                            attempt.plate.centre.y(), attempt.plate.centre.z()) +
                        attempt.miss + "; " + attempt.threshold);
    }
    run.log(LogLevel::info, std::to_string(boards.boards.size()) + " boards on " +
                                std::to_string(attempts.size()) + " plates");
    if (boards.boards.empty()) tell_nothing(run, attempts, nearest, cloud.size());
    if (boards.boards.empty() || run.debug())
        for (const PlateAttempt& attempt : attempts)
            run.save("plate_" + std::to_string(number++) + ".png",
                     [&](const std::filesystem::path& file) { draw_plate(target, attempt, file); });
    run.write("boards", std::move(boards));
}

void LidarTemplate::tell_nothing(Run& run, const std::vector<PlateAttempt>& attempts,
                                 const PlateCandidate& nearest, std::size_t points) const {
    Note note;
    note.looked_for = "boards '" + p_.target + "' in " + std::to_string(points) + " points";
    const auto best =
        std::max_element(attempts.begin(), attempts.end(),
                         [](const auto& a, const auto& b) { return a.closeness < b.closeness; });
    if (best != attempts.end()) {
        note.nearest_miss = best->miss + printed(", %.1f m away", best->plate.centre.norm());
        note.threshold = best->threshold;
        note.hint = "see the saved pictures of the plates; is the target's file that of the board?";
    } else if (nearest.closeness > 0.0) {
        note.nearest_miss = printed(
            "a patch %.1f m away that fills %.0f %% of the plate and %.0f %% of a ring around it",
            nearest.centre.norm(), nearest.filled * 100.0, nearest.around * 100.0);
        note.threshold = "a plate of the target's size that stands free";
        note.hint = "is the board in the LiDAR's view, with free space around most of it?";
    } else {
        note.nearest_miss = points == 0 ? "the cloud is empty" : "no plane patch";
        note.hint = "look at the stage before, and at the LiDAR's view";
    }
    run.note(note);
}

}  // namespace petal
