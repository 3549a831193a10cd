// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_board_grouping.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace petal {

namespace {

/// A hole may lie this far from where one square's affine map expects it, in hole sides.
/// Perspective moves it by up to 0.3 at a tilt of 45 deg and a distance of two board widths; at 1.0
/// the plate begins.
constexpr double kReach = 0.5;
/// Squares of one board differ in area by perspective and by what shows through the hole.
constexpr double kMaxAreaRatio = 2.2;
/// RMS of the squares' corners about the homography, in hole sides. A hole of which a quarter is
/// hidden adds 0.06; contours are traced to half a pixel, 0.1 of the smallest hole.
constexpr double kMaxMisfit = 0.15;
/// cos 72 deg: boards nearer to edge on are not looked for.
constexpr double kMinForeshortening = 0.3;

struct IdealSquare {
    std::array<Eigen::Vector2d, 4> corners;
    Eigen::Vector2d center;
    double area = 0.0;
    int index = 0;
};

std::vector<IdealSquare> to_ideal(const std::vector<SquareCandidate>& squares,
                                  const CameraModel& camera) {
    std::vector<IdealSquare> ideal;
    for (std::size_t i = 0; i < squares.size(); ++i) {
        IdealSquare square;
        square.index = static_cast<int>(i);
        square.center.setZero();
        bool seen = true;
        for (std::size_t k = 0; k < 4 && seen; ++k) {
            const auto p = camera.undistort(squares[i].corners[k]);
            seen = p.has_value();
            if (seen) square.corners[k] = *p;
        }
        if (!seen) continue;
        for (std::size_t k = 0; k < 4; ++k) {
            const auto& a = square.corners[k];
            const auto& b = square.corners[(k + 1) % 4];
            square.center += 0.25 * a;
            square.area += 0.5 * (a.x() * b.y() - a.y() * b.x());
        }
        if (square.area > 0.0) ideal.push_back(square);
    }
    std::sort(ideal.begin(), ideal.end(), [](const auto& a, const auto& b) {
        return a.center.y() != b.center.y() ? a.center.y() < b.center.y() : a.index < b.index;
    });
    return ideal;
}

class Grouper {
   public:
    Grouper(std::vector<IdealSquare> squares, const HoleLayout& layout, int min_holes)
        : squares_(std::move(squares)), layout_(layout), min_holes_(min_holes) {}

    Grouping group() {
        for (const IdealSquare& anchor : squares_)
            for (std::size_t hole = 0; hole < layout_.holes(); ++hole)
                for (std::size_t turn = 0; turn < 4; ++turn) try_anchor(anchor, hole, turn);
        std::stable_sort(result_.hypotheses.begin(), result_.hypotheses.end(),
                         [](const auto& a, const auto& b) {
                             return a.holes_seen != b.holes_seen ? a.holes_seen > b.holes_seen
                                                                 : a.misfit < b.misfit;
                         });
        return std::move(result_);
    }

   private:
    void try_anchor(const IdealSquare& anchor, std::size_t hole, std::size_t turn) {
        const std::vector<Eigen::Vector2d>& board = layout_.hole(hole);
        std::vector<Eigen::Vector2d> image(4);
        for (std::size_t i = 0; i < 4; ++i) image[i] = anchor.corners[(i + turn) % 4];
        const auto affine = fit_affine(board, image);
        // Of the turns that leave the target as it is only the upright one is looked at.
        if (!affine || !layout_.is_upright(affine->topLeftCorner<2, 2>())) return;
        if (!layout_.plausible(*affine, kMinForeshortening)) return;

        const double side = std::sqrt(std::abs(anchor.area));
        BoardHypothesis found;
        found.squares.assign(layout_.holes(), -1);
        std::vector<const IdealSquare*> members(layout_.holes(), nullptr);
        members[hole] = &anchor;
        for (std::size_t other = 0; other < layout_.holes(); ++other) {
            if (other == hole) continue;
            members[other] =
                nearest(map_point(*affine, layout_.hole_center(other)), anchor.area, side);
        }
        for (std::size_t i = 0; i < members.size(); ++i) {
            if (!members[i]) continue;
            found.squares[i] = members[i]->index;
            ++found.holes_seen;
        }
        result_.best_holes = std::max(result_.best_holes, found.holes_seen);
        if (found.holes_seen < min_holes_ || !known_.insert(found.squares).second) return;
        if (fit(*affine, members, side, found)) result_.hypotheses.push_back(std::move(found));
    }

    const IdealSquare* nearest(const Eigen::Vector2d& expected, double area, double side) const {
        const double reach = kReach * side;
        auto it = std::lower_bound(
            squares_.begin(), squares_.end(), expected.y() - reach,
            [](const IdealSquare& square, double y) { return square.center.y() < y; });
        const IdealSquare* best = nullptr;
        double best_cost = 1e9;
        for (; it != squares_.end() && it->center.y() <= expected.y() + reach; ++it) {
            const double distance = (it->center - expected).norm();
            const double ratio = std::max(it->area / area, area / it->area);
            if (distance > reach || ratio > kMaxAreaRatio) continue;
            const double cost = distance / side + std::log(ratio);
            if (cost < best_cost) {
                best_cost = cost;
                best = &*it;
            }
        }
        return best;
    }

    bool fit(const Homography& affine, const std::vector<const IdealSquare*>& members, double side,
             BoardHypothesis& found) const {
        std::vector<Eigen::Vector2d> board, image;
        for (std::size_t i = 0; i < members.size(); ++i) {
            if (!members[i]) continue;
            // The square's corner that belongs to the hole's first is the one that the map expects
            // there.
            const Eigen::Vector2d arm = map_jacobian(affine, layout_.hole_center(i)) *
                                        (layout_.hole(i)[0] - layout_.hole_center(i));
            std::size_t first = 0;
            double best = 1e9;
            for (std::size_t k = 0; k < 4; ++k) {
                const double d = (members[i]->corners[k] - members[i]->center - arm).norm();
                if (d < best) {
                    best = d;
                    first = k;
                }
            }
            for (std::size_t k = 0; k < 4; ++k) {
                board.push_back(layout_.hole(i)[k]);
                image.push_back(members[i]->corners[(first + k) % 4]);
            }
        }
        const auto h = fit_homography(board, image);
        if (!h || !layout_.plausible(*h, kMinForeshortening)) return false;
        double sum = 0.0;
        for (std::size_t i = 0; i < board.size(); ++i)
            sum += (map_point(*h, board[i]) - image[i]).squaredNorm();
        found.misfit = std::sqrt(sum / static_cast<double>(board.size())) / side;
        found.board_to_image = *h;
        return found.misfit < kMaxMisfit;
    }

    std::vector<IdealSquare> squares_;
    const HoleLayout& layout_;
    int min_holes_;
    std::set<std::vector<int>> known_;
    Grouping result_;
};

}  // namespace

Grouping group_squares(const std::vector<SquareCandidate>& squares, const HoleLayout& layout,
                       const CameraModel& camera, int min_holes) {
    return Grouper(to_ideal(squares, camera), layout, min_holes).group();
}

}  // namespace petal
