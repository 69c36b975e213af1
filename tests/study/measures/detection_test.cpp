#include "study/measures/detection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace passung::measures {
namespace {

constexpr std::uint64_t kSeed = 5;

std::vector<std::int64_t> onsets(std::size_t count, const DetectionSettings& settings = {}) {
    StimulusTimes times(settings, kSeed);
    std::vector<std::int64_t> result;
    for (; result.size() < count; times.advance()) result.push_back(times.next());
    return result;
}

/// `count` ticks; the button `button` is down for 50 ticks from each of `presses` on.
std::vector<TickRecord> ticksWith(std::int64_t count, const std::vector<std::int64_t>& presses, int button = 1) {
    std::vector<TickRecord> records(static_cast<std::size_t>(count));
    for (std::int64_t tick = 0; tick < count; ++tick) {
        TickRecord& record = records[static_cast<std::size_t>(tick)];
        record.tick = tick;
        record.input_flags = 1;
        for (const std::int64_t press : presses)
            if (tick >= press && tick < press + 50) record.input_flags |= 1u << (7 + button);
    }
    return records;
}

std::vector<Detection> detect(const std::vector<TickRecord>& records, std::optional<std::int64_t> start,
                              std::int64_t end, const DetectionSettings& settings = {}) {
    DetectionTask task(settings, kSeed);
    for (const TickRecord& record : records) task.follow(record);
    return task.detections(start, end);
}

using enum DetectionResult;

TEST(StimulusTimes, AreFromTheLeastToTheMostIntervalApartAndFillIt) {
    // Truth: closed form: uniform in [3, 5] s has mean 4 s and standard deviation 2/sqrt(12) s; 2000 intervals bring
    // the mean within 4 of its standard errors, 0.052 s.
    const auto times = onsets(2000);
    std::int64_t before = 0, least = 1'000'000, most = 0;
    for (const std::int64_t onset : times) {
        least = std::min(least, onset - before);
        most = std::max(most, onset - before);
        before = onset;
    }
    EXPECT_GE(least, 3000);
    EXPECT_LT(least, 3010);
    EXPECT_LE(most, 5000);
    EXPECT_GT(most, 4990);
    EXPECT_NEAR(static_cast<double>(times.back()) / 2000.0, 4000.0, 52.0);
}

TEST(StimulusTimes, FollowFromTheSeedAlone) {
    // Truth: invariant
    StimulusTimes one({}, 1), again({}, 1), other({}, 2);
    int equal = 0;
    for (int i = 0; i < 100; ++i) {
        EXPECT_EQ(one.next(), again.next());
        equal += one.next() == other.next() ? 1 : 0;
        one.advance();
        again.advance();
        other.advance();
    }
    EXPECT_LT(equal, 3);
}

TEST(Detection, APressInTheWindowIsAHitAndPutsTheStimulusOut) {
    // Truth: closed form: pressed 400 ms after the first onset, then never again.
    const auto at = onsets(3);
    const std::int64_t end = at[2] + 1200;
    const auto found = detect(ticksWith(end + 20, {at[0] + 400}), 0, end);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0], (Detection{Hit, at[0], at[0] + 400, at[0] + 400}));
    EXPECT_EQ(found[1], (Detection{Miss, at[1], at[1] + 1000, {}}));
    EXPECT_EQ(found[2], (Detection{NotScored, at[2], at[2] + 1000, {}})) << "the end came before its last moment";
}

TEST(Detection, TheWindowsEdgesCountAndAMillisecondBesideDoesNot) {
    // Truth: closed form: 100 to 2500 ms
    const auto at = onsets(1);
    const auto resultOf = [&](std::int64_t after) {
        const auto found = detect(ticksWith(at[0] + 2900, {at[0] + after}), 0, at[0] + 2899);
        return std::pair(found.front().result, found.size());
    };
    EXPECT_EQ(resultOf(100), std::pair(Hit, std::size_t{1}));
    EXPECT_EQ(resultOf(2500), std::pair(Hit, std::size_t{1}));
    EXPECT_EQ(resultOf(99), std::pair(Miss, std::size_t{2})) << "and a false alarm";
    EXPECT_EQ(resultOf(2501), std::pair(Miss, std::size_t{2}));
}

TEST(Detection, EveryPressThatAnswersNothingIsAFalseAlarm) {
    // Truth: closed form: one before any stimulus, one after an answer; a button that is held is pressed once, and
    // another button is none.
    const auto at = onsets(1);
    const auto found = detect(ticksWith(at[0] + 2900, {1000, at[0] + 300, at[0] + 800}), 0, at[0] + 2899);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0], (Detection{FalseAlarm, {}, {}, 1000}));
    EXPECT_EQ(found[1].result, Hit);
    EXPECT_EQ(found[2], (Detection{FalseAlarm, {}, {}, at[0] + 800}));
    EXPECT_EQ(detect(ticksWith(at[0] + 2900, {at[0] + 300}, 2), 0, at[0] + 2899).front().result, Miss);
    DetectionSettings second;
    second.button = 2;
    EXPECT_EQ(detect(ticksWith(at[0] + 2900, {at[0] + 300}, 2), 0, at[0] + 2899, second).front().result, Hit);
    EXPECT_TRUE(detect(ticksWith(500, {0}), 0, 499).empty()) << "down from the beginning: pressed before";
}

TEST(Detection, OnlyWhatLiesInTheTrialIsScored) {
    // Truth: closed form: the trial begins after the first stimulus and ends between the second one's answer and onset.
    const auto at = onsets(2);
    const auto records = ticksWith(at[1] + 900, {at[0] + 300, at[1] + 300});
    const auto found = detect(records, at[0] + 1, at[1] + 200);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].result, NotScored);
    EXPECT_EQ(found[1], (Detection{NotScored, at[1], at[1] + 200, {}})) << "answered after the end";
    for (const Detection& d : detect(records, {}, at[1] + 800)) EXPECT_EQ(d.result, NotScored) << "never began";
    EXPECT_EQ(detect(records, at[0], at[1] + 300)[1].result, Hit);
}

TEST(Detection, TimeCountsMissedCycles) {
    // Truth: closed form: 200 ticks of which one stands for 31 periods are 230 ms.
    const auto at = onsets(1);
    auto records = ticksWith(at[0] + 2900, {at[0] + 200});
    records[static_cast<std::size_t>(at[0] + 100)].periods = 31;
    const auto found = detect(records, 0, at[0] + 2899);
    EXPECT_EQ(*found[0].response - *found[0].stimulus, 230);
}

TEST(Detection, MeasuresAreCountsRateAndMeanTime) {
    // Truth: closed form: hits after 400 and 600 ms, one miss, one false alarm, one not scored.
    const std::vector<Detection> all = {{Hit, 1000, 1400, 1400},
                                        {FalseAlarm, {}, {}, 2000},
                                        {Hit, 5000, 5600, 5600},
                                        {Miss, 9000, 10000, {}},
                                        {NotScored, 13000, 13500, {}}};
    const auto values = detectionValues(&all);
    ASSERT_EQ(values.size(), detectionDefinitions().size());
    EXPECT_EQ(values[0].value, 3.0);
    EXPECT_EQ(values[1].value, 2.0 / 3.0);
    EXPECT_EQ(values[2].value, 0.5);
    EXPECT_EQ(values[3].value, 1.0);
    for (const Value& value : detectionValues(nullptr)) EXPECT_FALSE(value.value) << value.name;
    const std::vector<Detection> none;
    EXPECT_EQ(detectionValues(&none)[0].value, 0.0);
    EXPECT_FALSE(detectionValues(&none)[1].value);
}

TEST(Detection, ATrialThatNobodyWatchesHasTimesOnly) {
    // Truth: invariant: a device that rests tells nothing of the part in the hand.
    TrialContext context;
    context.end_tick = 900;
    context.watched = false;
    const auto records = ticksWith(1000, {});
    for (const Value& value : computeMeasures(records, context)) {
        const bool time = value.name == "trial_time_s" || value.name == "time_s";
        EXPECT_EQ(value.value.has_value(), time || value.name == "success" || value.name == "finished") << value.name;
        if (time) {
            EXPECT_EQ(value.value, 0.9);
        }
    }
}

}  // namespace
}  // namespace passung::measures
