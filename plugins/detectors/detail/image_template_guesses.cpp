// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_template_guesses.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <set>

#include "detectors/detail/image_layout.hpp"
#include "detectors/detail/image_template_ideal.hpp"
#include "detectors/detail/image_template_turned.hpp"
#include "petal/calibration/angles.hpp"

namespace petal {

namespace {

/// A hole may lie this far from where the first two put it, in hole sizes: perspective moves it.
constexpr double kGuessReach = 0.5;
/// Areas differ by perspective and by what shows through a hole.
constexpr double kGuessAreaRatio = 2.2;
constexpr double kPairRatio = 1.45;  ///< the same for the distance of two holes
constexpr double kGuessMisfit = 0.2;
/// So near must a hole lie, and so alike be its area, that it counts for whole. One of which only a
/// part is seen as a region has its middle elsewhere, and draws the map there.
constexpr double kWholeReach = 0.2;
constexpr double kWholeAreaRatio = 1.35;

class Guesser {
   public:
    Guesser(const TemplateModel& model, std::vector<IdealRegion> regions, int min_holes)
        : model_(model), regions_(std::move(regions)), min_holes_(min_holes) {
        for (std::size_t i = 0; i < model.holes(); ++i) {
            roots_.push_back(root_of(model.hole(i).spread));
            for (std::size_t j = 0; j < model.holes(); ++j)
                farthest_ = std::max(
                    farthest_,
                    (roots_[i].inverse() * (model.hole(j).center - model.hole(i).center)).norm());
        }
    }

    void group(const std::function<void()>& check) {
        for (const IdealRegion& anchor : regions_) {
            if (check) check();
            if (model_.holes() == 1)
                for (int turn = 0; turn < 24; ++turn)
                    try_map(anchor.root * turn_by(turn * kPi / 12.0) * roots_[0].inverse(), anchor,
                            0, 0.0);
            else
                pair_up(anchor);
        }
    }

    GuessSearch take() { return std::move(result_); }

   private:
    void pair_up(const IdealRegion& anchor) {
        const double reach =
            kPairRatio * farthest_ * anchor.root.norm();  // Frobenius: above the larger half axis
        auto it = from_row(anchor.shape.center.y() - reach);
        for (; it != regions_.end() && it->shape.center.y() <= anchor.shape.center.y() + reach;
             ++it) {
            if (it->index == anchor.index) continue;
            const Eigen::Vector2d way = anchor.whiten * (it->shape.center - anchor.shape.center);
            if (way.norm() > kPairRatio * farthest_) continue;
            for (std::size_t i = 0; i < model_.holes(); ++i)
                for (std::size_t j = 0; j < model_.holes(); ++j)
                    if (i != j) try_pair(anchor, *it, i, j, way);
        }
    }

    void try_pair(const IdealRegion& anchor, const IdealRegion& second, std::size_t i,
                  std::size_t j, const Eigen::Vector2d& way) {
        const Eigen::Vector2d board =
            roots_[i].inverse() * (model_.hole(j).center - model_.hole(i).center);
        const double longer = way.norm() / board.norm();
        if (longer > kPairRatio || longer < 1.0 / kPairRatio) return;
        const double areas =
            second.shape.area / anchor.shape.area * (model_.hole(i).area / model_.hole(j).area);
        if (areas > kGuessAreaRatio || areas < 1.0 / kGuessAreaRatio) return;
        const double angle = std::atan2(way.y(), way.x()) - std::atan2(board.y(), board.x());
        const double doubt = 0.5 * (std::abs(std::log(longer)) / std::log(kPairRatio) +
                                    std::abs(std::log(areas)) / std::log(kGuessAreaRatio));
        try_map(anchor.root * turn_by(angle) * roots_[i].inverse(), anchor, i, doubt);
    }
    using Members = std::vector<const IdealRegion*>;  ///< by hole; null where none was seen

    /// `doubt` about a pair, 0 to 1.
    void try_map(const Eigen::Matrix2d& linear, const IdealRegion& anchor, std::size_t hole,
                 double doubt) {
        if (!model_.turns().is_upright(linear) || !not_from_the_side(linear)) return;
        const Homography map = affine_about(linear, model_.hole(hole).center, anchor.shape.center);
        Members all(model_.holes(), &anchor), whole = all;
        for (std::size_t k = 0; k < model_.holes(); ++k)
            if (k != hole) look_near(map, k, all[k], whole[k]);
        add_group(map, anchor, all, doubt);
        if (whole != all) add_group(map, anchor, whole, doubt);
    }

    void add_group(Homography map, const IdealRegion& anchor, const Members& members,
                   double doubt) {
        std::vector<int> key;
        int seen = 0;
        for (const IdealRegion* member : members) {
            key.push_back(member ? member->index : -1);
            seen += member ? 1 : 0;
        }
        result_.best_holes = std::max(result_.best_holes, seen);
        // One region's turn is told by its hull.
        const int least = model_.holes() == 1 ? 1 : std::max(2, min_holes_);
        if (seen < least || !known_.insert(std::move(key)).second) return;
        std::vector<Eigen::Vector2d> board, image;
        for (std::size_t k = 0; k < members.size(); ++k) {
            if (!members[k]) continue;
            board.push_back(model_.hole(k).center);
            image.push_back(members[k]->shape.center);
        }
        if (seen >= 3)
            if (const auto better = fit_affine(board, image)) map = *better;
        double misfit = 0.0;
        const double size = std::sqrt(anchor.shape.area);
        for (std::size_t k = 0; k < board.size(); ++k)
            misfit += (map_point(map, board[k]) - image[k]).squaredNorm();
        misfit = std::sqrt(misfit / seen) / size;
        if (misfit > kGuessMisfit) return;
        TemplateGuess guess = guess_at(map, model_, seen);
        guess.misfit = seen == 2 ? kGuessMisfit * doubt : misfit;
        if (seen >= 4) {
            guess.board = std::move(board);
            guess.image = std::move(image);
        }
        result_.guesses.push_back(std::move(guess));
    }

    std::vector<IdealRegion>::const_iterator from_row(double y) const {
        return std::lower_bound(
            regions_.begin(), regions_.end(), y,
            [](const IdealRegion& region, double row) { return region.shape.center.y() < row; });
    }

    /// The region that lies most nearly where the map puts a hole, and the one of those that look
    /// whole; null where there is none.
    void look_near(const Homography& map, std::size_t hole, const IdealRegion*& any,
                   const IdealRegion*& whole) const {
        const Eigen::Vector2d expected = map_point(map, model_.hole(hole).center);
        const double area =
            model_.hole(hole).area * std::abs(map.topLeftCorner<2, 2>().determinant());
        const double size = std::sqrt(area);
        any = whole = nullptr;
        double best = std::numeric_limits<double>::max(), best_whole = best;
        for (auto it = from_row(expected.y() - kGuessReach * size);
             it != regions_.end() && it->shape.center.y() <= expected.y() + kGuessReach * size;
             ++it) {
            const double distance = (it->shape.center - expected).norm() / size;
            if (distance > kGuessReach) continue;
            const double ratio = std::max(it->shape.area / area, area / it->shape.area);
            if (ratio > kGuessAreaRatio) continue;
            const double cost = distance + std::log(ratio);
            if (cost < best) {
                best = cost;
                any = &*it;
            }
            if (cost < best_whole && distance < kWholeReach && ratio < kWholeAreaRatio) {
                best_whole = cost;
                whole = &*it;
            }
        }
    }

    const TemplateModel& model_;
    std::vector<IdealRegion> regions_;
    int min_holes_;
    std::vector<Eigen::Matrix2d> roots_;
    double farthest_ = 0.0;  ///< of two holes, in spreads of the first
    std::set<std::vector<int>> known_;
    GuessSearch result_;
};

}  // namespace

TemplateGuess guess_at(const Homography& map, const TemplateModel& model, int holes_seen) {
    TemplateGuess guess;
    guess.map = map;
    guess.holes_seen = holes_seen;
    guess.board = model.target().outline;
    for (const auto& p : guess.board) guess.image.push_back(map_point(map, p));
    return guess;
}

GuessSearch guess_boards(const RegionSearch& regions, const TemplateModel& model,
                         const CameraModel& camera, int min_holes,
                         const std::function<void()>& check) {
    const std::vector<IdealRegion> holes = ideal_regions(regions.holes, camera);
    Guesser guesser(model, holes, min_holes);
    guesser.group(check);
    GuessSearch search = guesser.take();
    std::stable_sort(
        search.guesses.begin(), search.guesses.end(), [](const auto& a, const auto& b) {
            return a.holes_seen != b.holes_seen ? a.holes_seen > b.holes_seen : a.misfit < b.misfit;
        });
    const auto by_hull = [&](const IdealRegion& region, const std::vector<ImageRegion>& all,
                             auto guess, std::vector<TemplateGuess>& guesses) {
        std::vector<Eigen::Vector2d> hull;
        for (const auto& p : all[static_cast<std::size_t>(region.index)].hull)
            if (const auto ideal = camera.undistort(p)) hull.push_back(*ideal);
        if (hull.size() >= 3) guess(region, hull, model, guesses);
    };
    if (min_holes == 1 && model.holes() > 1)
        for (const IdealRegion& hole : holes)
            by_hull(hole, regions.holes, guess_by_hole, search.guesses);
    // Plates are few, and say more than holes that may belong to anything.
    std::vector<TemplateGuess> plates;
    for (const IdealRegion& plate : ideal_regions(regions.plates, camera))
        by_hull(plate, regions.plates, guess_by_plate, plates);
    search.guesses.insert(search.guesses.begin(), plates.begin(), plates.end());
    return search;
}

std::vector<Eigen::Isometry3d> guess_poses(const TemplateGuess& guess, const CameraModel& camera) {
    std::vector<cv::Point3d> board;
    std::vector<cv::Point2d> image;
    for (std::size_t i = 0; i < guess.board.size(); ++i) {
        board.emplace_back(guess.board[i].x(), guess.board[i].y(), 0.0);
        image.emplace_back((guess.image[i].x() - camera.cx()) / camera.fx(),
                           (guess.image[i].y() - camera.cy()) / camera.fy());
    }
    std::vector<cv::Mat> turns, places;
    try {
        cv::solvePnPGeneric(board, image, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), turns, places,
                            false, cv::SOLVEPNP_IPPE);
    } catch (const cv::Exception&) {
        return {};  // points that no pose has, as all on one line
    }
    std::vector<Eigen::Isometry3d> poses;
    for (std::size_t i = 0; i < turns.size(); ++i) {
        cv::Mat rotation;
        cv::Rodrigues(turns[i], rotation);
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 3; ++c) pose.linear()(r, c) = rotation.at<double>(r, c);
            pose.translation()(r) = places[i].at<double>(r);
        }
        // The front faces the camera: the board's z runs away from it.
        const bool front = pose.linear().col(2).dot(pose.translation()) > 0.0;
        if (pose.matrix().allFinite() && pose.translation().z() > 0.0 && front)
            poses.push_back(pose);
    }
    return poses;
}

}  // namespace petal
