#include "analysis/report/analysis_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "analysis/export/analysis_table.h"
#include "analysis/export/cells.h"
#include "core/base/json.h"

namespace passung::report {
namespace {

using exporter::FactorColumn;
using exporter::PlannedTest;
using exporter::StudyData;
using Names = std::vector<std::string>;

/// What a test is called in a sentence, and R's packages that its words need.
struct TestWords {
    const char* test;
    const char* words;
    Names packages;
};

const TestWords& wordsOf(const std::string& test) {
    static const std::vector<TestWords> known = {
        {"paired_t", "paired t-test", {"effectsize"}},
        {"wilcoxon", "signed-rank test of Wilcoxon", {"coin"}},
        {"rm_anova", "analysis of variance with repeated measures", {"afex", "emmeans", "effectsize"}},
        {"friedman", "rank test of Friedman", {"coin"}},
        {"welch_t", "t-test of Welch", {"effectsize"}},
        {"mann_whitney", "rank-sum test of Mann and Whitney", {"coin"}},
        {"mixed_anova", "mixed analysis of variance", {"afex", "emmeans", "effectsize"}},
        {"lmm", "linear mixed model", {"lmerTest", "lme4", "emmeans"}},
        {"mean", "mean with its interval", {}}};
    const auto found =
        std::find_if(known.begin(), known.end(), [&](const TestWords& words) { return test == words.test; });
    return found == known.end() ? known.back() : *found;
}

/// A text of R. Control characters do not occur in names and levels.
std::string rText(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') quoted += '\\';
        quoted += c;
    }
    return quoted + "\"";
}

/// A vector of R; of one text the text alone.
std::string rTexts(const Names& texts) {
    Names quoted;
    std::transform(texts.begin(), texts.end(), std::back_inserter(quoted), rText);
    return quoted.size() == 1 ? quoted.front() : "c(" + exporter::joined(quoted, ", ") + ")";
}

/// A text of the study as Markdown that shows it as it is: what could begin markup, mathematics or code of R is written
/// as its number.
std::string plainText(const std::string& text) {
    std::string plain;
    for (const char c : text) {
        if (std::string_view("`*[]<>&#$\\^~|@\"'{}!").find(c) == std::string_view::npos)
            plain += c;
        else
            plain += fmt::format("&#{};", static_cast<int>(c));
    }
    return plain;
}

/// The same as a word that stands out.
std::string marked(const std::string& word) { return "[" + plainText(word) + "]{.name}"; }

std::string chunk(const std::string& options, const std::string& code) {
    return "```{r " + options + "}\n" + code + "```\n\n";
}

/// One analysis, its number in the text and the stored protocols.
struct Section {
    const PlannedTest& planned;
    const StudyData& study;
    std::size_t number, protocol;  // from 1

    std::string id() const { return fmt::format("a{}", number); }
    const std::string& test() const { return planned.analysis->test; }
    Names between() const {
        Names names;
        for (const std::string& factor : planned.factors)
            if (std::find(planned.within.begin(), planned.within.end(), factor) == planned.within.end())
                names.push_back(factor);
        return names;
    }
    /// ", within = ..., between = ...", as far as there are any.
    std::string sides() const {
        return (planned.within.empty() ? "" : ", within = " + rTexts(planned.within)) +
               (between().empty() ? "" : ", between = " + rTexts(between()));
    }
    std::string factors() const { return planned.factors.empty() ? "character()" : rTexts(planned.factors); }
};

std::string headingOf(const Section& section) {
    const store::AnalysisRow& analysis = *section.planned.analysis;
    const bool thresholds = section.planned.ofThresholds();
    std::string text = fmt::format("## Analysis {}: {}, {} {{#{}}}\n\n", marked(std::to_string(section.number)),
                                   thresholds ? "thresholds of staircase " + marked(analysis.staircase)
                                              : marked(analysis.outcome) + " in block " + marked(section.planned.block),
                                   wordsOf(section.test()).words, section.id());
    Names marks;
    for (const std::string& factor : section.planned.factors) marks.push_back(marked(factor));
    if (!marks.empty()) text += "Factors: " + exporter::joined(marks, ", ") + ". ";
    return text + "Planned as number " + marked(std::to_string(analysis.number)) + " of the protocol.\n\n";
}

/// Levels in the order of the plan, as R's list.
std::string levelsOf(const Section& section) {
    Names lists;
    for (const std::string& factor : section.planned.factors)
        for (const FactorColumn& column : section.study.factors)
            if (column.column == factor) lists.push_back(factor + " = " + rTexts(column.levels));
    return section.id() + "_levels <- list(" + exporter::joined(lists, ",\n  ") + ")\n";
}

std::string rowsOf(const Section& section, const std::string& table) {
    const bool thresholds = section.planned.ofThresholds();
    return fmt::format("subset({}, protocol_sha256 == protocols[{}] & {} == {})", table, section.protocol,
                       thresholds ? "staircase" : "block",
                       rText(thresholds ? section.planned.analysis->staircase : section.planned.block));
}

std::string dataOf(const Section& section) {
    const std::string id = section.id();
    const char* table = section.planned.ofThresholds() ? "thresholds" : "cells";
    return levelsOf(section) + fmt::format("rows <- with_levels({}, {}_levels)\n", rowsOf(section, table), id) +
           fmt::format("people <- counted_people(sessions, studied, protocols[{}])\n", section.protocol) +
           fmt::format("{0} <- means_of_people(\"{0}\", rows, people, {1}{2})\n", id, rText(section.planned.value),
                       section.sides());
}

std::string pictureOf(const Section& section) {
    const char* file = section.planned.ofThresholds() ? "thresholds.csv" : "cells_long.csv";
    return fmt::format("plot_people({}, {}, {})\n", section.id(), rText(section.planned.value), section.factors()) +
           fmt::format("under_picture(\"{}\", {})\n", file, rText(section.planned.value));
}

/// The test itself, as an analyst calls it, and what shows it.
std::string testOf(const Section& section) {
    const std::string id = section.id(), value = rText(section.planned.value);
    std::string text = fmt::format("show_cells(\"{0}\", {0}, {1}, {2})\n", id, value, section.factors());
    const auto fitted = [&](const std::string& call, const char* shown) {
        return text + fmt::format("{0}_fit <- computed(\"{0}\", {1})\n{0}_p <- {2}(\"{0}\", {0}_fit, {0}, {3}, {4})\n",
                                  id, call, shown, value, section.factors());
    };
    if (section.test() == "rm_anova" || section.test() == "mixed_anova")
        return fitted(fmt::format("aov_ez(\"participant_id\", {}, {}{})", value, id, section.sides()), "show_anova");
    if (section.test() == "lmm") {
        const std::string effects =
            section.planned.factors.empty() ? "1" : exporter::joined(section.planned.factors, " * ");
        return fitted(
            fmt::format("lmerTest::lmer({} ~ {} + (1 | participant_id), {})", section.planned.value, effects, id),
            "show_lmm");
    }
    const std::string factor = section.planned.factors.empty() ? "" : rText(section.planned.factors.front());
    const auto ofLevels = [&](const std::string& levels, const std::string& call) {
        return text + fmt::format(
                          "{0}_{1} <- split({0}${2}, {0}${3})\n{0}_test <- computed(\"{0}\", {4})\n"
                          "{0}_p <- show_{5}(\"{0}\", {0}_test, {0}_{1}, {6}, {7})\n",
                          id, levels, section.planned.value, section.planned.factors.front(), call, section.test(),
                          value, factor);
    };
    const auto ofPair = [&](const char* function, const char* between, const char* end) {
        return ofLevels("pair", fmt::format("{0}({1}_pair[[1]]{2}{1}_pair[[2]]{3})", function, id, between, end));
    };
    if (section.test() == "paired_t") return ofPair("t.test", ", ", ", paired = TRUE");
    if (section.test() == "welch_t") return ofPair("t.test", ", ", "");
    if (section.test() == "wilcoxon") return ofPair("signed_ranks", " - ", "");
    if (section.test() == "mann_whitney") return ofPair("rank_sums", ", ", "");
    if (section.test() == "friedman")
        return text + fmt::format(
                          "{0}_wide <- do.call(cbind, split({0}${1}, {0}${2}))\n"
                          "{0}_test <- computed(\"{0}\", friedman.test(round({0}_wide, 9)))\n"
                          "{0}_p <- show_friedman(\"{0}\", {0}_test, {0}_wide, {3}, {4})\n",
                          id, section.planned.value, section.planned.factors.front(), value, factor);
    return text +
           fmt::format("{0}_test <- computed(\"{0}\", t.test({0}${1}))\nshow_mean(\"{0}\", {0}_test, {0}, {2})\n", id,
                       section.planned.value, value);
}

/// What stands beside the planned test of a measure.
std::string besideOf(const Section& section) {
    const std::string id = section.id();
    const std::string& outcome = section.planned.analysis->outcome;
    std::string text = fmt::format("made <- with_levels({}, {}_levels)\n", rowsOf(section, "trials"), id) +
                       fmt::format("made <- subset(made, participant_id %in% levels({}$participant_id))\n", id);
    if (exporter::isCensored(outcome) && !section.planned.factors.empty())
        text += fmt::format("show_censored(\"{0}\", made, {0}_p{1})\n", id, section.sides());
    return text + fmt::format("show_position(\"{}\", made, {})\n", id, rText(outcome));
}

std::string sectionText(const Section& section) {
    const std::string id = section.id();
    std::string text = headingOf(section) + chunk(id + "-data", dataOf(section)) +
                       chunk(fmt::format("{0}-picture, fig.height = picture_height({0}, {1})", id, section.factors()),
                             pictureOf(section)) +
                       chunk(id + "-test", testOf(section));
    if (!section.planned.ofThresholds()) text += chunk(id + "-beside", besideOf(section));
    return text;
}

/// Whom the report is about: real people where any count, else those of a pilot, else simulated ones.
std::string kindOf(const StudyData& study) {
    const std::set<std::string> counted = exporter::countedSessions(study);
    std::set<std::string> kinds;
    for (const store::SessionRow& session : study.sessions)
        if (counted.count(session.session_id) != 0) kinds.insert(session.kind);
    if (kinds.empty())
        for (const store::ParticipantRow& person : study.participants) kinds.insert(person.kind);
    for (const char* kind : {"real", "pilot"})
        if (kinds.count(kind) != 0) return kind;
    return "simulated";
}

std::string headOf(const StudyData& study, const Names& attached) {
    const store::ProtocolRow* newest = study.protocols.empty() ? nullptr : &study.protocols.back();
    const std::string title = newest == nullptr ? "Study" : newest->title.empty() ? newest->name : newest->title;
    Names hashes;
    for (const store::ProtocolRow& protocol : study.protocols) hashes.push_back(protocol.sha256);
    std::string libraries;
    for (const std::string& package : attached) libraries += "library(" + package + ")\n";
    return "---\ntitle: " + jsonText(plainText(title)) +
           "\noutput:\n  html_document:\n    theme: null\n    css: report.css\n    highlight: null\n    mathjax: null\n"
           "    toc: true\n    self_contained: true\n---\n\n" +
           "<!-- Written from the plan of the study; yours to change. Reads only files that lie beside it. -->\n\n" +
           chunk(
               "setup, include = FALSE",
               "knitr::opts_chunk$set(echo = FALSE, warning = FALSE, message = FALSE, results = \"asis\",\n"
               "                      fig.width = 7.4, dev = \"svg\")\n"
               "invisible(Sys.setlocale(\"LC_COLLATE\", \"C\"))\n" +
                   libraries +
                   "source(\"report.R\")\nsource(\"report_course.R\")\nsource(\"report_tests.R\")\ncheck_tables()\n\n" +
                   "studied <- " + rText(kindOf(study)) + "  # kind of participants; others are left apart\n" +
                   "protocols <- " + (hashes.empty() ? "character()" : rTexts(hashes)) + "\n" +
                   "participants <- read_table(\"participants.csv\")\nsessions <- read_table(\"sessions.csv\")\n"
                   "attempts <- read_table(\"trials.csv\")\n"
                   "trials <- subset(attempts, kind == studied & counted == 1)\n"
                   "cells <- subset(read_table(\"cells_long.csv\"), kind == studied)\n") +
           chunk("banner", "banner(studied)\n");
}

std::string courseText() {
    return "# Who and what is counted\n\n" + chunk("flow", "show_flow(participants, sessions, attempts, studied)\n") +
           "# Deviations from the plan\n\n" +
           chunk("deviations", "show_deviations(participants, sessions, attempts, studied, protocols)\n") +
           "# Balance of positions\n\n" + chunk("balance", "show_balance(trials)\n") +
           "# Timing of loop and pictures\n\n" +
           chunk("timing",
                 "show_timing(of_kind(read_table(\"timing.csv\"), studied), "
                 "of_kind(read_table(\"presentation.csv\"), studied))\n");
}

/// `outcomes`: measures that analyses plan.
std::string exploratoryText(const Names& outcomes) {
    std::string text = "# Exploratory\n\nNothing from here on was planned.\n\n";
    for (const std::string& outcome : outcomes)
        text += "## Course of " + marked(outcome) + "\n\n" +
                chunk("course-" + outcome + ", fig.height = course_height(trials)",
                      "plot_course(trials, " + rText(outcome) + ")\n") +
                "Each point is a trial, the line the median of a place; time-outs are at their limit.\n\n";
    return text + "## Means and scores\n\n" +
           chunk("measures", "show_measures(cells, grep(\"[.](restricted_)?mean$\", names(cells), value = TRUE))\n") +
           chunk("scores", "show_scores(of_kind(read_table(\"questionnaire_scores.csv\"), studied))\n") +
           "# Programs\n\n" + chunk("programs", "show_programs()\n") +
           chunk("results, include = FALSE", "write_results(studied)\n");
}

}  // namespace

AnalysisText writeAnalysis(const StudyData& study) {
    AnalysisText written;
    const auto need = [&written](const std::string& package) {
        if (std::find(written.packages.begin(), written.packages.end(), package) == written.packages.end())
            written.packages.push_back(package);
    };
    for (const char* package : {"rmarkdown", "knitr", "jsonlite", "digest"}) need(package);
    std::string sections;
    Names outcomes;
    bool reads_thresholds = false;
    const std::vector<exporter::Cell> cells = exporter::cellsOf(study);
    for (const PlannedTest& planned : exporter::plannedTests(study, cells)) {
        const auto protocol = std::find_if(study.protocols.begin(), study.protocols.end(), [&](const auto& row) {
            return row.sha256 == planned.analysis->protocol_sha256;
        });
        const Section section{planned, study, ++written.analyses,
                              static_cast<std::size_t>(protocol - study.protocols.begin()) + 1};
        sections += sectionText(section);
        reads_thresholds = reads_thresholds || planned.ofThresholds();
        for (const std::string& package : wordsOf(planned.analysis->test).packages) need(package);
        const std::string& outcome = planned.analysis->outcome;
        if (!outcome.empty() && std::find(outcomes.begin(), outcomes.end(), outcome) == outcomes.end())
            outcomes.push_back(outcome);
        if (exporter::isCensored(outcome) && !planned.factors.empty()) need("survival");
    }
    Names attached;
    for (const char* package : {"afex", "survival"})
        if (std::find(written.packages.begin(), written.packages.end(), package) != written.packages.end())
            attached.push_back(package);
    written.text = headOf(study, attached) + courseText() + "# Planned analyses\n\n";
    if (written.analyses == 0) written.text += "The protocol plans none.\n\n";
    if (reads_thresholds)
        written.text +=
            chunk("thresholds, include = FALSE", "thresholds <- of_kind(read_table(\"thresholds.csv\"), studied)\n");
    written.text += sections + exploratoryText(outcomes);
    return written;
}

}  // namespace passung::report
