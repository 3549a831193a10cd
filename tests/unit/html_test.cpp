// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include <limits>

#include "petal/html/escape.hpp"
#include "petal/html/page.hpp"
#include "petal/html/plots.hpp"
#include "petal/html/traced.hpp"

namespace petal::html {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::ordered_json;

const char* const kHostile = "<img src=x onerror=\"alert('1')\">&";
const char* const kTamed = "&lt;img src=x onerror=&quot;alert(&#39;1&#39;)&quot;&gt;&amp;";

TEST(HtmlEscape, NothingOfATextIsMarkup) {
    EXPECT_EQ(escape(kHostile), kTamed);
    EXPECT_EQ(escape("K\u00fcche \u2212 \U0001F300"), "K\u00fcche \u2212 \U0001F300");
    EXPECT_EQ(escape("a\tb\nc"), "a\tb\nc");
}

TEST(HtmlEscape, BytesThatAreNoTextAreReplaced) {
    EXPECT_EQ(escape("a\xFF"
                     "b"),
              "a\uFFFDb");
    EXPECT_EQ(escape("\xC3"), "\uFFFD") << "cut short";
    EXPECT_EQ(escape("\xC0\xAF"), "\uFFFD\uFFFD") << "overlong";
    EXPECT_EQ(escape("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD") << "a surrogate";
    EXPECT_EQ(escape("\x01"), "\uFFFD");
}

TEST(HtmlEscape, JsonCannotEndItsScriptAndStaysTheSameValue) {
    const Json json{{"name", "</script><!-- &"}};
    const std::string safe = json_for_script(json.dump());
    EXPECT_THAT(safe, Not(HasSubstr("<")));
    EXPECT_EQ(Json::parse(safe), json);
}

TEST(HtmlEscape, Base64OfTheStandardsExamples) {  // RFC 4648, section 10
    const auto of = [](const std::string& text) {
        return base64(std::vector<unsigned char>(text.begin(), text.end()));
    };
    EXPECT_EQ(of(""), "");
    EXPECT_EQ(of("f"), "Zg==");
    EXPECT_EQ(of("fo"), "Zm8=");
    EXPECT_EQ(of("foo"), "Zm9v");
    EXPECT_EQ(of("foobar"), "Zm9vYmFy");
    EXPECT_EQ(of("\xFF\xFE"), "//4=");
}

TEST(HtmlTraced, ANumberNamesItsPlaceAndItsFullValue) {
    const Json json{{"a", {{"b/c", {0.0123456789, -2.0}}}}, {"end", "inf"}, {"words", kHostile}};
    const Traced from(json);
    EXPECT_EQ(from.number("/a/b~1c/0", {1000.0, 1, "mm"}),
              "<data value=\"0.0123456789\" data-from=\"/a/b~1c/0\" data-scale=\"1000\">12.3</data>"
              "\u00a0mm");
    EXPECT_EQ(from.general("/a/b~1c/1"),
              "<data value=\"-2.0\" data-from=\"/a/b~1c/1\">\u22122</data>");
    EXPECT_EQ(from.number("/a/nothing"), "none");
    EXPECT_THAT(from.general("/end"), HasSubstr(">inf<"));
    EXPECT_EQ(from.text("/words"), std::string("<span data-from=\"/words\">") + kTamed + "</span>");
    EXPECT_EQ(pointer_part("a/b~c"), "a~1b~0c");
}

TEST(HtmlPlots, FiveNumbersAreInterpolatedQuartiles) {
    using Five = std::array<double, 5>;
    EXPECT_EQ(five_numbers({4.0, 1.0, 3.0, 2.0}), (Five{1.0, 1.75, 2.5, 3.25, 4.0}));
    EXPECT_EQ(five_numbers({7.0}), (Five{7.0, 7.0, 7.0, 7.0, 7.0}));
}

TEST(HtmlPlots, TextsAreEscapedAndNumbersFinite) {
    constexpr double kEnd = std::numeric_limits<double>::infinity();
    const PlotFrame frame{kHostile, kHostile};
    const std::string plots =
        box_plot(frame, {{kHostile, "u", {0, 1, 2, 3, 4}, 0, "/a"}}, true) +
        interval_plot(frame, {{kHostile, kEnd, -1.0, kEnd, 0.5, 0}}) +
        distribution_plot(frame, {{kHostile, {1.0, 2.0, kEnd}, 0}}) +
        curve_plot(frame, kHostile, {{kHostile, 1.0, 0.5, kEnd, false}, {"2", {}, {}, {}, true}});
    EXPECT_THAT(plots, Not(HasSubstr("<img")));
    EXPECT_THAT(plots, HasSubstr("&lt;img"));
    EXPECT_THAT(plots, Not(HasSubstr("=\"inf")));
    EXPECT_THAT(plots, Not(HasSubstr("nan")));
    EXPECT_THAT(plots, HasSubstr("data-box=\"/a\""));
}

/// The value of x1 of the first element of that class.
double first_x(const std::string& svg, const std::string& style) {
    const std::size_t at = svg.find("class=\"" + style + "\"");
    return at == std::string::npos ? -1.0 : std::stod(svg.substr(svg.find("x1=\"", at) + 4));
}

TEST(HtmlPlots, ABoxStandsWhereItsNumbersAre) {
    // Symmetric about zero: the median's line lies on the line of zero, halfway across the plot.
    const std::string svg = box_plot({"t", "px"}, {{"a", "u", {-2, -1, 0, 1, 2}, 0, ""}}, true);
    EXPECT_DOUBLE_EQ(first_x(svg, "median"), first_x(svg, "zero"));
    EXPECT_DOUBLE_EQ(first_x(svg, "median"), (30.0 + 600.0 - 14.0) / 2.0);
    EXPECT_LT(first_x(svg, "whisker"), first_x(svg, "median"));
}

TEST(HtmlPlots, EqualAndMissingValuesStillGiveAPlot) {
    for (const std::string& svg :
         {box_plot({"t", "px"}, {{"a", "u", {5, 5, 5, 5, 5}, 0, ""}}, false),
          box_plot({"t", "px"}, {{"a", "u", {0, 0, 0, 0, 0}, 0, ""}}, true),
          distribution_plot({"t", "px"}, {}), curve_plot({"t", "px"}, "x", {})}) {
        EXPECT_THAT(svg, HasSubstr("</svg>"));
        EXPECT_THAT(svg, Not(HasSubstr("nan")));
    }
}

TEST(HtmlPage, IsWholeAndAsksForNothing) {
    Page page;
    page.title = kHostile;
    page.header = "<h1>x</h1>";
    page.sections = {{"one", kHostile, table(kHostile, {"a", "b"}, {{"x", "y"}})}};
    page.document = "{\"x\": \"</script>\"}\n";
    page.document_name = kHostile;
    const std::string text = page_text(page);
    EXPECT_THAT(text, Not(HasSubstr("<img")));
    EXPECT_THAT(text, HasSubstr("default-src 'none'"));
    for (const char* const outside : {"http://", "https://", "src=\"/", "url("})
        EXPECT_THAT(text, Not(HasSubstr(outside)));
    EXPECT_THAT(text, HasSubstr("<a href=\"#one\">"));
    EXPECT_THAT(text, HasSubstr("<section id=\"one\">"));
    EXPECT_THAT(text, HasSubstr("<th scope=\"row\" class=\"left\">x</th><td>y</td>"));
    // The document's own script is the first that ends.
    const std::size_t begin = text.find("id=\"data\"");
    const std::size_t end = text.find("</script>", begin);
    const std::size_t json = text.find('\n', begin) + 1;
    EXPECT_EQ(Json::parse(text.substr(json, end - json)), Json::parse(page.document));
}

}  // namespace
}  // namespace petal::html
