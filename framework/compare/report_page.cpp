// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <nlohmann/json.hpp>

#include "petal/html/escape.hpp"
#include "petal/html/page.hpp"
#include "petal/html/traced.hpp"
#include "petal/printed.hpp"
#include "report.hpp"
#include "report_plots.hpp"

namespace petal::compare {

namespace {

using html::Traced;
using Section = html::Page::Section;
using PageJson = nlohmann::ordered_json;

std::string element(const std::string& list, std::size_t index) {
    return list + "/" + std::to_string(index);
}

std::string under(const std::string& object, const std::string& key) {
    return object + "/" + html::pointer_part(key);
}

/// An end of an interval; infinite ones lie among the units that failed.
std::string end_html(const Traced& from, const std::string& pointer, bool with_sign) {
    const PageJson& value = from.at(pointer);
    if (!value.is_string()) return from.general(pointer, with_sign ? 3 : 4, with_sign);
    return "<data value=\"" + value.get<std::string>() + "\" data-from=\"" + html::escape(pointer) +
           "\">" + (value == "inf" ? "+fails" : "-fails") + "</data>";
}

/// "0.067 [0.060, 0.073]".
std::string interval_html(const Traced& from, const std::string& pointer, bool with_sign) {
    if (!from.at(pointer).is_object()) return "none";
    return end_html(from, pointer + "/value", with_sign) + " [" +
           end_html(from, pointer + "/low", with_sign) + ", " +
           end_html(from, pointer + "/high", with_sign) + "]";
}

std::string verdict_badge(const Traced& from, const std::string& judgement) {
    const std::string verdict = from.at(judgement + "/verdict").get<std::string>();
    const char* style = verdict == "better" ? "good" : verdict == "worse" ? "bad" : "fair";
    if (verdict == "equivalent") style = "soft";
    return std::string("<span class=\"badge ") + style + "\">" + from.text(judgement + "/verdict") +
           "</span>";
}

std::string undecided_words(const Traced& from, const std::string& judgement) {
    if (!from.at(judgement + "/reason").is_string()) return {};
    std::string words = "<br><span class=\"soft\">" + from.text(judgement + "/reason");
    if (from.at(judgement + "/more_seeds").is_number())
        words += "; about " + from.number(judgement + "/more_seeds", {1.0, 0}) +
                 " more seeds would decide";
    return words + "</span>";
}

std::string header_html(const Comparison& comparison, const Traced& from) {
    const std::size_t units = [&] {
        std::size_t count = 0;
        for (const DataItem& item : comparison.data) count += comparison.seeds_of(item).size();
        return count * comparison.variants.size();
    }();
    return "<h1>Comparison: " + from.text("/name") + "</h1>\n<p class=\"lead\">" +
           from.text("/about") + "</p>\n<p class=\"soft\">" +
           Traced::count("/variants", "members", comparison.variants.size()) +
           " variants, data: " + Traced::count("/data", "members", comparison.data.size()) +
           ", units: " + std::to_string(units) + ". Everything is held against <strong>" +
           from.text("/reference") + "</strong>.</p>\n";
}

/// A row a variant, a column a metric: who is better at what.
Section summary_section(const Comparison& comparison, const Figures& figures, const Traced& from) {
    std::vector<std::string> head{"variant"};
    for (std::size_t m = 0; m < figures.metrics.size(); ++m)
        head.push_back(from.text(element("/metrics", m) + "/name"));
    head.emplace_back("failures");
    std::vector<std::vector<std::string>> rows;
    std::vector<std::size_t> left;
    for (std::size_t column = 0; column < head.size(); ++column) left.push_back(column);
    for (std::size_t v = 0; v < comparison.variants.size(); ++v) {
        if (v == comparison.reference) continue;
        const std::string& name = comparison.variants[v].name;
        std::vector<std::string> row{html::escape(name)};
        for (std::size_t m = 0; m < figures.metrics.size(); ++m) {
            const std::string judgement =
                under(element("/metrics", m) + "/variants", name) + "/to_reference";
            row.push_back(from.at(judgement).is_object() ? verdict_badge(from, judgement) : "");
        }
        const std::string failures = under("/failures", name);
        row.push_back(from.number(failures + "/failed", {1.0, 0}) + " of " +
                      from.number(failures + "/units", {1.0, 0}));
        rows.push_back(std::move(row));
    }
    return {"summary", "In short",
            "<p>Better and worse hold at a confidence of " + from.general("/confidence") +
                " over the whole page; equivalent means that the difference is too small to "
                "matter.</p>\n" +
                html::table("Against the reference", head, rows, left)};
}

Section metric_page(const Comparison& comparison, const Figures& figures, std::size_t m,
                    const std::vector<UnitOutcome>& outcomes, const Traced& from) {
    const std::string place = element("/metrics", m);
    const MetricSpec& metric = figures.metrics[m].metric;
    std::vector<std::vector<std::string>> rows;
    for (std::size_t v = 0; v < comparison.variants.size(); ++v) {
        const std::string its = under(place + "/variants", comparison.variants[v].name);
        const std::size_t failed = figures.metrics[m].variants[v].failed;
        std::vector<std::string> row{
            html::escape(comparison.variants[v].name), from.number(its + "/units", {1.0, 0}),
            failed == 0 ? from.number(its + "/failed", {1.0, 0})
                        : "<strong>" + from.number(its + "/failed", {1.0, 0}) + "</strong>",
            interval_html(from, its + "/median", false)};
        const std::string judgement = its + "/to_reference";
        if (from.at(judgement).is_object()) {
            row.push_back(interval_html(from, judgement + "/median_difference", true));
            row.push_back(from.number(judgement + "/win_share", {100.0, 0, "%"}));
            row.push_back(from.general(judgement + "/p_holm", 2));
            row.push_back(verdict_badge(from, judgement) + undecided_words(from, judgement));
        } else {
            row.insert(row.end(), {"", "", "", "reference"});
        }
        rows.push_back(std::move(row));
    }
    std::string text = "<p>";
    if (metric.better == Direction::none) {
        text += "Differences are told, not judged.";
    } else {
        text += metric.better == Direction::lower ? "Lower is better." : "Higher is better.";
    }
    if (metric.margin > 0.0)
        text += metric.margin_is_share ? " Differences within " +
                                             from.number(place + "/margin_share", {100.0, 1, "%"}) +
                                             " of the reference do not matter."
                                       : " Differences within " + from.general(place + "/margin") +
                                             " " + html::escape(metric.unit) + " do not matter.";
    for (const std::string& item : figures.metrics[m].not_measured_on)
        text += " Not measured on " + html::escape(item) + ".";
    text += "</p>\n" +
            html::table("Medians and differences, with intervals of " +
                            printed("%g %%", 100.0 * comparison.confidence),
                        {"variant", "units", "failed", "median", "difference", "wins", "p", ""},
                        rows, {0, 7}) +
            metric_plots(comparison, figures.metrics[m], outcomes);
    return {printed("metric%zu", m), metric.name, text};
}

Section sweep_page(const Comparison& comparison, const Figures& figures, const std::string& param,
                   std::size_t number, const Traced& from) {
    const std::string list = under("/sweeps", param);
    std::vector<std::string> head{"value", "failed"};
    for (const MetricFigures& metric : figures.metrics)
        head.push_back(html::escape(metric.metric.name));
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < from.at(list).size(); ++i) {
        const std::string point = element(list, i);
        std::vector<std::string> row{html::escape(from.at(point + "/value").dump()),
                                     from.number(point + "/failed", {1.0, 0})};
        for (const MetricFigures& metric : figures.metrics)
            row.push_back(interval_html(from, under(point + "/median", metric.metric.name), false));
        rows.push_back(std::move(row));
    }
    return {printed("sweep%zu", number), "Sensitivity to " + param,
            html::table("Medians by value", head, rows) + sweep_plots(comparison, figures, param)};
}

/// The picture, where there is room; else where it lies.
std::string picture_of_unit(const UnitPicture& picture, std::size_t& room) {
    if (picture.bytes.size() > room)
        return "<p class=\"soft\">Its picture: <a href=\"" + html::escape(picture.path) + "\">" +
               html::escape(picture.path) + "</a></p>\n";
    room -= picture.bytes.size();
    const bool jpeg =
        picture.path.size() > 4 && picture.path.substr(picture.path.size() - 4) == ".jpg";
    return std::string("<figure><img alt=\"What a stage drew: ") + html::escape(picture.path) +
           "\" src=\"data:image/" + (jpeg ? "jpeg" : "png") + ";base64," +
           html::base64(picture.bytes) + "\"><figcaption>" + html::escape(picture.path) +
           "</figcaption></figure>\n";
}

Section failure_page(const Comparison& comparison, const Figures& figures,
                     const std::vector<UnitOutcome>& outcomes, const UnitPictures& pictures,
                     const Traced& from) {
    std::vector<std::vector<std::string>> rows;
    for (std::size_t v = 0; v < comparison.variants.size(); ++v) {
        const std::string its = under("/failures", comparison.variants[v].name);
        std::vector<std::string> row{html::escape(comparison.variants[v].name),
                                     from.number(its + "/units", {1.0, 0}),
                                     from.number(its + "/failed", {1.0, 0})};
        const std::string judgement = its + "/to_reference";
        if (figures.failures[v].judgement) {
            row.push_back(from.number(judgement + "/only_variant_failed", {1.0, 0}));
            row.push_back(from.number(judgement + "/only_reference_failed", {1.0, 0}));
            row.push_back(from.general(judgement + "/p_holm", 2));
            row.push_back(from.text(judgement + "/verdict"));
        } else {
            row.insert(row.end(), {"", "", "", "reference"});
        }
        rows.push_back(std::move(row));
    }
    std::string text =
        "<p>A unit fails where its outcome is " + from.text("/failure") + " or worse.</p>\n" +
        html::table("Failures by variant",
                    {"variant", "units", "failed", "it alone", "reference alone", "p", ""}, rows,
                    {0, 6});
    std::size_t room = 4000000;  // bytes of pictures in the page; the others are linked
    std::size_t index = 0;
    for (const UnitOutcome& outcome : outcomes) {
        if (outcome.failure.empty()) continue;
        const std::string unit = element("/failed_units", index++);
        text += "<details class=\"keep\"" + std::string(index <= 3 ? " open" : "") + "><summary>" +
                from.text(unit + "/variant") + ", " + from.text(unit + "/data") + ", seed " +
                from.number(unit + "/seed", {1.0, 0}) + ": " + from.text(unit + "/cause") +
                "</summary>\n<p>" + from.text(unit + "/reason") + "</p>\n";
        const auto drawn = pictures.find(outcome.key);
        if (drawn != pictures.end())
            for (const UnitPicture& picture : drawn->second) text += picture_of_unit(picture, room);
        text += "</details>\n";
    }
    if (index == 0) text += "<p>No unit failed.</p>\n";
    return {"failures", "Failures", text};
}

}  // namespace

std::string report_html(const Comparison& comparison, const Figures& figures,
                        const std::vector<UnitOutcome>& outcomes, const std::string& document,
                        const UnitPictures& pictures) {
    const auto json = PageJson::parse(document);
    const Traced from(json);
    html::Page page;
    page.title = "Comparison " + comparison.name;
    page.header = header_html(comparison, from);
    page.sections.push_back(summary_section(comparison, figures, from));
    for (std::size_t m = 0; m < figures.metrics.size(); ++m)
        page.sections.push_back(metric_page(comparison, figures, m, outcomes, from));
    std::size_t number = 0;
    for (const auto& [param, points] : json.at("sweeps").items())
        page.sections.push_back(sweep_page(comparison, figures, param, number++, from));
    page.sections.push_back(failure_page(comparison, figures, outcomes, pictures, from));
    page.document = document;
    page.document_name = "compare.json";
    page.footer =
        "<p>Written by petal compare. The values behind the plots are in "
        "<code>metrics/</code>.</p>\n";
    return html::page_text(page);
}

}  // namespace petal::compare
