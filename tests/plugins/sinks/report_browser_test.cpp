// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include "browser.hpp"
#include "report_samples.hpp"

namespace petal {
namespace {

using report_samples::Sample;
using testing::Browser;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// The page of the sample, with hostile names everywhere.
class ReportInBrowser : public ::testing::Test {
   protected:
    void SetUp() override {
        if (Browser::program().empty())
            GTEST_SKIP() << "no chromium: scripts/install_packages.sh packages-checks.txt";
        report_.fire();
        page_ = report_.folder() / "report.html";
    }

    testing::StageHarness report_ = Sample().harness();
    std::filesystem::path page_;
};

/// Lists what on the page is not what the document says; an empty list where all is.
const char* const kWrongNumbers = R"js((() => {
    const data = JSON.parse(document.getElementById("data").textContent);
    const view = JSON.parse(document.getElementById("view-data").textContent);
    const at = (from, pointer) => pointer.split("/").slice(1).reduce(
        (value, part) => value[part.replace(/~1/g, "/").replace(/~0/g, "~")], from);
    const wrong = [];
    const shown = (element) => Number(element.textContent.replace(/\u2212/g, "-").replace(/\u202f/g, ""));
    const counts = {
        members: (list) => list.length,
        both: (list) => list.filter((b) => b.corners_lidar && b.corners_image).length,
        lidar: (list) => list.filter((b) => b.corners_lidar && !b.corners_image).length,
        camera: (list) => list.filter((b) => !b.corners_lidar && b.corners_image).length };
    for (const e of document.querySelectorAll("data")) {
        let value;
        if (e.dataset.from) value = at(data, e.dataset.from);
        else if (e.dataset.view) value = at(view, e.dataset.view);
        else value = counts[e.dataset.count](at(data, e.dataset.of));
        if (Number(e.value) !== value) { wrong.push(e.outerHTML); continue; }
        const text = e.textContent.replace(/\u2212/g, "-");
        const mantissa = text.split("e")[0];
        const decimals = (mantissa.split(".")[1] || "").length;
        const power = text.includes("e") ? Number(text.split("e")[1]) : 0;
        const scaled = value * Number(e.dataset.scale || 1);
        if (!(Math.abs(shown(e) - scaled) <= 0.5000001 * Math.pow(10, power - decimals))) wrong.push(e.outerHTML);
    }
    for (const e of document.querySelectorAll("span[data-from]"))
        if (at(data, e.dataset.from) !== e.textContent) wrong.push(e.outerHTML);
    for (const e of document.querySelectorAll("g[data-box]"))
        if (JSON.stringify(at(data, e.dataset.box)) !== JSON.stringify(e.dataset.values.split(" ").map(Number)))
            wrong.push(e.outerHTML);
    return wrong;
})())js";

/// Numbers with a decimal point that stand in the text and name no source: there must be none.
const char* const kNumbersWithoutSource = R"js((() => {
    const found = [];
    const walker = document.createTreeWalker(document.querySelector("main"), NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
        const inside = walker.currentNode.parentElement.closest("[data-from], [data-view], script, svg, pre, select");
        if (!inside && /\d\.\d/.test(walker.currentNode.textContent)) found.push(walker.currentNode.textContent);
    }
    return found;
})())js";

/// How many pixels of the canvas are not its background, as a share.
const char* const kDrawnShare = R"js((() => {
    const source = document.querySelector("#view3d canvas");
    const copy = document.createElement("canvas");
    copy.width = source.width; copy.height = source.height;
    const context = copy.getContext("2d");
    context.drawImage(source, 0, 0);
    const pixels = context.getImageData(0, 0, copy.width, copy.height).data;
    let drawn = 0;
    for (let i = 0; i < pixels.length; i += 4)
        if (Math.abs(pixels[i] - pixels[0]) + Math.abs(pixels[i + 1] - pixels[1]) + Math.abs(pixels[i + 2] - pixels[2]) > 20)
            ++drawn;
    return drawn * 4 / pixels.length;
})())js";

TEST_F(ReportInBrowser, NumbersAreTheDocumentsAndTheViewIsDrawn) {
    Browser browser;
    browser.open(page_);
    ASSERT_TRUE(
        browser.becomes_true("document.getElementById('view3d').dataset.state === 'drawn'"));
    EXPECT_THAT(browser.evaluate(kWrongNumbers), IsEmpty());
    EXPECT_THAT(browser.evaluate(kNumbersWithoutSource), IsEmpty());
    EXPECT_GT(browser.evaluate("document.querySelectorAll('data[data-from]').length"), 80);
    EXPECT_GT(browser.evaluate("document.querySelectorAll('g[data-box]').length"), 5);
    // A plate and a wall fill a good part of the view; sensors alone would be below a per cent.
    EXPECT_GT(browser.evaluate(kDrawnShare).get<double>(), 0.05);
    EXPECT_NE(browser.evaluate("document.title"), "run") << "a label ran as a script";
    EXPECT_EQ(browser.evaluate("document.querySelectorAll('img[src=x], main b').length"), 0);
    for (const int width : {1400, 500}) {
        browser.call(
            "Emulation.setDeviceMetricsOverride",
            {{"width", width}, {"height", 900}, {"deviceScaleFactor", 1}, {"mobile", false}});
        EXPECT_LE(browser.evaluate("document.documentElement.scrollWidth"), width)
            << "nothing but tables scrolls sideways";
    }
    EXPECT_THAT(browser.complaints(), IsEmpty());
    // The checks themselves: they see a number that is another, and one from nowhere.
    browser.evaluate("document.querySelector('data[data-from]').textContent = '7.77'; 0");
    EXPECT_EQ(browser.evaluate(kWrongNumbers).size(), 1U);
    browser.evaluate("document.querySelector('main p').append(' 0.5'); 0");
    EXPECT_EQ(browser.evaluate(kNumbersWithoutSource).size(), 1U);
}

TEST_F(ReportInBrowser, KeysAloneReachAndMoveEverything) {
    Browser browser;
    browser.open(page_);
    ASSERT_TRUE(
        browser.becomes_true("document.getElementById('view3d').dataset.state === 'drawn'"));
    browser.press("Tab");
    EXPECT_EQ(browser.evaluate("document.activeElement.className"), "skip") << "the first of all";
    // Every control of the view comes by Tab before the view itself, and Tab leads out of it again.
    std::vector<std::string> reached;
    for (int i = 0; i < 80; ++i) {
        browser.press("Tab");
        const std::string what = browser.evaluate(
            "document.activeElement.closest('#view3d') ? (document.activeElement.className || "
            "document.activeElement.tagName) : ''");
        if (!what.empty()) reached.push_back(what);
        if (what.empty() && !reached.empty()) break;
    }
    EXPECT_THAT(reached, ElementsAre("SELECT", "BUTTON", "BUTTON", "BUTTON", "BUTTON", "INPUT",
                                     "INPUT", "INPUT", "view"));
    browser.press("Tab", 8);  // back into the view
    EXPECT_EQ(browser.evaluate("document.activeElement.className"), "view");
    const auto eye_after = [&browser](const std::string& key, int modifiers) {
        const std::string eye = "document.getElementById('view3d').dataset.eye";
        const std::string before = browser.evaluate(eye);
        browser.press(key, modifiers);
        EXPECT_TRUE(browser.becomes_true(eye + " !== '" + before + "'")) << key;
        return browser.evaluate(eye).get<std::string>();
    };
    const std::string overview = browser.evaluate("document.getElementById('view3d').dataset.eye");
    for (const char* const key : {"ArrowLeft", "ArrowUp", "+", "-"}) eye_after(key, 0);
    eye_after("ArrowRight", 8);
    // The camera's origin in the LiDAR frame: -R' t of the sample, x y z = 0.03 0.04 -0.11.
    EXPECT_EQ(eye_after("c", 0), "0.0300 0.0400 -0.1100");
    EXPECT_EQ(eye_after("l", 0), "0.0000 0.0000 0.0000");
    EXPECT_EQ(eye_after("o", 0), overview);
    browser.press("n");
    EXPECT_EQ(browser.evaluate("document.querySelector('#view3d select').value"), "1");
    EXPECT_THAT(browser.complaints(), IsEmpty());
}

TEST_F(ReportInBrowser, WithoutWebglTheRestIsThereAndSaysSo) {
    Browser browser({"--disable-3d-apis"});
    browser.open(page_);
    EXPECT_EQ(browser.evaluate("document.getElementById('view3d').dataset.state"), "absent");
    EXPECT_GT(browser.evaluate("document.getElementById('view-message').offsetHeight"), 0);
    EXPECT_THAT(browser.evaluate(kWrongNumbers), IsEmpty());
    EXPECT_EQ(browser.evaluate("Array.from(document.images).every((i) => i.naturalWidth > 0)"),
              true);
    EXPECT_THAT(browser.complaints(), IsEmpty());
}

}  // namespace
}  // namespace petal
