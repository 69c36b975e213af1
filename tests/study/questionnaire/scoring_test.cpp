#include "study/questionnaire/scoring.h"

#include <gtest/gtest.h>

#include <cmath>

namespace passung::questionnaire {
namespace {

std::vector<Answer> answersOf(const std::vector<std::optional<double>>& numbers) {
    std::vector<Answer> answers;
    for (const auto& number : numbers) answers.push_back({number, ""});
    return answers;
}

/// Four items from 0 to 10, the last one reversed.
Definition fourItems() {
    Definition definition;
    for (const char* id : {"a", "b", "c", "d"}) {
        Item item;
        item.id = id;
        item.response.high = 10.0;
        definition.items.push_back(item);
    }
    definition.items[3].reversed = true;
    return definition;
}

Scale scaleOf(Formula formula, std::vector<std::size_t> items) {
    Scale scale;
    scale.name = "s";
    scale.formula = formula;
    scale.items = std::move(items);
    return scale;
}

TEST(Scoring, AReversedItemIsAlignedBeforeShiftAndFactor) {
    // Truth: closed form: 2 * ((1 - 3) + (3 - 3) + (10 - 4 - 3)) = 2.
    Definition definition = fourItems();
    definition.scales = {scaleOf(Formula::Sum, {0, 2, 3})};
    definition.scales[0].shift = -3.0;
    definition.scales[0].factor = 2.0;
    const auto scores = computeScores(definition, answersOf({1, 9, 3, 4}));
    EXPECT_DOUBLE_EQ(scores[0].value.value(), 2.0);
    EXPECT_EQ(scores[0].items, 3u);
    EXPECT_EQ(scores[0].missing, 0u);
}

TEST(Scoring, AMissingItemLeavesNoScoreUnlessTheScaleAllowsIt) {
    // Truth: closed form: of 1, 2, (missing), 10 - 4: mean 3, and a sum of four such items is 12.
    Definition definition = fourItems();
    definition.scales = {scaleOf(Formula::Mean, {0, 1, 2, 3}), scaleOf(Formula::Mean, {0, 1, 2, 3}),
                         scaleOf(Formula::Sum, {0, 1, 2, 3}), scaleOf(Formula::Mean, {0, 1})};
    definition.scales[1].max_missing = definition.scales[2].max_missing = 1;
    const auto scores = computeScores(definition, answersOf({1, 2, std::nullopt, 4}));
    EXPECT_FALSE(scores[0].value);
    EXPECT_EQ(scores[0].missing, 1u);
    EXPECT_DOUBLE_EQ(scores[1].value.value(), 3.0);
    EXPECT_DOUBLE_EQ(scores[2].value.value(), 12.0);
    EXPECT_DOUBLE_EQ(scores[3].value.value(), 1.5) << "the missing item is not in this scale";
    const auto two_missing = computeScores(definition, answersOf({1, std::nullopt, std::nullopt, 4}));
    EXPECT_FALSE(two_missing[1].value);
    EXPECT_FALSE(two_missing[2].value);
    EXPECT_EQ(two_missing[2].missing, 2u);
}

TEST(Scoring, AScaleOfScalesHasAScoreOnlyIfEachHas) {
    // Truth: closed form
    Definition definition = fourItems();
    definition.scales = {scaleOf(Formula::Mean, {0, 1}), scaleOf(Formula::Sum, {1, 2}), {}};
    definition.scales[2].scales = {0, 1};
    definition.scales[2].formula = Formula::Sum;
    definition.scales[2].factor = 0.5;
    const auto scores = computeScores(definition, answersOf({1, 3, 5, 0}));
    EXPECT_DOUBLE_EQ(scores[2].value.value(), 0.5 * (2.0 + 8.0));
    EXPECT_EQ(scores[2].items, 4u) << "an item that enters twice counts twice";
    const auto missing = computeScores(definition, answersOf({1, 3, std::nullopt, 0}));
    EXPECT_FALSE(missing[2].value);
    EXPECT_EQ(missing[2].missing, 1u);
}

TEST(Scoring, PairsWeighARating) {
    // Truth: closed form: a wins against b and c, c against b: weights 2, 0, 1; (2*6 + 0*9 + 1*3) / 3 = 5.
    Definition definition = fourItems();
    definition.items.pop_back();
    for (const auto& of : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}}) {
        Item pair;
        pair.response.kind = AnswerKind::Pair;
        pair.of = of;
        definition.items.push_back(pair);
    }
    definition.scales = {scaleOf(Formula::PairWeighted, {0, 1, 2})};
    EXPECT_DOUBLE_EQ(computeScores(definition, answersOf({6, 9, 3, 0, 0, 1}))[0].value.value(), 5.0);
    const auto open = computeScores(definition, answersOf({6, 9, 3, 0, std::nullopt, 1}));
    EXPECT_FALSE(open[0].value);
    EXPECT_EQ(open[0].items, 6u);
    EXPECT_EQ(open[0].missing, 1u);
    EXPECT_FALSE(computeScores(definition, answersOf({6, std::nullopt, 3, 0, 0, 1}))[0].value)
        << "b weighs nothing here, but it was asked";
}

TEST(Scoring, LateralityComparesMarksForBothHands) {
    // Truth: closed form: 2 + 1 + 1 marks right, 1 + 1 left; "both" marks both.
    Definition definition = fourItems();
    definition.scales = {scaleOf(Formula::Laterality, {0, 1, 2, 3})};
    EXPECT_DOUBLE_EQ(computeScores(definition, answersOf({2, 1, 0, -1}))[0].value.value(), 100.0 * (4 - 2) / (4 + 2));
    EXPECT_DOUBLE_EQ(computeScores(definition, answersOf({-1, -1, -2, -2}))[0].value.value(), -100.0);
    EXPECT_FALSE(computeScores(definition, answersOf({2, std::nullopt, 0, -1}))[0].value);
}

TEST(Scoring, CarelessAnswersAreCounted) {
    // Truth: closed form: the last item is reversed, so that equal answers are 10 - 2 x 2 = 6 apart; identical ones are
    // counted as given. A difference of exactly the spread is not wide.
    Definition definition = fourItems();
    definition.scales = {scaleOf(Formula::Mean, {0, 3}),
                         scaleOf(Formula::Mean, {1, 2}),
                         {},
                         scaleOf(Formula::MostIdentical, {0, 1, 2, 3})};
    definition.scales[2].formula = Formula::WideScales;
    definition.scales[2].scales = {0, 1};
    definition.scales[2].spread = 5.0;
    const auto wide = [&](const std::vector<std::optional<double>>& answers) {
        return computeScores(definition, answersOf(answers))[2].value;
    };
    EXPECT_EQ(wide({2, 2, 2, 2}), 1.0);
    EXPECT_EQ(wide({2, 2, 7, 8}), 0.0);
    EXPECT_EQ(wide({2, 2, 8, 2}), 2.0);
    EXPECT_FALSE(wide({2, 2, std::nullopt, 2}));
    EXPECT_EQ(computeScores(definition, answersOf({2, 3, 2, 3}))[3].value, 2.0);
    EXPECT_EQ(computeScores(definition, answersOf({2, 2, 2, 3}))[3].value, 3.0);
}

TEST(Scoring, AClassBeginsAtItsLimit) {
    // Truth: closed form
    Scale scale;
    scale.classes = {{"left", -100.0}, {"mixed", -60.0}, {"right", 61.0}};
    EXPECT_EQ(classOf(scale, -100.0), "left");
    EXPECT_EQ(classOf(scale, -62.5), "left");
    EXPECT_EQ(classOf(scale, -60.0), "mixed");
    EXPECT_EQ(classOf(scale, 60.0), "mixed");
    EXPECT_EQ(classOf(scale, 61.0), "right");
    EXPECT_EQ(classOf(scale, -101.0), "");
}

TEST(Scoring, AGoldenVectorHoldsToFourDecimalsOnly) {
    // Truth: closed form: the mean of 1, 2, 2 is 1.66666...
    Definition definition = fourItems();
    definition.scales = {scaleOf(Formula::Mean, {0, 1, 2})};
    const Golden rounded{answersOf({1, 2, 2, 0}), {{0, 1.6667, ""}}};
    EXPECT_TRUE(goldenFaults(definition, rounded).empty());
    for (const std::optional<double> wrong : {std::optional(1.6666), std::optional(1.6668), std::optional<double>()}) {
        const Golden golden{answersOf({1, 2, 2, 0}), {{0, wrong, ""}}};
        EXPECT_EQ(goldenFaults(definition, golden).size(), 1u);
    }
}

TEST(Scoring, AnAnswerMustBeOneThatTheItemOffers) {
    // Truth: closed form
    Item item;
    item.response.high = 100.0;
    item.response.step = 5.0;
    const auto fault = [&](double value) { return answerFault(item, {value, ""}); };
    EXPECT_EQ(fault(0), "");
    EXPECT_EQ(fault(35), "");
    EXPECT_EQ(fault(36), "must be 0 and a multiple of 5");
    EXPECT_EQ(fault(105), "must be from 0 to 100");
    EXPECT_NE(fault(std::nan("")), "");
    EXPECT_EQ(answerFault(item, {std::nullopt, "many"}), "must be a number");
    EXPECT_EQ(answerFault(item, {}), "") << "skipped";
    item.response.kind = AnswerKind::Choice;
    item.response.options = {{1.0, "yes"}, {2.0, "no"}};
    EXPECT_EQ(fault(2), "");
    EXPECT_EQ(fault(3), "is none of the options");
    item.response.kind = AnswerKind::Pair;
    EXPECT_EQ(fault(1), "");
    EXPECT_NE(fault(2), "");
}

}  // namespace
}  // namespace passung::questionnaire
