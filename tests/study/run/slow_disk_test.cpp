#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "study/protocol/protocol_reader.h"
#include "study/run/files/known_names.h"
#include "study/run/run_study.h"
#include "study/store/read/store_reader.h"
#include "tests/study/store/fake_study.h"
#include "tests/study/store/faulty_disk.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

constexpr std::chrono::milliseconds kDelay{200};

/// The small study with trials that end by their time-out only.
plan::StudyPlan shortTrials() {
    std::string text = smallStudy();
    const auto replace = [&](const std::string& from, const std::string& to) {
        const auto at = text.find(from);
        if (at == std::string::npos) throw std::runtime_error("no " + from);
        text.replace(at, from.size(), to);
    };
    replace("\"task.timeout_s\" = 20", "\"task.timeout_s\" = 1.2");
    replace("repetitions = 3", "repetitions = 1");
    auto plan = protocol::readProtocolText(text, "study.toml", run::knownDevices(), run::knownMeasures());
    if (!plan) throw std::runtime_error(toString(plan.errors().front()));
    return *std::move(plan);
}

TEST(SlowDisk, NoWriteOf200MillisecondsReachesTheTick) {
    // Truth: closed form. The disk makes every write and every sync wait for 200 ms, so that a commit takes seconds; a
    // tick that waited for one would have that in its own record, as computing time or as the periods that the next one
    // came late. One tick is left to a system that gives this process no time. Nothing is dropped.
    const fake::TempFolder folder;
    const plan::StudyPlan plan = shortTrials();
    run::RunOptions options;
    options.database = folder / "s.db";
    options.participant = "S001";
    options.clock = run::Clock::RealTime;
    options.backup = false;
    std::atomic<int> waits = 0;
    std::atomic<bool> runs = false;
    {
        fake::FaultyDisk disk([&](fake::DiskWork work, std::int64_t) {
            if (work != fake::DiskWork::Delete && runs) {
                std::this_thread::sleep_for(kDelay);
                ++waits;
            }
            return fake::DiskFault{};
        });
        options.interrupted = [&] {
            runs = true;  // the session is there
            return false;
        };
        const auto end = run::runStudy(plan, options, {});
        ASSERT_TRUE(end) << toString(end.errors().front());
    }
    EXPECT_GE(waits, 50);
    const auto reader = store::StoreReader::open(options.database);
    ASSERT_TRUE(reader);
    const auto attempts = reader->attempts();
    ASSERT_TRUE(attempts);
    ASSERT_GE(attempts->size(), plan.conditions.size()) << "a busy machine has trials repeated";
    int slow = 0;
    std::int64_t ticks = 0;
    for (const store::AttemptRow& attempt : *attempts) {
        ASSERT_TRUE(attempt.timing);
        EXPECT_EQ(attempt.timing->dropped_samples, 0);
        const auto records = reader->records(attempt.attempt_id);
        ASSERT_TRUE(records);
        for (std::size_t i = 0; i < records->size(); ++i) {
            EXPECT_EQ((*records)[i].tick, static_cast<std::int64_t>(i));
            const bool computed = std::chrono::nanoseconds((*records)[i].duration_ns) >= kDelay;
            const bool came_late = std::chrono::milliseconds((*records)[i].periods) >= kDelay;
            slow += computed || came_late ? 1 : 0;
        }
        ticks += static_cast<std::int64_t>(records->size());
    }
    EXPECT_GT(ticks, 500);
    EXPECT_LE(slow, 1) << "of " << ticks << " ticks, while the disk waited " << waits << " times";
}

}  // namespace
}  // namespace passung::test
