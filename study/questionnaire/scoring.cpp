#include "study/questionnaire/scoring.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/assert.h"

namespace passung::questionnaire {
namespace {

/// Golden vectors are written with four decimals.
constexpr double kHalfOfLastDigit = 0.5e-4 * (1.0 + 1e-6);

double aligned(const Item& item, double answer) {
    return item.reversed ? item.response.low + item.response.high - answer : answer;
}

Score scoreItems(const Definition& definition, const Scale& scale, const std::vector<Answer>& answers) {
    Score score{std::nullopt, scale.items.size(), 0};
    double sum = 0.0;
    for (const std::size_t i : scale.items) {
        if (answers[i].number)
            sum += aligned(definition.items[i], *answers[i].number) + scale.shift;
        else
            ++score.missing;
    }
    const std::size_t answered = score.items - score.missing;
    if (answered == 0 || score.missing > scale.max_missing) return score;
    const double mean = sum / static_cast<double>(answered);
    // Without missing items the sum itself: a mean times their number need not be it to the last digit.
    const double whole = score.missing == 0 ? sum : mean * static_cast<double>(score.items);
    score.value = scale.factor * (scale.formula == Formula::Mean ? mean : whole);
    return score;
}

Score scoreScales(const Scale& scale, const std::vector<Score>& scores) {
    Score score;
    double sum = 0.0;
    bool whole = true;
    for (const std::size_t i : scale.scales) {
        score.items += scores[i].items;
        score.missing += scores[i].missing;
        whole = whole && scores[i].value;
        sum += scores[i].value.value_or(0.0);
    }
    const double count = static_cast<double>(scale.scales.size());
    if (whole) score.value = scale.factor * (scale.formula == Formula::Mean ? sum / count : sum);
    return score;
}

Score scorePairs(const Definition& definition, const Scale& scale, const std::vector<Answer>& answers) {
    Score score;
    std::vector<double> weights(answers.size(), 0.0);
    double pairs = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const Item& item = definition.items[i];
        if (item.response.kind != AnswerKind::Pair) continue;
        ++score.items;
        if (!answers[i].number) {
            ++score.missing;
            continue;
        }
        weights[*answers[i].number == 0.0 ? item.of.first : item.of.second] += 1.0;
        pairs += 1.0;
    }
    for (const std::size_t i : scale.items) {
        ++score.items;
        if (!answers[i].number) ++score.missing;
        sum += weights[i] * aligned(definition.items[i], answers[i].number.value_or(0.0));
    }
    if (score.missing == 0) score.value = scale.factor * sum / pairs;
    return score;
}

/// Missing items are told by `score`.
std::vector<double> answered(const std::vector<std::size_t>& items, const std::vector<Answer>& answers, Score& score) {
    std::vector<double> numbers;
    for (const std::size_t i : items)
        if (answers[i].number)
            numbers.push_back(*answers[i].number);
        else
            ++score.missing;
    return numbers;
}

Score scoreLaterality(const Scale& scale, const std::vector<Answer>& answers) {
    Score score{std::nullopt, scale.items.size(), 0};
    double right = 0.0, left = 0.0;
    for (const double answer : answered(scale.items, answers, score)) {
        right += answer == 0.0 ? 1.0 : std::max(answer, 0.0);
        left += answer == 0.0 ? 1.0 : std::max(-answer, 0.0);
    }
    if (score.missing == 0) score.value = 100.0 * (right - left) / (right + left);
    return score;
}

Score countIdentical(const Scale& scale, const std::vector<Answer>& answers) {
    Score score{std::nullopt, scale.items.size(), 0};
    std::map<double, double> times;
    double most = 0.0;
    for (const double answer : answered(scale.items, answers, score)) most = std::max(most, ++times[answer]);
    if (score.missing == 0) score.value = most;
    return score;
}

Score countWideScales(const Definition& definition, const Scale& scale, const std::vector<Answer>& answers) {
    Score score;
    double wide = 0.0;
    for (const std::size_t s : scale.scales) {
        double low = INFINITY, high = -INFINITY;
        for (const std::size_t i : definition.scales[s].items) {
            ++score.items;
            if (!answers[i].number) {
                ++score.missing;
                continue;
            }
            const double answer = aligned(definition.items[i], *answers[i].number);
            low = std::min(low, answer);
            high = std::max(high, answer);
        }
        if (high - low > scale.spread) wide += 1.0;
    }
    if (score.missing == 0) score.value = wide;
    return score;
}

}  // namespace

std::vector<Score> computeScores(const Definition& definition, const std::vector<Answer>& answers) {
    PASSUNG_ASSERT(answers.size() == definition.items.size());
    std::vector<Score> scores;
    for (const Scale& scale : definition.scales) {
        if (scale.formula == Formula::WideScales)
            scores.push_back(countWideScales(definition, scale, answers));
        else if (!scale.scales.empty())
            scores.push_back(scoreScales(scale, scores));
        else if (scale.formula == Formula::PairWeighted)
            scores.push_back(scorePairs(definition, scale, answers));
        else if (scale.formula == Formula::Laterality)
            scores.push_back(scoreLaterality(scale, answers));
        else if (scale.formula == Formula::MostIdentical)
            scores.push_back(countIdentical(scale, answers));
        else
            scores.push_back(scoreItems(definition, scale, answers));
    }
    return scores;
}

std::string_view classOf(const Scale& scale, double value) {
    std::string_view label;
    for (const Class& next : scale.classes)
        if (value >= next.from) label = next.label;
    return label;
}

std::vector<std::string> goldenFaults(const Definition& definition, const Golden& golden) {
    std::vector<std::string> faults;
    const auto text = [](const std::optional<double>& value) {
        return value ? fmt::format("{:.6g}", *value) : std::string("no score");
    };
    const auto scores = computeScores(definition, golden.answers);
    for (const Golden::Expected& expected : golden.scores) {
        const Scale& scale = definition.scales[expected.scale];
        const auto& value = scores[expected.scale].value;
        const bool agree = value && expected.value ? std::abs(*value - *expected.value) <= kHalfOfLastDigit
                                                   : !value && !expected.value;
        if (!agree)
            faults.push_back(fmt::format("scale {} gives {}, not {}", scale.name, text(value), text(expected.value)));
        else if (!expected.class_label.empty() && classOf(scale, *value) != expected.class_label)
            faults.push_back(fmt::format("{} on scale {} is in class \"{}\", not \"{}\"", text(value), scale.name,
                                         classOf(scale, *value), expected.class_label));
    }
    return faults;
}

}  // namespace passung::questionnaire
