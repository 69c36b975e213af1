#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <thread>

#include "study/store/schema/sqlite.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

// A session that an experimenter commands from a second terminal, killed at every step of the script and resumed,
// against the same session without a kill.

namespace passung::test {
namespace {

/// Trials with real parts, which the experimenter starts and ends: nothing goes on by itself, and a busy machine
/// invalidates none.
std::string timedStudy() {
    std::string text = smallStudy();
    const auto replace = [&](const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
    };
    replace("\"task.timeout_s\" = 0.4, \"contact.method\" = \"penalty\"", "\"task.timeout_s\" = 1000");
    replace("\"task.timeout_s\" = 20, \"contact.method\" = \"god_object_heuristic\"", "\"task.timeout_s\" = 1001");
    replace("[task]\n",
            "[loop]\nmax_missed_share = 1\n\n[feedback]\nkinesthetic = false\n\n[task]\ntimed_by = \"experimenter\"\n");
    return text;
}

/// A trial as the experimenter leads it. What is said in a pause after it changes the order.
struct Led {
    std::string end = "done";
    std::vector<std::vector<std::string>> in_pause = {};  // empty: no pause
};

const std::vector<Led> kScript = {{},         {"failed", {{"repeat", "--reason", "slipped"}}},
                                  {},         {"done", {{"invalidate", "--reason", "was told"}, {"back"}, {"back"}}},
                                  {},         {},
                                  {"failed"}, {},
                                  {},         {}};

/// Refusals that are over once the program has come to its next trial.
constexpr std::array kNotYet = {"no session runs on it", "the session has begun already",
                                "no trial runs that the experimenter times", "the trial's clock has not been started"};

class CommandedSession {
public:
    /// `kills`: the program is killed at every moment of the script.
    explicit CommandedSession(bool kills) : kills_(kills) {
        writeText(folder_.path() / "study.toml", timedStudy());
        begin({"run", "study.toml", "--db", "s.db", "--real-time"});
    }

    void lead(const Led& trial) {
        static_cast<void>(killed());
        say({"start"});
        if (killed()) say({"start"});
        if (!trial.in_pause.empty()) say({"pause"});
        say({trial.end});
        waitForEnd();
        if (trial.in_pause.empty()) return;
        waitForPause();
        for (std::vector<std::string> words : trial.in_pause) {
            if (words[0] == "invalidate") words.insert(words.end(), {"--attempt", newestAttempt()});
            if (killed()) {
                say({"stop"});                                // nothing else pauses it before a trial
                if (words[0] == "repeat") words[0] = "back";  // the last attempt is the one that was stopped
            }
            say(words);
        }
        if (killed()) say({"stop"});
        say({"continue"});
    }

    /// Every attempt but those that a kill cut off, and the pause after it, in time.
    std::string attempts(const std::string& what) {
        if (program_) {
            EXPECT_EQ(program_->wait(), 0) << program_->err();
        }
        program_.reset();
        const store::Database database(folder_ / "s.db", store::OpenMode::ReadOnly);
        EXPECT_EQ(database.text("SELECT end_state FROM session"), "complete");
        return database.text("SELECT group_concat(" + what +
                             ", ', ') FROM (SELECT * FROM attempt JOIN trial_plan USING(trial_id) JOIN condition "
                             "USING(condition_id) WHERE outcome<>'crashed' AND coalesce(invalid_reason, '')<>"
                             "'emergency stop' ORDER BY attempt_id)");
    }
    std::int64_t killCount() const { return kill_count_; }

private:
    void begin(std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"--answers", "experimenter", "--no-backup"});
        program_ = std::make_unique<Program>(folder_.path(), arguments, true);
    }

    Ended tell(std::vector<std::string> words) const {
        words.insert(words.begin(), "session");
        words.insert(words.begin() + 2, folder_ / "s.db");
        return runProgram(console_.path(), words);
    }

    /// Throws where waiting will not help: the program has ended by itself.
    void waitAMoment() const {
        if (program_->hasEnded()) throw std::runtime_error("the program has ended: " + program_->err());
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }

    /// Says it until the session is where it can be obeyed; throws where waiting will not help.
    void say(const std::vector<std::string>& words) const {
        for (;;) {
            const Ended ended = tell(words);
            if (ended.exit_code == 0) return;
            const bool comes = std::any_of(kNotYet.begin(), kNotYet.end(), [&](const char* not_yet) {
                return ended.err.find(not_yet) != std::string::npos;
            });
            if (!comes) throw std::runtime_error(ended.err);
            waitAMoment();
        }
    }

    /// Obeyed is not yet stored: only an acknowledged attempt outlives a kill.
    void waitForEnd() {
        for (std::string line = "aborted"; line.ends_with("aborted");) line = program_->nextAcknowledgement();
    }

    void waitForSession() const {
        while (tell({"done"}).err.find("no session runs on it") != std::string::npos) waitAMoment();
    }

    void waitForPause() const {
        while (tell({"pause"}).err.find("the session is paused already") == std::string::npos) waitAMoment();
    }

    std::string newestAttempt() const {
        return store::Database(folder_ / "s.db", store::OpenMode::ReadOnly)
            .text("SELECT max(attempt_id) FROM attempt WHERE outcome='success'");
    }

    /// A moment of the script: kills the program and goes on with the session, if that is wanted.
    bool killed() {
        if (!kills_) return false;
        if (kill_count_++ == 0) waitForSession();
        program_->killNow();
        EXPECT_EQ(program_->wait(), -SIGKILL) << program_->err();
        begin({"resume", "s.db"});
        return true;
    }

    TempFolder folder_, console_;
    std::unique_ptr<Program> program_;
    bool kills_;
    std::int64_t kill_count_ = 0;
};

TEST(ResumeCommands, AfterAKillAtEveryStepTheOrderIsThatOfTheUninterruptedSession) {
    // Truth: closed form for the order of the uninterrupted session: trial 1 is repeated, 2 goes to the block's end, 1
    // and 0 are gone back to. Truth: independent program for the other one: that session.
    CommandedSession whole(false);
    for (const Led& trial : kScript) whole.lead(trial);
    ASSERT_EQ(whole.attempts("trial_index"), "0, 1, 1, 2, 0, 1, 3, 4, 5, 2");

    CommandedSession killed(true);
    for (const Led& trial : kScript) killed.lead(trial);
    const std::string all = "trial_index || ' ' || condition || ' ' || outcome || ' ' || coalesce(invalid_reason, '')";
    EXPECT_EQ(killed.attempts(all), whole.attempts(all));
    EXPECT_EQ(killed.killCount(), 26);
}

}  // namespace
}  // namespace passung::test
