#include "analysis/power/r_tests.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "analysis/export/cells.h"
#include "analysis/export/table.h"
#include "analysis/power/planned_analysis.h"
#include "analysis/power/temporary_folder.h"
#include "analysis/report/r_program.h"

namespace passung::power {
namespace {

/// What R is told before the call. data.csv has a row per cell, of survival per trial: study, person, the factors as
/// f1, f2 ... by the number of their level, value, and whether the trial finished.
constexpr const char* kProgram = R"r(
combination <- function(rows, factors) if (length(factors) == 0) rep("", nrow(rows)) else do.call(paste, unname(rows[factors]))

# Rows of the persons who have a value at each combination within persons.
complete <- function(rows, within) {
  wanted <- length(unique(combination(rows, within)))
  rows <- rows[!is.na(rows$value), ]
  has <- tapply(combination(rows, within), rows$person, function(at) length(unique(at)))
  rows[rows$person %in% names(has)[has == wanted], ]
}

as_factors <- function(rows, columns) {
  rows[columns] <- lapply(rows[columns], factor)
  rows
}

# One mean, or its logarithm, per person and combination.
means_of <- function(rows, within, between, logarithm) {
  rows <- complete(rows, within)
  means <- aggregate(rows["value"], rows[c("person", within, between)], mean)
  if (logarithm) {
    means <- means[!(means$person %in% means$person[means$value <= 0]), ]
    means$value <- log(means$value)
  }
  as_factors(means, c("person", within, between))
}

# A person's difference between the planted level and the one that it is compared with, of two factors the difference of
# two such; where groups are compared one group's mean less the other's.
difference_of <- function(means, pairs, within) {
  own <- intersect(names(pairs), within)
  side <- function(factor) (means[[factor]] == pairs[[factor]][1]) - (means[[factor]] == pairs[[factor]][2])
  sign <- Reduce(`*`, lapply(own, side), rep(1, nrow(means)))
  of_person <- function(i) if (length(own) == 0) mean(means$value[i]) else
    (mean(means$value[i][sign[i] > 0]) - mean(means$value[i][sign[i] < 0])) * 2^(length(own) - 1)
  d <- tapply(seq_len(nrow(means)), means$person, of_person)
  groups <- setdiff(names(pairs), own)
  if (length(groups) == 0) return(c(mean(d), sd(d)))
  group <- means[[groups]][match(names(d), means$person)]
  c(mean(d[group == pairs[[groups]][1]]) - mean(d[group == pairs[[groups]][2]]), NA)
}

of_term <- function(table, term) table[vapply(strsplit(rownames(table), ":"), setequal, NA, term), ]

variance_test <- function(means, within, between, term) {
  fit <- afex::aov_ez("person", "value", means, within = if (length(within) > 0) within,
                      between = if (length(between) > 0) between)
  unlist(of_term(anova(fit, correction = "GG"), term)[c("F", "Pr(>F)")])
}

mixed_test <- function(means, within, between, term) {
  terms <- paste(c(within, between), collapse = " * ")
  fit <- lmerTest::lmer(as.formula(paste("value ~", terms, "+ (1 | person)")), means)
  unlist(of_term(anova(fit), term)[c("F value", "Pr(>F)")])
}

# t and p of the one of two one-sided t-tests that says less. The bounds are, as in a report, of the plan's first level
# less its second, whichever the effect is planted at.
equivalence_test <- function(means, pair, bounds, paired) {
  pair <- sort(pair)
  x <- means$value[means$f1 == pair[1]]
  y <- means$value[means$f1 == pair[2]]
  tests <- list(t.test(x, y, paired = paired, alternative = "greater", mu = bounds[1]),
                t.test(x, y, paired = paired, alternative = "less", mu = bounds[2]))
  test <- tests[[which.max(vapply(tests, function(test) test$p.value, 0))]]
  c(test$statistic, test$p.value)
}

# Logarithm of the ratio of hazards, chi squared and p, as the report of times that were cut off has them.
hazard_test <- function(trials, within, between, pairs) {
  factor <- names(pairs)
  trials[[factor]] <- relevel(trials[[factor]], as.character(pairs[[factor]][2]))
  inside <- factor %in% within
  fit <- function(factors) {
    terms <- paste(c(factors, if (inside) "strata(person)"), collapse = " + ")
    formula <- as.formula(paste("survival::Surv(value, finished) ~", if (nzchar(terms)) terms else "1"))
    strata <- survival::strata
    environment(formula) <- environment()
    if (inside) survival::coxph(formula, trials) else survival::coxph(formula, trials, cluster = trials$person)
  }
  side <- if (inside) within else between
  whole <- fit(side)
  b <- coef(whole)[startsWith(names(coef(whole)), factor)]
  of_whole <- function(model) model$loglik[length(model$loglik)]
  v <- vcov(whole)[names(b), names(b), drop = FALSE]
  finite <- all(abs(b) < 10 & sqrt(diag(v)) < 10)
  chisq <- if (inside) 2 * (of_whole(whole) - of_whole(fit(setdiff(side, factor)))) else
    if (finite) as.numeric(b %*% solve(v, b)) else NA
  c(unname(b[paste0(factor, pairs[[factor]][1])]), chisq, pchisq(chisq, length(b), lower.tail = FALSE))
}

one_study <- function(rows, test, within, between, pairs, logarithm, bounds) {
  if (test == "survival") {
    trials <- as_factors(complete(rows, within), c("person", within, between))
    found <- tryCatch(hazard_test(trials, within, between, pairs), error = function(e) rep(NA, 3))
    return(c(nlevels(trials$person), found[1], NA, found[2:3]))
  }
  none <- function(e) c(NA, NA)
  means <- tryCatch(means_of(rows, within, between, logarithm), error = function(e) NULL)
  if (is.null(means)) return(c(0, NA, NA, NA, NA))
  found <- tryCatch(switch(test,
    lmm = mixed_test(means, within, between, names(pairs)),
    equivalence = equivalence_test(means, pairs[[1]], bounds, length(within) > 0),
    variance_test(means, within, between, names(pairs))), error = none)
  c(nlevels(means$person), tryCatch(difference_of(means, pairs, within), error = none), found)
}

write_tests <- function(...) {
  data <- read.csv("data.csv")
  studies <- split(data, data$study)
  tests <- suppressMessages(suppressWarnings(lapply(studies, one_study, ...)))
  writeLines(vapply(names(tests), function(study)
    paste(c(study, sprintf("%.17g", tests[[study]])), collapse = " "), ""), "tests.txt")
}
)r";

/// A factor of the test as R has it.
struct TestFactor {
    std::string name;
    std::string column;  // f1 …
    bool within = true;
    std::vector<std::string> levels;

    /// The level's number, from 1.
    std::size_t number(const std::string& level) const {
        return static_cast<std::size_t>(std::find(levels.begin(), levels.end(), level) - levels.begin()) + 1;
    }
};

TestFactor testFactor(const std::string& name, const plan::StudyPlan& plan) {
    TestFactor factor{name, "", true, {}};
    if (name == plan::kBlockFactor) {
        for (const plan::Block& block : plan.blocks)
            if (block.phase == plan::Phase::Main) factor.levels.push_back(block.name);
        return factor;
    }
    const plan::Factor& known = *factorNamed(name, plan);
    factor.within = known.kind != plan::FactorKind::Between;
    for (const plan::Level& level : known.levels) factor.levels.push_back(level.label);
    return factor;
}

std::vector<TestFactor> factorsOf(const PlantedEffect& effect, const std::string& test, const plan::StudyPlan& plan) {
    std::vector<std::string> names;
    for (const LevelPair& pair : effect.at) names.push_back(pair.factor);
    const plan::Analysis* planned = plannedAnalysis(effect, plan);
    if (planned != nullptr && planned->test == test && test != "equivalence") names = planned->factors;
    std::vector<TestFactor> factors;
    for (const std::string& name : names) {
        factors.push_back(testFactor(name, plan));
        factors.back().column = fmt::format("f{}", factors.size());
    }
    return factors;
}

/// The rows of one study in data.csv.
std::string rowsOf(const PlantedEffect& effect, const std::string& test, const plan::StudyPlan& plan,
                   const std::vector<TestFactor>& factors, const exporter::StudyData& study, std::size_t number) {
    std::string rows;
    const std::string block = plannedBlock(effect, plan);
    for (const exporter::Cell& cell : exporter::cellsOf(study)) {
        if ((!block.empty() && cell.block != block) || !exporter::canHave(*cell.condition, effect.measure)) continue;
        std::string start = fmt::format("{},{}", number, cell.participant_id);
        bool is_compared = true;
        for (const TestFactor& factor : factors) {
            const std::string level =
                factor.name == plan::kBlockFactor ? cell.block : exporter::levelOf(cell.condition->levels, factor.name);
            if (test == "equivalence")
                is_compared = level == effect.at.front().level || level == effect.at.front().against;
            start += fmt::format(",{}", factor.number(level));
        }
        if (!is_compared) continue;
        if (test != "survival") {
            rows += fmt::format("{},{},\n", start, exporter::cell(exporter::valueOf(cell, effect.measure)));
            continue;
        }
        for (const store::AttemptRow* attempt : cell.attempts)
            if (const auto time = attempt->measures.find(effect.measure); time != attempt->measures.end())
                rows += fmt::format("{},{},{}\n", start, exporter::cell(time->second),
                                    attempt->outcome == "success" ? 1 : 0);
    }
    return rows;
}

/// "c("f1", "f3")" of the factors within or between persons.
std::string columnsIn(const std::vector<TestFactor>& factors, bool within) {
    std::string names;
    for (const TestFactor& factor : factors)
        if (factor.within == within) names += (names.empty() ? "\"" : ", \"") + factor.column + '"';
    return names.empty() ? "character()" : "c(" + names + ")";
}

std::string callOf(const PlantedEffect& effect, const std::string& test, const plan::StudyPlan& plan,
                   const std::vector<TestFactor>& factors) {
    std::string pairs;
    for (const LevelPair& pair : effect.at)
        for (const TestFactor& factor : factors)
            if (factor.name == pair.factor)
                pairs += fmt::format("{}{} = c({}, {})", pairs.empty() ? "" : ", ", factor.column,
                                     factor.number(pair.level), factor.number(pair.against));
    const plan::Analysis* planned = plannedAnalysis(effect, plan);
    const auto bounds =
        planned != nullptr && planned->equivalence_bounds ? *planned->equivalence_bounds : std::pair(0.0, 0.0);
    return fmt::format(
        "source(\"tests.R\"); write_tests(test = \"{}\", within = {}, between = {}, pairs = list({}), logarithm = {}, "
        "bounds = c({}, {}))",
        test, columnsIn(factors, true), columnsIn(factors, false), pairs,
        plansLogarithm(effect, plan) ? "TRUE" : "FALSE", bounds.first, bounds.second);
}

/// What R wrote: a line per study that had rows.
std::vector<EffectTest> readTests(const std::filesystem::path& file, std::size_t studies) {
    std::vector<EffectTest> tests(studies);
    std::ifstream lines(file);
    const auto number = [](const std::string& word) {
        return word.starts_with("N") ? EffectTest::kNothing : std::stod(word);  // NA, NaN
    };
    std::size_t study = 0;
    for (std::string n, mean, sd, statistic, p; lines >> study >> n >> mean >> sd >> statistic >> p;)
        tests.at(study) = {static_cast<std::size_t>(number(n)), number(mean), number(sd), number(statistic), number(p)};
    return tests;
}

std::vector<std::string> packagesOf(const std::string& test) {
    if (test == "lmm") return {"lmerTest"};
    if (test == "survival") return {"survival"};
    if (test == "equivalence") return {};
    return {"afex"};
}

}  // namespace

bool testedInR(const PlantedEffect& effect, const std::string& test) {
    return effect.at.size() == 2 || test == "lmm" || test == "survival" || test == "equivalence";
}

std::string whyNotInR(const PlantedEffect& effect, const std::string& test, const plan::StudyPlan& plan) {
    if (test == "survival" && effect.measure != "time_s") return "is of time_s";
    const plan::Analysis* planned = plannedAnalysis(effect, plan);
    if (test == "equivalence" && (planned == nullptr || !planned->equivalence_bounds))
        return "takes its bounds from the protocol: plan an analysis of this measure and factor with "
               "equivalence_bounds";
    const std::string install = report::installCommand(report::missingPrograms(packagesOf(test)));
    return install.empty() ? "" : "is computed by R, which lacks it here: " + install;
}

Result<std::vector<EffectTest>> testInR(const PlantedEffect& effect, const std::string& test,
                                        const plan::StudyPlan& plan, std::span<const exporter::StudyData> studies) {
    const TemporaryFolder folder;
    if (const auto made = folder.made(); !made) return made.errors();
    const std::vector<TestFactor> factors = factorsOf(effect, test, plan);
    std::string data = "study,person";
    for (const TestFactor& factor : factors) data += ',' + factor.column;
    data += ",value,finished\n";
    for (std::size_t i = 0; i < studies.size(); ++i) data += rowsOf(effect, test, plan, factors, studies[i], i);
    std::ofstream(folder.path() / "tests.R") << kProgram;
    std::ofstream file(folder.path() / "data.csv");
    file << data << std::flush;
    if (!file) return Error{.message = "a temporary file cannot be written", .file = folder.path().string()};
    const report::Evaluated evaluated = report::evaluate(folder.path(), callOf(effect, test, plan, factors));
    if (!evaluated.failed.empty()) return Error{.message = "R: " + evaluated.failed, .key = "--test", .value = test};
    return readTests(folder.path() / "tests.txt", studies.size());
}

}  // namespace passung::power
