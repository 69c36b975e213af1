#include "study/store/rows/secondary_rows.h"

#include <gtest/gtest.h>

#include <fstream>

#include "study/store/transfer/merge.h"
#include "tests/study/store/fake_study.h"

namespace passung::store {
namespace {

using enum measures::DetectionResult;

const std::vector<measures::Detection> kDetections = {
    {Hit, 3000, 3400, 3400}, {FalseAlarm, {}, {}, 4000}, {Miss, 7000, 8000, {}}, {NotScored, 11000, 11500, {}}};

/// The third trial of four has a secondary task and no force; the session never ends.
void write(const std::string& path) {
    auto store = fake::openStore(path);
    auto writer = fake::beginSession(*store, "S001", 4);
    auto start = fake::attemptStart(2);
    start.params_json = R"({"cues": {"visual": 1, "vibrotactile": 0, "audio": 0, "full_depth_m": 0.002,
        "full_speed_m_per_s": 0.1, "sound_decay_s": 0.05, "masking_noise": true},
        "kinesthetic": false, "timed_by": "experimenter", "secondary": {"stimulus": "audio"}})";
    const auto id = fake::require(writer->startAttempt(start));
    writer->appendEvent({id, start.start_ns + 200'000'000, "session", "trial_started", "{}"});
    auto end = fake::attemptEnd(2, 100);
    end.detections = kDetections;
    fake::require(writer->finishAttempt(id, end));
    fake::require(fake::writeAttempt(*writer, 3, 40));
}

std::vector<measures::Detection> stored(const std::string& path) {
    std::vector<measures::Detection> result;
    std::int64_t number = 0;
    for (const DetectionRow& row : fake::require(fake::require(StoreReader::open(path)).detections())) {
        EXPECT_EQ(row.number, ++number);
        result.push_back(row.detection);
    }
    return result;
}

TEST(SecondaryRows, AreWhatWasScoredThoughTheSessionNeverEnded) {
    // Truth: closed form: what was written, with times after the attempt's start
    const fake::TempFolder folder;
    write(folder / "s.db");
    EXPECT_EQ(stored(folder / "s.db"), kDetections);
}

TEST(SecondaryRows, TheAttemptTellsWhatItGaveAndWhoTimedIt) {
    // Truth: closed form: what was written; the attempt after it has none of it.
    const fake::TempFolder folder;
    write(folder / "s.db");
    const auto attempts = fake::require(fake::require(StoreReader::open(folder / "s.db")).attempts());
    ASSERT_EQ(attempts.size(), 2u);
    EXPECT_FALSE(attempts[0].kinesthetic);
    EXPECT_TRUE(attempts[0].cues.masking);
    EXPECT_EQ(attempts[0].timed_by, "experimenter");
    EXPECT_EQ(attempts[0].stimulus, "audio");
    EXPECT_EQ(attempts[0].trial_ns, attempts[0].start_ns + 200'000'000);
    EXPECT_TRUE(attempts[1].kinesthetic);
    EXPECT_FALSE(attempts[1].cues.masking);
    EXPECT_EQ(attempts[1].timed_by, "program");
    EXPECT_EQ(attempts[1].stimulus, "none");
    EXPECT_FALSE(attempts[1].trial_ns);
}

TEST(SecondaryRows, GoAlongIntoAMergedDatabase) {
    // Truth: invariant
    const fake::TempFolder folder;
    {
        auto store = fake::openStore(folder / "a.db");
        auto writer = fake::beginSession(*store, "S001", 1);
        const auto id = fake::require(writer->startAttempt(fake::attemptStart(0)));
        auto end = fake::attemptEnd(0, 100);
        end.detections = kDetections;
        fake::require(writer->finishAttempt(id, end));
        fake::require(writer->finishSession(true, end.end_ns));
    }
    fake::require(mergeDatabases({folder / "a.db"}, folder / "all.db", fake::options()));
    EXPECT_EQ(stored(folder / "all.db"), kDetections);
}

TEST(Pictures, AnotherContentUnderTheSameProtocolIsRefused) {
    // Truth: invariant: participants would have read another page.
    const fake::TempFolder folder;
    const std::string picture = folder / "page.png";
    const auto draw = [&](const std::string& bytes) { std::ofstream(picture, std::ios::binary) << bytes; };
    auto plan = fake::makePlan();
    plan.pictures = {{"page.png", picture, 1, 1}};
    draw("one");
    auto store = fake::openStore(folder / "s.db");
    const std::string sha256 = fake::require(store->importProtocol(plan));
    EXPECT_EQ(fake::require(store->importProtocol(plan)), sha256) << "the same again";
    draw("two");
    const auto refused = store->importProtocol(plan);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.errors().front().message.find("the picture page.png has changed"), std::string::npos);
    std::filesystem::remove(picture);
    EXPECT_FALSE(store->importProtocol(plan));
}

}  // namespace
}  // namespace passung::store
