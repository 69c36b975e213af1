#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace passung::plan {

/// Two levels of a factor that are compared: the mean of the one less that of the other.
struct Contrast {
    std::string factor, level, against;
};

/// What a study means to test, written down before the first participant.
struct Analysis {
    std::string outcome;               // a measure, or QUESTIONNAIRE.SCALE; empty: the thresholds of a staircase
    std::vector<std::string> factors;  // names; kBlockFactor: which main block
    std::string test;                  // "rm_anova" …
    std::string block = {};            // whose trials; empty: every main block's that has the outcome, each by
                                       // itself, or all of them where they are a factor
    std::string staircase = {};        // whose thresholds; empty: none
    std::string role = {};             // "primary", "secondary", "exploratory"
    std::string transform = {};        // "log"; empty: none
    std::vector<std::string> covariates = {};  // columns of trials
    std::vector<Contrast> contrasts = {};
    std::optional<std::pair<double, double>> equivalence_bounds = {};  // in the outcome's unit
    std::string family = {};  // name of those whose p values are adjusted together; empty: none
};

/// The name by which an analysis has main blocks as the levels of a factor.
inline constexpr const char* kBlockFactor = "block";

/// A rule on recorded values: whatever is below or above a bound is left out of all analyses.
struct DataRule {
    bool of_participants = false;        // by a person's mean; else trial by trial
    std::string value;                   // a measure or, of participants, QUESTIONNAIRE.SCALE
    std::optional<double> below, above;  // left out if; one of them at least
    std::string reason;                  // in words; empty: the rule itself says it
};

}  // namespace passung::plan
