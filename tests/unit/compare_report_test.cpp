// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "browser.hpp"
#include "petal/output.hpp"
#include "report.hpp"
#include "unit_store.hpp"

namespace petal::compare {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const std::string kWild = "</script><img src=x>";

/// A reference, a variant that is better but for one failure, and two values of a swept parameter.
struct ReportCase {
    Comparison comparison;
    std::vector<UnitOutcome> outcomes;

    ReportCase() {
        comparison.name = "case " + kWild;
        comparison.about = "about " + kWild;
        for (const std::string& name :
             {"old " + kWild, std::string("new"), std::string("a.b=1"), std::string("a.b=2")}) {
            Variant variant;
            variant.name = name;
            if (name.rfind("a.b=", 0) == 0) variant.swept = SweepPoint{"a.b", name.substr(4)};
            comparison.variants.push_back(variant);
        }
        comparison.data.push_back({});
        comparison.data.back().name = "hall " + kWild;
        for (std::uint64_t seed = 1; seed <= 8; ++seed) comparison.seeds.push_back(seed);
        MetricSpec metric;
        metric.name = "error/px " + kWild;
        metric.unit = "px";
        metric.better = Direction::lower;
        metric.margin = 0.01;
        comparison.metrics.push_back(metric);
        for (std::size_t v = 0; v < comparison.variants.size(); ++v)
            for (const std::uint64_t seed : comparison.seeds) {
                UnitOutcome outcome;
                outcome.variant = v;
                outcome.seed = seed;
                outcome.key = std::to_string(v) + "-" + std::to_string(seed);
                outcome.values[metric.name] =
                    1.0 - 0.25 * static_cast<double>(v) + 0.01 * static_cast<double>(seed);
                if (v == 1 && seed == 3) {
                    outcome.values.clear();
                    outcome.failure = "error";
                    outcome.reason = "no board " + kWild;
                }
                outcomes.push_back(outcome);
            }
    }

    std::string document() const {
        return compare_json(comparison, Plan{}, make_figures(comparison, outcomes), outcomes);
    }
    std::string page(const UnitPictures& pictures = {}) const {
        return report_html(comparison, make_figures(comparison, outcomes), outcomes, document(),
                           pictures);
    }
};

TEST(CompareReport, HoldsTheDocumentAndItsNumbersStandThere) {
    const ReportCase one;
    const std::string page = one.page();
    const std::size_t begin = page.find('>', page.find("id=\"data\"")) + 1;
    const json document = json::parse(page.substr(begin, page.find("</script>", begin) - begin));
    EXPECT_EQ(document, json::parse(one.document()));
    const std::string name = document["metrics"][0]["name"];
    const json& median = document["metrics"][0]["variants"]["new"]["median"]["value"];
    EXPECT_THAT(page, HasSubstr("<data value=\"" + median.dump() +
                                "\" data-from=\"/metrics/0/variants/new/median/value\">"));
    EXPECT_THAT(page, HasSubstr("data-from=\"/metrics/0/variants/new/to_reference/p_holm\""));
    EXPECT_THAT(page, HasSubstr("data-from=\"/sweeps/a.b/1/median/error~1px &lt;"));
    for (const char* const part : {"Median differences", "Distribution", "Sensitivity to a.b"})
        EXPECT_THAT(page, HasSubstr(part));
    EXPECT_TRUE(page == one.page()) << "the same input, the same bytes";
}

TEST(CompareReport, TextsAreEscaped) {
    const std::string page = ReportCase().page();
    EXPECT_THAT(page, Not(HasSubstr("<img src=x>")));
    for (const char* const text :
         {"case &lt;", "about &lt;", "old &lt;", "hall &lt;", "no board &lt;", "error/px &lt;"})
        EXPECT_THAT(page, HasSubstr(text));
}

TEST(CompareReport, AFailureHasItsReasonAndPictureAndALargePictureIsLinked) {
    const ReportCase one;
    UnitPictures pictures;
    pictures["1-3"] = {{"units/1-3/pictures/a.png", {'P', 'N', 'G'}},
                       {"units/1-3/pictures/b.jpg", std::vector<unsigned char>(5000000)}};
    const std::string page = one.page(pictures);
    EXPECT_THAT(page, HasSubstr("data-from=\"/failed_units/0/reason\">no board"));
    EXPECT_THAT(page, HasSubstr("src=\"data:image/png;base64,UE5H\""));
    EXPECT_THAT(page, HasSubstr("<a href=\"units/1-3/pictures/b.jpg\">"));
    EXPECT_LT(page.size(), 200000U);
}

TEST(CompareReport, OpensInABrowserWithoutComplaint) {
    if (petal::testing::Browser::program().empty())
        GTEST_SKIP() << "no chromium: scripts/install_packages.sh packages-checks.txt";
    std::string folder = (std::filesystem::temp_directory_path() / "petal-report-XXXXXX").string();
    ASSERT_NE(::mkdtemp(folder.data()), nullptr);
    const std::filesystem::path file = std::filesystem::path(folder) / "report.html";
    write_file(file, ReportCase().page());
    petal::testing::Browser browser;
    browser.open(file);
    for (const int width : {1400, 500}) {
        browser.call(
            "Emulation.setDeviceMetricsOverride",
            {{"width", width}, {"height", 900}, {"deviceScaleFactor", 1}, {"mobile", false}});
        EXPECT_LE(browser.evaluate("document.documentElement.scrollWidth"), width);
    }
    EXPECT_GT(browser.evaluate("document.querySelectorAll('data[data-from][title]').length"), 30)
        << "each number tells its place when pointed at";
    EXPECT_EQ(browser.evaluate("document.querySelectorAll('svg.plot').length"), 3 + 1);
    EXPECT_THAT(browser.complaints(), IsEmpty());
    std::filesystem::remove_all(folder);
}

TEST(CompareReport, PicturesLieBesideTheUnit) {
    std::string folder = (std::filesystem::temp_directory_path() / "petal-report-XXXXXX").string();
    ASSERT_NE(::mkdtemp(folder.data()), nullptr);
    const UnitStore store(folder);
    UnitRecord record;
    record.key = "k";
    record.status = "error";
    record.pictures = {{"b.png", "2"}, {"a.png", "1"}};
    store.store(record);
    const auto found = store.pictures("k");
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].filename(), "a.png");
    EXPECT_THAT(store.pictures("other"), IsEmpty());
    std::string damage;
    const auto loaded = store.load("k", damage);
    EXPECT_TRUE(loaded && loaded->pictures.empty()) << "they are not loaded with the record";
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace petal::compare
