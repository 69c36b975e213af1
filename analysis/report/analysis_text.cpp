#include "analysis/report/analysis_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>

#include "analysis/export/analysis_table.h"
#include "analysis/export/cell_tables.h"
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
        {"survival", "proportional hazards of the time to success", {"survival"}},
        {"ordinal", "cumulative link mixed model", {"ordinal"}},
        {"equivalence", "test of equivalence", {}},
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
    Names blocks = {};             // with cells

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
    /// Empty, or what follows a call's other arguments.
    std::string contrasts() const {
        Names each;
        for (const plan::Contrast& contrast : planned.analysis->contrasts)
            each.push_back(rTexts({contrast.factor, contrast.level, contrast.against}));
        return each.empty() ? "" : ", contrasts = list(" + exporter::joined(each, ", ") + ")";
    }
    bool isExploratory() const { return planned.analysis->role == "exploratory"; }
};

/// What is analysed, and where.
std::string outcomeOf(const Section& section) {
    const store::AnalysisRow& analysis = *section.planned.analysis;
    if (section.planned.ofThresholds()) return "thresholds of staircase " + marked(analysis.staircase);
    const std::string outcome = (analysis.transform.empty() ? "" : "logarithm of ") + marked(analysis.outcome);
    return outcome + (section.planned.block.empty() ? "" : " in block " + marked(section.planned.block));
}

std::string headingOf(const Section& section) {
    const store::AnalysisRow& analysis = *section.planned.analysis;
    std::string text = fmt::format("## Analysis {}: {}, {} {{#{}}}\n\n", marked(std::to_string(section.number)),
                                   outcomeOf(section), wordsOf(section.test()).words, section.id());
    Names marks;
    for (const std::string& factor : section.planned.factors) marks.push_back(marked(factor));
    if (!marks.empty()) text += "Factors: " + exporter::joined(marks, ", ") + ". ";
    text += "Planned as number " + marked(std::to_string(analysis.number)) + " of the protocol";
    if (!analysis.role.empty()) text += ", " + analysis.role;
    if (!analysis.family.empty()) text += ", in the family " + marked(analysis.family);
    return text + ".\n\n";
}

/// Blocks of a protocol that have cells.
Names blocksOf(const std::vector<exporter::Cell>& cells, const std::string& protocol) {
    Names blocks;
    for (const exporter::Cell& cell : cells)
        if ((protocol.empty() || cell.protocol_sha256 == protocol) &&
            std::find(blocks.begin(), blocks.end(), cell.block) == blocks.end())
            blocks.push_back(cell.block);
    return blocks;
}

/// Levels in the order of the plan, as R's list.
std::string levelsOf(const Section& section) {
    Names lists;
    for (const std::string& factor : section.planned.factors)
        for (const FactorColumn& column : section.study.factors)
            if (column.column == factor) lists.push_back(factor + " = " + rTexts(column.levels));
    if (section.planned.overBlocks()) lists.push_back("block = " + rTexts(section.blocks));
    return section.id() + "_levels <- list(" + exporter::joined(lists, ",\n  ") + ")\n";
}

std::string rowsOf(const Section& section, const std::string& table) {
    const bool thresholds = section.planned.ofThresholds();
    std::string rows = fmt::format("subset({}, protocol_sha256 == protocols[{}]", table, section.protocol);
    if (thresholds) rows += " & staircase == " + rText(section.planned.analysis->staircase);
    if (!section.planned.block.empty()) rows += " & block == " + rText(section.planned.block);
    return rows + ")";
}

/// The table that has the persons' values: of single trials that of cells tells who has any.
std::string valuesOf(const Section& section) {
    if (section.planned.ofThresholds()) return rowsOf(section, "thresholds");
    if (section.planned.ofScale())
        return "scale_rows(" + rowsOf(section, "scores") + ", attempts, " + rText(section.planned.analysis->outcome) +
               ", " + section.factors() + ")";
    return rowsOf(section, "cells");
}

std::string columnOf(const Section& section) {
    return section.planned.ofTrials() ? exporter::cellColumn(section.planned.value) : section.planned.value;
}

std::string dataOf(const Section& section) {
    const std::string id = section.id();
    const store::AnalysisRow& analysis = *section.planned.analysis;
    std::string text =
        levelsOf(section) + fmt::format("rows <- with_levels({}, {}_levels)\n", valuesOf(section), id) +
        fmt::format("people <- counted_people(sessions, studied, protocols[{}])\n", section.protocol) +
        fmt::format("{0} <- means_of_people(\"{0}\", rows, people, {1}{2}{3})\n", id, rText(columnOf(section)),
                    section.sides(), analysis.transform.empty() ? "" : ", transform = \"" + analysis.transform + "\"");
    if (!analysis.covariates.empty() && section.test() == "lmm")
        text += fmt::format("{0} <- with_covariates({0}, with_levels({1}, {0}_levels), {2}, {3})\n", id,
                            rowsOf(section, "trials"), rTexts(analysis.covariates), section.factors());
    return text;
}

std::string pictureOf(const Section& section) {
    const char* file = section.planned.ofTrials() ? "cells_long.csv" : section.planned.file();
    return fmt::format("plot_people({}, {}, {})\n", section.id(), rText(columnOf(section)), section.factors()) +
           fmt::format("under_picture(\"{}\", {})\n", file, rText(columnOf(section)));
}

/// Rows of single trials of those who are analysed.
std::string trialsOf(const Section& section) {
    const std::string id = section.id();
    return fmt::format("made <- with_levels({}, {}_levels)\n", rowsOf(section, "trials"), id) +
           fmt::format("made <- subset(made, participant_id %in% levels({}$participant_id))\n", id);
}

/// The test itself, as an analyst calls it, and what shows it.
std::string testOf(const Section& section) {
    const std::string id = section.id(), value = rText(columnOf(section));
    const store::AnalysisRow& analysis = *section.planned.analysis;
    std::string text = fmt::format("show_cells(\"{0}\", {0}, {1}, {2})\n", id, value, section.factors());
    std::string covariates;
    for (const std::string& covariate : analysis.covariates) covariates += " + " + covariate;
    if (section.test() == "survival")
        return text + trialsOf(section) +
               fmt::format("{0}_p <- show_survival(\"{0}\", made{1}{2})\n", id, section.sides(),
                           covariates.empty() ? "" : ", covariates = " + rTexts(analysis.covariates));
    const auto fitted = [&](const std::string& call, const char* shown) {
        return text + fmt::format(
                          "{0}_fit <- computed(\"{0}\", {1})\n"
                          "{0}_p <- {2}(\"{0}\", {0}_fit, {0}, {3}, {4}{5})\n",
                          id, call, shown, value, section.factors(), section.contrasts());
    };
    if (section.test() == "rm_anova" || section.test() == "mixed_anova")
        return fitted(fmt::format("aov_ez(\"participant_id\", {}, {}{})", value, id, section.sides()), "show_anova");
    if (section.test() == "lmm") {
        const std::string effects =
            section.planned.factors.empty() ? "1" : exporter::joined(section.planned.factors, " * ");
        return fitted(fmt::format("lmerTest::lmer({} ~ {} + (1 | participant_id), {})", columnOf(section),
                                  effects + covariates, id),
                      "show_lmm");
    }
    if (section.test() == "ordinal")
        return fitted(fmt::format("ordinal_model({}, {}, {})", id, value, section.factors()), "show_ordinal");
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
    if (section.test() == "equivalence")
        return text + fmt::format(
                          "{0}_pair <- split({0}${1}, {0}${2})\n"
                          "{0}_p <- show_equivalence(\"{0}\", {0}_pair, {3}, {4}, c({5}, {6}), paired = {7})\n",
                          id, columnOf(section), section.planned.factors.front(), value, factor,
                          analysis.equivalence_bounds->first, analysis.equivalence_bounds->second,
                          section.planned.within.empty() ? "FALSE" : "TRUE");
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
    std::string text = trialsOf(section);
    if (exporter::isCensored(outcome) && !section.planned.factors.empty() && !section.planned.ofTrials())
        text += fmt::format("show_censored(\"{0}\", made, {0}_p{1})\n", id, section.sides());
    return text + fmt::format("show_position(\"{}\", made, {})\n", id, rText(outcome));
}

std::string sectionText(const Section& section) {
    const std::string id = section.id();
    std::string text = headingOf(section) + chunk(id + "-data", dataOf(section)) +
                       chunk(fmt::format("{0}-picture, fig.height = picture_height({0}, {1})", id, section.factors()),
                             pictureOf(section)) +
                       chunk(id + "-test", testOf(section));
    if (section.planned.ofThresholds())
        text += chunk(id + "-function, fig.height = function_height(answers_of(" + rowsOf(section, "answers") + "))",
                      fmt::format("show_functions(\"{}\", answers_of({}), rows)\n", id, rowsOf(section, "answers")));
    else if (!section.planned.ofScale())
        text += chunk(id + "-beside", besideOf(section));
    return text;
}

/// p values of analyses that are planned as one family.
std::string familiesText(const std::vector<Section>& sections) {
    std::map<std::string, Names> families;
    for (const Section& section : sections)
        if (!section.planned.analysis->family.empty())
            families[section.planned.analysis->family].push_back(fmt::format("{0} = {0}_p", section.id()));
    if (families.empty()) return "";
    std::string text = "## Families\n\n";
    for (const auto& [name, members] : families)
        text += chunk("family-" + name,
                      "show_family(" + rText(name) + ", list(" + exporter::joined(members, ", ") + "))\n");
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
           chunk("setup, include = FALSE",
                 "knitr::opts_chunk$set(echo = FALSE, warning = FALSE, message = FALSE, results = \"asis\",\n"
                 "                      fig.width = 7.4, dev = \"svg\")\n"
                 "options(bitmapType = \"cairo\")\n"
                 "invisible(Sys.setlocale(\"LC_COLLATE\", \"C\"))\n"
                 "for (file in c(\"report.R\", \"report_course.R\", \"report_curves.R\", \"report_pictures.R\", "
                 "\"report_tests.R\")) source(file)\n"
                 "check_tables()\n" +
                     libraries + "\n" + "studied <- " + rText(kindOf(study)) +
                     "  # kind of participants; others are left apart\n" + "protocols <- " +
                     (hashes.empty() ? "character()" : rTexts(hashes)) + "\n" +
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
                 "of_kind(read_table(\"presentation.csv\"), studied))\n") +
           chunk("timeline, fig.height = timeline_height(of_kind(attempts, studied))",
                 "plot_timeline(of_kind(attempts, studied))\n");
}

/// Of a picture whose lines would take more as such than as points.
constexpr const char* kManyLines = ", dev = \"png\", dpi = 120";

/// Pictures of a block's trials; `outcomes`: measures that analyses plan.
std::string blockPictures(const std::string& block, const Names& outcomes) {
    const std::string rows = "subset(courses, block == " + rText(block) + ")";
    std::string text = "## Block " + marked(block) + "\n\n" +
                       chunk("contact-" + block + ", fig.height = courses_height(" + rows + ")" + kManyLines,
                             "plot_courses(" + rows + ")\n") +
                       chunk("paths-" + block + ", fig.height = paths_height(" + rows + ")" + kManyLines,
                             "plot_paths(" + rows + ")\n");
    const std::string its = "subset(cells, block == " + rText(block) + ")";
    for (const std::string& outcome : outcomes)
        text += chunk(fmt::format("who-{}-{}, fig.height = matrix_height({})", block, outcome, its),
                      fmt::format("plot_matrix({}, {})\n", its, rText(exporter::cellColumn(outcome))));
    return text;
}

/// `outcomes`: measures that analyses plan; `blocks`: with trials that can count.
std::string exploratoryText(const StudyData& study, const Names& outcomes, const Names& blocks,
                            const std::string& planned) {
    std::string text = "# Exploratory\n\n";
    text += planned.empty() ? "Nothing from here on was planned.\n\n"
                            : "What follows was planned as exploratory; after that nothing was.\n\n" + planned;
    if (!blocks.empty()) text += chunk("courses, include = FALSE", "courses <- read_courses(trials)\n");
    for (const std::string& block : blocks) text += blockPictures(block, outcomes);
    if (!study.accuracy.empty())
        text += "## What accuracy cost\n\n" +
                chunk("accuracy, fig.height = 4", "plot_accuracy(read_table(\"accuracy.csv\"))\n");
    for (const std::string& outcome : outcomes)
        text += "## Course of " + marked(outcome) + "\n\n" +
                chunk("course-" + outcome + ", fig.height = course_height(trials)",
                      "plot_course(trials, " + rText(outcome) + ")\n") +
                "Each point is a trial, the line the median of a place; time-outs are at their limit.\n\n";
    return text + "## Means and scores\n\n" +
           chunk("measures", "show_measures(cells, grep(\"[.](restricted_)?mean$\", names(cells), value = TRUE))\n") +
           (study.questionnaires.empty()
                ? ""
                : chunk("profiles, fig.height = profiles_height(scores)", "plot_profiles(scores)\n") +
                      chunk("scores", "show_scores(scores)\n")) +
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
    for (const char* package : {"pandoc", "rmarkdown", "knitr", "jsonlite", "digest"}) need(package);
    std::vector<Section> sections;
    Names outcomes;
    bool reads_thresholds = false;
    const std::vector<exporter::Cell> cells = exporter::cellsOf(study);
    const std::vector<PlannedTest> tests = exporter::plannedTests(study, cells);
    for (const PlannedTest& planned : tests) {
        const auto protocol = std::find_if(study.protocols.begin(), study.protocols.end(), [&](const auto& row) {
            return row.sha256 == planned.analysis->protocol_sha256;
        });
        sections.push_back({planned, study, ++written.analyses,
                            static_cast<std::size_t>(protocol - study.protocols.begin()) + 1,
                            blocksOf(cells, protocol->sha256)});
        reads_thresholds = reads_thresholds || planned.ofThresholds();
        for (const std::string& package : wordsOf(planned.analysis->test).packages) need(package);
        const std::string& outcome = planned.analysis->outcome;
        if (!outcome.empty() && !planned.ofScale() &&
            std::find(outcomes.begin(), outcomes.end(), outcome) == outcomes.end())
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
        written.text += chunk("thresholds, include = FALSE",
                              "thresholds <- of_kind(read_table(\"thresholds.csv\"), studied)\n"
                              "answers <- of_kind(read_table(\"staircase.csv\"), studied)\n");
    if (!study.questionnaires.empty())
        written.text +=
            chunk("forms, include = FALSE", "scores <- of_kind(read_table(\"questionnaire_scores.csv\"), studied)\n");
    std::string planned, exploratory;
    for (const Section& section : sections) (section.isExploratory() ? exploratory : planned) += sectionText(section);
    written.text +=
        planned + familiesText(sections) + exploratoryText(study, outcomes, blocksOf(cells, ""), exploratory);
    return written;
}

}  // namespace passung::report
