#include "study/protocol/questionnaire_reader.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/regular_file.h"
#include "study/protocol/questionnaire_texts.h"
#include "study/questionnaire/scoring.h"

namespace passung::protocol {
namespace {

const std::string kSound = R"(questionnaire = "small"
version = "1.0"
languages = ["en", "de"]
title = { en = "Title", de = "Titel" }
instruction = { en = "Do.", de = "Los." }
licence = "ours"
citation = "none"
[[response]]
name = "points"
kind = "rating"
low = 1
high = 5
[[response]]
name = "which"
kind = "pair"
[[item]]
id = "a"
response = "points"
text = { en = "An a?", de = "Ein a?" }
[[item]]
id = "b"
response = "points"
text = { en = "A b?", de = "Ein b?" }
reversed = true
[[item]]
id = "a_b"
response = "which"
pair = ["a", "b"]
[[scale]]
name = "both"
items = ["a", "b"]
[[scale]]
name = "weighted"
formula = "pair_weighted"
items = ["a", "b"]
[[golden]]
answers = [2, 2, 1]
scores = { both = 3, weighted = 4 }
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const auto position = text.find(from);
    if (position == std::string::npos) throw std::runtime_error("no " + from);
    return text.replace(position, from.size(), to);
}

/// All errors, a line each.
std::string faultsOf(const std::string& text) {
    const auto definition = readQuestionnaire(text, "q.toml", "");
    std::string lines;
    if (!definition)
        for (const Error& error : definition.errors()) lines += (lines.empty() ? "" : "\n") + toString(error);
    return lines;
}

TEST(QuestionnaireReader, TakesTheTextsOfTheLanguage) {
    // Truth: closed form
    EXPECT_EQ(faultsOf(kSound), "");
    const auto german = readQuestionnaire(kSound, "q.toml", "de");
    EXPECT_EQ(german->items[1].text, "Ein b?");
    EXPECT_EQ(german->items[2].text, "Ein a? / Ein b?");
    EXPECT_EQ(german->title, "Titel");
    EXPECT_EQ(readQuestionnaire(kSound, "q.toml", "fr")->language, "en");
    EXPECT_TRUE(isQuestionnaire(kSound, "q.toml"));
    EXPECT_FALSE(isQuestionnaire("[[questionnaire]]\nfile = \"x\"\n", "s.toml"));
}

struct Mistake {
    const char *from, *to, *expected;
};

TEST(QuestionnaireReader, NamesPlaceAndRequirementOfEachMistake) {
    // Truth: closed form: line and column of the mistake; the words are a regression.
    const std::vector<Mistake> mistakes = {
        {"id = \"a_b\"", "id = \"b\"", "q.toml:26:6: error: item.id: \"b\": two items have this id"},
        {", de = \"Ein b?\"", "", "q.toml:23:8: error: item.text: {...}: the text in \"de\" is missing"},
        {"{ en = \"Do.\", de = \"Los.\" }", "\"Do.\"",
         "q.toml:5:15: error: instruction: \"Do.\": needs a text for each language, as in { en = \"...\" }"},
        {"response = \"points\"\ntext = { en = \"A b", "response = \"point\"\ntext = { en = \"A b",
         "q.toml:22:12: error: item.response: \"point\": no response has this name"},
        {"high = 5", "high = 1", "q.toml:12:8: error: response.high: 1: must be > low"},
        {"high = 5", "high = 5\nstep = 3", "q.toml:13:8: error: response.step: 3: must lead from low to high"},
        {"pair = [\"a\", \"b\"]", "pair = [\"a\", \"c\"]",
         "q.toml:28:8: error: item.pair: [\"a\", \"c\"]: must be the ids of two items"},
        {"items = [\"a\", \"b\"]", "items = [\"a\", \"c\"]",
         "q.toml:31:15: error: scale.items: \"c\": no item has this id"},
        {"items = [\"a\", \"b\"]", "items = [\"a\", \"a_b\"]",
         "q.toml:31:9: error: scale.items: [\"a\", \"a_b\"]: a text or a pair cannot be scored"},
        {"items = [\"a\", \"b\"]", "items = [\"a\", \"b\"]\nmax_missing = 2",
         "q.toml:32:15: error: scale.max_missing: 2: must leave at least one answer"},
        {"items = [\"a\", \"b\"]\n[[golden]]", "items = [\"a\"]\n[[golden]]",
         "q.toml:34:11: error: scale.formula: \"pair_weighted\": needs every pair of its items once: 0 pairs, not 1"},
        {"answers = [2, 2, 1]", "answers = [2, 2]",
         "q.toml:37:11: error: golden.answers: [2, 2]: must be 3 answers, not 2"},
        {"answers = [2, 2, 1]", "answers = [2, 6, 1]",
         "q.toml:37:15: error: golden.answers: 6: item b: must be from 1 to 5"},
        {"both = 3", "both = 2", "q.toml:38:10: error: golden.scores: {...}: scale both gives 3, not 2"},
        {"both = 3", "bth = 3", "q.toml:38:12: error: golden.scores.bth: 3: no scale has this name"},
        {"version = \"1.0\"\n", "", "q.toml:1:1: error: version: required"},
        {"reversed = true", "revers = true",
         "q.toml:24:1: error: item.revers: unknown key; did you mean \"reversed\"?"},
    };
    for (const Mistake& mistake : mistakes)
        EXPECT_EQ(faultsOf(replaced(kSound, mistake.from, mistake.to)), mistake.expected);
}

TEST(QuestionnaireReader, WantsAGoldenVector) {
    // Truth: invariant
    const auto text = kSound.substr(0, kSound.find("[[golden]]"));
    EXPECT_EQ(faultsOf(text), "q.toml:1:1: error: golden: required");
}

TEST(QuestionnaireReader, AnyDamagedLineIsReadOrRefusedWithAPlace) {
    // Truth: invariant: no input may crash the reader, and no error may lack its place.
    for (std::size_t start = 0; start < kSound.size();) {
        const std::size_t end = kSound.find('\n', start) + 1;
        for (const char* value : {"", "nan", "-1", "\"x\"", "[]", "[{}, {}]", "{}", "true", "[1, \"a\"]"}) {
            const auto equals = kSound.find(" = ", start);
            if (equals >= end) continue;
            const auto damaged = *value == '\0' ? kSound.substr(0, start) + kSound.substr(end)
                                                : kSound.substr(0, equals + 3) + value + "\n" + kSound.substr(end);
            const auto read = readQuestionnaire(damaged, "d.toml", "");
            if (read) continue;
            for (const Error& error : read.errors()) {
                EXPECT_EQ(error.file, "d.toml");
                EXPECT_GE(error.line, 1) << toString(error);
            }
        }
        start = end;
    }
}

const std::string kTexts = R"(texts_for = "ueq_s"
language = "de"
source = "made up for this test"
low = 1
high = 7
)";

questionnaire::Definition shippedSlot(const std::string& key) {
    const std::string path = PASSUNG_SOURCE_DIR "/protocols/questionnaires/" + key + ".toml";
    return *readQuestionnaire(*readFile(path), path, "");
}

/// Texts for the eight items of a slot, last one first.
std::string textsFor(int items) {
    std::string text = kTexts;
    for (int i = items; i > 0; --i)
        text += "[[item]]\nid = \"i" + std::to_string(i) + "\"\ntext = \"Text " + std::to_string(i) + "\"\n";
    return text;
}

std::string faultsOfTexts(const std::string& key, const std::string& text) {
    const auto filled = withTexts(shippedSlot(key), text, "t.toml");
    std::string lines;
    if (!filled)
        for (const Error& error : filled.errors()) lines += (lines.empty() ? "" : "\n") + toString(error);
    return lines;
}

TEST(QuestionnaireTexts, FillASlotInTheirOwnOrderAndScoresFollow) {
    // Truth: closed form: items 8 ... 1 answered so that item i has the golden vector's answer; 1.5, 0, 0.75.
    const auto slot = shippedSlot("ueq_s");
    const auto filled = withTexts(slot, textsFor(8), "t.toml");
    ASSERT_TRUE(filled) << toString(filled.errors().front());
    EXPECT_EQ(filled->language, "de");
    EXPECT_EQ(filled->items.front().id, "i8");
    EXPECT_EQ(filled->items.back().text, "Text 1");
    std::vector<questionnaire::Answer> answers = slot.golden.front().answers;
    std::reverse(answers.begin(), answers.end());
    const auto scores = questionnaire::computeScores(*filled, answers);
    EXPECT_DOUBLE_EQ(scores[0].value.value(), 1.5);
    EXPECT_DOUBLE_EQ(scores[1].value.value(), 0.0);
    EXPECT_DOUBLE_EQ(scores[2].value.value(), 0.75);
}

TEST(QuestionnaireTexts, MustBeOfThisQuestionnaireCompleteAndOnItsScale) {
    // Truth: closed form: line and column of the mistake; the words are a regression.
    const std::string sound = textsFor(8);
    EXPECT_EQ(faultsOfTexts("ueq_s", textsFor(7)),
              "t.toml:6:1: error: item: [{...}, {...}, {...}, {...}, {...}, {...}, "
              "{...}]: the text of i8 is missing");
    EXPECT_EQ(faultsOfTexts("ueq_s", replaced(sound, "id = \"i8\"", "id = \"i9\"")).substr(0, 64),
              "t.toml:6:1: error: item: [{...}, {...}, {...}, {...}, {...}, {..");
    EXPECT_EQ(faultsOfTexts("ueq_s", replaced(sound, "low = 1", "low = -3")),
              "t.toml:4:7: error: low: -3: ueq_s is scored for answers from 1 to 7");
    EXPECT_EQ(faultsOfTexts("ueq_s", replaced(sound, "\"ueq_s\"", "\"ueq\"")),
              "t.toml:1:13: error: texts_for: \"ueq\": must be \"ueq_s\": the questionnaire that these texts are for");
    EXPECT_EQ(faultsOfTexts("ueq_s", sound + "reversed = true\n"),
              "t.toml:30:12: error: item.reversed: true: ueq_s says itself which items are reversed");
    EXPECT_EQ(faultsOfTexts("ueq_s", sound + "[[item]]\nid = \"i1\"\ntext = \"again\"\n"),
              "t.toml:31:6: error: item.id: \"i1\": two texts are for this item");
}

}  // namespace
}  // namespace passung::protocol
