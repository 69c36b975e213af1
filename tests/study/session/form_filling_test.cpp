#include "study/session/form_filling.h"

#include <gtest/gtest.h>

namespace passung::session {
namespace {

/// Two ratings from 0 to 10 and a text, shown last item first.
class FormFillingTest : public testing::Test {
protected:
    FormFillingTest() {
        for (const char* id : {"a", "b", "text"}) {
            questionnaire::Item item;
            item.id = id;
            item.response.high = 10.0;
            if (std::string(id) == "text") item.response.kind = questionnaire::AnswerKind::Text;
            planned_.definition.items.push_back(item);
        }
    }
    FormFilling filling(std::int64_t now_ms) const {
        return FormFilling(ShownQuestionnaire{planned_, {}, "1|session_end|||", {2, 1, 0}, {}}, now_ms);
    }

    plan::PlannedQuestionnaire planned_;
};

TEST_F(FormFillingTest, TimesEveryItemFromItsFirstShowingToItsLastAnswer) {
    // Truth: closed form: shown at 100, 400, 1000; answered at 400, 1000, 1500; b again at 2100; a kept at 2600.
    FormFilling filling = this->filling(100);
    EXPECT_EQ(filling.item().id, "text");
    EXPECT_EQ(filling.give({std::nullopt, "hard"}, 400), "");
    EXPECT_EQ(filling.give({3.0, ""}, 1000), "");
    EXPECT_EQ(filling.give({7.0, ""}, 1500), "");
    ASSERT_TRUE(filling.atEnd());
    EXPECT_TRUE(filling.back(1600));
    EXPECT_TRUE(filling.back(1800));
    EXPECT_EQ(filling.item().id, "b");
    EXPECT_EQ(filling.answer().number, 3.0);
    EXPECT_EQ(filling.give({4.0, ""}, 2100), "");
    EXPECT_EQ(filling.give(filling.answer(), 2600), "");
    const FilledForm filled = filling.filled("experimenter");
    EXPECT_EQ(filled.answered_by, "experimenter");
    ASSERT_EQ(filled.answers.size(), 3u);
    EXPECT_EQ(filled.answers[2].answer.text, "hard");
    EXPECT_EQ(filled.answers[2].response_ms, 300);
    EXPECT_EQ(filled.answers[1].answer.number, 4.0);
    EXPECT_EQ(filled.answers[1].response_ms, 1700);
    EXPECT_EQ(filled.answers[1].changes, 1);
    EXPECT_EQ(filled.answers[0].response_ms, 500) << "confirming an answer does not change it";
    EXPECT_EQ(filled.answers[0].changes, 0);
}

TEST_F(FormFillingTest, AnItemMayBeLeftOutButNotAnsweredWrong) {
    // Truth: closed form; a wrong answer keeps the item, one that is given later is no change.
    FormFilling filling = this->filling(0);
    EXPECT_FALSE(filling.back(10)) << "there is no item before the first";
    EXPECT_EQ(filling.give({}, 20), "");
    EXPECT_EQ(filling.give({11.0, ""}, 30), "must be from 0 to 10");
    EXPECT_EQ(filling.item().id, "b");
    EXPECT_EQ(filling.shown(), 1u);
    EXPECT_EQ(filling.give({}, 40), "");
    EXPECT_TRUE(filling.back(50));
    EXPECT_EQ(filling.give({2.0, ""}, 60), "");
    EXPECT_EQ(filling.give({5.0, ""}, 70), "");
    const FilledForm filled = filling.filled("participant");
    EXPECT_TRUE(filled.answers[2].answer.missing());
    EXPECT_EQ(filled.answers[1].changes, 0) << "nothing had been given";
    EXPECT_EQ(filled.answers[1].response_ms, 40);
}

}  // namespace
}  // namespace passung::session
