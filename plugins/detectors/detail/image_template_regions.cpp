// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_template_regions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "detectors/detail/image_binaries.hpp"

namespace petal {

namespace {

constexpr double kLeastHole = 20.0;    ///< px^2: below it a region has no shape
constexpr double kLeastPlate = 400.0;  ///< px^2
constexpr double kLargestHole = 0.1;   ///< of the image
constexpr double kLargestPlate = 0.7;  ///< of the image
/// A region's roundness over the hole's: small ones are traced to half a pixel, and something
/// bright may hide a part.
constexpr std::array<double, 2> kHoleRoundness{0.88, 1.3};
constexpr std::array<double, 2> kPlateRoundness{0.95, 1.12};

struct FoundRegion {
    ImageRegion region;
    std::vector<cv::Point> contour;
};

struct RegionKind {
    std::vector<double> roundness;  ///< of the shapes that are looked for
    std::array<double, 2> ratio{};
    double least_area = 0.0, most_area = 0.0;
    std::vector<FoundRegion> found = {};
};

bool region_before(const ImageRegion& a, const ImageRegion& b) {
    const auto key = [](const ImageRegion& r) {
        return std::array<double, 3>{r.shape.center.y(), r.shape.center.x(), r.shape.area};
    };
    return key(a) < key(b);
}

class RegionCollector {
   public:
    RegionCollector(const cv::Mat& grey, const TemplateModel& model) {
        const double pixels = static_cast<double>(grey.cols) * grey.rows;
        holes_ = {{}, kHoleRoundness, kLeastHole, kLargestHole * pixels};
        for (std::size_t i = 0; i < model.holes(); ++i)
            holes_.roundness.push_back(model.hole(i).roundness());
        plates_ = {
            {model.plate().roundness()}, kPlateRoundness, kLeastPlate, kLargestPlate * pixels};
    }

    void add(const cv::Mat& bright) {
        contours_.clear();
        cv::findContours(bright, contours_, hierarchy_, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
        for (std::size_t i = 0; i < contours_.size(); ++i)
            judge(contours_[i], hierarchy_[i][3] >= 0 ? holes_ : plates_);
    }

    RegionSearch take() const { return {merged(holes_), merged(plates_), borders_}; }

   private:
    void judge(std::vector<cv::Point>& contour, RegionKind& kind) {
        // A contour of n points encloses at most n^2 / (4 pi).
        const double points = static_cast<double>(contour.size());
        if (points < 8.0 || points * points < 6.0 * kind.least_area) return;
        const double area = cv::contourArea(contour);
        if (area < kind.least_area || area > kind.most_area) return;
        ++borders_;
        const cv::Moments m = cv::moments(contour);
        if (!(m.m00 > 0.0)) return;
        ImageRegion region;
        region.shape.center = {m.m10 / m.m00, m.m01 / m.m00};
        region.shape.area = m.m00;
        region.shape.spread << m.mu20 / m.m00, m.mu11 / m.m00, m.mu11 / m.m00, m.mu02 / m.m00;
        const double roundness = region.shape.roundness();
        const bool alike =
            std::any_of(kind.roundness.begin(), kind.roundness.end(), [&](double wanted) {
                return roundness > kind.ratio[0] * wanted && roundness < kind.ratio[1] * wanted;
            });
        if (alike) kind.found.push_back({std::move(region), std::move(contour)});
    }

    /// Versions of nearly the same place and size are one region: their mean.
    static std::vector<ImageRegion> merged(const RegionKind& kind) {
        std::vector<const FoundRegion*> order;
        for (const FoundRegion& found : kind.found) order.push_back(&found);
        std::stable_sort(order.begin(), order.end(), [](const auto* a, const auto* b) {
            return region_before(a->region, b->region);
        });
        std::vector<ImageRegion> kept;
        std::vector<cv::Point> hull;
        for (const FoundRegion* found : order) {
            const ImageRegion& region = found->region;
            const double side = std::sqrt(region.shape.area);
            ImageRegion* twin = nullptr;
            for (auto k = kept.rbegin(); k != kept.rend() && !twin; ++k) {
                // Sorted by rows: what is farther up is no twin. Means move by less than a side.
                if (k->shape.center.y() < region.shape.center.y() - 2.0 * side) break;
                const double ratio = k->shape.area / region.shape.area;
                if ((k->shape.center - region.shape.center).norm() < 0.12 * side && ratio > 0.75 &&
                    ratio < 1.0 / 0.75)
                    twin = &*k;
            }
            if (!twin) {
                kept.push_back(region);
                cv::convexHull(found->contour, hull);
                for (const cv::Point& p : hull) kept.back().hull.emplace_back(p.x, p.y);
                continue;
            }
            const double share = 1.0 / (twin->votes + 1.0);
            TemplateShape& mean = twin->shape;
            mean.center += share * (region.shape.center - mean.center);
            mean.spread += share * (region.shape.spread - mean.spread);
            mean.area += share * (region.shape.area - mean.area);
            ++twin->votes;
        }
        std::stable_sort(kept.begin(), kept.end(), region_before);
        return kept;
    }

    RegionKind holes_, plates_;
    int borders_ = 0;
    std::vector<std::vector<cv::Point>> contours_;
    std::vector<cv::Vec4i> hierarchy_;
};

}  // namespace

RegionSearch find_regions(const cv::Mat& grey, const TemplateModel& model, int levels,
                          const std::function<void()>& check) {
    RegionCollector collector(grey, model);
    if (grey.cols < 8 || grey.rows < 8) return {};
    const auto add = [&](const cv::Mat& bright) {
        if (check) check();
        collector.add(bright);
    };
    visit_binaries(grey, levels, add);
    visit_faint_binaries(grey, add);
    return collector.take();
}

}  // namespace petal
