#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "core/base/regular_file.h"
#include "study/protocol/questionnaire_reader.h"
#include "study/questionnaire/scoring.h"

namespace passung::protocol {
namespace {

using questionnaire::Definition;

constexpr const char* kFolder = PASSUNG_SOURCE_DIR "/protocols/questionnaires/";

Definition readShipped(const std::string& key, std::string_view language = "en") {
    const std::string path = kFolder + key + ".toml";
    auto definition = readQuestionnaire(*readFile(path), path, language);
    if (!definition) throw std::runtime_error(toString(definition.errors().front()));
    return *std::move(definition);
}

std::vector<std::string> shippedKeys() {
    std::vector<std::string> keys;
    for (const auto& entry : std::filesystem::directory_iterator(kFolder))
        if (entry.path().extension() == ".toml") keys.push_back(entry.path().stem().string());
    std::sort(keys.begin(), keys.end());
    return keys;
}

std::vector<questionnaire::Answer> answersOf(const std::vector<double>& numbers) {
    std::vector<questionnaire::Answer> answers;
    for (const double number : numbers) answers.push_back({number, ""});
    return answers;
}

/// Of the file's golden vectors so many contradict `definition`.
std::size_t contradicted(const Definition& definition) {
    return static_cast<std::size_t>(
        std::count_if(definition.golden.begin(), definition.golden.end(),
                      [&](auto& golden) { return !questionnaire::goldenFaults(definition, golden).empty(); }));
}

TEST(ShippedQuestionnaires, AreSoundAndHaveGoldenVectorsThatHold) {
    // Truth: closed form (each file's own vectors)
    const auto keys = shippedKeys();
    EXPECT_EQ(keys.size(), 16u);
    for (const std::string& key : keys) {
        SCOPED_TRACE(key);
        const Definition definition = readShipped(key);
        EXPECT_EQ(definition.key, key) << "the file is named after the questionnaire";
        EXPECT_GE(definition.golden.size(), 1u);
        EXPECT_EQ(contradicted(definition), 0u);
    }
}

TEST(ShippedQuestionnaires, ThoseWithTextsHaveThemInEnglishAndGerman) {
    // Truth: invariant
    std::size_t with_texts = 0;
    for (const std::string& key : shippedKeys()) {
        const Definition english = readShipped(key), german = readShipped(key, "de");
        if (english.is_template) {
            for (const auto& item : english.items) EXPECT_EQ(item.text, "") << key << ": no text of others is shipped";
            continue;
        }
        ++with_texts;
        EXPECT_EQ(german.language, "de");
        for (std::size_t i = 0; i < english.items.size(); ++i) EXPECT_FALSE(german.items[i].text.empty());
        EXPECT_NE(english.items[0].text, german.items[0].text) << key;
    }
    EXPECT_EQ(with_texts, 9u);
}

struct Published {
    const char* key;
    std::vector<double> answers;
    std::vector<std::pair<const char*, double>> scores;
};

TEST(ShippedQuestionnaires, GivePublishedScores) {
    // Truth: independent program (worked by hand from the instruments' manuals, apart from the files)
    const std::vector<Published> table = {
        {"nasa_tlx_raw", {70, 25, 55, 30, 65, 40}, {{"workload", 47.5}}},
        {"sus_usability", {4, 2, 5, 1, 4, 2, 5, 2, 4, 3}, {{"usability", 80.0}}},
        {"ssq",
         {1, 1, 0, 2, 1, 0, 1, 0, 1, 0, 1, 0, 0, 0, 1, 0},
         {{"nausea", 38.16}, {"oculomotor", 53.06}, {"disorientation", 27.84}, {"total", 48.62}}},
        {"ueq",
         {6, 5, 2, 1, 2, 5, 6, 5, 2, 3, 6, 2, 5, 6, 4, 6, 1, 3, 2, 5, 2, 6, 1, 2, 1, 5},
         {{"attractiveness", 13.0 / 6},
          {"perspicuity", 1.75},
          {"efficiency", 2.0},
          {"dependability", 2.0},
          {"stimulation", 1.5},
          {"novelty", 1.0},
          {"pragmatic", 5.75 / 3},
          {"hedonic", 1.25}}},
        {"ueq_s", {6, 5, 6, 5, 4, 5, 3, 4}, {{"pragmatic", 1.5}, {"hedonic", 0.0}, {"overall", 0.75}}},
        {"ipq",
         {5, 4, 2, 5, 4, 5, 3, 4, 2, 4, 3, 3, 2, 1},
         {{"general", 5.0}, {"spatial", 4.4}, {"involvement", 3.75}, {"realism", 2.25}}},
        {"pq_uqo",
         {5, 6, 5, 4, 5, 4, 5, 6, 5, 5, 6, 5, 4, 3, 6, 5, 2, 2, 6, 5, 5, 4, 6, 5},
         {{"total", 99}, {"realism", 32}, {"act", 22}, {"interface", 17}, {"examine", 17}, {"performance", 11}}},
        {"ehi_short", {100, 100, 50, 100}, {{"laterality", 87.5}}},
        {"ehi_oldfield", {2, 2, 2, 2, 2, 2, 2, 2, 0, 0}, {{"laterality", 80.0}}},
    };
    for (const Published& row : table) {
        SCOPED_TRACE(row.key);
        const Definition definition = readShipped(row.key);
        const auto scores = questionnaire::computeScores(definition, answersOf(row.answers));
        for (const auto& [name, value] : row.scores)
            EXPECT_NEAR(scores[questionnaire::scaleNamed(definition, name).value()].value.value(), value, 1e-9) << name;
    }
}

TEST(ShippedQuestionnaires, WeightedLoadHasFifteenPairsWhoseWeightsSumToFifteen) {
    // Truth: closed form: (5*70 + 1*25 + 3*55 + 2*30 + 4*65 + 0*40) / 15; whoever wins, each pair gives one tally.
    const Definition definition = readShipped("nasa_tlx_weighted");
    std::vector<double> wins(6, 0.0);
    auto answers = answersOf({70, 25, 55, 30, 65, 40});
    const std::vector<double> rank = {5, 1, 3, 2, 4, 0};
    for (std::size_t i = 6; i < definition.items.size(); ++i) {
        const auto [first, second] = definition.items[i].of;
        const bool first_wins = rank[first] > rank[second];
        wins[first_wins ? first : second] += 1.0;
        answers.push_back({first_wins ? 0.0 : 1.0, ""});
    }
    EXPECT_EQ(definition.items.size(), 6u + 15u);
    EXPECT_EQ(wins, rank);
    EXPECT_NEAR(questionnaire::computeScores(definition, answers)[0].value.value(), 860.0 / 15.0, 1e-9);
}

TEST(ShippedQuestionnaires, AKeyOfDisorientationWithoutItemEightIsFound) {
    // Truth: invariant: a wrong key that is about must contradict a golden vector.
    Definition definition = readShipped("ssq");
    auto& items = definition.scales[questionnaire::scaleNamed(definition, "disorientation_raw").value()].items;
    ASSERT_EQ(std::erase(items, questionnaire::itemNamed(definition, "i8").value()), 1u);
    EXPECT_EQ(contradicted(definition), 2u);
}

TEST(ShippedQuestionnaires, WrongListsOfReversedPairsAreFound) {
    // Truth: invariant: the list without 25, and one that begins 3, 4, 5, 8, 9, 12, 13, are about.
    Definition missing = readShipped("ueq");
    missing.items[24].reversed = false;
    EXPECT_EQ(contradicted(missing), 3u);
    Definition other = readShipped("ueq");
    for (const std::size_t number : {8u, 13u}) other.items[number - 1].reversed = true;
    EXPECT_EQ(contradicted(other), 3u);
}

TEST(ShippedQuestionnaires, AnyItemReversedWronglyIsFound) {
    // Truth: invariant: an answer in the middle would hide it, so at least one vector has none there.
    for (const char* key :
         {"sus_usability", "ueq", "ipq", "pq_uqo", "contact_perception", "ergonomy", "nasa_tlx_raw"}) {
        const Definition sound = readShipped(key);
        for (std::size_t i = 0; i < sound.items.size(); ++i) {
            Definition wrong = sound;
            wrong.items[i].reversed = !wrong.items[i].reversed;
            EXPECT_GE(contradicted(wrong), 1u) << key << " " << sound.items[i].id;
        }
    }
}

}  // namespace
}  // namespace passung::protocol
