#include <gtest/gtest.h>

#include "study/store/schema/sqlite.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

class ReplayMeasures : public testing::Test {
protected:
    ReplayMeasures() {
        writeText(folder_.path() / "study.toml", smallStudy());
        EXPECT_EQ(runProgram(folder_.path(), {"run", "study.toml", "--db", "s.db", "--no-backup"}).exit_code, 0);
    }
    Ended replay(const std::string& attempt) const {
        return runProgram(folder_.path(), {"replay", "s.db", "--attempt", attempt});
    }
    void change(const std::string& sql) const {
        const store::Database database(folder_ / "s.db", store::OpenMode::ReadWrite);
        database.execute(sql);
    }
    TempFolder folder_;
};

TEST_F(ReplayMeasures, ComeOutOfTheRecordedTicksAgain) {
    // Truth: invariant: every bit, in successes and time-outs; a measure or outcome that was changed is found.
    const Ended all = runProgram(folder_.path(), {"replay", "s.db"});
    EXPECT_EQ(all.exit_code, 0) << all.out;
    std::size_t proven = 0;
    for (const std::string& line : linesOf(all.out))
        proven += line.find("every recorded bit and every measure the same") == std::string::npos ? 0 : 1;
    EXPECT_EQ(proven, 6u) << all.out;

    change("UPDATE attempt_measure SET value_num=value_num*(1+1e-15) WHERE attempt_id=2 AND measure='trial_time_s'");
    EXPECT_EQ(replay("1").exit_code, 0);
    const Ended changed = replay("2");
    EXPECT_EQ(changed.exit_code, 1);
    EXPECT_NE(changed.out.find("DIFFERS in trial_time_s: stored "), std::string::npos) << changed.out;

    change("DELETE FROM attempt_measure WHERE attempt_id=3 AND measure='trial_time_s'");
    const Ended lacking = replay("3");  // a program that had no such measure leaves the same
    EXPECT_EQ(lacking.exit_code, 1);
    EXPECT_NE(lacking.out.find("NOT PROVEN: "), std::string::npos) << lacking.out;
    EXPECT_NE(lacking.out.find("but trial_time_s was not recorded"), std::string::npos) << lacking.out;
    change("INSERT INTO attempt_measure(attempt_id, measure) VALUES(3, 'trial_time_s')");
    EXPECT_NE(replay("3").out.find("DIFFERS in trial_time_s: stored none"), std::string::npos);

    change(
        "UPDATE attempt SET outcome=CASE outcome WHEN 'success' THEN 'timeout' ELSE 'success' END "
        "WHERE attempt_id=4");
    EXPECT_NE(replay("4").out.find("DIFFERS in outcome: stored "), std::string::npos);
}

TEST_F(ReplayMeasures, OfAnAbortedAttemptToo) {
    // Truth: invariant: when somebody aborted it is in no record, only in the stored end.
    Program program(folder_.path(), {"run", "study.toml", "--db", "s.db", "--no-backup", "--simulated", "50"}, true);
    EXPECT_NE(program.nextAcknowledgement(), "");
    program.send(SIGINT);
    EXPECT_EQ(program.wait(), 1);
    const Ended all = runProgram(folder_.path(), {"replay", "s.db"});
    EXPECT_EQ(all.out.find("DIFFERS"), std::string::npos) << all.out;
}

}  // namespace
}  // namespace passung::test
