// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/report.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "report_samples.hpp"
#include "sinks/result.hpp"

namespace petal {
namespace {

using nlohmann::json;
using report_samples::Sample;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::StageHarness;

std::string file_text(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::string page_of(StageHarness& sink) {
    sink.fire();
    return file_text(sink.folder() / "report.html");
}

/// The JSON in the script of that id.
json script_json(const std::string& page, const std::string& id) {
    const std::size_t begin = page.find('>', page.find("id=\"" + id + "\"")) + 1;
    return json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

/// The page without its scripts.
std::string markup_of(std::string page) {
    for (std::size_t begin = page.find("<script"); begin != std::string::npos;
         begin = page.find("<script"))
        page.erase(begin, page.find("</script>", begin) + 9 - begin);
    return page;
}

TEST(ReportTest, HoldsTheSameDocumentAsTheResult) {
    const Sample sample;
    StageHarness report = sample.harness();
    const json document = script_json(page_of(report), "data");
    StageHarness result = StageHarness::of<ResultSink>();
    result.give<Extrinsics>("extrinsics", sample.extrinsics);
    EXPECT_EQ(document["verdict"], "weak");
    EXPECT_EQ(document["reasons"].size(), 2U) << "the solver's and the finding's, once";
    EXPECT_EQ(document["scenes"].size(), 2U);
    // What depends on the extrinsics alone is the same, to the bit, as what sink.result writes.
    result.fire();
    const json alone = json::parse(file_text(result.folder() / "result.json"));
    EXPECT_EQ(document["extrinsics"], alone["extrinsics"]);
    EXPECT_EQ(document["residuals"]["u_px"], alone["residuals"]["u_px"]);
    EXPECT_FALSE(report.verdict()) << "sink.result tells the run, once";
}

TEST(ReportTest, EveryNumberStandsInTheDocumentWhereItSays) {
    const Sample sample;
    StageHarness report = sample.harness();
    const std::string page = page_of(report);
    const json document = script_json(page, "data");
    const std::string begin = "<data value=\"";
    const std::string middle = "\" data-from=\"";
    std::size_t numbers = 0;
    for (std::size_t at = page.find(begin); at != std::string::npos;
         at = page.find(begin, at + 1)) {
        const std::size_t value = at + begin.size();
        const std::size_t value_end = page.find('"', value);
        if (page.compare(value_end, middle.size(), middle) != 0) continue;  // a count
        const std::size_t from = value_end + middle.size();
        const std::string place = page.substr(from, page.find('"', from) - from);
        if (place.find('&') != std::string::npos) continue;  // hostile keys: in the browser
        ASSERT_TRUE(document.contains(json::json_pointer(place))) << place;
        EXPECT_EQ(document.at(json::json_pointer(place)),
                  json::parse(page.substr(value, value_end - value)))
            << place;
        ++numbers;
    }
    EXPECT_GT(numbers, 70U) << "two matrices alone have 32";
    EXPECT_THAT(page, HasSubstr("data-from=\"/extrinsics/0/T_lidar_camera/2/3\""));
    EXPECT_THAT(page, HasSubstr("data-scale=\"1000\">2.20</data>")) << "sigma of t_y in mm";
    EXPECT_THAT(page, HasSubstr("data-from=\"/extrinsics/0/considered/sigma_rotation_deg/1\""));
}

TEST(ReportTest, TextsFromFilesAreEscaped) {
    const Sample sample;
    StageHarness report = sample.harness();
    const std::string page = page_of(report);
    EXPECT_THAT(page, Not(HasSubstr("<img src=x")));
    EXPECT_THAT(page, Not(HasSubstr("<b>")));
    const std::string markup = markup_of(page);
    EXPECT_THAT(markup, HasSubstr("hall &lt;/script&gt;&lt;img src=x onerror=&quot;"));
    for (const char* const what : {"two boards only &lt;", "the board moved &lt;", "FRONT &lt;",
                                   "LIDAR &lt;", "odd/na~me_px&lt;"})
        EXPECT_THAT(markup, HasSubstr(what));
}

TEST(ReportTest, AsksForNothingFromOutside) {
    const Sample sample;
    StageHarness report = sample.harness();
    const std::string markup = markup_of(page_of(report));
    std::size_t pictures = 0;
    // By hand: a regular expression would go one call deeper with each byte of a picture.
    for (const std::string attribute : {" src=\"", " href=\"", " srcset=\"", " action=\""})
        for (std::size_t at = markup.find(attribute); at != std::string::npos;
             at = markup.find(attribute, at + 1)) {
            const std::string target = markup.substr(at + attribute.size(), 30);
            EXPECT_TRUE(target.rfind("data:", 0) == 0 || target.front() == '#') << target;
            if (target.rfind("data:image/jpeg;base64,", 0) == 0) ++pictures;
        }
    EXPECT_EQ(pictures, 2U * 2U + 2U) << "two photos and one enlarged board a scene";
}

TEST(ReportTest, ShowsAsManyPointsAsAskedForAndSaysOfHowMany) {
    const Sample sample;
    StageHarness report = sample.harness();
    report.set("view_points", 1000);
    const std::string page = page_of(report);
    const json view = script_json(page, "view-data");
    EXPECT_EQ(view["shown"], 1000);
    EXPECT_EQ(view["of"], 4 * 81 * 61);
    ASSERT_EQ(view["scenes"].size(), 2U);
    for (const json& scene : view["scenes"]) {
        EXPECT_EQ(scene["shown"], 500);
        EXPECT_GT(scene["seen"], 250) << "the plate, and what it does not hide of the wall";
        EXPECT_LT(scene["seen"], 500) << "the plate hides a part of the wall";
        EXPECT_EQ(scene["points"].get<std::string>().size(), 500U * 8U) << "6 bytes in base64";
        EXPECT_EQ(scene["colours"].get<std::string>().size(), 500U * 4U);
    }
    EXPECT_THAT(page, HasSubstr("data-view=\"/shown\">1\u202f000</data>"));
}

TEST(ReportTest, TheSameInputAndSeedGiveTheSameBytes) {
    const Sample sample;
    const auto fired = [&sample](std::uint64_t seed, int threads) {
        StageHarness report = sample.harness();
        report.set("view_points", 500).seed(seed).threads(threads);
        return page_of(report);
    };
    const std::string first = fired(7, 1);
    EXPECT_TRUE(first == fired(7, 4));
    EXPECT_FALSE(first == fired(8, 1)) << "other points are drawn";
}

TEST(ReportTest, WithoutAPoseItSaysWhyAndShowsWhatWasFound) {
    Sample sample;
    sample.extrinsics = Extrinsics{};
    sample.extrinsics.reasons = {"nothing to solve"};
    StageHarness report = sample.harness();
    const std::string markup = markup_of(page_of(report));
    EXPECT_THAT(markup, HasSubstr("<span class=\"badge bad\">Not usable</span>"));
    EXPECT_THAT(markup, HasSubstr("<span data-from=\"/reasons/0\">nothing to solve</span>"));
    EXPECT_THAT(markup, HasSubstr("No camera was solved"));
    EXPECT_THAT(markup, HasSubstr("notes of <code>run.json</code>"));
    EXPECT_THAT(markup, Not(HasSubstr("orders fit alike"))) << "there was nothing to order";
    EXPECT_THAT(markup, HasSubstr("no pose of this camera, so only what it found itself"));
    EXPECT_THAT(markup, HasSubstr("data:image/jpeg"));
}

TEST(ReportTest, NeedsTheExtrinsicsAlone) {
    StageHarness report = StageHarness::of<Report>();
    report.give<Extrinsics>("extrinsics", Sample().extrinsics);
    const std::string page = page_of(report);
    EXPECT_THAT(page, HasSubstr("No photo was wired"));
    EXPECT_THAT(page, Not(HasSubstr("id=\"view3d\"")));
    EXPECT_LT(page.size(), 200000U) << "without the 3D view there is no three.js in it";
}

TEST(ReportTest, BoardsOfOneSensorAreCounted) {
    const Sample sample;
    StageHarness report = sample.harness();
    const std::string page = page_of(report);
    EXPECT_THAT(page,
                HasSubstr("<data value=\"1\" data-count=\"lidar\" data-of=\"/scenes/1/boards\">"));
    EXPECT_THAT(page,
                HasSubstr("<data value=\"0\" data-count=\"lidar\" data-of=\"/scenes/0/boards\">"));
    EXPECT_THAT(page,
                HasSubstr("<data value=\"1\" data-count=\"both\" data-of=\"/scenes/1/boards\">"));
}

}  // namespace
}  // namespace petal
