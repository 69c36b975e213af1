#include "study/person/simulated_answers.h"

#include <gtest/gtest.h>

#include <cmath>

namespace passung::person {
namespace {

using questionnaire::AnswerKind;
using questionnaire::Definition;
using questionnaire::Felt;
using questionnaire::Item;

Item rating(std::optional<Felt> felt) {
    Item item;
    item.response.low = 1.0;
    item.response.high = 7.0;
    item.felt = felt;
    return item;
}

Definition ratings(const std::vector<std::optional<Felt>>& felt) {
    Definition definition;
    for (const auto& each : felt) definition.items.push_back(rating(each));
    return definition;
}

std::vector<std::size_t> listed(const Definition& definition) {
    std::vector<std::size_t> order(definition.items.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    return order;
}

/// Rates as meant: no noise, no leaning.
constexpr RatingStyle kExact{.extremity = 1.0, .leaning = 0.0, .noise = 0.0};

TEST(SimulatedAnswers, FollowWhatWasRenderedByTheStatedFunction) {
    // Truth: closed form: 1 + 6 u to the nearest integer, u = 5/(5+5), 30/(30+10), 0.2 and 0.004/(0.004+0.002).
    const Experience experience = experienceOf(5.0, 30.0, 0.2, 0.004);
    const auto definition =
        ratings({Felt::Force, Felt::Time, Felt::Failure, Felt::Success, Felt::Depth, Felt::Hardness, {}});
    const auto answers = answerItems(definition, listed(definition), experience, kExact, 3);
    std::vector<double> numbers;
    for (const auto& answer : answers) numbers.push_back(answer.number.value());
    EXPECT_EQ(numbers, (std::vector<double>{4, 6, 2, 6, 5, 3, 4}));
}

TEST(SimulatedAnswers, CarryThePersonsUseOfScales) {
    // Truth: closed form: 0.5 + 1.8 * (0.75 - 0.5) = 0.95 of six steps is 5.7, so 6 of them; the middle stays.
    const auto definition = ratings({Felt::Time, {}});
    constexpr RatingStyle kExtreme{.extremity = 1.8, .leaning = 0.0, .noise = 0.0};
    const auto answers = answerItems(definition, {0, 1}, experienceOf(0, 30, 0, 0), kExtreme, 3);
    EXPECT_EQ(answers[0].number, 7.0);
    EXPECT_EQ(answers[1].number, 4.0);
}

TEST(SimulatedAnswers, AreOnesThatTheItemsOffer) {
    // Truth: invariant
    Definition definition = ratings({Felt::Force, {}});
    definition.items[0].response = {AnswerKind::Rating, 0.0, 100.0, 5.0, {}, {}, {}};
    definition.items.resize(6);
    definition.items[2].response = {AnswerKind::Number, 16.0, 120.0, 1.0, {}, {}, {}};
    definition.items[3].response = {AnswerKind::Choice, 0.0, 0.0, 1.0, {}, {}, {{-50.0, "l"}, {100.0, "r"}}};
    definition.items[4].response.kind = AnswerKind::Text;
    definition.items[5].response.kind = AnswerKind::Pair;
    definition.items[5].of = {0, 1};
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        const auto answers = answerItems(definition, listed(definition), {}, drawRatingStyle(seed), seed);
        for (std::size_t i = 0; i < answers.size(); ++i) {
            EXPECT_EQ(answers[i].missing(), i == 4);
            EXPECT_EQ(questionnaire::answerFault(definition.items[i], answers[i]), "") << i;
        }
        EXPECT_EQ(answers[5].number, *answers[0].number > *answers[1].number ? 0.0 : 1.0);
    }
}

TEST(SimulatedAnswers, AreThoseOfTheSeed) {
    // Truth: invariant
    const auto definition = ratings({{}, {}, {}, {}, {}, {}, {}, {}});
    const auto answer = [&](std::uint64_t seed) {
        std::vector<double> numbers;
        for (const auto& each : answerItems(definition, listed(definition), {}, RatingStyle{}, seed))
            numbers.push_back(*each.number);
        return numbers;
    };
    EXPECT_EQ(answer(4), answer(4));
    EXPECT_NE(answer(4), answer(5));
}

}  // namespace
}  // namespace passung::person
