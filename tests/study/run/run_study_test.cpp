#include "study/run/run_study.h"
#include "study/run/files/known_names.h"

#include <gtest/gtest.h>

#include "study/protocol/protocol_reader.h"
#include "study/run/person/performer.h"
#include "study/store/schema/sqlite.h"
#include "tests/support/temp_folder.h"
#include "tests/ui/cli/small_study.h"

namespace passung::run {
namespace {

plan::StudyPlan planOf(const std::string& text) {
    auto plan = protocol::readProtocolText(text, "study.toml", knownDevices(), knownMeasures());
    if (!plan) throw std::runtime_error(toString(plan.errors().front()));
    return *std::move(plan);
}

class Pilot final : public Performer {
    plan::ParticipantKind kind() const override { return plan::ParticipantKind::Pilot; }
};

TEST(RunStudy, WhoIsNotAdmittedIsNotEnrolled) {
    // Truth: invariant: a refusal leaves no row of the participant, however often it is tried.
    const auto plan =
        planOf(test::smallStudy() + "\n[[consent]]\nclause = \"data_use\"\ntext = { en = \"May we?\" }\n");
    const test::TempFolder folder;
    Pilot visitor;  // nobody has asked for their consent
    RunOptions options;
    options.database = folder / "study.db";
    options.backup = false;
    options.performer = &visitor;
    for (int i = 0; i < 2; ++i) {
        const auto end = runStudy(plan, options, {});
        ASSERT_FALSE(end);
        EXPECT_EQ(end.errors().front().message,
                  "participant T001 has not consented to what this protocol requires: data_use");
    }
    const store::Database database(options.database, store::OpenMode::ReadOnly);
    EXPECT_EQ(database.integer("SELECT count(*) FROM participant"), 0);
    EXPECT_EQ(database.integer("SELECT count(*) FROM design_slot WHERE participant_id IS NOT NULL"), 0);
}

TEST(RunStudy, EverySessionInRealTimeBeginsWhenItBegins) {
    // Truth: invariant under a clock that goes on by an hour each time that it is looked at: no stamp is earlier than
    // what came before it, in one session and from one to the next.
    std::string text = test::smallStudy();
    text.replace(text.find("\"task.timeout_s\" = 20"), 21, "\"task.timeout_s\" = 0.4");  // short trials do
    text.replace(text.find("repetitions = 3"), 15, "repetitions = 1");
    const std::string block = text.substr(text.find("[[block]]"));
    text += "\n" + block + "session = 2\n";
    text.replace(text.rfind("\"main\""), 6, "\"later\"");
    const auto plan = planOf(text);
    const test::TempFolder folder;
    std::int64_t now_ms = 1'709'208'000'000;
    RunOptions options;
    options.database = folder / "study.db";
    options.backup = false;
    options.clock = Clock::RealTime;
    options.now = [&] { return now_ms += 3'600'000; };
    const auto end = runStudy(plan, options, {});
    ASSERT_TRUE(end) << toString(end.errors().front());
    const store::Database database(options.database, store::OpenMode::ReadOnly);
    ASSERT_EQ(database.integer("SELECT count(*) FROM session WHERE epoch='wall'"), 2);
    EXPECT_EQ(database.integer("SELECT count(*) FROM event WHERE t_utc IS NULL"), 0);
    EXPECT_EQ(database.integer("SELECT count(*) FROM (SELECT t_utc < lag(t_utc) OVER (ORDER BY event_id) AS back FROM "
                               "event) WHERE back"),
              0);
    EXPECT_EQ(database.integer("SELECT count(*) FROM session s JOIN session l ON l.ordinal=2 WHERE s.ordinal=1 AND "
                               "s.started_utc < s.ended_utc AND s.ended_utc < l.started_utc AND l.started_utc < "
                               "l.ended_utc"),
              1)
        << "the second session has the first one's clock";
}

}  // namespace
}  // namespace passung::run
