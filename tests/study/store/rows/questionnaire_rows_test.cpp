#include "study/store/rows/questionnaire_rows.h"

#include <gtest/gtest.h>

#include "core/base/regular_file.h"
#include "study/store/schema/sqlite.h"
#include "tests/study/store/fake_questionnaire.h"

namespace passung::store {
namespace {

using fake::require;

constexpr std::int64_t kSecond = 1'000'000'000;

class QuestionnaireRows : public testing::Test {
protected:
    /// One condition's form with item "located" (index 3) skipped, then the demographics with a hard text.
    void write() {
        auto store = fake::openStore(folder_ / "s.db");
        auto writer = fake::beginAskingSession(*store, plan_, "S001", 4);
        require(fake::storeForm(*writer, plan_, {0, 0, {}, 2}, {6, 3, 7, std::nullopt, 2, 2, 4, 5}, 3 * kSecond));
        require(fake::storeForm(*writer, plan_, {1, {}, {}, {}}, {34, 1, 2, 1, 0, 3, std::nullopt}, 4 * kSecond,
                                fake::kHardText));
    }
    std::vector<QuestionnaireRunRow> runs() {
        return require(require(StoreReader::open(folder_ / "s.db")).questionnaireRuns());
    }

    fake::TempFolder folder_;
    plan::StudyPlan plan_ = fake::makeAskingPlan();
};

TEST_F(QuestionnaireRows, AreWhatWasAnsweredThoughTheSessionNeverEnded) {
    // Truth: closed form (what was written; overall of 6, 8-3, 7, 8-2, 8-2, 4, 5 by seven items, one missing)
    write();
    const auto all = runs();
    ASSERT_EQ(all.size(), 2u);
    const QuestionnaireRunRow& contact = all[0];
    EXPECT_EQ(contact.participant_id, "S001");
    EXPECT_EQ(contact.kind, "simulated");
    EXPECT_EQ(contact.questionnaire, "contact_perception");
    EXPECT_EQ(contact.language, "de");
    EXPECT_EQ(contact.moment, "after_condition");
    EXPECT_EQ(contact.block_index, 0);
    EXPECT_EQ(contact.block, "main, \"first\"");
    EXPECT_EQ(contact.condition, "god/0.1");
    EXPECT_FALSE(contact.trial_index);
    EXPECT_EQ(contact.completed_utc, "2000-01-01T00:00:03.000Z");
    ASSERT_EQ(contact.responses.size(), 8u);
    EXPECT_EQ(contact.responses[0].item, "matched") << "in the order of showing";
    EXPECT_EQ(contact.responses[0].value_num, 5.0);
    EXPECT_EQ(contact.responses[0].rt_ms, 707);
    EXPECT_EQ(contact.responses[0].changes, 2);
    EXPECT_EQ(contact.responses[4].item, "located");
    EXPECT_TRUE(contact.responses[4].skipped);
    EXPECT_FALSE(contact.responses[4].value_num);
    const auto score = [&](const std::string& scale) {
        for (const ScoreRow& row : contact.scores)
            if (row.scale == scale) return row;
        throw std::runtime_error(scale);
    };
    EXPECT_FALSE(score("clarity").value);
    EXPECT_EQ(score("clarity").n_missing, 1);
    EXPECT_EQ(score("clarity").n_items, 2);
    EXPECT_DOUBLE_EQ(score("overall").value.value(), 39.0 / 7.0);
    EXPECT_EQ(all[1].moment, "session_end");
    EXPECT_FALSE(all[1].block_index);
    EXPECT_FALSE(all[1].condition);
    EXPECT_EQ(all[1].responses[0].value_text, fake::kHardText);
    EXPECT_FALSE(all[1].responses[0].skipped);
    EXPECT_TRUE(all[1].scores.empty());
}

TEST_F(QuestionnaireRows, KeepTheInstrumentAsItWasAndSayWhoAnswered) {
    // Truth: invariant: an answer means what was asked, so the file's text stays with it.
    write();
    const auto all = runs();
    EXPECT_EQ(all[0].definition_text,
              *readFile(PASSUNG_SOURCE_DIR "/protocols/questionnaires/contact_perception.toml"));
    EXPECT_FALSE(all[0].texts_text);
    const auto events = require(require(StoreReader::open(folder_ / "s.db")).events());
    ASSERT_EQ(events.size(), 2u);
    EXPECT_EQ(events[0].event, "questionnaire_answered");
    EXPECT_EQ(events[0].t_ns, 3 * kSecond);
    EXPECT_EQ(events[0].payload_json, R"({"questionnaire":"contact_perception","moment":"after_condition","form":"0|",)"
                                      R"("answered_by":"participant"})");
}

TEST_F(QuestionnaireRows, AChangedFileNeedsANewVersionOfTheProtocol) {
    // Truth: invariant: answers to two wordings must not mix under one protocol.
    write();
    auto store = fake::openStore(folder_ / "s.db");
    EXPECT_TRUE(store->importProtocol(plan_)) << "the same again";
    plan_.expanded_json = R"({"questionnaires": ["contact_perception", "another wording"]})";
    const auto refused = store->importProtocol(plan_);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.errors().front().message.find("questionnaire's file has changed"), std::string::npos);
}

TEST_F(QuestionnaireRows, GoWithTheirParticipant) {
    // Truth: invariant: erasing somebody leaves none of their answers and keeps the instrument.
    write();
    const Database database(folder_ / "s.db", OpenMode::ReadWrite);
    database.execute("DELETE FROM participant WHERE participant_id='S001'");
    for (const char* table : {"questionnaire_run", "item_response", "score"})
        EXPECT_EQ(database.integer("SELECT count(*) FROM " + std::string(table)), 0) << table;
    EXPECT_EQ(database.integer("SELECT count(*) FROM questionnaire"), 2);
}

}  // namespace
}  // namespace passung::store
