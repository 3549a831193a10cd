// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_template_search.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "detectors/detail/image_binaries.hpp"
#include "detectors/detail/image_template_guesses.hpp"
#include "detectors/detail/image_template_look.hpp"
#include "detectors/detail/image_template_regions.hpp"
#include "detectors/detail/image_template_twin.hpp"
#include "detectors/image_template.hpp"
#include "petal/error.hpp"

namespace petal {

namespace {

/// Guesses looked at, the likeliest first, and fits begun; far more than there can be boards.
constexpr std::size_t kMostGuesses = 1500;
constexpr int kMostFits = 150;
/// What PlaceLook says of a guess that is glanced at.
constexpr double kLeastLook = 0.25;
/// What a hole that was seen adds to a glance's figure. It decides between places that look alike,
/// no more: four parts of holes, or four bricks, are worth less than two whole holes.
constexpr double kHoleSeen = 0.05;
/// A coarse fit with fewer edges in place is not worth a fine one.
constexpr double kCoarseInPlace = 0.15;
constexpr std::size_t kMostRejected = 30;

/// The same place, turned so that the board stands upright in the image as nearly as can be.
void set_upright(FittedBoard& fit, const TemplateModel& model, const CameraModel& camera) {
    const auto seen = fit.pose.see(model, camera, model.center());
    if (!seen) return;
    for (const Homography& turn : model.turns().all()) {
        if (!model.turns().is_upright(seen->by_board * turn.topLeftCorner<2, 2>())) continue;
        Eigen::Isometry3d by = Eigen::Isometry3d::Identity();
        by.linear().topLeftCorner<2, 2>() = turn.topLeftCorner<2, 2>();
        by.translation().head<2>() = turn.topRightCorner<2, 1>();
        fit.pose.T_camera_board = fit.pose.T_camera_board * by;
        return;
    }
}

class BoardSearch {
   public:
    BoardSearch(const cv::Mat& grey, const TemplateModel& model, const CameraModel& camera,
                const ImageTemplateParams& params)
        : model_(model),
          camera_(camera),
          params_(params),
          noise_(image_noise(grey)),
          edges_(grey),
          fit_(edges_, model, camera, noise_, params) {}

    /// A place to fit a board at.
    struct Attempt {
        TemplatePose pose;
        int holes_seen = 0;
        double score = 0.0;
    };

    /// The likeliest first.
    std::vector<Attempt> attempts(const GuessSearch& search,
                                  const std::function<void()>& check) const {
        std::vector<Attempt> all;
        for (const TemplateGuess* guess : worth_a_glance(search.guesses, check)) {
            check();
            // A plate counts as all its holes.
            const double seen =
                guess->holes_seen > 0 ? guess->holes_seen : static_cast<double>(model_.holes());
            for (const Eigen::Isometry3d& pose : guess_poses(*guess, camera_)) {
                const double look = glance({pose}, edges_, model_, camera_, noise_, params_);
                if (look > 0.0) all.push_back({{pose}, guess->holes_seen, look + kHoleSeen * seen});
            }
        }
        std::stable_sort(all.begin(), all.end(),
                         [](const Attempt& a, const Attempt& b) { return a.score > b.score; });
        return all;
    }

    void try_at(const Attempt& attempt, TemplateSearch& search) const {
        const auto place = attempt.pose.see(model_, camera_, model_.center());
        if (!place || known(place->pixel, search) || ++search.fits > kMostFits) return;
        const FittedBoard coarse = fit_.coarse(attempt.pose);
        if (!coarse.converged || fit_.holes_in_place(coarse) < kCoarseInPlace) return;
        TemplateBoard board;
        board.fit = fit_.fine(coarse);
        board.verdict = judge_board(board.fit, edges_, model_, camera_, noise_, params_);
        const auto seen = board.fit.pose.see(model_, camera_, model_.center());
        if (!seen) return;
        board.middle = seen->pixel;
        board.size_px =
            0.5 * model_.target().width() * std::sqrt(std::abs(seen->by_board.determinant()));
        board.holes_seen = attempt.holes_seen;
        if (!board.verdict.rejected.empty()) {
            reject(board, search);
            return;
        }
        if (known(board.middle, search)) return;
        consider_other_tilt(board);
        set_upright(board.fit, model_, camera_);
        search.boards.push_back(std::move(board));
    }

   private:
    /// Before walls of bricks many thousand groups lie as holes do, some better than those of the
    /// board; the image between them tells.
    std::vector<const TemplateGuess*> worth_a_glance(const std::vector<TemplateGuess>& guesses,
                                                     const std::function<void()>& check) const {
        const PlaceLook place(edges_, model_, camera_, noise_);
        std::vector<std::pair<double, const TemplateGuess*>> looks;
        for (std::size_t i = 0; i < guesses.size(); ++i) {
            if (i % 256 == 0) check();
            const double look = place.at(guesses[i].map);
            if (look > kLeastLook) looks.emplace_back(look, &guesses[i]);
        }
        std::stable_sort(looks.begin(), looks.end(),
                         [](const auto& a, const auto& b) { return a.first > b.first; });
        std::vector<const TemplateGuess*> worth;
        for (std::size_t i = 0; i < std::min(looks.size(), kMostGuesses); ++i)
            worth.push_back(looks[i].second);
        return worth;
    }

    void consider_other_tilt(TemplateBoard& board) const {
        const FittedBoard coarse = fit_.coarse(mirrored(board.fit.pose, model_));
        if (!coarse.converged) return;
        const FittedBoard other = fit_.fine(coarse);
        if (!other.converged) return;
        const TemplateVerdict verdict =
            judge_board(other, edges_, model_, camera_, noise_, params_);
        if (!verdict.rejected.empty()) return;
        board.fit = of_two_tilts(board.fit, other, model_);
    }

    static bool known(const Eigen::Vector2d& place, const TemplateSearch& search) {
        return std::any_of(search.boards.begin(), search.boards.end(), [&](const auto& board) {
            return (board.middle - place).norm() < board.size_px;
        });
    }

    void reject(const TemplateBoard& board, TemplateSearch& search) const {
        if (search.rejected.size() >= kMostRejected) return;
        RejectedGroup group;
        group.reason = board.verdict.rejected;
        const double x = model_.target().width(), y = model_.target().height();
        const std::array<Eigen::Vector2d, 4> box{{{0.0, 0.0}, {x, 0.0}, {x, y}, {0.0, y}}};
        for (std::size_t i = 0; i < 4; ++i) {
            const auto seen = board.fit.pose.see(model_, camera_, box[i]);
            group.outline[i] = seen ? seen->pixel : board.middle;
        }
        search.rejected.push_back(std::move(group));
    }

    const TemplateModel& model_;
    const CameraModel& camera_;
    const ImageTemplateParams& params_;
    double noise_;
    EdgeSampler edges_;
    TemplateFit fit_;
};

/// A parallelogram of the region's moments, to be drawn.
std::array<Eigen::Vector2d, 4> drawn_region(const TemplateShape& shape) {
    const Eigen::Matrix2d root =
        std::sqrt(3.0) *
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(shape.spread).operatorSqrt();
    const Eigen::Vector2d a = root.col(0), b = root.col(1);
    return {
        {shape.center - a - b, shape.center + a - b, shape.center + a + b, shape.center - a + b}};
}

}  // namespace

TemplateSearch search_boards(const cv::Mat& grey, const TemplateModel& model,
                             const CameraModel& camera, const ImageTemplateParams& params,
                             const std::function<void()>& check) {
    TemplateSearch search;
    const RegionSearch regions = find_regions(grey, model, params.levels, check);
    search.borders = regions.borders;
    for (const ImageRegion& region : regions.holes)
        search.regions.push_back(drawn_region(region.shape));
    if (grey.cols < 8 || grey.rows < 8) return search;
    const GuessSearch guesses = guess_boards(regions, model, camera, params.min_holes, check);
    search.best_holes = guesses.best_holes;
    const BoardSearch boards(grey, model, camera, params);
    search.guesses = static_cast<int>(guesses.guesses.size());
    for (const auto& attempt : boards.attempts(guesses, check)) {
        check();
        boards.try_at(attempt, search);
    }
    std::stable_sort(search.boards.begin(), search.boards.end(), [](const auto& a, const auto& b) {
        return a.middle.x() != b.middle.x() ? a.middle.x() < b.middle.x()
                                            : a.middle.y() < b.middle.y();
    });
    return search;
}

ImageBoard to_packet(const TemplateBoard& found, const TemplateModel& model,
                     const CameraModel& camera, const std::string& label, double floor_px) {
    ImageBoard board;
    board.target = model.target().name;
    board.camera = label;
    const auto size = static_cast<Eigen::Index>(2 * model.corners().size());
    Eigen::MatrixXd carry(size, 6);
    Eigen::Index row = 0;
    for (const auto& corner : model.corners()) {
        const auto seen = found.fit.pose.see(model, camera, corner);
        if (!seen) throw Error("image_template: a corner of a fitted board cannot be seen");
        board.corners.push_back(seen->pixel);
        carry.middleRows<2>(row) = seen->by_pose;
        row += 2;
    }
    const Matrix6d of_floor = (carry.transpose() * carry).inverse();
    const Matrix6d of_pose = found.fit.covariance + floor_px * floor_px * of_floor;
    const Eigen::MatrixXd joint = carry * of_pose * carry.transpose();
    board.joint_covariance = 0.5 * (joint + joint.transpose());
    double variance = 0.0;
    for (Eigen::Index i = 0; i < size; i += 2) {
        board.covariance.push_back(board.joint_covariance.block<2, 2>(i, i));
        variance += board.covariance.back().trace() / static_cast<double>(size);
    }
    int measured = 0;
    for (const FittedSide& side : found.fit.sides) measured += side.measured ? 1 : 0;
    board.quality["holes_seen"] = found.holes_seen;
    board.quality["sides_measured"] = measured;
    board.quality["edges_in_place"] = found.verdict.edges;
    board.quality["outline_in_place"] = found.verdict.outline;
    board.quality["plate_even"] = found.verdict.plate;
    board.quality["contrast"] = found.verdict.contrast;
    board.quality["edge_sigma_px"] = found.fit.sample_sigma_px;
    board.quality["hole_scatter_m"] = found.fit.hole_scatter;
    board.quality["outline_scatter_m"] = found.fit.outline_scatter;
    board.quality["hole_inset_m"] = found.fit.shifts.inset;
    board.quality["mean_sigma_px"] = std::sqrt(variance);
    return board;
}

}  // namespace petal
