#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "study/store/read/store_reader.h"
#include "study/store/schema/sqlite.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/typed_studies.h"

// Cues beside the force: who gets them, who does not, and what the export says of it.

namespace passung::test {
namespace {

/// The study without force, with these cues.
std::string withCues(std::string text, const std::string& cues) {
    text.insert(text.find("[[block]]"), "[feedback]\nkinesthetic = false\ncues = [" + cues + "]\n\n");
    return text;
}

/// The ball through a bore that it hardly fits into, so that nobody comes through without touching.
std::string tightPassage() {
    std::string text = passageStudy();
    const std::string wide = "levels = [12, 14]", tight = "levels = [10.4, 10.8]";
    text.replace(text.find(wide), wide.size(), tight);
    return text;
}

struct Trials {
    std::vector<store::AttemptRow> attempts;
    std::vector<std::string> given;  // feedback_given of each
};

/// What simulated participants made of a study.
Trials runStudy(const TempFolder& folder, const std::string& text, const std::string& people) {
    writeText(folder.path() / "study.toml", text);
    Trials trials;
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{"run", "study.toml", "--simulated", people, "--db", "s.db"},
                                               {"export", "s.db", "--out", "out", "--no-samples"}}) {
        const Ended ended = runProgram(folder.path(), arguments);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        if (ended.exit_code != 0) return trials;
    }
    const auto reader = store::StoreReader::open(folder / "s.db");
    if (auto attempts = reader->attempts()) trials.attempts = *attempts;
    const auto table = fake::readCsv(readText(folder.path() / "out/trials.csv"));
    for (std::size_t row = 0; row < table.rows.size(); ++row) trials.given.push_back(table.at(row, "feedback_given"));
    return trials;
}

TEST(CuesRun, WhereNothingIsGivenTheCuesOfAConditionChangeNoBit) {
    // Truth: invariant: a part that touches nothing gives no cue; equal seeds then give equal trials.
    std::string study = placementStudy();
    study.replace(study.find("[15, 0, 2]"), 10, "[15, 0, 9]");  // above what the hand may touch by its errors
    std::vector<std::string> hashes;
    for (const char* cues : {"", "\"visual\"", "\"vibrotactile\"", "\"audio\""}) {
        const TempFolder folder;
        const Trials trials = runStudy(folder, withCues(study, cues), "2");
        ASSERT_EQ(trials.attempts.size(), 8u);
        std::string all;
        for (std::size_t i = 0; i < trials.attempts.size(); ++i) {
            all += trials.attempts[i].state_hash + " ";
            EXPECT_EQ(trials.given[i], "none") << cues;
        }
        hashes.push_back(all);
    }
    for (const std::string& hash : hashes) EXPECT_EQ(hash, hashes.front());
}

double chanceOf(int fewer, int of) {  // two-sided sign test, exact
    double sum = 0.0;
    for (int k = 0; k <= fewer; ++k)
        sum += std::exp(std::lgamma(of + 1.0) - std::lgamma(k + 1.0) - std::lgamma(of - k + 1.0) - of * std::log(2.0));
    return std::min(1.0, 2.0 * sum);
}

TEST(CuesRun, GivenCuesChangeWhatHappens) {
    // Truth: closed form (sign test) over pairs of trials with equal seeds, with a cue and without; by default 20
    // pairs, PASSUNG_CUE_PEOPLE = 50 makes 200. In those of the cue it was handed over, in the others nothing was.
    const char* asked = std::getenv("PASSUNG_CUE_PEOPLE");
    const std::string people = asked != nullptr ? asked : "5";
    const TempFolder none_folder;
    const Trials none = runStudy(none_folder, withCues(tightPassage(), ""), people);
    for (const std::string cue : {"visual", "vibrotactile"}) {
        const TempFolder folder;
        const Trials cued = runStudy(folder, withCues(tightPassage(), "\"" + cue + "\""), people);
        ASSERT_EQ(cued.attempts.size(), none.attempts.size());
        int faster = 0, slower = 0, given = 0;
        for (std::size_t i = 0; i < none.attempts.size(); ++i) {
            ASSERT_EQ(cued.attempts[i].seed, none.attempts[i].seed);
            EXPECT_EQ(none.given[i], "none");
            EXPECT_TRUE(cued.given[i] == cue || cued.given[i] == "none") << cued.given[i];
            given += cued.given[i] == cue ? 1 : 0;
            const double with = cued.attempts[i].measures.at("trial_time_s");
            const double without = none.attempts[i].measures.at("trial_time_s");
            faster += with < without ? 1 : 0;
            slower += with > without ? 1 : 0;
        }
        const double p = chanceOf(std::min(faster, slower), faster + slower);
        std::printf("%s: %zu pairs, cue given in %d, faster %d, slower %d, p = %.2g\n", cue.c_str(),
                    none.attempts.size(), given, faster, slower, p);
        EXPECT_GT(given, static_cast<int>(none.attempts.size()) / 2);
        EXPECT_LT(p, 0.001) << cue;
    }
}

TEST(CuesRun, PeopleAndPilotsAreRefusedBeforeAnythingIsStored) {
    // Truth: invariant: no device here has an actuator; the line names cue and conditions, simulated people run.
    const TempFolder folder;
    writeText(folder.path() / "study.toml", withCues(placementStudy(), "\"vibrotactile\""));
    const std::string cue = "feedback.cues = [\"vibrotactile\"]";
    const Ended checked = runProgram(folder.path(), {"check", "study.toml"});
    EXPECT_EQ(checked.exit_code, 0);
    EXPECT_NE((checked.out + checked.err).find("warning: " + cue), std::string::npos) << checked.out << checked.err;
    EXPECT_NE((checked.out + checked.err).find("conditions: "), std::string::npos);
    for (const char* code : {"P001", "T001"}) {
        const Ended run = runProgram(folder.path(), {"run", "study.toml", "--participant", code, "--db", "p.db"});
        EXPECT_EQ(run.exit_code, 1);
        EXPECT_NE(run.err.find(std::string(code) + " cannot take part: " + cue), std::string::npos) << run.err;
        EXPECT_FALSE(std::filesystem::exists(folder.path() / "p.db"));
    }
    writeText(folder.path() / "study.toml", withCues(placementStudy(), "\"visual\""));
    const Ended quiet = runProgram(folder.path(), {"check", "study.toml"});
    EXPECT_EQ((quiet.out + quiet.err).find("can be given to simulated"), std::string::npos) << "a window draws it";
}

TEST(CuesRun, APersonsSessionIsNotResumedUnderACueThatNothingGives) {
    // Truth: invariant: a database from before the refusal holds such a session; it stays as it was. Made from a
    // simulated participant's by giving them a person's code.
    const TempFolder folder;
    const std::string path = folder / "p.db";
    writeText(folder.path() / "study.toml", withCues(placementStudy(), "\"vibrotactile\""));
    {
        Program run(folder.path(), {"run", "study.toml", "--db", "p.db", "--no-backup"}, true);
        ASSERT_NE(run.nextAcknowledgement(), "");
        run.killNow();
        ASSERT_EQ(run.wait(), -SIGKILL);
    }
    {
        const store::Database database(path, store::OpenMode::ReadWrite);
        database.execute("PRAGMA foreign_keys=OFF");
        for (const char* table : {"participant", "session"})
            database.execute(std::string("UPDATE ") + table + " SET participant_id='P001' WHERE participant_id='S001'");
        database.execute(
            "UPDATE participant SET kind='real'; UPDATE design_slot SET state='free', participant_id=NULL");
    }
    const auto attempts = [&] {
        return store::Database(path, store::OpenMode::ReadOnly).integer("SELECT count(*) FROM attempt");
    };
    const auto before = attempts();
    const Ended resumed = runProgram(folder.path(), {"resume", "p.db"});
    EXPECT_EQ(resumed.exit_code, 1);
    EXPECT_NE(resumed.err.find("P001 cannot take part: feedback.cues = [\"vibrotactile\"]"), std::string::npos)
        << resumed.err;
    EXPECT_EQ(attempts(), before);
}

}  // namespace
}  // namespace passung::test
