#include "study/person/simulated_answers.h"

#include <algorithm>
#include <cmath>

#include "core/base/random.h"

namespace passung::person {
namespace {

using questionnaire::Answer;
using questionnaire::AnswerKind;
using questionnaire::Felt;
using questionnaire::Item;
using questionnaire::Response;

double feltPart(const Item& item, const Experience& experience) {
    if (!item.felt) return 0.5;
    switch (*item.felt) {
        case Felt::Force:
            return experience.force;
        case Felt::Time:
            return experience.time;
        case Felt::Failure:
            return experience.failure;
        case Felt::Success:
            return 1.0 - experience.failure;
        case Felt::Depth:
            return experience.depth;
        case Felt::Hardness:
            return 1.0 - experience.depth;
    }
    return 0.5;
}

/// Steps from the low to the high end.
int stepsOf(const Response& response) {
    constexpr int kHundredths = 100;
    if (!(response.step > 0.0)) return kHundredths;
    return static_cast<int>(std::lround((response.high - response.low) / response.step));
}

/// The answer so many steps above the low end.
Answer stepsUp(const Response& response, std::int64_t steps) {
    const double share = static_cast<double>(steps) / stepsOf(response);
    if (!(response.step > 0.0)) return {response.low + (response.high - response.low) * share, ""};
    return {response.low + response.step * static_cast<double>(steps), ""};
}

Answer rate(const Response& response, double impression, const RatingStyle& style, Random& random) {
    const double meant = 0.5 + style.extremity * (impression - 0.5) + style.leaning;
    const double place = std::clamp(meant + style.noise * random.normal(), 0.0, 1.0);
    return stepsUp(response, std::lround(place * stepsOf(response)));
}

Answer toss(Random& random) { return {static_cast<double>(random.below(2)), ""}; }

Answer answerPair(const Item& item, const std::vector<Answer>& answers, Random& random) {
    const auto& first = answers[item.of.first].number;
    const auto& second = answers[item.of.second].number;
    if (!first || !second || *first == *second) return toss(random);
    return {*first > *second ? 0.0 : 1.0, ""};
}

}  // namespace

Experience experienceOf(double force, double time, double failure, double depth) {
    const auto part = [](double value, double half) { return value / (value + half); };
    return {part(force, 5.0), part(time, 10.0), failure, part(depth, 0.002)};
}

RatingStyle drawRatingStyle(std::uint64_t seed) {
    Random random(seed);
    RatingStyle style;
    style.extremity = std::exp(0.25 * random.normal());
    style.leaning = 0.08 * random.normal();
    return style;
}

std::vector<Answer> answerItems(const questionnaire::Definition& definition, const std::vector<std::size_t>& order,
                                const Experience& experience, const RatingStyle& style, std::uint64_t seed) {
    Random random(seed);
    std::vector<Answer> answers(definition.items.size());
    for (const std::size_t i : order) {
        const Item& item = definition.items[i];
        const Response& response = item.response;
        switch (response.kind) {
            case AnswerKind::Rating:
                answers[i] = rate(response, feltPart(item, experience), style, random);
                break;
            case AnswerKind::Number: {
                const auto values = static_cast<std::uint64_t>(stepsOf(response)) + 1;
                answers[i] = stepsUp(response, static_cast<std::int64_t>(random.below(values)));
                break;
            }
            case AnswerKind::Choice:
                answers[i].number = response.options[random.below(response.options.size())].value;
                break;
            case AnswerKind::Pair:
                answers[i] = answerPair(item, answers, random);
                break;
            case AnswerKind::Text:
                break;
        }
    }
    return answers;
}

}  // namespace passung::person
