#include "analysis/export/questionnaire_tables.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "analysis/export/export.h"
#include "study/questionnaire/cronbach_alpha.h"
#include "study/store/people/participant_records.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/study/store/fake_questionnaire.h"

namespace passung::exporter {
namespace {

using fake::require;

constexpr std::int64_t kSecond = 1'000'000'000;

/// Two people with all four conditions. Answers of person p in condition c: every item 2 + p + c, but one is skipped.
class QuestionnaireTables : public testing::Test {
protected:
    void SetUp() override {
        writeStudy();
        exportNow();
    }
    void exportNow() {
        const auto reader = require(store::StoreReader::open(folder_ / "s.db"));
        require(exportAll(reader, folder_ / "out", {}));
    }
    void writeStudy() {
        auto store = fake::openStore(folder_ / "s.db");
        for (int person = 0; person < 2; ++person) {
            auto writer = fake::beginAskingSession(*store, plan_, person == 0 ? "S001" : "S002", 4);
            for (std::size_t c = 0; c < 4; ++c) {
                // Not in the order of the conditions: the wide table must not depend on it.
                const std::size_t condition = person == 0 ? 3 - c : c;
                std::vector<std::optional<double>> answers(8, 2.0 + person + static_cast<double>(condition));
                if (person == 1 && condition == 0) answers[0].reset();
                require(fake::storeForm(*writer, plan_, {0, 0, {}, condition}, answers, kSecond));
            }
            require(fake::storeForm(*writer, plan_, {1, {}, {}, {}}, {34, 1, 2, 1, 0, 3, std::nullopt}, 2 * kSecond,
                                    fake::kHardText));
            require(writer->finishSession(true, 3 * kSecond));
        }
    }
    fake::CsvFile csv(const std::string& name) {
        std::ifstream stream(folder_ / ("out/" + name), std::ios::binary);
        return fake::readCsv({std::istreambuf_iterator<char>(stream), {}});
    }

    fake::TempFolder folder_;
    plan::StudyPlan plan_ = fake::makeAskingPlan();
};

TEST_F(QuestionnaireTables, ItemsHaveOneRowPerAnswerAsShown) {
    // Truth: closed form (what was written; items are shown last one first)
    const auto items = csv("questionnaire_items.csv");
    ASSERT_EQ(items.rows.size(), 2u * (4u * 8u + 7u));
    EXPECT_EQ(items.at(0, "participant_id"), "S001");
    EXPECT_EQ(items.at(0, "kind"), "simulated");
    EXPECT_EQ(items.at(0, "questionnaire"), "contact_perception");
    EXPECT_EQ(items.at(0, "condition"), "god/0,5");
    EXPECT_EQ(items.at(0, "item"), "matched");
    EXPECT_EQ(items.at(0, "presented_index"), "0");
    EXPECT_EQ(items.at(0, "value"), "5");
    EXPECT_EQ(items.at(0, "response_time_ms"), "707");
    EXPECT_EQ(items.at(0, "changes"), "2");
    EXPECT_EQ(items.at(32, "item"), "impairment");
    EXPECT_EQ(items.at(32, "value"), "NA");
    EXPECT_EQ(items.at(32, "value_text"), fake::kHardText);
    EXPECT_EQ(items.at(32, "block"), "NA");
}

TEST_F(QuestionnaireTables, ScoresSayScaleAndFormula) {
    // Truth: closed form: of answers 5, one of the two reversed: (5 + 8 - 5) / 2 = 4.
    const auto scores = csv("questionnaire_scores.csv");
    ASSERT_EQ(scores.rows.size(), 2u * 4u * 5u);
    std::size_t row = 0;
    while (scores.at(row, "scale") != "hardness") ++row;
    EXPECT_EQ(scores.at(row, "score"), "4");
    EXPECT_EQ(scores.at(row, "scale_label"), "Hard walls, 1 to 7");
    EXPECT_EQ(scores.at(row, "scale_formula"), "mean over hard, sank_in (reversed)");
    EXPECT_EQ(scores.at(row, "class"), "NA");
    EXPECT_EQ(scores.at(row, "scoring_version"), "1");
}

TEST_F(QuestionnaireTables, WideHasAColumnForEachOccasionInTheOrderOfConditions) {
    // Truth: closed form: clarity is the mean of two unreversed items, 2 + person + condition.
    const auto wide = csv("scores_wide.csv");
    ASSERT_EQ(wide.rows.size(), 2u);
    std::vector<std::string> columns;
    for (const std::string& name : wide.header)
        if (name.find("clarity") != std::string::npos) columns.push_back(name);
    const std::string start = "contact_perception.clarity.after_condition.main, \"first\".";
    EXPECT_EQ(columns, (std::vector<std::string>{start + "penalty_0.1", start + "penalty_0_5", start + "god_0.1",
                                                 start + "god_0_5"}));
    for (std::size_t person = 0; person < 2; ++person)
        for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(wide.at(person, columns[c]), std::to_string(2 + person + c));
    const auto people = csv("participants.csv");
    for (std::size_t person = 0; person < 2; ++person) {
        EXPECT_EQ(wide.at(person, "group"), people.at(person, "group"));
        EXPECT_EQ(wide.at(person, "order_sequence"), people.at(person, "sequence_index"));
    }
    EXPECT_EQ(wide.at(1, "contact_perception.hardness.after_condition.main, \"first\".penalty_0.1"), "NA");
}

TEST_F(QuestionnaireTables, ReliabilityIsOfAnOccasionOrOfPersons) {
    // Truth: closed form: two equal items have alpha 1, over persons at each of four conditions, over their means and
    // over the differences from them; an item and its reversal have sums that do not vary. S002 left out one item of
    // hardness in the first condition.
    const auto table = csv("questionnaire_reliability.csv");
    std::map<std::string, int> clarity, hardness;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        const std::string level = table.at(row, "level"), forms = table.at(row, "n_forms");
        const std::string people = table.at(row, "n_participants");
        if (table.at(row, "scale") == "clarity") {
            ++clarity[level];
            EXPECT_EQ(table.at(row, "cronbach_alpha"), "1") << level;
            EXPECT_EQ(people, "2") << level;
            EXPECT_EQ(forms, level == "occasion" ? "2" : "8") << level;
            EXPECT_EQ(table.at(row, "condition") == "NA", level != "occasion");
        } else if (table.at(row, "scale") == "hardness") {
            ++hardness[level];
            EXPECT_EQ(table.at(row, "cronbach_alpha"), "NA") << level;
            EXPECT_EQ(forms, level != "occasion" ? "7" : table.at(row, "condition") == "penalty/0.1" ? "1" : "2");
        }
    }
    EXPECT_EQ(clarity, (std::map<std::string, int>{{"occasion", 4}, {"between", 1}, {"within", 1}}));
    EXPECT_EQ(hardness, clarity);
}

TEST_F(QuestionnaireTables, KeysTellTextAnswersPolarityAndScales) {
    // Truth: invariant: the questionnaire's own file, which the export holds too, byte for byte.
    const auto keys = csv("questionnaire_keys.csv");
    const auto& definition = plan_.questionnaires[0].definition;
    std::size_t row = 0;
    while (keys.at(row, "item") != "sank_in") ++row;
    const auto item = questionnaire::itemNamed(definition, "sank_in");
    EXPECT_EQ(keys.at(row, "questionnaire"), "contact_perception");
    EXPECT_EQ(keys.at(row, "reversed"), "1");
    EXPECT_EQ(keys.at(row, "scales"), "hardness;overall");
    EXPECT_EQ(keys.at(row, "text"), definition.items[*item].text);
    EXPECT_EQ(keys.at(row, "low"), "1");
    EXPECT_EQ(keys.at(row, "high"), "7");
    EXPECT_NE(keys.at(row, "labels").find("1 = " + definition.items[*item].response.low_anchor), std::string::npos);
}

TEST_F(QuestionnaireTables, WhoIsExcludedCountsNowhere) {
    // Truth: invariant: without S001 everything that counts is S002's alone; the forms stay in the long tables.
    {
        const auto store = fake::openStore(folder_ / "s.db");
        require(store::ParticipantRecords(*store, {"e", ""}).exclude("S001", "asleep"));
    }
    exportNow();
    const auto wide = csv("scores_wide.csv");
    ASSERT_EQ(wide.rows.size(), 1u);
    EXPECT_EQ(wide.at(0, "participant_id"), "S002");
    const auto reliability = csv("questionnaire_reliability.csv");
    for (std::size_t row = 0; row < reliability.rows.size(); ++row) {
        if (reliability.at(row, "scale") == "clarity" && reliability.at(row, "level") == "occasion") {
            EXPECT_EQ(reliability.at(row, "n_forms"), "1");
        }
    }
    for (const char* file : {"questionnaire_items.csv", "questionnaire_scores.csv", "sessions.csv"}) {
        const auto table = csv(file);
        for (std::size_t row = 0; row < table.rows.size(); ++row)
            EXPECT_EQ(table.at(row, "counted"), table.at(row, "participant_id") == "S001" ? "0" : "1") << file;
    }
}

TEST_F(QuestionnaireTables, OnlyTheNewestFormOfAnOccasionCounts) {
    // Truth: closed form: one condition asked about twice, 3 then 7 at every item, in one session: clarity is 7.
    const std::string path = folder_ / "again.db";
    {
        auto store = fake::openStore(path);
        auto writer = fake::beginAskingSession(*store, plan_, "S003", 4);
        for (const double answer : {3.0, 7.0})
            for (const std::size_t condition : {0u, 1u})
                require(fake::storeForm(*writer, plan_, {0, 0, {}, condition},
                                        std::vector<std::optional<double>>(8, condition == 0 ? answer : 5.0), kSecond));
        require(writer->finishSession(true, 3 * kSecond));
    }
    require(exportAll(require(store::StoreReader::open(path)), folder_ / "out", {}));
    const auto wide = csv("scores_wide.csv");
    const std::string clarity = "contact_perception.clarity.after_condition.main, \"first\".";
    EXPECT_EQ(wide.at(0, clarity + "penalty_0.1"), "7");
    EXPECT_EQ(wide.at(0, clarity + "penalty_0_5"), "5");
    const auto items = csv("questionnaire_items.csv");
    ASSERT_EQ(items.rows.size(), 4u * 8u) << "all of them are there";
    for (std::size_t row = 0; row < items.rows.size(); ++row)
        EXPECT_EQ(items.at(row, "counted"), row < 16 ? "0" : "1") << row;
    const auto reliability = csv("questionnaire_reliability.csv");
    EXPECT_EQ(reliability.at(0, "n_forms"), "1");
}

TEST_F(QuestionnaireTables, NoCellOfAnyTableIsEmpty) {
    // Truth: invariant: README.md promises NA for a missing value. Demographics have answers without labels, and S001
    // is excluded without a reason. The codebook says of itself where it is empty.
    {
        auto store = fake::openStore(folder_ / "s.db");
        require(store::ParticipantRecords(*store, {"e", ""}).exclude("S001", ""));
    }
    exportNow();
    int tables = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "out")) {
        const std::string name = entry.path().filename().string();
        if (!name.ends_with(".csv") || name == "codebook.csv") continue;
        ++tables;
        const auto table = csv(name);
        for (const auto& row : table.rows)
            for (std::size_t i = 0; i < row.size(); ++i) EXPECT_NE(row[i], "") << name << ": " << table.header[i];
    }
    EXPECT_GE(tables, 12);
    EXPECT_EQ(csv("participants.csv").at(0, "status_reason"), "NA");
}

TEST_F(QuestionnaireTables, AreInTheCodebook) {
    // Truth: invariant: every column of every table is described.
    const auto book = csv("codebook.csv");
    for (const char* file : {"questionnaire_items.csv", "questionnaire_scores.csv", "scores_wide.csv",
                             "questionnaire_reliability.csv", "questionnaire_keys.csv"}) {
        std::vector<std::string> described;
        for (std::size_t row = 0; row < book.rows.size(); ++row)
            if (book.at(row, "file") == file) described.push_back(book.at(row, "column"));
        EXPECT_EQ(described, csv(file).header) << file;
    }
}

}  // namespace
}  // namespace passung::exporter
