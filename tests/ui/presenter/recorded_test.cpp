#include "ui/presenter/recorded.h"

#include <gtest/gtest.h>

#include "tests/study/store/fake_study.h"
#include "ui/presenter/axis.h"
#include "ui/presenter/participant.h"
#include "ui/presenter/playback.h"

namespace passung {
namespace {

using namespace presenter;
using fake::require;

TEST(Recorded, QuartilesInterpolateBetweenNeighbours) {
    // Truth: closed form. Of n values the quartile stands at place (n - 1) / 4 from 0: of seven half-way between two.
    const FiveNumbers four = fiveNumbers({4, 1, 3, 2});
    EXPECT_DOUBLE_EQ(four.lower, 1.75);
    EXPECT_DOUBLE_EQ(four.median, 2.5);
    EXPECT_DOUBLE_EQ(four.upper, 3.25);
    const FiveNumbers seven = fiveNumbers({2.5, 8, 1, 3.5, 9, 4, 7.25});
    EXPECT_DOUBLE_EQ(seven.least, 1.0);
    EXPECT_DOUBLE_EQ(seven.lower, 3.0);
    EXPECT_DOUBLE_EQ(seven.median, 4.0);
    EXPECT_DOUBLE_EQ(seven.upper, 7.625);
    EXPECT_DOUBLE_EQ(seven.most, 9.0);
    const FiveNumbers one = fiveNumbers({7});
    EXPECT_EQ(one.lower, 7.0);
    EXPECT_EQ(one.upper, 7.0);
}

TEST(Recorded, LooksAtWhatCountsPerConditionAndNeverMixesKinds) {
    // Truth: closed form. Trial i of the fake study has condition i mod 4 and takes 1 + i/10 s; eight trials.
    const fake::TempFolder folder;
    {
        const auto store = fake::openStore(folder / "s.db");
        const auto writer = fake::beginSession(*store, "S001", 8);
        for (int trial = 0; trial < 8; ++trial) require(fake::writeAttempt(*writer, trial, 50));
        require(writer->reorder(
            {.discounted = {session::AttemptId{2}}, .reason = "the phone rang", .steps = {}}));  // trial 1, condition 1
        require(writer->finishSession(true, 100'000'000'000));
    }
    const auto recorded = require(readRecorded(require(store::StoreReader::open(folder / "s.db"))));
    EXPECT_EQ(recorded.kinds, std::vector<std::string>{"simulated"});
    const auto looks = lookAt(recorded, "completion_time_s", "simulated");
    ASSERT_EQ(looks.size(), 4u);
    EXPECT_EQ(looks[0].values, (std::vector{1.0, 1.4}));
    EXPECT_EQ(looks[1].values, (std::vector{1.5})) << "an attempt that does not count";
    EXPECT_EQ(looks[0].participants, 1u);
    EXPECT_DOUBLE_EQ(looks[3].numbers.median, 1.5);
    EXPECT_TRUE(lookAt(recorded, "completion_time_s", "real").empty());
    ASSERT_EQ(attemptsOf(recorded, recorded.data.sessions[0].session_id).size(), 8u);
    EXPECT_EQ(attemptsOf(recorded, recorded.data.sessions[0].session_id)[5]->trial_index, 5);
}

TEST(Recorded, ALookBeginsWithAMeasureThatVaries) {
    // Truth: invariant. Of three measures the time is the same in all attempts, or varies, or nothing varies.
    Recorded recorded;
    for (const char* name : {"trials", "time_s", "peak_force_N"}) recorded.measures.push_back({name, "", ""});
    recorded.data.attempts.resize(2);
    const auto set = [&](const char* name, double first, double second) {
        recorded.data.attempts[0].measures[name] = first;
        recorded.data.attempts[1].measures[name] = second;
    };
    set("trials", 1, 1);
    set("time_s", 30, 30);
    set("peak_force_N", 2, 2);
    EXPECT_EQ(firstMeasure(recorded), 0u);
    set("peak_force_N", 2, 3);
    EXPECT_EQ(firstMeasure(recorded), 2u);
    set("time_s", 30, 29);
    EXPECT_EQ(firstMeasure(recorded), 1u);
}

TEST(Trace, ItsLineHasNoGapHoweverSteepTheSignalAndHoweverNarrowTheField) {
    // Truth: invariant. Neighbouring columns touch in width and height, each shows its own values, all lie in the field
    // but for half a line; at every pixel across there is a column.
    const auto count = static_cast<std::size_t>(Trace::kSeconds / Trace::kStretch);
    std::vector<Trace::Span> spans(count);
    for (std::size_t i = 0; i < count; ++i) {
        const float value = i % 97 == 0 ? 10.0f : i % 2 == 0 ? 0.0f : 4.0f;
        spans[i] = {value, value + (i % 5 == 0 ? 1.0f : 0.0f)};
    }
    const double height = 120.0, top = 20.0;
    for (const double width : {90.0, 333.0, 470.0, 1900.0}) {
        const auto strokes = strokesOf(spans, width, height, top);
        ASSERT_EQ(strokes.size(), count);
        for (std::size_t i = 0; i < count; ++i) {
            const Stroke& stroke = strokes[i];
            const auto y = [&](float value) { return height * (1.0 - static_cast<double>(value) / top); };
            EXPECT_LE(stroke.upper, y(spans[i].high) + 1e-3);
            EXPECT_GE(stroke.lower, y(spans[i].low) - 1e-3);
            EXPECT_GE(stroke.lower - stroke.upper, 1.59f);
            EXPECT_GE(stroke.right - stroke.left, 1.59f);
            if (i == 0) continue;
            EXPECT_LE(stroke.left, strokes[i - 1].right + 1e-3f);
            EXPECT_LE(stroke.upper, strokes[i - 1].lower + 1e-3f);
            EXPECT_GE(stroke.lower, strokes[i - 1].upper - 1e-3f);
        }
        EXPECT_LE(strokes.front().left, 1.0f);
        EXPECT_GE(strokes.back().right, static_cast<float>(width) - 1e-3f);
    }
}

TEST(Trace, ItsScaleShowsMicrometres) {
    // Truth: closed form: the smallest of 1, 2, 5 · 10^n that has room for the peak.
    EXPECT_DOUBLE_EQ(traceTop(0.004, 0.001), 0.005);  // 4 um in mm fill four fifths of the field
    EXPECT_DOUBLE_EQ(traceTop(0.0, 0.001), 0.001);
    EXPECT_DOUBLE_EQ(traceTop(3.0, 0.5), 5.0);
}

TEST(Axis, ItsMarksAreRoundAndHoldEverything) {
    // Truth: invariant.
    EXPECT_EQ(axisMarks(0.0, 10.0, 5), (std::vector{0.0, 2.0, 4.0, 6.0, 8.0, 10.0}));
    const struct {
        double low, high;
    } cases[] = {{0.13, 0.94}, {-3.0, 17.2}, {1e-7, 3e-7}, {5.0, 5.0}, {0.0, 0.0}, {-2.0, -1.0}};
    for (const auto& each : cases) {
        const auto marks = axisMarks(each.low, each.high, 5);
        EXPECT_LE(marks.front(), each.low);
        EXPECT_GE(marks.back(), each.high - 1e-12);
        EXPECT_GE(marks.size(), 3u);
        EXPECT_LE(marks.size(), 9u);
    }
}

/// Ticks of a proxy at rest and a hand that comes to press; the force of tick i is i [N], the trial begins at tick 10.
std::vector<TickRecord> pressing() {
    std::vector<TickRecord> records(101);
    for (std::size_t i = 0; i < records.size(); ++i) {
        records[i].tick = static_cast<std::int64_t>(i);
        records[i].force_N = {0.0f, 0.0f, static_cast<float>(i)};
        records[i].hand_depth_m = 1e-3f * static_cast<float>(i);
        records[i].status = i >= 10 ? kEngaged : 0u;
        records[i].periods = i == 50 ? 11 : 1;  // ten cycles were missed
    }
    return records;
}

TEST(Playback, ShowsTheNewestTickOfEveryTimeWithMissedCyclesInIt) {
    // Truth: closed form: 100 ticks of 1 ms after the first, ten missed ones more.
    Playback playback(pressing(), nullptr);
    EXPECT_NEAR(playback.length(), 0.110, 1e-12);
    EXPECT_NEAR(playback.go(), 0.010, 1e-12);
    playback.seek(0.0305);
    EXPECT_EQ(playback.record().tick, 30);
    playback.seek(0.0550);
    EXPECT_EQ(playback.record().tick, 49) << "in the gap the tick before it holds";
    playback.seek(9.0);
    EXPECT_EQ(playback.record().tick, 100);
    playback.seek(-1.0);
    EXPECT_EQ(playback.record().tick, 0);
}

TEST(Playback, PlaysAtItsSpeedToTheEndAndBeginsAnewThen) {
    // Truth: closed form.
    Playback playback(pressing(), nullptr);
    EXPECT_FALSE(playback.pass(0.01)) << "it does not play";
    playback.setSpeed(0.5);
    playback.play(true);
    EXPECT_TRUE(playback.pass(0.04));
    EXPECT_NEAR(playback.time(), 0.02, 1e-12);
    playback.setSpeed(4.0);
    EXPECT_TRUE(playback.pass(1.0));
    EXPECT_FALSE(playback.plays());
    EXPECT_EQ(playback.record().tick, 100);
    playback.play(true);
    EXPECT_EQ(playback.time(), 0.0);
}

TEST(Playback, KeepsEveryPeakInItsColumns) {
    // Truth: invariant. However few columns there are, the largest force is in one.
    const Playback playback(pressing(), nullptr);
    for (const std::size_t columns : {1u, 7u, 100u, 1000u}) {
        const auto spans = playback.forces(columns);
        ASSERT_EQ(spans.size(), columns);
        EXPECT_EQ(spans.front().low, 0.0f);
        EXPECT_EQ(spans.back().high, 100.0f);
        EXPECT_NEAR(playback.depths(columns).back().high, 100.0f, 1e-3);
    }
}

TEST(Playback, ShowsTheOtherPoseAsAGhostWhereItIsAnother) {
    // Truth: closed form: what is drawn is the protocol's choice, the ghost is the rest.
    DrawnScene scene;
    scene.parts.resize(1);
    auto cube = std::make_shared<ShadedMesh>();
    cube->low_mm = {-10.0f, -10.0f, -10.0f};
    cube->high_mm = {10.0f, 10.0f, 10.0f};
    scene.parts[0].mesh = cube;
    TickRecord record;
    record.hand_quaternion = record.proxy_quaternion = {1.0f, 0.0f, 0.0f, 0.0f};
    record.proxy_position_m = {0.0f, 0.0f, 0.002f};
    record.force_N = {0.0f, 0.0f, 2.0f};
    ParticipantView view = playbackView(scene, record);
    EXPECT_NEAR(view.X_WHeld.p.z(), 0.002, 1e-9);
    EXPECT_TRUE(view.start_mark);
    EXPECT_NEAR(view.X_WStart.p.z(), 0.0, 1e-9);
    EXPECT_TRUE(view.arrow) << "whoever felt it";
    EXPECT_NEAR(view.arrow_from.z(), 0.012, 1e-9) << "at the drawn part's top";
    EXPECT_NEAR(view.arrow_way.z(), 2.0 * kArrowPerNewton, 1e-12);
    scene.shown = plan::ShownPose::Device;
    view = playbackView(scene, record);
    EXPECT_NEAR(view.X_WHeld.p.z(), 0.0, 1e-9);
    EXPECT_NEAR(view.X_WStart.p.z(), 0.002, 1e-9);
    record.proxy_position_m = {};
    EXPECT_FALSE(playbackView(scene, record).start_mark) << "both are the same";
}

}  // namespace
}  // namespace passung
