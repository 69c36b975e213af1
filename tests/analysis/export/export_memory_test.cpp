#include <gtest/gtest.h>
#include <malloc.h>

#include <cstdio>
#include <fstream>

#include "analysis/export/export.h"
#include "tests/study/store/fake_study.h"

namespace passung::exporter {
namespace {

constexpr std::int64_t kOfASession = 200;

/// Attempts of 20 ticks, of each 200 that were judged by exact geometry.
void writeStudy(const std::string& path, std::int64_t attempts) {
    const auto store = fake::openStore(path);
    for (std::int64_t first = 0; first < attempts; first += kOfASession) {
        const auto writer = fake::beginSession(*store, "S" + std::to_string(100 + first / kOfASession), kOfASession,
                                               false, fake::makePlan(100));
        for (std::int64_t trial = 0; trial < kOfASession; ++trial) {
            const auto id = fake::require(writer->startAttempt(fake::attemptStart(trial)));
            const auto records = fake::makeRecords(static_cast<std::uint64_t>(trial), 20);
            writer->appendRecords(id, 0, records);
            for (int event = 0; event < 6; ++event)
                writer->appendEvent({id, trial * 10'000'000'000 + event, "session", "started", R"({"n":1})"});
            session::AttemptEnd end = fake::attemptEnd(trial, 20);
            end.overlaps.clear();
            for (std::int64_t tick = 0; tick < 200; ++tick)
                end.overlaps.push_back({tick, true, false, false, 1e-6 / static_cast<double>(tick + 3), 2e-6});
            fake::require(writer->finishAttempt(id, end));
        }
    }
}

/// What /proc says of this process, in kB.
long status(const std::string& what) {
    std::ifstream lines("/proc/self/status");
    for (std::string name, line; lines >> name && std::getline(lines, line);)
        if (name == what + ":") return std::stol(line);
    return -1;
}

/// How much more memory an export takes at its most, in kB.
long peakOfExport(const std::string& database, const std::string& folder) {
    malloc_trim(0);
    EXPECT_TRUE(std::ofstream("/proc/self/clear_refs") << 5 << std::flush) << "the highest so far is not forgotten";
    const long before = status("VmRSS");
    const auto reader = fake::require(store::StoreReader::open(database));
    fake::require(exportAll(reader, folder, {}));
    return status("VmHWM") - before;
}

TEST(ExportMemory, GrowsByAFewKilobytesAnAttempt) {
    // Truth: the system's own account of this process. An export of 10 GB is to need 300 MB at most: an attempt of 5 s
    // has half a megabyte of samples, so 20 000 of them may take 15 kB each (153 when all rows were kept as texts).
    const test::TempFolder folder;
    writeStudy(folder / "few.db", 400);
    writeStudy(folder / "many.db", 4000);
    const long few = peakOfExport(folder / "few.db", folder / "few");
    const long many = peakOfExport(folder / "many.db", folder / "many");
    const double each = static_cast<double>(many - few) / 3600.0;
    std::printf("an export of 400 attempts: %ld kB, of 4000: %ld kB, %.2f kB an attempt\n", few, many, each);
    EXPECT_LT(each, 15.0);
}

}  // namespace
}  // namespace passung::exporter
