// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_template_solve.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "detectors/detail/image_wall_prior.hpp"
#include "detectors/detail/median_value.hpp"

namespace petal {

namespace {

constexpr Eigen::Index kUnknowns = 12;  ///< pose, inset, hole walls, outset, plate walls
using Vector12d = Eigen::Matrix<double, kUnknowns, 1>;
using Matrix12d = Eigen::Matrix<double, kUnknowns, kUnknowns>;

constexpr double kTurnPrior = 0.3;    ///< rad, 1 sigma of one step; keeps weak views in reach
constexpr double kInsetSigma = 5e-4;  ///< m: how holes are cut
constexpr double kPriorSides = 2.0;   ///< `tolerance` counts as so many sides
constexpr double kCauchy = 2.4;
constexpr std::size_t kSolveLeastSamples = 12;
constexpr double kMostFaint = 3.0;  ///< or strong: more is not the wall's doing

WallShare wall_share(double edge, double plate, bool outline) {
    const WallShare share = expected_wall_share(std::clamp(edge / std::max(plate, 1.0), 0.05, 1.0));
    // What lies behind the outline may be brighter than the plate, too.
    return outline ? WallShare{0.5, std::hypot(1.0 - share.mean, share.sigma)} : share;
}

/// The median edge of the outline, grey levels; 0 for none.
double outline_strength(const FittedBoard& board) {
    std::vector<double> strengths;
    for (const EdgeSample& sample : board.samples)
        if (sample.outline && sample.seen) strengths.push_back(sample.strength);
    return median_value(strengths);
}

/// px outwards by each of the unknowns, and what does not depend on them.
struct Design {
    Vector12d row = Vector12d::Zero();
    double known = 0.0;
};

Design design_of(const EdgeSample& sample, const EdgeShifts& shifts) {
    Design design;
    design.row.head<6>() = sample.by_pose.transpose();
    const Eigen::Index own = sample.outline ? 9 : 6;
    const double faint = sample.outline ? 1.0 : shifts.faintness_of(sample.side);
    design.row(own) = sample.outline ? sample.px_per_m : -sample.px_per_m;
    design.row.segment<2>(own + 1) =
        faint * sample.px_per_m * sample.wall * sample.outwards.cwiseAbs2();
    design.known = (1.0 - faint) * sample.px_per_m * sample.wall;
    return design;
}

/// Of offsets of sides, robust, with what is known before.
double scatter_of(const std::vector<double>& off, double prior) {
    const double own = 1.4826 * median_value(off);
    const double n = static_cast<double>(off.size());
    return std::sqrt((kPriorSides * prior * prior + n * own * own) / (kPriorSides + n));
}

/// The samples of one side, and what they share.
struct SideEffect {
    Eigen::Matrix2d own =
        Eigen::Matrix2d::Zero();  ///< information of (offset, tilt) by its samples
    Eigen::Matrix<double, 2, kUnknowns> cross = Eigen::Matrix<double, 2, kUnknowns>::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    Eigen::Matrix2d reduced = Eigen::Matrix2d::Zero();  ///< covariance of (offset, tilt)
    Eigen::Vector2d effect = Eigen::Vector2d::Zero();   ///< px: offset and tilt
    double px_per_m = 0.0;
    double widened = 1.0;  ///< of its prior's variance, where it disagrees
    int samples = 0;
    bool outline = false;
};

class TemplateSolve {
   public:
    TemplateSolve(const TemplateModel& model, const TemplateFitLimits& limits, double noise,
                  const SolveSettings& settings, FittedBoard& board)
        : model_(model),
          limits_(limits),
          noise_(noise),
          settings_(settings),
          board_(board),
          effects_(model.sides().size()),
          robust_(board.samples.size(), 1.0),
          hole_scatter_(std::max(board.hole_scatter, limits.tolerance)),
          outline_scatter_(std::max(board.outline_scatter, 2.0 * limits.tolerance)) {
        for (const EdgeSample& sample : board.samples)
            sigma_.push_back(edge_sigma(noise, sample.strength));
    }

    bool solve() {
        if (!expect()) return false;
        if (settings_.go_on) start_from_before();
        for (int round = 0; round < settings_.rounds; ++round) {
            add_up();
            if (!step()) return false;
            weigh_sides();
            weigh_samples();
        }
        return keep();
    }

   private:
    bool takes_part(const EdgeSample& sample) const {
        return sample.seen && sample.strength >= kLeastEdgeShare * board_.usual_strength;
    }
    /// px: of a sample's offset, what the unknowns do not explain.
    double left_of(const EdgeSample& sample) const {
        const Design design = design_of(sample, board_.shifts);
        return sample.offset - design.known - design.row.dot(solution_);
    }
    double& scatter(const SideEffect& side) {
        return side.outline ? outline_scatter_ : hole_scatter_;
    }

    /// What is known before the samples; false where they are too few.
    bool expect() {
        std::vector<double> strengths, scales;
        for (const EdgeSample& sample : board_.samples) {
            if (!sample.seen || sample.outline) continue;
            strengths.push_back(sample.strength);
            scales.push_back(sample.px_per_m);
        }
        if (strengths.size() < kSolveLeastSamples) return false;
        board_.usual_strength = median_value(strengths);
        measure_faintness();
        weight_.segment<3>(3).setConstant(1.0 / (kTurnPrior * kTurnPrior));
        const double inset = std::hypot(kInsetSigma, kInsetSigmaPx / median_value(scales));
        for (const Eigen::Index own : {6, 9}) {
            const WallShare share =
                wall_share(own == 6 ? board_.usual_strength : outline_strength(board_),
                           board_.plate_grey, own == 9);
            weight_(own) = 1.0 / (inset * inset);
            weight_.segment<2>(own + 1).setConstant(
                limits_.model_walls ? 1.0 / (share.sigma * share.sigma) : 1e12);
            expected_.segment<2>(own + 1).setConstant(limits_.model_walls ? share.mean : 0.0);
        }
        return true;
    }

    void measure_faintness() {
        std::vector<std::vector<double>> strengths(effects_.size());
        for (const EdgeSample& sample : board_.samples)
            if (takes_part(sample)) strengths[sample.side].push_back(sample.strength);
        board_.shifts.faintness.assign(effects_.size(), 1.0);
        if (!limits_.model_walls) return;
        for (std::size_t s = 0; s < effects_.size(); ++s)
            if (!strengths[s].empty())
                board_.shifts.faintness[s] =
                    std::clamp(board_.usual_strength / median_value(strengths[s]), 1.0 / kMostFaint,
                               kMostFaint);
    }

    /// Weights by what the board is already known to be. A pass that began with all weights alike
    /// would be drawn to sides that were found to be off, and may end there.
    void start_from_before() {
        const EdgeShifts& shifts = board_.shifts;
        solution_.tail<6>() << shifts.inset, shifts.hole_wall[0], shifts.hole_wall[1],
            shifts.outset, shifts.plate_wall[0], shifts.plate_wall[1];
        std::vector<std::vector<double>> off(effects_.size());
        for (const EdgeSample& sample : board_.samples) {
            if (!takes_part(sample)) continue;
            SideEffect& side = effects_[sample.side];
            off[sample.side].push_back(left_of(sample));
            side.px_per_m += sample.px_per_m;
            side.outline = sample.outline;
        }
        for (std::size_t s = 0; s < effects_.size(); ++s) {
            if (off[s].empty()) continue;
            effects_[s].effect(0) = median_value(off[s]);
            effects_[s].px_per_m /= static_cast<double>(off[s].size());
            widen(effects_[s], effects_[s].effect(0) / effects_[s].px_per_m);
        }
        weigh_samples();
    }

    /// The normal equations, without what the samples of each side share.
    void add_up() {
        for (SideEffect& side : effects_) {
            const double widened = side.widened;
            side = {};
            side.widened = widened;
        }
        information_ = weight_.asDiagonal();
        right_ = weight_.cwiseProduct(expected_);
        for (std::size_t i = 0; i < board_.samples.size(); ++i) {
            const EdgeSample& sample = board_.samples[i];
            if (!takes_part(sample)) continue;
            SideEffect& side = effects_[sample.side];
            const auto [row, known] = design_of(sample, board_.shifts);
            const double offset = sample.offset - known;
            const double sigma = unit_ * sigma_[i];
            const double w = robust_[i] / (settings_.pixels_share * sigma * sigma);
            const Eigen::Vector2d shared(1.0, sample.u);
            information_ += w * row * row.transpose();
            right_ += w * offset * row;
            side.own += w * shared * shared.transpose();
            side.cross += w * shared * row.transpose();
            side.right += w * offset * shared;
            side.px_per_m += sample.px_per_m;
            side.outline = sample.outline;
            ++side.samples;
        }
        for (SideEffect& side : effects_) {
            if (side.samples == 0) continue;
            side.px_per_m /= side.samples;
            const double shared = scatter(side) * side.px_per_m;
            Eigen::Matrix2d own = side.own;
            own(0, 0) += 1.0 / (side.widened * shared * shared);
            own(1, 1) += 3.0 / (side.widened * shared * shared);
            side.reduced = own.inverse();
            information_ -= side.cross.transpose() * side.reduced * side.cross;
            right_ -= side.cross.transpose() * side.reduced * side.right;
        }
    }

    bool step() {
        const Eigen::LDLT<Matrix12d> solver(information_);
        if (solver.info() != Eigen::Success) return false;
        solution_ = solver.solve(right_);
        return solution_.allFinite();
    }

    void widen(SideEffect& side, double off) {
        const double usual = kCauchy * scatter(side);
        side.widened = 1.0 + off * off / (usual * usual);
    }

    void weigh_sides() {
        std::vector<double> holes, outline;
        for (SideEffect& side : effects_) {
            if (side.samples == 0) continue;
            side.effect = side.reduced * (side.right - side.cross * solution_);
            // Of its own samples alone, not drawn to the geometry.
            const double off =
                (side.right(0) - side.cross.row(0).dot(solution_)) / side.own(0, 0) / side.px_per_m;
            (side.outline ? outline : holes).push_back(std::abs(off));
            widen(side, off);
        }
        hole_scatter_ = scatter_of(holes, limits_.tolerance);
        outline_scatter_ = scatter_of(outline, 2.0 * limits_.tolerance);
    }

    void weigh_samples() {
        std::vector<double> left(board_.samples.size(), 0.0), normalised;
        for (std::size_t i = 0; i < left.size(); ++i) {
            const EdgeSample& sample = board_.samples[i];
            if (!takes_part(sample)) continue;
            const Eigen::Vector2d& effect = effects_[sample.side].effect;
            left[i] = left_of(sample) - effect(0) - sample.u * effect(1);
            normalised.push_back(std::abs(left[i]) / sigma_[i]);
        }
        unit_ = std::max(1.4826 * median_value(normalised), 0.3);
        for (std::size_t i = 0; i < left.size(); ++i) {
            const double ratio = left[i] / (kCauchy * unit_ * sigma_[i]);
            robust_[i] = 1.0 / (1.0 + ratio * ratio);
        }
    }

    /// False where the pose is no board's.
    bool keep() {
        board_.hole_scatter = hole_scatter_;
        board_.outline_scatter = outline_scatter_;
        board_.sample_sigma_px = unit_ * edge_sigma(noise_, board_.usual_strength);
        board_.shifts.inset = solution_(6);
        board_.shifts.hole_wall = {solution_(7), solution_(8)};
        board_.shifts.outset = solution_(9);
        board_.shifts.plate_wall = {solution_(10), solution_(11)};
        board_.sides.assign(effects_.size(), {});
        for (std::size_t s = 0; s < effects_.size(); ++s)
            board_.sides[s].measured = effects_[s].samples > 0 && effects_[s].widened < 2.0;
        board_.covariance = information_.inverse().topLeftCorner<6, 6>();
        const Eigen::Matrix<double, 6, 1> step = solution_.head<6>();
        board_.last_step = std::sqrt(std::max(0.0, step.dot(board_.covariance.llt().solve(step))));
        board_.pose.step(model_, step);
        const Eigen::Isometry3d& pose = board_.pose.T_camera_board;
        const double towards = pose.linear().col(2).dot(pose.translation().normalized());
        return step.norm() < 10.0 && pose.translation().z() > 0.0 && towards > 0.1;
    }

    const TemplateModel& model_;
    const TemplateFitLimits& limits_;
    double noise_;
    SolveSettings settings_;
    FittedBoard& board_;
    std::vector<SideEffect> effects_;
    std::vector<double> sigma_, robust_;  ///< of each sample
    double hole_scatter_, outline_scatter_;
    double unit_ = 1.0;  ///< of the sigmas
    Vector12d expected_ = Vector12d::Zero(), weight_ = Vector12d::Zero();
    Vector12d right_ = Vector12d::Zero(), solution_ = Vector12d::Zero();
    Matrix12d information_ = Matrix12d::Zero();
};

}  // namespace

bool solve_template(const TemplateModel& model, const TemplateFitLimits& limits, double noise,
                    const SolveSettings& settings, FittedBoard& board) {
    return TemplateSolve(model, limits, noise, settings, board).solve();
}

}  // namespace petal
