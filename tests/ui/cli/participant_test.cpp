#include <gtest/gtest.h>

#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

TEST(ParticipantCommand, TakesPeopleFromEnrolmentToErasure) {
    // Truth: invariant (the experimenter's actions, by their lines and exit codes)
    const TempFolder folder;
    writeText(folder / "study.toml",
              smallStudy() + "[[consent]]\nclause = \"data_use\"\ntext = { en = \"Analysis?\" }\n");
    const auto does = [&](std::vector<std::string> arguments, int code, const std::string& says) {
        arguments.insert(arguments.begin(), "participant");
        const Ended ended = runProgram(folder.path(), arguments);
        EXPECT_EQ(ended.exit_code, code) << ended.out << ended.err;
        const std::string text = code == 0 ? ended.out : ended.err;
        EXPECT_NE(text.find(says), std::string::npos) << text;
        if (code == 1) {
            EXPECT_EQ(linesOf(ended.err).size(), 1u) << ended.err;
        }
    };
    does({"enrol", "s.db"}, 1, "s.db: error: cannot be opened");
    EXPECT_FALSE(std::filesystem::exists(folder / "s.db"));
    does({"enrol", "s.db", "--protocol", "study.toml"}, 0, "P001: real participant, enrolled\n");
    does({"enrol", "s.db", "T007", "--kind", "pilot"}, 0, "T007: pilot participant, enrolled\n");
    does({"enrol", "s.db", "P001"}, 1, "already enrolled");
    does({"consent", "s.db", "P001", "--clause", "data_use"}, 0, "P001: yes: data_use\n");
    does({"list", "s.db"}, 0, "data_use yes");
    does({"exclude", "s.db", "T007"}, 2, "--reason is required");
    does({"exclude", "s.db", "T007", "--reason", "came late"}, 0, "T007: excluded");
    does({"list", "s.db"}, 0, "; came late");
    does({"readmit", "s.db", "T007"}, 2, "--reason is required");
    does({"readmit", "s.db", "T007", "--reason", "wrong code"}, 0, "T007: takes part again and the data counts\n");
    does({"list", "s.db"}, 0, "; readmitted: wrong code");
    does({"readmit", "s.db", "T007", "--reason", "again"}, 1, "participant T007 is not excluded");
    does({"exclude", "s.db", "T007", "--reason", "came late"}, 0, "T007: excluded");
    std::filesystem::create_directory(folder / "tables");
    writeText(folder / "tables/participants.csv", "participant_id,kind\nP001,real\n");
    does({"withdraw", "s.db", "P001", "--scope", "erase"}, 0,
         "names P001 too, delete it if it is a copy of this database: " + (folder / "tables") + "\n");
    does({"audit", "s.db"}, 0, "7 actions in an unbroken chain, the details of 2 erased");
    const Ended run = runProgram(folder.path(), {"run", "study.toml", "--db", "s.db", "--participant", "T007"});
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.err.find("sigma7: has no driver in this program"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace passung::test
