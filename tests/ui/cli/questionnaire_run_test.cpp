#include <gtest/gtest.h>

#include <map>

#include "study/store/read/store_reader.h"
#include "study/store/schema/sqlite.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

namespace fs = std::filesystem;

/// A folder with the small study, asking before and after, after each condition and after each trial.
class QuestionnaireRun : public testing::Test {
protected:
    QuestionnaireRun() {
        for (const char* key : {"ssq", "nasa_tlx_weighted", "contact_perception", "ueq_s"})
            fs::copy(fs::path(PASSUNG_SOURCE_DIR) / "protocols/questionnaires" / (std::string(key) + ".toml"),
                     folder_.path());
        std::string texts = "texts_for = \"ueq_s\"\nlanguage = \"en\"\nsource = \"made up\"\nlow = 1\nhigh = 7\n";
        for (int i = 1; i <= 8; ++i)
            texts += "[[item]]\nid = \"i" + std::to_string(i) + "\"\ntext = \"Made up " + std::to_string(i) + "\"\n";
        writeText(folder_.path() / "our_texts.toml", texts);
        std::string study = smallStudy();
        const auto ask = [&](const std::string& file, const std::string& moment, const std::string& more = "") {
            study += "\n[[questionnaire]]\nfile = \"" + file + ".toml\"\nmoment = \"" + moment + "\"\n" + more;
        };
        ask("ssq", "session_start", "language = \"de\"\n");
        ask("contact_perception", "after_trial");
        ask("nasa_tlx_weighted", "after_condition");
        ask("ueq_s", "after_block", "texts = \"our_texts.toml\"\n");
        ask("ssq", "session_end", "language = \"de\"\n");
        writeText(folder_.path() / "study.toml", study);
    }

    Ended run(const std::vector<std::string>& arguments) const { return runProgram(folder_.path(), arguments); }

    /// The tables that tell of questionnaires, by name.
    std::map<std::string, std::string> exported(const std::string& database) const {
        const Ended ended = run({"export", database, "--out", database + ".out", "--no-samples"});
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        std::map<std::string, std::string> tables;
        for (const char* name : {"questionnaire_items.csv", "questionnaire_scores.csv", "scores_wide.csv",
                                 "questionnaire_reliability.csv"})
            tables[name] = readText(folder_.path() / (database + ".out") / name);
        return tables;
    }

    TempFolder folder_;
};

TEST_F(QuestionnaireRun, OfAStudyInTwoLanguagesIsInThatOfTheSession) {
    // Truth: invariant: two people, one protocol, each reads their own language, and both are scored alike.
    writeText(folder_.path() / "two.toml",
              smallStudy("two") +
                  "[text.en]\nwelcome = \"Welcome\"\n[text.de]\nwelcome = \"Willkommen\"\n[[instruction]]\nmoment = "
                  "\"session_start\"\ntext = \"welcome\"\n[[questionnaire]]\nfile = \"ssq.toml\"\nmoment = "
                  "\"session_end\"\n");
    for (const char* language : {"de", "en"}) {
        const Ended ended = run({"run", "two.toml", "--db", "s.db", "--no-backup", "--language", language});
        ASSERT_EQ(ended.exit_code, 0) << ended.err;
    }
    const auto reader = store::StoreReader::open(folder_ / "s.db");
    const auto runs = reader->questionnaireRuns();
    ASSERT_TRUE(runs);
    ASSERT_EQ(runs->size(), 2u);
    EXPECT_EQ((*runs)[0].language, "de");
    EXPECT_EQ((*runs)[1].language, "en");
    EXPECT_EQ((*runs)[0].scores.size(), (*runs)[1].scores.size());
    const auto tables = exported("s.db");
    EXPECT_NE(tables.at("scores_wide.csv").find("ssq.total.session_end"), std::string::npos);
}

TEST_F(QuestionnaireRun, ASimulatedParticipantAnswersEveryFormAtItsMomentAndIsMarked) {
    // Truth: closed form: six trials of two conditions in one block: 1 + 6 + 2 + 1 + 1 forms of 16, 8, 21, 8 items.
    const Ended ended = run({"run", "study.toml", "--db", "s.db"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const auto reader = store::StoreReader::open(folder_ / "s.db");
    const auto runs = reader->questionnaireRuns();
    ASSERT_TRUE(runs);
    std::vector<std::string> order;
    for (const auto& each : *runs)
        order.push_back(each.questionnaire + (each.trial_index ? " " + std::to_string(*each.trial_index) : "") +
                        (each.condition && !each.trial_index ? " after its condition" : ""));
    ASSERT_EQ(order.size(), 11u);
    EXPECT_EQ(order[0], "ssq");
    EXPECT_EQ(order[1], "contact_perception 0");
    EXPECT_EQ(order[5], "contact_perception 4");
    EXPECT_EQ(order[6], "nasa_tlx_weighted after its condition");
    EXPECT_EQ(order[7], "contact_perception 5");
    EXPECT_EQ(order[8], "nasa_tlx_weighted after its condition");
    EXPECT_EQ(order[9], "ueq_s");
    EXPECT_EQ(order[10], "ssq");
    EXPECT_EQ((*runs)[0].language, "de");
    EXPECT_EQ((*runs)[9].texts_text, readText(folder_.path() / "our_texts.toml"));

    const auto tables = exported("s.db");
    const auto items = fake::readCsv(tables.at("questionnaire_items.csv"));
    EXPECT_EQ(items.rows.size(), 16u + 6u * 8u + 2u * 21u + 8u + 16u);
    for (std::size_t row = 0; row < items.rows.size(); ++row) {
        EXPECT_EQ(items.at(row, "kind"), "simulated");
        EXPECT_EQ(items.at(row, "response_time_ms"), "NA") << "no clock runs";
        EXPECT_EQ(items.at(row, "skipped"), "0");
    }
    const auto scores = fake::readCsv(tables.at("questionnaire_scores.csv"));
    for (std::size_t row = 0; row < scores.rows.size(); ++row) {
        EXPECT_NE(scores.at(row, "score"), "NA");
        if (scores.at(row, "questionnaire") != "nasa_tlx_weighted") continue;
        EXPECT_EQ(scores.at(row, "n_items"), "21");
    }
    const auto wide = fake::readCsv(tables.at("scores_wide.csv"));
    EXPECT_TRUE(wide.has("ssq.total.session_start"));
    EXPECT_TRUE(wide.has("ssq.total.session_end"));
    EXPECT_TRUE(wide.has("nasa_tlx_weighted.workload.after_condition.main.fair"));
}

TEST_F(QuestionnaireRun, AnswersFollowFromSeedAndCodeAlone) {
    // Truth: invariant (in virtual time nothing but protocol, seed and code decides)
    ASSERT_EQ(run({"run", "study.toml", "--simulated", "2", "--db", "both.db"}).exit_code, 0);
    for (const char* code : {"S001", "S002"})
        ASSERT_EQ(run({"run", "study.toml", "--participant", code, "--db", "each.db"}).exit_code, 0);
    ASSERT_EQ(run({"run", "study.toml", "--simulated", "2", "--seed", "8", "--db", "other.db"}).exit_code, 0);
    const auto both = exported("both.db"), other = exported("other.db");
    EXPECT_EQ(exported("each.db"), both);
    for (const auto& [name, bytes] : both) EXPECT_NE(other.at(name), bytes) << name;
}

TEST_F(QuestionnaireRun, AFailureIsRatedWorseThanASuccess) {
    // Truth: invariant: TLX's performance rises with the share of failures; one condition always fails, one succeeds.
    ASSERT_EQ(run({"run", "study.toml", "--simulated", "4", "--db", "s.db"}).exit_code, 0);
    const auto items = fake::readCsv(exported("s.db").at("questionnaire_items.csv"));
    std::map<std::string, double> sums;
    for (std::size_t row = 0; row < items.rows.size(); ++row)
        if (items.at(row, "item") == "pe") sums[items.at(row, "condition")] += std::stod(items.at(row, "value"));
    EXPECT_GT(sums.at("none"), sums.at("fair") + 4 * 30.0);
}

TEST_F(QuestionnaireRun, AWrongKeyStopsTheStudyBeforeTheFirstParticipant) {
    // Truth: closed form: SSQ's disorientation without item 8 contradicts the file's second and third vector.
    std::string text = readText(folder_.path() / "ssq.toml");
    const std::string sound = "\"i5\", \"i8\", \"i10\"";
    ASSERT_NE(text.find(sound), std::string::npos);
    text.replace(text.find(sound), sound.size(), "\"i5\", \"i10\"");
    writeText(folder_.path() / "ssq.toml", text);
    for (const char* command : {"check", "run"}) {
        const Ended ended = run({command, "study.toml"});
        EXPECT_EQ(ended.exit_code, 1);
        EXPECT_NE(ended.err.find("ssq.toml:"), std::string::npos) << ended.err;
        EXPECT_NE(ended.err.find("error: golden.scores: {...}: scale disorientation gives 0, not 41.76"),
                  std::string::npos)
            << ended.err;
    }
    EXPECT_FALSE(fs::exists(folder_.path() / "small.db"));
    EXPECT_EQ(run({"check", "ssq.toml"}).exit_code, 1);
    const Ended slot = run({"check", "ueq_s.toml"});
    EXPECT_EQ(slot.exit_code, 0);
    EXPECT_EQ(slot.out,
              "ueq_s.toml: ok: ueq_s 1.0, 8 items, 3 scales, 1 golden vectors, a template for the lab's texts\n");
}

TEST_F(QuestionnaireRun, AnotherWordingNeedsAnotherVersionOfTheStudy) {
    // Truth: invariant: answers to two wordings must not mix under one protocol.
    ASSERT_EQ(run({"run", "study.toml", "--db", "s.db"}).exit_code, 0);
    writeText(folder_.path() / "our_texts.toml", readText(folder_.path() / "our_texts.toml") + "# changed\n");
    const Ended refused = run({"run", "study.toml", "--db", "s.db"});
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_NE(refused.err.find("a questionnaire's file has changed"), std::string::npos) << refused.err;
    EXPECT_EQ(run({"replay", "s.db"}).exit_code, 0) << "a replay needs no questionnaire";
}

}  // namespace
}  // namespace passung::test
