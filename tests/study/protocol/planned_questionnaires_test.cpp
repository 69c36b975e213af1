#include "study/protocol/planned_questionnaires.h"

#include <gtest/gtest.h>

#include <map>

#include "core/base/regular_file.h"
#include "study/plan/language.h"

namespace passung::protocol {
namespace {

plan::StudyPlan planOf(const std::string& tables, Errors& errors) {
    plan::StudyPlan plan;
    plan.source_path = "studies/study.toml";
    plan.blocks = {{"practice", plan::Phase::Practice, 1, plan::BlockOrder::Listed, 0},
                   {"main", plan::Phase::Main, 1, plan::BlockOrder::Listed, 0}};
    const auto document = parseDocument(tables, plan.source_path);
    plan.questionnaires = readQuestionnaires(document->find("questionnaire")->items, plan.blocks, errors);
    return plan;
}

/// Files by path, and which were read.
struct Files {
    std::map<std::string, std::string> text;
    std::vector<std::string> read = {};
    Result<std::string> operator()(const std::string& path) {
        read.push_back(path);
        if (text.count(path) == 0) return Error{"cannot be opened", path};
        return text.at(path);
    }
};

std::string shipped(const std::string& key) {
    return *readFile(PASSUNG_SOURCE_DIR "/protocols/questionnaires/" + key + ".toml");
}

constexpr const char* kTlx = "[[questionnaire]]\nfile = \"q/tlx.toml\"\nmoment = \"after_block\"\nlanguage = \"de\"\n";

TEST(PlannedQuestionnaires, FilesLieBesideTheStudyAndGoIntoItsExpandedText) {
    // Truth: closed form
    Errors errors;
    plan::StudyPlan plan = planOf(kTlx, errors);
    EXPECT_TRUE(errors.empty());
    Files files{{{"studies/q/tlx.toml", shipped("nasa_tlx_raw")}}};
    ASSERT_TRUE(loadQuestionnaires(plan, std::ref(files)));
    const plan::PlannedQuestionnaire& planned = plan.questionnaires.front();
    EXPECT_EQ(planned.moment, plan::Moment::AfterBlock);
    EXPECT_EQ(planned.definition.language, "de");
    EXPECT_EQ(planned.definition.items.size(), 6u);
    EXPECT_NE(plan.expanded_json.find(planned.source_json), std::string::npos);
    EXPECT_NE(planned.source_json.find("Wie geistig anstrengend"), std::string::npos);
}

TEST(PlannedQuestionnaires, AFaultLeavesThePlanAsItWasAndNamesTheFile) {
    // Truth: invariant: a golden vector of the file was changed.
    Errors errors;
    plan::StudyPlan plan = planOf(kTlx, errors);
    std::string wrong = shipped("nasa_tlx_raw");
    wrong.replace(wrong.find("47.5"), 4, "47.6");
    Files files{{{"studies/q/tlx.toml", wrong}}};
    const auto done = loadQuestionnaires(plan, std::ref(files));
    ASSERT_FALSE(done);
    EXPECT_EQ(done.errors().front().file, "studies/q/tlx.toml");
    EXPECT_EQ(done.errors().front().message, "scale workload gives 47.5, not 47.6");
    EXPECT_TRUE(plan.questionnaires.front().definition.items.empty());
    EXPECT_EQ(plan.expanded_json, "");
}

TEST(PlannedQuestionnaires, ASlotNeedsTextsInTheStudysLanguageAndNothingElseTakesTexts) {
    // Truth: closed form; the words are a regression
    std::string texts = "texts_for = \"ueq_s\"\nlanguage = \"de\"\nsource = \"made up\"\nlow = 1\nhigh = 7\n";
    for (int i = 1; i <= 8; ++i) texts += "[[item]]\nid = \"i" + std::to_string(i) + "\"\ntext = \"Text\"\n";
    Files files{{{"studies/u.toml", shipped("ueq_s")}, {"studies/t.toml", texts}, {"studies/n.toml", shipped("ssq")}}};
    const auto faultOf = [&](const std::string& table) -> std::string {
        Errors errors;
        plan::StudyPlan plan = planOf("[[questionnaire]]\nmoment = \"session_end\"\n" + table, errors);
        const auto done = loadQuestionnaires(plan, std::ref(files));
        return done ? "" : toString(done.errors().front());
    };
    EXPECT_EQ(faultOf("file = \"u.toml\"\ntexts = \"t.toml\"\nlanguage = \"de\"\n"), "");
    EXPECT_EQ(
        faultOf("file = \"u.toml\"\ntexts = \"t.toml\"\n"),
        "studies/study.toml:1:1: error: questionnaire.language: \"en\": there are no texts of ueq_s in this language");
    EXPECT_EQ(faultOf("file = \"n.toml\"\ntexts = \"t.toml\"\n"),
              "studies/study.toml:1:1: error: questionnaire.texts: \"t.toml\": ssq has texts of its own");
    EXPECT_EQ(faultOf("file = \"u.toml\"\ntexts = \"none.toml\"\n"),
              "studies/study.toml:1:1: error: questionnaire.texts: \"none.toml\": cannot be opened");
}

TEST(PlannedQuestionnaires, OfAStudyInSeveralLanguagesAreAskedInThatOfTheSession) {
    // Truth: closed form (the shipped file's own texts); the words are a regression
    Errors errors;
    plan::StudyPlan plan = planOf(kTlx, errors);
    plan.languages = {"en", "de"};
    Files files{{{"studies/q/tlx.toml", shipped("nasa_tlx_raw")}}};
    ASSERT_TRUE(loadQuestionnaires(plan, std::ref(files)));
    EXPECT_EQ(plan::languagesAsked(plan, plan.questionnaires[0]), plan.languages);
    const std::string stored = plan.expanded_json;
    ASSERT_TRUE(loadQuestionnaires(plan, std::ref(files), "en"));
    EXPECT_EQ(plan.questionnaires[0].definition.language, "en");
    EXPECT_NE(plan.expanded_json, stored) << "only the plan as it was is the protocol's";

    plan.languages = {"de", "fr"};
    plan.questionnaires[0].language = "de";
    const auto missing = loadQuestionnaires(plan, std::ref(files));
    ASSERT_FALSE(missing);
    EXPECT_EQ(
        toString(missing.errors().front()),
        "studies/study.toml:1:1: error: questionnaire.language: \"fr\": there are no texts of nasa_tlx_raw in this "
        "language of the study");
    plan.languages = {"fr", "it"};
    EXPECT_TRUE(loadQuestionnaires(plan, std::ref(files))) << "German whatever the session is in";
    EXPECT_TRUE(loadQuestionnaires(plan, std::ref(files), "it"));
    EXPECT_EQ(plan.questionnaires[0].language, "de");
}

TEST(PlannedQuestionnaires, ASlotOfAStudyInSeveralLanguagesHasItsTextsInEach) {
    // Truth: closed form; the words are a regression
    const auto texts = [](const std::string& language) {
        std::string text =
            "texts_for = \"ueq_s\"\nlanguage = \"" + language + "\"\nsource = \"made up\"\nlow = 1\nhigh = 7\n";
        for (int i = 1; i <= 8; ++i) text += "[[item]]\nid = \"i" + std::to_string(i) + "\"\ntext = \"Text\"\n";
        return text;
    };
    Files files{
        {{"studies/u.toml", shipped("ueq_s")}, {"studies/de.toml", texts("de")}, {"studies/en.toml", texts("en")}}};
    const auto table = [](const std::string& language) {
        return "[[questionnaire]]\nmoment = \"session_end\"\nfile = \"u.toml\"\ntexts = \"" + language +
               ".toml\"\nlanguage = \"" + language + "\"\n";
    };
    Errors errors;
    plan::StudyPlan one = planOf(table("de"), errors);
    one.languages = {"en", "de"};
    const auto missing = loadQuestionnaires(one, std::ref(files));
    ASSERT_FALSE(missing);
    EXPECT_NE(toString(missing.errors().front()).find("\"de.toml\": the study is also in \"en\""), std::string::npos);

    plan::StudyPlan both = planOf(table("de") + table("en"), errors);
    EXPECT_FALSE(loadQuestionnaires(both, std::ref(files))) << "asked twice at one moment";
    both.languages = {"en", "de"};
    const auto done = loadQuestionnaires(both, std::ref(files));
    ASSERT_TRUE(done) << toString(done.errors().front());
    ASSERT_TRUE(loadQuestionnaires(both, std::ref(files), "en"));
    ASSERT_EQ(both.questionnaires.size(), 1u);
    EXPECT_EQ(both.questionnaires[0].definition.language, "en");
}

TEST(PlannedQuestionnaires, ABlockHasNoMeaningAtTheEndsOfASession) {
    // Truth: closed form; the words are a regression
    Errors errors;
    planOf("[[questionnaire]]\nfile = \"x\"\nmoment = \"session_end\"\nblock = \"main\"\n", errors);
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(toString(errors.front()),
              "studies/study.toml:4:9: error: questionnaire.block: \"main\": has no meaning at the start or end of a "
              "session");
}

}  // namespace
}  // namespace passung::protocol
