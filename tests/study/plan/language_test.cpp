#include "study/plan/language.h"

#include <gtest/gtest.h>

namespace passung::plan {
namespace {

using Languages = std::vector<std::string>;

TEST(Language, OfAStudyIsThatOfItsTextsElseOfItsConsentElseOfItsQuestionnaires) {
    // Truth: closed form.
    StudyPlan plan;
    EXPECT_EQ(languagesOf(plan), Languages{"en"});
    plan.questionnaires.resize(3);
    plan.questionnaires[0].language = plan.questionnaires[2].language = "fr";
    plan.questionnaires[1].language = "it";
    EXPECT_EQ(languagesOf(plan), (Languages{"fr", "it"}));
    plan.consent = {{"data", true, {{"de", "Ja?"}, {"nl", "Ja?"}}}, {"film", false, {{"de", "Ja?"}, {"nl", "Ja?"}}}};
    EXPECT_EQ(languagesOf(plan), (Languages{"de", "nl"}));
    plan.languages = {"nl", "de"};
    EXPECT_EQ(languagesOf(plan), (Languages{"nl", "de"}));
}

TEST(Language, IsTheFirstUnlessAnotherOneOfTheStudyIsAskedFor) {
    // Truth: closed form.
    StudyPlan plan;
    plan.source_path = "study.toml";
    plan.languages = {"nl", "de"};
    EXPECT_EQ(*chooseLanguage(plan, ""), "nl");
    EXPECT_EQ(*chooseLanguage(plan, "de"), "de");
    const auto other = chooseLanguage(plan, "en");
    ASSERT_FALSE(other);
    EXPECT_EQ(toString(other.errors().front()),
              "study.toml: error: language: \"en\": must be one of the protocol's languages: nl, de");
}

}  // namespace
}  // namespace passung::plan
