// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "petal/calibration/plane_fit.hpp"

namespace petal {
namespace {

constexpr double kCellShare = 0.1;                         ///< of the board's lesser side
constexpr double kLeastCell = 0.02, kGreatestCell = 0.06;  ///< m
constexpr double kToleranceShare = 0.5;                    ///< of a cell: off the plane
constexpr int kSearchLeastPoints = 2;                      ///< of a cell
constexpr int kLeastSeedPoints = 100;                      ///< around a seed: fewer fix no board
constexpr int kTriples = 40;
constexpr int kSettlings = 6;
constexpr int kMostCovered = 2;     ///< patches that a cell may seed or belong to
constexpr double kSeedReach = 0.8;  ///< of the plate's radius
constexpr double kRingWidth = 0.3;  ///< of the plate's radius
constexpr double kLeastFilled = 0.45, kMostFilled = 1.9, kMostAround = 0.5;
constexpr double kSamePlate = 0.4;  ///< of the plate's radius
constexpr double kSameNormal = 0.9;

}  // namespace

PlateSearch::PlateSearch(const Cloud& cloud, const PlateShape& shape)
    : cell_size_(std::clamp(kCellShare * shape.least_side(), kLeastCell, kGreatestCell)),
      tolerance_(kToleranceShare * cell_size_),
      plate_radius_(shape.radius()),
      plate_area_(shape.plate_area()),
      cells_(gather_cells(cloud, cell_size_, kSearchLeastPoints)) {
    sort_into_blocks();
}

void PlateSearch::sort_into_blocks() {
    const float scale = static_cast<float>(1.0 / plate_radius_);
    std::vector<std::pair<Key, std::uint32_t>> order;
    order.reserve(cells_.size());
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const Eigen::Vector3i at = (scale * cells_[i].mean).array().floor().matrix().cast<int>();
        order.emplace_back(cell_key(at), static_cast<std::uint32_t>(i));
    }
    std::sort(order.begin(), order.end());
    std::vector<PlateCell> sorted;
    sorted.reserve(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i == 0 || order[i].first != order[i - 1].first)
            blocks_[order[i].first].first = static_cast<std::uint32_t>(i);
        blocks_[order[i].first].second = static_cast<std::uint32_t>(i + 1);
        sorted.push_back(cells_[order[i].second]);
    }
    cells_ = std::move(sorted);
}

void PlateSearch::collect(const Eigen::Vector3d& centre, double radius,
                          std::vector<std::uint32_t>& found) const {
    found.clear();
    const Eigen::Vector3i low =
        ((centre.array() - radius) / plate_radius_).floor().matrix().cast<int>();
    const Eigen::Vector3i high =
        ((centre.array() + radius) / plate_radius_).floor().matrix().cast<int>();
    const float limit = static_cast<float>(radius * radius);
    const Eigen::Vector3f middle = centre.cast<float>();
    for (int x = low.x(); x <= high.x(); ++x)
        for (int y = low.y(); y <= high.y(); ++y)
            for (int z = low.z(); z <= high.z(); ++z) {
                const auto block = blocks_.find(cell_key({x, y, z}));
                if (block == blocks_.end()) continue;
                for (std::uint32_t i = block->second.first; i < block->second.second; ++i)
                    if ((cells_[i].mean - middle).squaredNorm() <= limit) found.push_back(i);
            }
}

/// Moves to the middle of what lies in the plane nearby, and fits the plane to it. False where
/// there is no plane.
bool PlateSearch::settle(PlateCandidate& plate) const {
    std::vector<std::uint32_t> near;
    for (int step = 0; step < kSettlings; ++step) {
        collect(plate.centre, plate_radius_, near);
        PlaneFitter fitter;
        for (const std::uint32_t i : near) {
            const Eigen::Vector3d p = cells_[i].mean.cast<double>();
            if (std::abs(plate.normal.dot(p - plate.centre)) <= tolerance_) fitter.add(p);
        }
        const std::optional<PlaneFit> fit = fitter.fit();
        if (!fit) return false;
        const double moved = (fit->centroid - plate.centre).norm();
        plate.centre = fit->centroid;
        plate.normal = fit->normal;
        if (step >= 2 && moved < 0.1 * cell_size_) break;
    }
    return true;
}

/// How much of the plate and of a ring around it is there, by squares of the plane.
void PlateSearch::measure(PlateCandidate& plate) const {
    const double outer = plate_radius_ * (1.0 + kRingWidth) + cell_size_;
    std::vector<std::uint32_t> near;
    collect(plate.centre, outer, near);
    const Eigen::Matrix3d axes = plane_frame(plate.normal, plate.centre).linear();
    const int half = static_cast<int>(std::ceil(outer / cell_size_));
    const int size = 2 * half + 1;
    std::vector<char> taken(static_cast<std::size_t>(size * size), 0);
    int inside = 0, ring = 0;
    for (const std::uint32_t i : near) {
        const Eigen::Vector3d q = axes.transpose() * (cells_[i].mean.cast<double>() - plate.centre);
        if (std::abs(q.z()) > tolerance_) continue;
        const int column = static_cast<int>(std::floor(q.x() / cell_size_ + 0.5)) + half;
        const int row = static_cast<int>(std::floor(q.y() / cell_size_ + 0.5)) + half;
        if (column < 0 || row < 0 || column >= size || row >= size) continue;
        char& one = taken[static_cast<std::size_t>(row) * static_cast<std::size_t>(size) +
                          static_cast<std::size_t>(column)];
        if (one != 0) continue;
        one = 1;
        const double radius = q.head<2>().norm();
        if (radius <= plate_radius_ + 0.5 * cell_size_)
            ++inside;
        else if (radius <= plate_radius_ * (1.0 + kRingWidth) + 0.5 * cell_size_)
            ++ring;
    }
    const double square = cell_size_ * cell_size_;
    const double a = plate_radius_ + 0.5 * cell_size_, b = a + plate_radius_ * kRingWidth;
    plate.filled = inside * square / plate_area_;
    plate.around = ring * square / (M_PI * (b * b - a * a));
    plate.closeness = std::min(plate.filled, 1.0) - plate.around;
}

void PlateSearch::keep(const PlateCandidate& plate) {
    if (plate.filled < kLeastFilled || plate.filled > kMostFilled || plate.around > kMostAround) {
        if (plate.closeness > nearest_miss_.closeness) nearest_miss_ = plate;
        return;
    }
    for (PlateCandidate& other : plates_) {
        if ((other.centre - plate.centre).norm() > kSamePlate * plate_radius_ ||
            std::abs(other.normal.dot(plate.normal)) < kSameNormal)
            continue;
        if (plate.closeness > other.closeness) other = plate;
        return;
    }
    plates_.push_back(plate);
}

void PlateSearch::try_patch(const Eigen::Vector3d& centre, const Eigen::Vector3d& normal) {
    PlateCandidate plate;
    plate.centre = centre;
    plate.normal = normal;
    if (!settle(plate)) return;
    measure(plate);
    keep(plate);
}

std::vector<PlateCandidate> PlateSearch::find(Rng& rng, const std::function<void()>& poll) {
    std::vector<std::uint32_t> seeds;
    for (std::size_t i = 0; i < cells_.size(); ++i) seeds.push_back(static_cast<std::uint32_t>(i));
    for (std::size_t i = seeds.size(); i > 1; --i)
        std::swap(seeds[i - 1], seeds[static_cast<std::size_t>(rng() % i)]);
    const double reach = kSeedReach * plate_radius_;
    const double least_cells = kLeastFilled * plate_area_ / (cell_size_ * cell_size_) / 3.0;
    std::vector<std::uint32_t> near;
    std::vector<int> covered(cells_.size(), 0);
    for (const std::uint32_t seed : seeds) {
        if (covered[seed] >= kMostCovered) continue;
        poll();
        covered[seed] = kMostCovered;
        const Eigen::Vector3d at = cells_[seed].mean.cast<double>();
        collect(at, reach, near);
        if (static_cast<double>(near.size()) < least_cells) continue;
        int points = 0;
        for (const std::uint32_t i : near) points += cells_[i].count;
        if (points < kLeastSeedPoints) continue;
        // The plane that holds the seed and most of the cells around it.
        Eigen::Vector3d best_normal = Eigen::Vector3d::Zero();
        std::size_t best = 0;
        for (int triple = 0; triple < kTriples; ++triple) {
            const auto drawn = [&] {
                return Eigen::Vector3d(cells_[near[static_cast<std::size_t>(rng() % near.size())]]
                                           .mean.cast<double>() -
                                       at);
            };
            const Eigen::Vector3d first = drawn(), second = drawn();
            const Eigen::Vector3d cross = first.cross(second);
            if (cross.norm() < 0.1 * reach * reach) continue;
            const Eigen::Vector3d normal = cross.normalized();
            const Eigen::Vector3f n = normal.cast<float>();
            const float off = static_cast<float>(normal.dot(at));
            const float limit = static_cast<float>(tolerance_);
            std::size_t count = 0;
            for (const std::uint32_t i : near)
                if (std::abs(n.dot(cells_[i].mean) - off) <= limit) ++count;
            if (count > best) {
                best = count;
                best_normal = normal;
            }
        }
        if (static_cast<double>(best) < least_cells) continue;
        for (const std::uint32_t i : near)
            if (std::abs(best_normal.dot(cells_[i].mean.cast<double>() - at)) <= tolerance_)
                ++covered[i];
        try_patch(at, best_normal);
    }
    std::stable_sort(
        plates_.begin(), plates_.end(),
        [](const PlateCandidate& a, const PlateCandidate& b) { return a.closeness > b.closeness; });
    return plates_;
}

}  // namespace petal
