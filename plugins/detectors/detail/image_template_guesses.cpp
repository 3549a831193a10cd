// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_template_guesses.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <set>

#include "detectors/detail/image_layout.hpp"
#include "petal/calibration/angles.hpp"
#include "petal/calibration/polygon.hpp"

namespace petal {

namespace {

/// A hole may lie this far from where the first two put it, in hole sizes: perspective moves it.
constexpr double kGuessReach = 0.5;
/// Areas differ by perspective and by what shows through a hole.
constexpr double kGuessAreaRatio = 2.2;
constexpr double kPairRatio = 1.45;  ///< the same for the distance of two holes
constexpr double kGuessMisfit = 0.2;
/// cos 75 deg: boards nearer to edge on are not looked for.
constexpr double kLeastForeshortening = 0.26;

/// The symmetric root of a spread, which must be positive definite.
Eigen::Matrix2d root_of(const Eigen::Matrix2d& spread) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).operatorSqrt();
}

struct IdealRegion {
    TemplateShape shape;  ///< ideal pixels
    Eigen::Matrix2d root, whiten;
    int index = 0;
};

/// The regions as an ideal pinhole would see them; those that it cannot see are left out.
std::vector<IdealRegion> ideal_regions(const std::vector<ImageRegion>& regions,
                                       const CameraModel& camera) {
    std::vector<IdealRegion> ideal;
    for (std::size_t i = 0; i < regions.size(); ++i) {
        const TemplateShape& raw = regions[i].shape;
        const auto here = camera.undistort(raw.center);
        const auto right = camera.undistort(raw.center + Eigen::Vector2d(0.5, 0.0));
        const auto down = camera.undistort(raw.center + Eigen::Vector2d(0.0, 0.5));
        if (!here || !right || !down) continue;
        Eigen::Matrix2d j;
        j << 2.0 * (*right - *here), 2.0 * (*down - *here);
        IdealRegion region;
        region.shape = {*here, j * raw.spread * j.transpose(),
                        raw.area * std::abs(j.determinant())};
        region.root = root_of(region.shape.spread);
        if (!(std::abs(region.root.determinant()) > 1e-9)) continue;
        region.whiten = region.root.inverse();
        region.index = static_cast<int>(i);
        ideal.push_back(region);
    }
    std::stable_sort(ideal.begin(), ideal.end(), [](const auto& a, const auto& b) {
        return a.shape.center.y() < b.shape.center.y();
    });
    return ideal;
}

Eigen::Matrix2d turn_by(double angle) {
    return Eigen::Rotation2Dd(angle).toRotationMatrix();
}

Homography affine_about(const Eigen::Matrix2d& linear, const Eigen::Vector2d& board,
                        const Eigen::Vector2d& image) {
    Homography h = Homography::Identity();
    h.topLeftCorner<2, 2>() = linear;
    h.topRightCorner<2, 1>() = image - linear * board;
    return h;
}

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
    /// `doubt` about a pair, 0 to 1.
    void try_map(const Eigen::Matrix2d& linear, const IdealRegion& anchor, std::size_t hole,
                 double doubt) {
        if (!model_.turns().is_upright(linear)) return;
        const Eigen::Vector2d stretch = linear.jacobiSvd().singularValues();
        if (stretch(1) < kLeastForeshortening * stretch(0)) return;
        Homography map = affine_about(linear, model_.hole(hole).center, anchor.shape.center);
        std::vector<int> members(model_.holes(), -1);
        std::vector<Eigen::Vector2d> board, image;
        for (std::size_t k = 0; k < model_.holes(); ++k) {
            const IdealRegion* seen = k == hole ? &anchor : nearest(map, k);
            if (!seen) continue;
            members[k] = seen->index;
            board.push_back(model_.hole(k).center);
            image.push_back(seen->shape.center);
        }
        const auto seen = static_cast<int>(board.size());
        result_.best_holes = std::max(result_.best_holes, seen);
        if (seen < min_holes_ || !known_.insert(members).second) return;
        if (seen >= 3)
            if (const auto better = fit_affine(board, image)) map = *better;
        TemplateGuess guess;
        guess.holes_seen = seen;
        const double size = std::sqrt(anchor.shape.area);
        for (std::size_t k = 0; k < board.size(); ++k)
            guess.misfit += (map_point(map, board[k]) - image[k]).squaredNorm();
        guess.misfit = std::sqrt(guess.misfit / seen) / size;
        if (guess.misfit > kGuessMisfit) return;
        if (seen == 2) guess.misfit = kGuessMisfit * doubt;
        if (seen < 4) {
            board = model_.target().outline;
            image.clear();
            for (const auto& p : board) image.push_back(map_point(map, p));
        }
        guess.board = std::move(board);
        guess.image = std::move(image);
        result_.guesses.push_back(std::move(guess));
    }

    std::vector<IdealRegion>::const_iterator from_row(double y) const {
        return std::lower_bound(
            regions_.begin(), regions_.end(), y,
            [](const IdealRegion& region, double row) { return region.shape.center.y() < row; });
    }

    const IdealRegion* nearest(const Homography& map, std::size_t hole) const {
        const Eigen::Vector2d expected = map_point(map, model_.hole(hole).center);
        const double area =
            model_.hole(hole).area * std::abs(map.topLeftCorner<2, 2>().determinant());
        const double size = std::sqrt(area);
        const IdealRegion* best = nullptr;
        double best_cost = std::numeric_limits<double>::max();
        for (auto it = from_row(expected.y() - kGuessReach * size);
             it != regions_.end() && it->shape.center.y() <= expected.y() + kGuessReach * size;
             ++it) {
            const double distance = (it->shape.center - expected).norm() / size;
            const double ratio = std::max(it->shape.area / area, area / it->shape.area);
            if (distance > kGuessReach || ratio > kGuessAreaRatio) continue;
            const double cost = distance + std::log(ratio);
            if (cost < best_cost) {
                best_cost = cost;
                best = &*it;
            }
        }
        return best;
    }

    const TemplateModel& model_;
    std::vector<IdealRegion> regions_;
    int min_holes_;
    std::vector<Eigen::Matrix2d> roots_;
    double farthest_ = 0.0;  ///< of two holes, in spreads of the first
    std::set<std::vector<int>> known_;
    GuessSearch result_;
};

/// A plate's moments leave its turn open: the turns that let the outline's corners lie on the hull.
void guess_plate(const IdealRegion& plate, const std::vector<Eigen::Vector2d>& hull,
                 const TemplateModel& model, std::vector<TemplateGuess>& guesses) {
    constexpr int kSteps = 60;        // in a full turn
    constexpr double kOffHull = 0.1;  // of the root of the plate's area
    const Eigen::Matrix2d unroot = root_of(model.plate().spread).inverse();
    std::vector<TemplateGuess> turned(kSteps);
    std::vector<double> off(kSteps, 0.0);
    for (std::size_t step = 0; step < kSteps; ++step) {
        const double angle = 2.0 * kPi * static_cast<double>(step) / kSteps;
        const Eigen::Matrix2d linear = plate.root * turn_by(angle) * unroot;
        const Homography map = affine_about(linear, model.plate().center, plate.shape.center);
        turned[step].board = model.target().outline;
        for (const auto& p : model.target().outline) {
            turned[step].image.push_back(map_point(map, p));
            off[step] += distance_to_polygon(hull, turned[step].image.back()) /
                         static_cast<double>(model.target().outline.size());
        }
        const Eigen::Vector2d stretch = linear.jacobiSvd().singularValues();
        if (!model.turns().is_upright(linear) || stretch(1) < kLeastForeshortening * stretch(0))
            turned[step].board.clear();
    }
    for (std::size_t step = 0; step < kSteps; ++step) {
        const double before = off[(step + kSteps - 1) % kSteps], after = off[(step + 1) % kSteps];
        if (!turned[step].board.empty() && off[step] < before && off[step] <= after &&
            off[step] < kOffHull * std::sqrt(plate.shape.area))
            guesses.push_back(std::move(turned[step]));
    }
}

}  // namespace

GuessSearch guess_boards(const RegionSearch& regions, const TemplateModel& model,
                         const CameraModel& camera, int min_holes,
                         const std::function<void()>& check) {
    Guesser guesser(model, ideal_regions(regions.holes, camera), min_holes);
    guesser.group(check);
    GuessSearch search = guesser.take();
    std::stable_sort(
        search.guesses.begin(), search.guesses.end(), [](const auto& a, const auto& b) {
            return a.holes_seen != b.holes_seen ? a.holes_seen > b.holes_seen : a.misfit < b.misfit;
        });
    // Plates are few, and say more than holes that may belong to anything.
    std::vector<TemplateGuess> plates;
    for (const IdealRegion& plate : ideal_regions(regions.plates, camera)) {
        std::vector<Eigen::Vector2d> hull;
        for (const auto& p : regions.plates[static_cast<std::size_t>(plate.index)].hull)
            if (const auto ideal = camera.undistort(p)) hull.push_back(*ideal);
        if (hull.size() >= 3) guess_plate(plate, hull, model, plates);
    }
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
