#include <gtest/gtest.h>

#include "core/tick/numerics.h"
#include "study/store/schema/sqlite.h"
#include "tests/study/store/postgres.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

class Damage : public testing::Test {
protected:
    Damage() {
        writeText(folder_.path() / "study.toml", smallStudy());
        EXPECT_EQ(ends({"run", "study.toml", "--db", "s.db"}, 0).err, "");
    }
    Ended ends(const std::vector<std::string>& arguments, int exit_code) const {
        const Ended ended = runProgram(folder_.path(), arguments);
        EXPECT_EQ(ended.exit_code, exit_code) << arguments[0] << ": " << ended.out << ended.err;
        return ended;
    }
    void change(const std::string& sql) const {
        store::Database(folder_ / "s.db", store::OpenMode::ReadWrite).execute(sql);
    }
    TempFolder folder_;
};

TEST_F(Damage, IsHealedByWhatWasPushedIntoAServer) {
    // Truth: invariant: a server of its own holds what was pushed before the damage. Verify says that it is healed.
    if (!fake::Postgres::installed()) GTEST_SKIP() << "no PostgreSQL server is installed";
    const fake::Postgres server;
    EXPECT_EQ(ends({"push", "s.db", "--to", server.uri()}, 0).out,
              "s.db: 1 sessions added, 0 brought up to date, 0 known\n");
    EXPECT_EQ(ends({"push", "s.db", "--to", server.uri()}, 0).out,
              "s.db: 0 sessions added, 0 brought up to date, 1 known\n");
    change("UPDATE attempt_measure SET value_num=9 WHERE attempt_id=3 AND measure='trial_time_s'");
    ends({"verify", "s.db"}, 1);
    ends({"push", "s.db", "--to", server.uri()}, 1);
    EXPECT_EQ(linesOf(ends({"restore", "s.db", "--from", server.uri()}, 0).out).size(), 1u);
    ends({"verify", "s.db"}, 0);
    EXPECT_EQ(
        ends({"push", "s.db", "--to", "postgresql:///none?host=" + folder_.path().string()}, 1).err.find("s.db: "), 0u);
}

TEST_F(Damage, IsNamedExportedAroundAndHealed) {
    // Truth: invariant: one chunk and one measure are damaged; each command says so in a line and ends in 1, and after
    // the restore each ends in 0.
    EXPECT_NE(ends({"verify", "s.db"}, 0).out.find("nothing is damaged"), std::string::npos);
    ends({"export", "s.db", "--out", "whole"}, 0);
    change(
        "UPDATE sample_chunk SET data=zeroblob(length(data)) WHERE attempt_id=2 AND first_tick=0; UPDATE "
        "attempt_measure SET value_num=9 WHERE attempt_id=3 AND measure='trial_time_s'");
    const Ended found = ends({"verify", "s.db"}, 1);
    EXPECT_NE(found.err.find("s.db: error: S001, session 1, trial 2, attempt 1, samples: chunk of samples from tick 0: "
                             "checksum"),
              std::string::npos)
        << found.err;
    EXPECT_NE(found.err.find("trial 3, attempt 1, attempt_measure: is not as the run wrote it"), std::string::npos);
    EXPECT_EQ(linesOf(found.err).size(), 2u) << found.err;

    const Ended exported = ends({"export", "s.db", "--out", "out"}, 1);
    EXPECT_EQ(linesOf(exported.err).size(), 2u) << exported.err;
    EXPECT_EQ(linesOf(readText(folder_.path() / "out/missing.csv")).size(), 3u);
    EXPECT_EQ(linesOf(readText(folder_.path() / "out/trials.csv")).size() + 1,
              linesOf(readText(folder_.path() / "whole/trials.csv")).size());
    EXPECT_EQ(readText(folder_.path() / "out/samples/S001_1_t003_a1.csv.gz"),
              readText(folder_.path() / "whole/samples/S001_1_t003_a1.csv.gz"));

    const Ended replayed = ends({"replay", "s.db"}, 1);
    EXPECT_NE(replayed.out.find("5 attempts replayed, 1 differ, 1 damaged and not compared\n"), std::string::npos)
        << replayed.out;

    const Ended merged = ends({"merge", "s.db", "--out", "all.db"}, 1);
    EXPECT_NE(merged.err.find("error: damaged: "), std::string::npos) << merged.err;

    const Ended restored = ends({"restore", "s.db", "--from", "s.db.backup"}, 0);
    EXPECT_EQ(linesOf(restored.out).size(), 2u) << restored.out;
    ends({"verify", "s.db"}, 0);
    ends({"replay", "s.db"}, 0);
    ends({"export", "s.db", "--out", "healed"}, 0);
    EXPECT_EQ(readText(folder_.path() / "healed/SHA256SUMS"), readText(folder_.path() / "whole/SHA256SUMS"));
    EXPECT_NE(ends({"restore", "s.db", "--from", "s.db.backup"}, 0).out.find("nothing was changed"), std::string::npos);
}

TEST_F(Damage, AnEarlierWholeExportIsKeptAndNamed) {
    // Truth: invariant: what the whole export says is not in the damaged database any more, and nobody loses it.
    ends({"export", "s.db", "--out", "out"}, 0);
    const std::string whole = readText(folder_.path() / "out/SHA256SUMS");
    change("UPDATE attempt_measure SET value_num=9 WHERE attempt_id=3 AND measure='trial_time_s'");
    const Ended damaged = ends({"export", "s.db", "--out", "out"}, 1);
    EXPECT_NE(damaged.err.find("out: warning: the earlier export may hold what this one lacks: kept as out.backup.1"),
              std::string::npos)
        << damaged.err;
    EXPECT_EQ(readText(folder_.path() / "out.backup.1/SHA256SUMS"), whole);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out/missing.csv"));
}

TEST_F(Damage, HasExitCodesForWrongUsageAndForWhatNoSourceHeals) {
    // Truth: invariant
    ends({"verify"}, 2);
    ends({"restore", "s.db"}, 2);
    ends({"verify", "none.db"}, 1);
    ends({"verify", "study.toml"}, 1);
    ends({"restore", "none.db", "--from", "s.db.backup"}, 1);
    ends({"restore", "study.toml", "--from", "s.db.backup"}, 1);
    EXPECT_EQ(readText(folder_.path() / "study.toml"), smallStudy());
    change("UPDATE attempt SET seed=seed+1 WHERE attempt_id=1");
    ends({"restore", "s.db", "--from", "none.db"}, 1);
    std::filesystem::copy_file(folder_ / "s.db", folder_ / "copy.db");
    const Ended both = ends({"restore", "s.db", "--from", "copy.db"}, 1);
    EXPECT_NE(both.err.find("trial 1, attempt 1: is not as the run wrote it: there is no intact copy"),
              std::string::npos)
        << both.err;
    EXPECT_NE(ends({"restore", "s.db", "--from", "postgresql:///none?host=/nowhere"}, 1).err.find("PostgreSQL"),
              std::string::npos);
}

TEST_F(Damage, ARecordingOfOtherNumericsIsNotComparable) {
    // Truth: invariant: the same data under another number, and under none as in older files, is never said to differ.
    EXPECT_EQ(ends({"replay", "s.db", "--attempt", "1"}, 0).out.find("not comparable"), std::string::npos);
    change("UPDATE sample_chunk SET data=zeroblob(length(data))");
    for (const std::string& number : {std::to_string(tick::kNumerics + 1), std::string("NULL")}) {
        change("UPDATE stream SET numerics=" + number);
        const Ended replayed = ends({"replay", "s.db"}, 1);
        const std::string said = number == "NULL" ? "0" : number;
        EXPECT_NE(replayed.out.find("not comparable: recorded by the arithmetic of numerics " + said),
                  std::string::npos)
            << replayed.out;
        EXPECT_EQ(replayed.out.find("DIFFERS"), std::string::npos) << replayed.out;
        EXPECT_NE(replayed.out.find("0 attempts replayed, 0 differ, 6 not comparable\n"), std::string::npos)
            << replayed.out;
    }
}

}  // namespace
}  // namespace passung::test
