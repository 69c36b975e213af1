#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/questionnaire/definition.h"

namespace passung::questionnaire {

struct Score {
    std::optional<double> value;  // empty: no score, too much is missing
    std::size_t items = 0;        // that enter; an item that enters by two scales counts twice
    std::size_t missing = 0;      // of them
};

/// One score for each scale. Nothing is imputed but what a scale's max_missing allows.
/// @pre an answer for each item, without answerFault()
std::vector<Score> computeScores(const Definition& definition, const std::vector<Answer>& answers);

/// The class that `value` falls into; empty below the first one or without classes.
std::string_view classOf(const Scale& scale, double value);

/// How the scores of a golden vector differ from what it claims, a sentence each; none if they agree.
std::vector<std::string> goldenFaults(const Definition& definition, const Golden& golden);

}  // namespace passung::questionnaire
