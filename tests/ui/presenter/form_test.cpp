#include "ui/presenter/form.h"

#include <gtest/gtest.h>

namespace passung {
namespace {

using presenter::Form;
using presenter::FormFault;
using presenter::FormRequest;
using presenter::FormView;
using presenter::ItemControl;
using questionnaire::AnswerKind;
using questionnaire::Item;

Item itemOf(AnswerKind kind, const std::string& id) {
    Item item;
    item.id = id;
    item.text = "What about " + id + "?";
    item.response.kind = kind;
    return item;
}

Item rating(const std::string& id, double low, double high, double step) {
    Item item = itemOf(AnswerKind::Rating, id);
    item.response.low = low;
    item.response.high = high;
    item.response.step = step;
    return item;
}

Item choice(const std::string& id, std::vector<questionnaire::Option> options) {
    Item item = itemOf(AnswerKind::Choice, id);
    item.response.options = std::move(options);
    return item;
}

Item number(const std::string& id, double low, double high) {
    Item item = itemOf(AnswerKind::Number, id);
    item.response.low = low;
    item.response.high = high;
    item.response.step = 0.0;
    return item;
}

Form formOf(std::vector<Item> items, std::vector<std::size_t> order = {}, bool consent = false) {
    auto request = std::make_shared<FormRequest>();
    request->id = "form";
    request->consent = consent;
    for (std::size_t i = 0; i < items.size() && order.size() < items.size(); ++i) order.push_back(i);
    request->order = std::move(order);
    request->definition.items = std::move(items);
    return Form(request, 0);
}

std::optional<double> answer(const Form& form, std::size_t item) {
    return form.filled("participant").answers[item].answer.number;
}

TEST(Form, ShowsItemsAsPresentedOnPagesThatAreAboutEquallyFull) {
    // Truth: closed form. Seven scales do not fit on a page of six: four and three.
    std::vector<Item> items;
    for (int i = 0; i < 7; ++i) items.push_back(rating("r" + std::to_string(i), 1, 7, 1));
    Form form = formOf(items, {6, 5, 4, 3, 2, 1, 0});
    EXPECT_EQ(form.view().pages, 2u);
    ASSERT_EQ(form.view().rows.size(), 4u);
    EXPECT_EQ(form.view().rows[0].text, "What about r6?");
    EXPECT_EQ(form.view().rows[0].number, 1u);
    for (std::size_t row = 0; row < 4; ++row) form.pick(row, 0, 1);
    form.next(2);
    ASSERT_EQ(form.view().rows.size(), 3u);
    EXPECT_EQ(form.view().rows[2].text, "What about r0?");
    EXPECT_EQ(form.view().rows[2].number, 7u);
    EXPECT_NEAR(form.view().share, 4.0 / 7.0, 1e-12);
}

TEST(Form, LooksFollowFromHowItemsAreAnswered) {
    // Truth: closed form
    const auto controlOf = [](const Item& item) { return formOf({item}).view().rows.front().control; };
    EXPECT_EQ(controlOf(rating("likert", 1, 7, 1)), ItemControl::Points);
    EXPECT_EQ(controlOf(rating("tlx", 0, 100, 5)), ItemControl::Ticks);
    EXPECT_EQ(formOf({rating("tlx", 0, 100, 5)}).view().rows.front().ticks, 21);
    EXPECT_EQ(controlOf(rating("vas", 0, 100, 0)), ItemControl::Line);
    EXPECT_EQ(controlOf(rating("percent", 0, 100, 1)), ItemControl::Line);
    EXPECT_EQ(controlOf(choice("side", {{7, "left"}, {9, "right"}})), ItemControl::Options);
    EXPECT_EQ(controlOf(number("age", 16, 120)), ItemControl::Number);
    EXPECT_EQ(controlOf(itemOf(AnswerKind::Text, "words")), ItemControl::Text);
}

TEST(Form, CountsTheTimeFromShowingToTheLastAnswerAndEveryChange) {
    // Truth: closed form
    Form form = formOf({rating("a", 1, 5, 1), rating("b", 1, 5, 1)});
    form.pick(0, 1, 1200);
    form.pick(0, 3, 2500);
    form.pick(0, 3, 9000);  // the same again is neither a change nor a later answer
    form.pick(1, 0, 4000);
    form.next(9999);
    ASSERT_TRUE(form.isDone());
    const auto filled = form.filled("participant");
    EXPECT_EQ(filled.answers[0].answer.number, 4.0);
    EXPECT_EQ(filled.answers[0].response_ms, 2500);
    EXPECT_EQ(filled.answers[0].changes, 1);
    EXPECT_EQ(filled.answers[1].response_ms, 4000);
    EXPECT_EQ(filled.answers[1].changes, 0);
    EXPECT_EQ(filled.answered_by, "participant");
}

TEST(Form, TimeDoesNotCountWhileItCannotBeSeen) {
    // Truth: closed form. 3 s of a pause lie within the 10 s.
    Form form = formOf({rating("a", 1, 5, 1)});
    form.hide(2000);
    form.hide(2500);
    form.unhide(5000);
    form.pick(0, 0, 10'000);
    form.next(10'000);
    EXPECT_EQ(form.filled("").answers[0].response_ms, 7000);
}

TEST(Form, OpenItemsArePointedOutOnceAndThenLeftOut) {
    // Truth: invariant, as at the terminal.
    Form form = formOf({rating("a", 1, 5, 1), rating("b", 1, 5, 1), rating("c", 1, 5, 1)});
    form.pick(0, 0, 1);
    form.focus(3);
    form.next(2);
    EXPECT_FALSE(form.isDone());
    EXPECT_EQ(form.view().open, 2u);
    EXPECT_EQ(form.view().focus, 1u);
    EXPECT_TRUE(form.view().rows[1].open);
    form.pick(1, 4, 3);
    EXPECT_EQ(form.view().open, 1u);
    form.next(4);
    ASSERT_TRUE(form.isDone());
    EXPECT_TRUE(form.filled("").answers[2].answer.missing());
    EXPECT_EQ(form.filled("").answers[1].answer.number, 5.0);
}

TEST(Form, AClauseOfConsentMustBeDecided) {
    // Truth: invariant
    Form form = formOf({choice("data", {{1, ""}, {0, ""}})}, {}, true);
    EXPECT_EQ(form.view().rows[0].control, ItemControl::Decision);
    for (int i = 0; i < 3; ++i) form.next(i);
    EXPECT_FALSE(form.isDone());
    EXPECT_TRUE(form.digit(0, 2, 5));
    form.next(6);
    ASSERT_TRUE(form.isDone());
    EXPECT_EQ(answer(form, 0), 0.0);
}

TEST(Form, KeysAnswerEveryKindOfScale) {
    // Truth: closed form
    Form form = formOf({rating("likert", 1, 7, 1), rating("differential", -3, 3, 1), rating("tlx", 0, 100, 5),
                        rating("vas", 0, 10, 0), choice("side", {{7, "left"}, {9, "right"}})});
    form.step(0, 1, 0);  // the first arrow: the middle
    EXPECT_EQ(*form.view().rows[0].value, 4.0);
    form.step(0, 1, 0);
    EXPECT_EQ(*form.view().rows[0].value, 5.0);
    EXPECT_TRUE(form.digit(0, 7, 0));
    EXPECT_EQ(*form.view().rows[0].value, 7.0);
    EXPECT_FALSE(form.digit(0, 8, 0));
    EXPECT_FALSE(form.digit(0, 0, 0));
    form.step(0, 1, 0);
    EXPECT_EQ(*form.view().rows[0].value, 7.0) << "there is nothing beyond the end";
    EXPECT_TRUE(form.digit(1, 1, 0));
    EXPECT_EQ(*form.view().rows[1].value, -3.0) << "the first point";
    form.step(2, -1, 0);
    EXPECT_EQ(*form.view().rows[2].value, 50.0);
    form.step(2, -1, 0);
    EXPECT_EQ(*form.view().rows[2].value, 45.0);
    EXPECT_TRUE(form.digit(2, 3, 0));
    EXPECT_EQ(*form.view().rows[2].value, 30.0);
    form.end(2, true, 0);
    EXPECT_EQ(*form.view().rows[2].value, 100.0);
    form.place(2, 62.4, 0);
    EXPECT_EQ(*form.view().rows[2].value, 60.0) << "the nearest mark";
    form.place(3, 6.25, 0);
    EXPECT_EQ(*form.view().rows[3].value, 6.25) << "any value";
    form.place(3, -5.0, 0);
    EXPECT_EQ(*form.view().rows[3].value, 0.0);
    EXPECT_TRUE(form.digit(4, 2, 0));
    EXPECT_EQ(*form.view().rows[4].value, 9.0);
    EXPECT_EQ(form.view().rows[4].picked, 1u);
}

TEST(Form, APairTurnsThePageAndCanBeChangedByGoingBack) {
    // Truth: closed form: 0 is the first of the pair, 1 the second.
    Item pair = itemOf(AnswerKind::Pair, "w");
    pair.of = {0, 1};
    Form form = formOf({rating("a", 0, 100, 5), rating("b", 0, 100, 5), pair, pair, pair}, {0, 1, 2, 3, 4});
    form.place(0, 5, 0);
    form.place(1, 5, 0);
    form.next(0);
    EXPECT_EQ(form.view().rows.front().labels, (std::vector<std::string>{"What about a?", "What about b?"}));
    form.pick(0, 1, 0);
    EXPECT_EQ(form.view().page, 2u);
    form.pick(0, 0, 0);
    EXPECT_EQ(form.view().page, 3u);
    form.pick(0, 0, 0);
    EXPECT_EQ(form.view().page, 3u) << "the last page is handed in by hand";
    form.back(0);
    form.back(0);
    EXPECT_EQ(form.view().rows.front().picked, 1u);
    form.step(0, -1, 0);
    EXPECT_EQ(form.view().rows.front().picked, 0u) << "an arrow changes it and stays";
    for (int i = 0; i < 3; ++i) form.next(0);
    ASSERT_TRUE(form.isDone());
    EXPECT_EQ(answer(form, 2), 0.0);
    EXPECT_EQ(form.filled("").answers[2].changes, 1);
}

TEST(Form, TypedAnswersCountOnceTheyAreFinishedAndMustBePossible) {
    // Truth: closed form
    Form form = formOf({number("age", 16, 120), itemOf(AnswerKind::Text, "words")});
    for (const char* typed : {"3", "3x"}) form.type(0, typed, 100);
    form.next(200);
    EXPECT_EQ(form.view().rows[0].fault, FormFault::NoNumber);
    form.next(200);
    EXPECT_FALSE(form.isDone()) << "what is no answer is not left out silently";
    form.type(0, "7", 300);
    form.focus(1);
    EXPECT_EQ(form.view().rows[0].fault, FormFault::OutOfRange);
    EXPECT_EQ(form.view().rows[0].typed, "7");
    for (const char* typed : {"3", "37", "37,5"}) form.type(0, typed, 400);
    form.focus(1);
    EXPECT_EQ(form.view().rows[0].fault, FormFault::None);
    form.type(1, "  well\n", 500);
    form.next(600);
    ASSERT_TRUE(form.isDone());
    const auto filled = form.filled("");
    EXPECT_EQ(filled.answers[0].answer.number, 37.5);
    EXPECT_EQ(filled.answers[0].response_ms, 400);
    EXPECT_EQ(filled.answers[1].answer.text, "well");
    EXPECT_EQ(filled.answers[1].changes, 0);
}

TEST(Form, TwoButtonsOfTheDeviceAreEnough) {
    // Truth: closed form. The first goes round the answers, the second goes on.
    Form form = formOf({rating("a", 1, 3, 1), rating("tlx", 0, 100, 50)});
    for (const double expected : {1.0, 2.0, 3.0, 1.0}) {
        form.button(1, 0);
        EXPECT_EQ(*form.view().rows[0].value, expected);
    }
    form.button(2, 0);
    EXPECT_EQ(form.view().focus, 1u);
    form.button(1, 0);
    form.button(1, 0);
    form.button(2, 0);
    EXPECT_EQ(form.view().focus, 2u);
    form.button(2, 0);
    ASSERT_TRUE(form.isDone());
    EXPECT_EQ(answer(form, 0), 1.0);
    EXPECT_EQ(answer(form, 1), 50.0);
}

}  // namespace
}  // namespace passung
