// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_template_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "detectors/detail/image_wall_prior.hpp"

namespace petal {

namespace {

constexpr Eigen::Index kUnknowns = 12;  ///< pose, inset, hole walls, outset, plate walls
using Vector12d = Eigen::Matrix<double, kUnknowns, 1>;
using Matrix12d = Eigen::Matrix<double, kUnknowns, kUnknowns>;

/// Neighbouring samples share pixels: they count as half as many independent ones.
constexpr double kSamplesShare = 2.0;
constexpr double kTurnPrior = 0.3;    ///< rad, 1 sigma of one step; keeps weak views in reach
constexpr double kInsetSigma = 5e-4;  ///< m: how holes are cut
/// Of a hole: sides that scatter more about a first fit are no board's.
constexpr double kFarOff = 0.12;
constexpr double kPriorSides = 2.0;  ///< `tolerance` counts as so many sides
constexpr double kCauchy = 2.4;
constexpr double kSettled = 0.05;  ///< of a sigma
constexpr int kMostPasses = 12;

double median_value(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// How far an edge moves over a wall's width, 0 to 1 where the wall is between plate and what lies
/// behind in brightness: (wall - behind) / (plate - behind).
struct WallShare {
    double mean = 0.5, sigma = 0.5;
};

WallShare wall_share(double edge, double plate, bool outline) {
    const double contrast = std::clamp(edge / std::max(plate, 1.0), 0.05, 1.0);
    const double darker = (1.0 - kWallBrightness) / contrast;
    // What lies behind the outline may be brighter than the plate, too.
    if (outline) return {0.5, std::hypot(darker, kWallBrightnessSigma / contrast)};
    return {1.0 - darker, kWallBrightnessSigma / contrast};
}

/// The median edge of the outline, grey levels; 0 for none.
double outline_strength(const FittedBoard& board) {
    std::vector<double> strengths;
    for (const EdgeSample& sample : board.samples)
        if (sample.outline && sample.seen) strengths.push_back(sample.strength);
    return median_value(strengths);
}

/// px outwards by each of the unknowns.
Vector12d design_of(const EdgeSample& sample) {
    Vector12d row = Vector12d::Zero();
    row.head<6>() = sample.by_pose.transpose();
    const Eigen::Index own = sample.outline ? 9 : 6;
    row(own) = sample.outline ? sample.px_per_m : -sample.px_per_m;
    row.segment<2>(own + 1) = sample.px_per_m * sample.wall * sample.outwards.cwiseAbs2();
    return row;
}

/// The samples of one side, and what they share.
struct SideEffect {
    Eigen::Matrix2d own =
        Eigen::Matrix2d::Zero();  ///< information of (offset, tilt) by its samples
    Eigen::Matrix<double, 2, kUnknowns> cross = Eigen::Matrix<double, 2, kUnknowns>::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    Eigen::Vector2d effect = Eigen::Vector2d::Zero();  ///< px: offset and tilt
    double px_per_m = 0.0;
    double widened = 1.0;  ///< of its prior's variance, where it disagrees
    int samples = 0;
    bool outline = false;
};

}  // namespace

FittedBoard TemplateFit::coarse(const TemplatePose& guess) const {
    FittedBoard board;
    board.pose = guess;
    board.plate_grey = plate_grey(guess);
    for (const double in_holes : {0.35, 0.3, 0.2}) {
        const EdgeReach reach{in_holes, 2.5, 14.0, 5, false};
        board.samples = sample_edges(edges_, model_, camera_, board.pose, board.shifts, reach);
        if (!solve(board, 1.0, 4)) return board;
        if (board.hole_scatter > kFarOff * model_.hole_size()) return board;
    }
    const EdgeReach last{0.12, 2.0, 4.0, 5, false};
    board.samples = sample_edges(edges_, model_, camera_, board.pose, board.shifts, last);
    count(board, last);
    board.converged = true;
    return board;
}

FittedBoard TemplateFit::fine(const FittedBoard& coarse) const {
    FittedBoard board;
    board.pose = coarse.pose;
    board.shifts = coarse.shifts;
    board.plate_grey = plate_grey(coarse.pose);
    const EdgeReach wide{0.15, 2.0, 5.0, 12, true}, narrow{0.12, 1.5, 3.0, 40, true},
        last{0.12, 1.5, 3.0, 80, true};
    const auto pass = [&](const EdgeReach& reach) {
        board.samples = sample_edges(edges_, model_, camera_, board.pose, board.shifts, reach);
        return solve(board, kSamplesShare, 8);
    };
    if (!pass(wide)) return board;
    // Where walls show, a shift of the board, smaller holes and brighter walls look much alike, and
    // sides get their weights back slowly on the way from one to the other.
    int passes = 0;
    do {
        if (!pass(narrow)) return board;
    } while (board.last_step > kSettled && ++passes < kMostPasses);
    if (!pass(last)) return board;
    board.samples = sample_edges(edges_, model_, camera_, board.pose, board.shifts, last);
    count(board, last);
    board.converged = true;
    return board;
}

bool TemplateFit::solve(FittedBoard& board, double pixels_share, int rounds) const {
    std::vector<double> strengths, scales;
    for (const EdgeSample& sample : board.samples) {
        if (!sample.seen || sample.outline) continue;
        strengths.push_back(sample.strength);
        scales.push_back(sample.px_per_m);
    }
    if (strengths.size() < 12) return false;
    board.usual_strength = median_value(strengths);
    const double scale = median_value(scales);
    Vector12d expected = Vector12d::Zero(), weight = Vector12d::Zero();
    weight.segment<3>(3).setConstant(1.0 / (kTurnPrior * kTurnPrior));
    const double inset = std::hypot(kInsetSigma, kInsetSigmaPx / scale);
    for (const Eigen::Index own : {6, 9}) {
        const WallShare share = wall_share(
            own == 6 ? board.usual_strength : outline_strength(board), board.plate_grey, own == 9);
        weight(own) = 1.0 / (inset * inset);
        weight.segment<2>(own + 1).setConstant(
            limits_.model_walls ? 1.0 / (share.sigma * share.sigma) : 1e12);
        expected.segment<2>(own + 1).setConstant(limits_.model_walls ? share.mean : 0.0);
    }

    const std::size_t count = board.samples.size();
    std::vector<double> sigma(count), left(count, 0.0), robust(count, 1.0);
    for (std::size_t i = 0; i < count; ++i)
        sigma[i] = edge_sigma(noise_, board.samples[i].strength);
    std::vector<SideEffect> effects(model_.sides().size());
    double hole_scatter = std::max(board.hole_scatter, limits_.tolerance);
    double outline_scatter = std::max(board.outline_scatter, 2.0 * limits_.tolerance);
    double unit = 1.0;  // of the sigmas
    Vector12d solution = expected;
    Matrix12d information;
    for (int round = 0; round < rounds; ++round) {
        for (SideEffect& side : effects) {
            const double widened = side.widened;
            side = {};
            side.widened = widened;
        }
        information = weight.asDiagonal();
        Vector12d right = weight.cwiseProduct(expected);
        for (std::size_t i = 0; i < count; ++i) {
            const EdgeSample& sample = board.samples[i];
            if (!sample.seen || sample.strength < kLeastEdgeShare * board.usual_strength) continue;
            SideEffect& side = effects[sample.side];
            const Vector12d row = design_of(sample);
            const double w = robust[i] / (pixels_share * unit * unit * sigma[i] * sigma[i]);
            const Eigen::Vector2d shared(1.0, sample.u);
            information += w * row * row.transpose();
            right += w * sample.offset * row;
            side.own += w * shared * shared.transpose();
            side.cross += w * shared * row.transpose();
            side.right += w * sample.offset * shared;
            side.px_per_m += sample.px_per_m;
            side.outline = sample.outline;
            ++side.samples;
        }
        std::vector<Eigen::Matrix2d> reduced(effects.size());
        for (std::size_t s = 0; s < effects.size(); ++s) {
            SideEffect& side = effects[s];
            if (side.samples == 0) continue;
            side.px_per_m /= side.samples;
            const double scatter = (side.outline ? outline_scatter : hole_scatter) * side.px_per_m;
            Eigen::Matrix2d own = side.own;
            own(0, 0) += 1.0 / (side.widened * scatter * scatter);
            own(1, 1) += 3.0 / (side.widened * scatter * scatter);
            reduced[s] = own.inverse();
            information -= side.cross.transpose() * reduced[s] * side.cross;
            right -= side.cross.transpose() * reduced[s] * side.right;
        }
        const Eigen::LDLT<Matrix12d> solver(information);
        if (solver.info() != Eigen::Success) return false;
        solution = solver.solve(right);
        if (!solution.allFinite()) return false;

        std::vector<double> holes, outline, normalised;
        for (std::size_t s = 0; s < effects.size(); ++s) {
            SideEffect& side = effects[s];
            if (side.samples == 0) continue;
            side.effect = reduced[s] * (side.right - side.cross * solution);
            // Of its own samples alone, not drawn to the geometry.
            const double off =
                (side.right(0) - side.cross.row(0).dot(solution)) / side.own(0, 0) / side.px_per_m;
            (side.outline ? outline : holes).push_back(std::abs(off));
            const double usual = kCauchy * (side.outline ? outline_scatter : hole_scatter);
            side.widened = 1.0 + off * off / (usual * usual);
        }
        for (std::size_t i = 0; i < count; ++i) {
            const EdgeSample& sample = board.samples[i];
            if (!sample.seen || sample.strength < kLeastEdgeShare * board.usual_strength) continue;
            const Eigen::Vector2d& effect = effects[sample.side].effect;
            left[i] =
                sample.offset - design_of(sample).dot(solution) - effect(0) - sample.u * effect(1);
            normalised.push_back(std::abs(left[i]) / sigma[i]);
        }
        unit = std::max(1.4826 * median_value(normalised), 0.3);
        for (std::size_t i = 0; i < count; ++i) {
            const double ratio = left[i] / (kCauchy * unit * sigma[i]);
            robust[i] = 1.0 / (1.0 + ratio * ratio);
        }
        const auto scatter_of = [](const std::vector<double>& off, double prior) {
            const double own = 1.4826 * median_value(off);
            const double n = static_cast<double>(off.size());
            return std::sqrt((kPriorSides * prior * prior + n * own * own) / (kPriorSides + n));
        };
        hole_scatter = scatter_of(holes, limits_.tolerance);
        outline_scatter = scatter_of(outline, 2.0 * limits_.tolerance);
    }
    board.hole_scatter = hole_scatter;
    board.outline_scatter = outline_scatter;
    board.sample_sigma_px = unit * edge_sigma(noise_, board.usual_strength);
    board.shifts.inset = solution(6);
    board.shifts.hole_wall = {solution(7), solution(8)};
    board.shifts.outset = solution(9);
    board.shifts.plate_wall = {solution(10), solution(11)};
    board.sides.assign(effects.size(), {});
    for (std::size_t s = 0; s < effects.size(); ++s)
        board.sides[s].measured = effects[s].samples > 0 && effects[s].widened < 2.0;
    board.covariance = information.inverse().topLeftCorner<6, 6>();
    const Eigen::Matrix<double, 6, 1> step = solution.head<6>();
    board.last_step = std::sqrt(std::max(0.0, step.dot(board.covariance.llt().solve(step))));
    board.pose.step(model_, solution.head<6>());
    const Eigen::Isometry3d& pose = board.pose.T_camera_board;
    const double towards = pose.linear().col(2).dot(pose.translation().normalized());
    return solution.head<6>().norm() < 10.0 && pose.translation().z() > 0.0 && towards > 0.1;
}

double TemplateFit::plate_grey(const TemplatePose& pose) const {
    std::vector<double> greys;
    for (std::size_t i = 0; i < model_.plate_points().size(); i += 4) {
        const auto seen = pose.see(model_, camera_, model_.plate_points()[i]);
        if (const auto grey = seen ? edges_.grey(seen->pixel) : std::nullopt)
            greys.push_back(*grey);
    }
    return median_value(greys);
}

}  // namespace petal
