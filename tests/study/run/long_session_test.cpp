#include <gtest/gtest.h>

#include <cstdio>

#include "study/protocol/protocol_reader.h"
#include "study/run/files/known_names.h"
#include "study/run/run_study.h"
#include "study/store/schema/sqlite.h"
#include "tests/study/store/fake_study.h"
#include "tests/support/length.h"
#include "tests/ui/cli/small_study.h"

// The data of a session of an hour, every channel of every tick at 1 kHz. PASSUNG_LONG=1: all of it; else a minute.

namespace passung::test {
namespace {

using fake::require;

constexpr std::int64_t kTrialSeconds = 20, kHour = 3600;
constexpr double kMegabytesAnHour = 500.0;

/// kTrialSeconds of what a simulated person does in the small study, trial after trial, with times that ticks take.
std::vector<TickRecord> realRecords(const std::string& path) {
    const auto plan =
        require(protocol::readProtocolText(smallStudy(), "study.toml", run::knownDevices(), run::knownMeasures()));
    run::RunOptions options;
    options.database = path;
    options.backup = false;
    require(run::runStudy(plan, options, {}));
    const store::StoreReader reader = require(store::StoreReader::open(path));
    std::vector<TickRecord> all;
    for (const store::AttemptRow& attempt : require(reader.attempts()))
        for (const TickRecord& record : require(reader.records(attempt.attempt_id))) all.push_back(record);
    Random random(5);
    std::vector<TickRecord> records;
    for (std::int64_t tick = 0; tick < kTrialSeconds * 1000; ++tick) {
        records.push_back(all[static_cast<std::size_t>(tick) % all.size()]);
        records.back().tick = tick;
        records.back().duration_ns = 8'000 + static_cast<std::int64_t>(random.below(20'000));
    }
    return records;
}

TEST(LongSession, AnHourOfEveryChannelFitsItsDatabaseAndLosesNoRecord) {
    // Truth: closed form (the mark of an hour, in proportion to what is written) for records of a simulated session
    const std::int64_t seconds = test::atFullLength() ? kHour : 60;
    const std::int64_t trials = seconds / kTrialSeconds;
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    const std::size_t ticks = static_cast<std::size_t>(kTrialSeconds * 1000);
    const std::vector<TickRecord> records = realRecords(folder / "small.db");
    {
        const auto store = fake::openStore(path);
        const auto writer = fake::beginSession(*store, "S001", trials, true);
        for (std::int64_t trial = 0; trial < trials; ++trial) {
            const auto id = require(writer->startAttempt(fake::attemptStart(trial)));
            for (std::size_t i = 0; i < ticks; i += 20) writer->appendRecords(id, 0, std::span(records).subspan(i, 20));
            require(writer->finishAttempt(id, fake::attemptEnd(trial, ticks, true)));
        }
        require(writer->finishSession(true, seconds * 1'000'000'000));
    }
    const double megabytes = static_cast<double>(std::filesystem::file_size(path)) / 1e6;
    std::printf("%lld s: %.1f MB, %.0f MB an hour\n", static_cast<long long>(seconds), megabytes,
                megabytes * static_cast<double>(kHour) / static_cast<double>(seconds));
    EXPECT_LE(megabytes, kMegabytesAnHour * static_cast<double>(seconds) / static_cast<double>(kHour));
    const store::Database database(path, store::OpenMode::ReadWrite);
    EXPECT_EQ(database.integer("SELECT sum(n) FROM sample_chunk JOIN stream USING(stream_id) WHERE stream='tick'"),
              seconds * 1000);
    EXPECT_EQ(database.integer("SELECT sum(n) FROM sample_chunk JOIN stream USING(stream_id) WHERE stream<>'tick'"),
              seconds * 1000);
    const store::StoreReader reader = require(store::StoreReader::open(path));
    EXPECT_TRUE(fake::sameStoredBits(require(reader.records(trials)), records)) << "the last trial";
}

}  // namespace
}  // namespace passung::test
