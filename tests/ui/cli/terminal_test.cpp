#include <sys/stat.h>

#include <gtest/gtest.h>

#include <regex>
#include <thread>

#include "study/store/schema/sqlite.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

// A person at the terminal, played by a script: consent and questionnaires, while a simulated hand does the trials.

namespace passung::test {
namespace {

namespace fs = std::filesystem;

/// A folder with the small study of two trials, which asks for consent and, after its block, one questionnaire with
/// three kinds of items.
class TerminalTest : public testing::Test {
protected:
    TerminalTest() {
        writeText(folder_ / "ask.toml", R"(questionnaire = "ask"
version = "1.0"
languages = ["en"]
licence = "ours"
citation = "ours"
title = { en = "After the trials" }
instruction = { en = "Please answer." }

[[response]]
name = "ten"
kind = "rating"
low = 0
high = 10

[[response]]
name = "side"
kind = "choice"
options = [{ value = 7, text = { en = "left" } }, { value = 9, text = { en = "right" } }]

[[response]]
name = "words"
kind = "text"

[[item]]
id = "effort"
response = "ten"
text = { en = "How hard was it?" }
low_anchor = { en = "easy" }
high_anchor = { en = "hard" }

[[item]]
id = "hand"
response = "side"
text = { en = "Which hand?" }

[[item]]
id = "remarks"
response = "words"
text = { en = "Anything else?" }

[[scale]]
name = "effort"
label = "Effort"
items = ["effort"]

[[golden]]
answers = [3, 7, "NA"]
scores = { effort = 3 }
)");
        std::string study = smallStudy();
        study.replace(study.find("repetitions = 3"), 15, "repetitions = 1");
        study += R"(
[[consent]]
clause = "data_use"
text = { en = "May we analyse the data?" }

[[consent]]
clause = "photos"
required = false
text = { en = "May we take photos?" }

[[questionnaire]]
file = "ask.toml"
moment = "after_block"
)";
        writeText(folder_ / "study.toml", study);
    }
    Ended run(const std::string& typed, const std::vector<std::string>& arguments) const {
        writeText(folder_ / ".in", typed);
        return runProgram(folder_.path(), arguments);
    }
    /// The arguments of a rehearsal in German, for which the questionnaire gets German texts.
    std::vector<std::string> inGerman() const {
        const std::string ask = std::regex_replace(readText(folder_ / "ask.toml"),
                                                   std::regex(R"(\{ en = ("[^"]*") \})"), "{ en = $1, de = $1 }");
        writeText(folder_ / "ask.toml", std::regex_replace(ask, std::regex(R"(\["en"\])"), R"(["en", "de"])"));
        auto arguments = rehearse_;
        arguments.insert(arguments.end(), {"--language", "de"});
        return arguments;
    }
    std::string query(const std::string& sql) const {
        return store::Database(folder_ / "s.db", store::OpenMode::ReadOnly).text(sql);
    }

    const std::vector<std::string> rehearse_ = {"run", "study.toml", "--db", "s.db", "--answers", "experimenter"};
    TempFolder folder_;
};

constexpr const char* kResponses =
    "SELECT group_concat(item || '=' || coalesce(value_num, value_text, 'NULL') || ' ' || skipped || ' ' || changes, "
    "'; ') FROM (SELECT * FROM item_response ORDER BY presented_index)";

TEST_F(TerminalTest, AsksConsentAndEveryItemAndKeepsHowItWasAnswered) {
    // Truth: closed form: the script's answers; 11 is out of range, "<" goes back from the second item to change 4
    // to 6.
    const Ended ended = run("maybe\nyes\nno\n11\nx\n4\n<\n6\n3\n2\n\n\n\n", rehearse_);
    ASSERT_EQ(ended.exit_code, 0) << ended.err << ended.out;
    EXPECT_EQ(query(kResponses), "effort=6.0 0 1; hand=9.0 0 0; remarks=NULL 1 0");
    EXPECT_EQ(query("SELECT value FROM score"), "6.0");
    EXPECT_EQ(query("SELECT group_concat(clause || ' ' || decision) FROM consent"), "data_use yes,photos no");
    EXPECT_EQ(query("SELECT payload_json->>'answered_by' FROM event WHERE event='questionnaire_answered'"),
              "experimenter");
    EXPECT_EQ(query("SELECT kind || ' ' || status FROM participant"), "simulated complete") << "the hand is simulated";
    EXPECT_EQ(query("SELECT count(rt_ms) FROM item_response"), "0") << "virtual time";
    EXPECT_EQ(query("SELECT max(decided_utc) FROM consent"), query("SELECT started_utc FROM session"));
    for (const char* shown : {"May we analyse the data?", "== After the trials ==", "1/3  How hard was it?",
                              "0 to 10   (0: easy, 10: hard)", "must be from 0 to 10", "must be one of the numbers",
                              "    2: right", "Enter keeps 4", "Enter once more leaves it out"})
        EXPECT_NE(ended.out.find(shown), std::string::npos) << shown << " in\n" << ended.out;
}

TEST_F(TerminalTest, WhoRefusesARequiredClauseGetsNoSessionAndMayComeAgain) {
    // Truth: invariant (admission); what is decided is not asked again.
    const Ended refused = run("no\n", rehearse_);
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_EQ(refused.err, "s.db: error: consent: S001: no consent to the clause data_use, no session\n");
    EXPECT_EQ(query("SELECT count(*) FROM session"), "0");
    auto again = rehearse_;
    again.insert(again.end(), {"--participant", "S001"});
    EXPECT_EQ(run("yes\n", again).exit_code, 1) << "nobody decided on the other one";
    EXPECT_EQ(run("yes\n1\n1\nfine\n\n", again).exit_code, 0);
    EXPECT_EQ(query("SELECT group_concat(clause || ' ' || decision) FROM consent"),
              "data_use no,data_use yes,photos yes");
}

TEST_F(TerminalTest, ResponseTimesAreMeasuredInRealTime) {
    // Truth: invariant: every item that was answered has a time, one that was left out too.
    auto real = rehearse_;
    real.insert(real.end(), {"--real-time"});
    ASSERT_EQ(run("yes\nyes\n5\n1\n\n\n\n", real).exit_code, 0);
    EXPECT_EQ(query("SELECT count(*) FROM item_response WHERE rt_ms >= 0"), "3");
}

TEST_F(TerminalTest, AQuestionnaireThatWasOpenAtAKillIsAskedAtResume) {
    // Truth: invariant: trials are not repeated, the form is stored once.
    ASSERT_EQ(mkfifo((folder_ / ".in").c_str(), 0600), 0);
    const int typed = open((folder_ / ".in").c_str(), O_RDWR | O_CLOEXEC);
    ASSERT_GE(typed, 0);
    {
        Program program(folder_.path(), rehearse_);
        ASSERT_EQ(write(typed, "yes\nno\n5\n", 9), 9);
        const auto asks = [&] {
            return fs::exists(folder_ / ".out") && program.out().find("2/3  Which hand?") != std::string::npos;
        };
        while (!asks()) std::this_thread::yield();
        program.killNow();
        ASSERT_EQ(program.wait(), -SIGKILL);
    }
    close(typed);
    fs::remove(folder_ / ".in");
    EXPECT_EQ(query("SELECT count(*) FROM questionnaire_run"), "0");
    const Ended resumed = run("8\n2\nfine\n\n", {"resume", "s.db", "--answers", "participant"});
    ASSERT_EQ(resumed.exit_code, 0) << resumed.err << resumed.out;
    EXPECT_EQ(query(kResponses), "effort=8.0 0 0; hand=9.0 0 0; remarks=fine 0 0");
    EXPECT_EQ(query("SELECT count(*) FROM attempt"), "2");
    EXPECT_EQ(query("SELECT end_state FROM session"), "complete");
}

TEST_F(TerminalTest, ASessionWhoseTerminalEndsIsInterruptedAndCanGoOn) {
    // Truth: invariant: what is due is not lost with the terminal.
    const Ended ended = run("yes\nno\n5\n", rehearse_);
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_NE(ended.err.find("interrupted"), std::string::npos) << ended.err;
    EXPECT_EQ(query("SELECT end_state FROM session"), "aborted");
    EXPECT_EQ(runProgram(folder_.path(), {"resume", "s.db"}).exit_code, 0) << "answered by the simulated person";
    EXPECT_EQ(query("SELECT count(*) FROM questionnaire_run"), "1");
    EXPECT_EQ(query("SELECT end_state FROM session"), "complete");
}

TEST_F(TerminalTest, InstructionsAreShownInTheAskedLanguageAndWaitForEnter) {
    // Truth: closed form: the script's lines; one that is not empty does not count as read.
    std::string study = readText(folder_ / "study.toml");
    study.replace(study.find("{ en = \"May we analyse the data?\" }"), 35,
                  R"({ en = "May we analyse the data?", de = "Dürfen wir die Daten auswerten?" })");
    study.replace(study.find("{ en = \"May we take photos?\" }"), 30,
                  R"({ en = "May we take photos?", de = "Dürfen wir fotografieren?" })");
    study += R"(
[text.en]
welcome = "Welcome."
thanks = "Thank you."
[text.de]
welcome = "Willkommen."
thanks = "Danke."
[[instruction]]
moment = "session_start"
text = "welcome"
[[instruction]]
moment = "session_end"
text = "thanks"
)";
    writeText(folder_ / "study.toml", study);
    const auto german = inGerman();
    const Ended ended = run("ja\nnein\nx\n\n5\n1\nfine\n\n\n", german);
    ASSERT_EQ(ended.exit_code, 0) << ended.err << ended.out;
    for (const char* shown : {"Dürfen wir die Daten auswerten?", "Willkommen.", "Enter alone goes on", "Danke."})
        EXPECT_NE(ended.out.find(shown), std::string::npos) << shown << " in\n" << ended.out;
    EXPECT_EQ(ended.out.find("Welcome."), std::string::npos);
    EXPECT_EQ(query("SELECT language FROM session"), "de");
    EXPECT_EQ(query("SELECT group_concat(source || ' ' || (payload_json->>'text'), ', ') FROM "
                    "(SELECT * FROM event WHERE event='instruction' ORDER BY event_id)"),
              "experimenter welcome, experimenter thanks");
    const Ended none = run("", {"run", "study.toml", "--db", "other.db", "--language", "fr"});
    EXPECT_EQ(none.exit_code, 1);
    EXPECT_EQ(none.err, "study.toml: error: language: \"fr\": must be one of the protocol's languages: en, de\n");
    EXPECT_FALSE(fs::exists(folder_ / "other.db")) << "nothing is half-written";
}

TEST_F(TerminalTest, ResumedSessionsKeepTheirLanguage) {
    // Truth: invariant: a participant is spoken to in one language.
    std::string study = readText(folder_ / "study.toml");
    study +=
        "\n[text.en]\nthanks = \"Thank you.\"\n[text.de]\nthanks = \"Danke.\"\n"
        "[[instruction]]\nmoment = \"session_end\"\ntext = \"thanks\"\n";
    for (std::size_t at = 0; (at = study.find("text = { en = \"May we", at)) != std::string::npos; at += 12)
        study.insert(at + 9, "de = \"Ja?\", ");
    writeText(folder_ / "study.toml", study);
    const auto german = inGerman();
    EXPECT_EQ(run("ja\nja\n5\n", german).exit_code, 1) << "the terminal ended";
    const Ended resumed = run("5\n1\nfine\n\n\n", {"resume", "s.db", "--answers", "participant"});
    ASSERT_EQ(resumed.exit_code, 0) << resumed.err << resumed.out;
    EXPECT_NE(resumed.out.find("Danke."), std::string::npos) << resumed.out;
    EXPECT_EQ(query("SELECT language FROM session"), "de");
}

TEST_F(TerminalTest, PeopleAreRefusedWithoutADeviceAndNothingIsStored) {
    // Truth: invariant: trials of a simulated hand are never stored under the code of a person.
    for (const char* code : {"P07", "T01"}) {
        const Ended refused = run("", {"run", "study.toml", "--db", "s.db", "--participant", code});
        EXPECT_EQ(refused.exit_code, 1);
        EXPECT_NE(refused.err.find("study.toml: error: device.preset: sigma7: has no driver in this program"),
                  std::string::npos)
            << refused.err;
        EXPECT_NE(refused.err.find(code), std::string::npos);
    }
    EXPECT_FALSE(fs::exists(folder_ / "s.db"));
}

}  // namespace
}  // namespace passung::test
