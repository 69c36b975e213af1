#include "study/measures/measures.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "study/measures/overlap.h"

namespace passung::measures {
namespace {

using std::numbers::pi;

/// What is left of the filter's beginning at rest after 300 ms: exp(-2 pi 10 Hz 0.3 s / sqrt 2) of its lag.
constexpr double kSettled = 1e-7;
constexpr double kStep = 0x1p-13;  // [m] a tick; exact in 32 bits, so that sums are exact too

/// `count` ticks from 0, hand and proxy far above the target's mouth at the origin, no contact.
std::vector<TickRecord> restingTicks(std::int64_t count) {
    std::vector<TickRecord> records(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < records.size(); ++i) {
        records[i].tick = static_cast<std::int64_t>(i);
        records[i].hand_position_m = {0.0f, 0.0f, 0.5f};
        records[i].proxy_position_m = {0.0f, 0.0f, 0.5f};
        records[i].hand_quaternion = {1.0f, 0.0f, 0.0f, 0.0f};
        records[i].proxy_quaternion = {1.0f, 0.0f, 0.0f, 0.0f};
    }
    return records;
}

/// Moves the proxy's origin to `depth` below the mouth, on the axis.
void putTipAt(TickRecord& record, double depth) { record.proxy_position_m = {0.0f, 0.0f, static_cast<float>(-depth)}; }

TrialContext contextUntil(std::int64_t end_tick, Outcome outcome = Outcome::Success) {
    TrialContext context;
    context.end_tick = end_tick;
    context.outcome = outcome;
    return context;
}

std::map<std::string, std::optional<double>> measure(const std::vector<TickRecord>& records,
                                                     const TrialContext& context) {
    std::map<std::string, std::optional<double>> result;
    for (const Value& value : computeMeasures(records, context)) result[value.name] = value.value;
    return result;
}

TEST(Measures, EveryDefinitionHasAUniqueNameThatEndsInItsUnit) {
    // Truth: invariant
    const std::map<std::string, std::string> suffixes = {{"s", "_s"},    {"m", "_m"},    {"rad", "_rad"}, {"N", "_N"},
                                                         {"N m", "_Nm"}, {"N s", "_Ns"}, {"J", "_J"},     {"1", ""}};
    std::set<std::string> names;
    for (const MeasureDefinition& definition : definitions()) {
        EXPECT_TRUE(names.insert(definition.name).second) << definition.name;
        ASSERT_TRUE(suffixes.contains(definition.unit)) << definition.unit;
        EXPECT_TRUE(definition.name.ends_with(suffixes.at(definition.unit))) << definition.name;
        EXPECT_FALSE(definition.label.empty() || definition.formula.empty()) << definition.name;
    }
}

TEST(Measures, ValuesComeInTheOrderOfTheDefinitions) {
    // Truth: invariant
    const auto values = computeMeasures(restingTicks(3), contextUntil(2));
    ASSERT_EQ(values.size(), definitions().size());
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i].name, definitions()[i].name);
}

TEST(Measures, StraightLineHasTheLengthOfItsStepsAndItsClockStartsOutsideTheLeaveSphere) {
    // Truth: closed form. 1000 steps of 2^-13 m; |x| > 20 mm first at step ceil(0.02 · 2^13) = 164.
    auto records = restingTicks(1001);
    for (std::size_t i = 0; i < records.size(); ++i)
        records[i].hand_position_m = {static_cast<float>(kStep * static_cast<double>(i)), 0.0f, 0.5f};
    const auto values = measure(records, contextUntil(1000));
    EXPECT_NEAR(*values.at("path_length_m"), 1000.0 * kStep, kSettled);
    EXPECT_DOUBLE_EQ(*values.at("trial_time_s"), 1.0);
    EXPECT_DOUBLE_EQ(*values.at("completion_time_s"), 0.836);
    EXPECT_DOUBLE_EQ(*values.at("success"), 1.0);
    EXPECT_DOUBLE_EQ(*values.at("rotation_path_rad"), 0.0);
}

TEST(Measures, TimesAreTheNearestNumbersToTheirMilliseconds) {
    // Truth: closed form. 4028 times the nearest double to 0.001 is 4.0280000000000005.
    const auto values = measure(restingTicks(4029), contextUntil(4028));
    EXPECT_EQ(values.at("trial_time_s"), 4.028);
}

TEST(Measures, MissedCyclesStretchTheTimesThatTheyFallInto) {
    // Truth: closed form. Leaves at tick 200, touches at 400, engages at 600, ends at 1000. Of missed cycles 5 lie
    // before the start tick's record, 10 before leaving, 20 in the approach after it, 30 in the search, 40 in the
    // insertion.
    auto records = restingTicks(1001);
    for (std::size_t i = 200; i < records.size(); ++i) records[i].hand_position_m = {0.1f, 0.0f, 0.5f};
    for (std::size_t i = 400; i < records.size(); ++i) records[i].force_N = {0.0f, 0.0f, 2.0f};
    for (std::size_t i = 600; i < records.size(); ++i) putTipAt(records[i], 0.005);
    records[0].periods = 6;
    records[100].periods = 11;
    records[300].periods = 21;
    records[500].periods = 31;
    records[1000].periods = 41;
    const auto values = measure(records, contextUntil(1000));
    EXPECT_DOUBLE_EQ(*values.at("trial_time_s"), 1.100);
    EXPECT_DOUBLE_EQ(*values.at("completion_time_s"), 0.890);
    EXPECT_DOUBLE_EQ(*values.at("approach_time_s"), 0.430);
    EXPECT_DOUBLE_EQ(*values.at("search_time_s"), 0.230);
    EXPECT_DOUBLE_EQ(*values.at("insertion_time_s"), 0.440);
    EXPECT_DOUBLE_EQ(*values.at("contact_time_s"), 0.670);  // ticks 400…999 and the 70 periods that two of them last
    EXPECT_NEAR(*values.at("impulse_Ns"), 2.0 * 0.670, 1e-12);
}

TEST(Measures, CompletionTimeIsEmptyWithoutSuccess) {
    // Truth: closed form (definition)
    auto records = restingTicks(1001);
    for (std::size_t i = 500; i < records.size(); ++i) records[i].hand_position_m = {0.1f, 0.0f, 0.5f};
    const auto values = measure(records, contextUntil(1000, Outcome::Timeout));
    EXPECT_FALSE(values.at("completion_time_s"));
    EXPECT_DOUBLE_EQ(*values.at("success"), 0.0);
    EXPECT_DOUBLE_EQ(*values.at("time_s"), 1.0) << "so long it was not done";
    EXPECT_DOUBLE_EQ(*values.at("finished"), 0.0);
    const auto done = measure(records, contextUntil(1000));
    EXPECT_DOUBLE_EQ(*done.at("completion_time_s"), 0.5);
    EXPECT_DOUBLE_EQ(*done.at("time_s"), 1.0);
    EXPECT_DOUBLE_EQ(*done.at("finished"), 1.0);
}

TEST(Measures, CircleHasTheLengthOfItsChordsAndOneTurnOfRotation) {
    // Truth: closed form. Chords: 2 r n sin(π/n), of a circle that the low-pass draws in by 1/(1 + (1 Hz / 10 Hz)^4),
    // 1e-4, and by 3 % in the 50 ms at its ends, where the point reflection bends the other way; half as much of the
    // quaternions, which turn half as fast.
    constexpr int n = 1000;
    constexpr double r = 0.05;
    const Vec3 axis = Vec3(1.0, -2.0, 0.5).normalized();
    auto records = restingTicks(n + 1);
    for (int i = 0; i <= n; ++i) {
        const double angle = 2.0 * pi * i / n;
        TickRecord& record = records[static_cast<std::size_t>(i)];
        record.hand_position_m = {static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle)), 0};
        const double sign = i % 2 == 0 ? 1.0 : -1.0;  // q and -q are the same rotation
        const Vec3 v = sign * std::sin(angle / 2.0) * axis;
        record.hand_quaternion = {static_cast<float>(sign * std::cos(angle / 2.0)), static_cast<float>(v.x()),
                                  static_cast<float>(v.y()), static_cast<float>(v.z())};
    }
    const auto values = measure(records, contextUntil(n));
    EXPECT_NEAR(*values.at("path_length_m"), 2.0 * r * n * std::sin(pi / n), 5e-4 * 2.0 * pi * r);
    EXPECT_NEAR(*values.at("rotation_path_rad"), 2.0 * pi, 5e-4 * 2.0 * pi);
}

TEST(Measures, ForcesAndDepthsAverageOverContactTicksOnly) {
    // Truth: closed form. Contact in ticks 100…199 and 300…349 with |F| = 5 N, |T| = 0.25 N·m; one tick twice that.
    auto records = restingTicks(1001);
    for (std::size_t i = 0; i < records.size(); ++i) {
        if (!((i >= 100 && i < 200) || (i >= 300 && i < 350))) continue;
        const float factor = i == 320 ? 2.0f : 1.0f;
        records[i].force_N = {3.0f * factor, 4.0f * factor, 0.0f};
        records[i].torque_Nm = {0.0f, 0.0f, -0.25f * factor};
        records[i].hand_depth_m = 0x1p-9f * factor;
        records[i].proxy_depth_m = 0x1p-14f * factor;
        records[i].proxy_gap_m = 0x1p-15f / factor;
    }
    const auto values = measure(records, contextUntil(1000));
    EXPECT_DOUBLE_EQ(*values.at("contact_onsets"), 2.0);
    EXPECT_DOUBLE_EQ(*values.at("contact_time_s"), 0.150);
    EXPECT_DOUBLE_EQ(*values.at("mean_force_N"), 5.0 * 151.0 / 150.0);
    EXPECT_DOUBLE_EQ(*values.at("peak_force_N"), 10.0);
    EXPECT_DOUBLE_EQ(*values.at("mean_torque_Nm"), 0.25 * 151.0 / 150.0);
    EXPECT_DOUBLE_EQ(*values.at("peak_torque_Nm"), 0.5);
    EXPECT_DOUBLE_EQ(*values.at("mean_hand_depth_m"), 0x1p-9 * 151.0 / 150.0);
    EXPECT_DOUBLE_EQ(*values.at("max_hand_depth_m"), 0x1p-8);
    EXPECT_DOUBLE_EQ(*values.at("mean_proxy_depth_m"), 0x1p-14 * 151.0 / 150.0);
    EXPECT_DOUBLE_EQ(*values.at("max_proxy_depth_m"), 0x1p-13);
    EXPECT_DOUBLE_EQ(*values.at("min_proxy_gap_m"), 0x1p-16);
    EXPECT_FALSE(measure(restingTicks(101), contextUntil(100)).at("min_proxy_gap_m")) << "none is known";
    EXPECT_NEAR(*values.at("impulse_Ns"), 5.0 * 151.0 * 1e-3, 1e-12);
}

TEST(Measures, EveryTwentiethContactTickAndTheLargestOfDepthAndForceAreJudged) {
    // Truth: closed form. Contact in ticks 100 ... 199: the 1st, 21st ... of them; the force grows with the tick, the
    // depth falls with it, so that the 20 largest are the last and the first of them. Tick 5 is before the trial.
    auto records = restingTicks(1001);
    for (std::size_t i = 100; i < 200; ++i) {
        records[i].force_N = {0.0f, 0.0f, 1.0f + 0.01f * static_cast<float>(i)};
        records[i].proxy_depth_m = 1e-5f - 1e-8f * static_cast<float>(i);
    }
    records[5].force_N = {9.0f, 0.0f, 0.0f};
    TrialContext context = contextUntil(1000);
    context.start_tick = 10;
    const auto judged = ticksToJudge(records, context);
    ASSERT_EQ(judged.size(), 43u) << "20 and 20, and of every 20th those at 120, 140 and 160";
    for (const TickOverlap& tick : judged) {
        EXPECT_EQ(tick.every_20th, tick.tick % 20 == 0) << tick.tick;
        EXPECT_EQ(tick.largest_depth, tick.tick >= 100 && tick.tick < 120) << tick.tick;
        EXPECT_EQ(tick.largest_force, tick.tick >= 180 && tick.tick < 200) << tick.tick;
    }
    EXPECT_TRUE(ticksToJudge(restingTicks(50), contextUntil(49)).empty());
}

TEST(Measures, ExactOverlapsAreTheLargestAndTheShareOfEveryTwentiethAboveTwoMicrometres) {
    // Truth: closed form (definition). Of every 20th tick two of four overlap by more than 2 um.
    TrialContext context = contextUntil(100);
    for (const double depth : {0.0, 2e-6, 2.1e-6, 5e-5})
        context.overlaps.push_back({.tick = static_cast<std::int64_t>(context.overlaps.size()),
                                    .every_20th = true,
                                    .depth = depth,
                                    .bound = depth});
    context.overlaps.push_back({.tick = 9, .largest_depth = true, .depth = 7e-5, .bound = 7.2e-5});
    const auto values = measure(restingTicks(101), context);
    EXPECT_EQ(values.at("max_exact_overlap_m"), 7e-5);
    EXPECT_EQ(values.at("exact_overlap_share"), 0.5);
    const auto none = measure(restingTicks(101), contextUntil(100));
    EXPECT_FALSE(none.at("max_exact_overlap_m")) << "nothing was judged";
    EXPECT_FALSE(none.at("exact_overlap_share"));
}

TEST(Measures, AnOverlapThatIsNotProvenIsNoneThatWasMeasured) {
    // Truth: closed form (definition). A search that ended early found nothing, and proves 1 mm only.
    TrialContext context = contextUntil(100);
    context.overlaps = {{.tick = 1, .every_20th = true, .depth = 5e-6, .bound = 6e-6},
                        {.tick = 2, .every_20th = true, .depth = 0.0, .bound = 1e-3},
                        {.tick = 3, .every_20th = true, .depth = 0.0, .bound = 5e-7}};
    const auto values = measure(restingTicks(101), context);
    EXPECT_FALSE(values.at("max_exact_overlap_m"));
    EXPECT_EQ(values.at("exact_overlap_share"), 0.5) << "of the first and the third";
}

TEST(Measures, MeansAreEmptyAndSumsZeroWithoutContact) {
    // Truth: closed form (definition)
    const auto values = measure(restingTicks(101), contextUntil(100));
    for (const char* name : {"mean_force_N", "mean_torque_Nm", "mean_hand_depth_m", "mean_proxy_depth_m",
                             "approach_time_s", "search_time_s", "insertion_time_s"})
        EXPECT_FALSE(values.at(name)) << name;
    for (const char* name : {"contact_onsets", "contact_time_s", "peak_force_N", "peak_torque_Nm", "impulse_Ns",
                             "max_hand_depth_m", "max_proxy_depth_m", "work_J", "insertion_depth_m"})
        EXPECT_DOUBLE_EQ(values.at(name).value(), 0.0) << name;
}

TEST(Measures, HandThatMovesAgainstAForceDoesPositiveWork) {
    // Truth: closed form. W = |F| · distance.
    auto records = restingTicks(1001);
    for (std::size_t i = 0; i < records.size(); ++i) {
        records[i].hand_position_m = {static_cast<float>(kStep * static_cast<double>(i)), 0.0f, 0.5f};
        records[i].force_N = {-2.0f, 7.0f, 0.0f};  // the sideways part does no work
    }
    EXPECT_NEAR(*measure(records, contextUntil(1000)).at("work_J"), 2.0 * 1000.0 * kStep, 2.0 * kSettled);
}

TEST(Measures, HandThatTurnsWithATorqueTakesWorkOut) {
    // Truth: closed form. W = -T · angle; 1 rad in 1000 steps, 32-bit quaternions are off by < 2e-7 rad a step.
    auto records = restingTicks(1001);
    for (std::size_t i = 0; i < records.size(); ++i) {
        const double angle = 1e-3 * static_cast<double>(i);
        const double sign = i % 2 == 0 ? 1.0 : -1.0;  // q and -q are the same rotation
        records[i].hand_quaternion = {static_cast<float>(sign * std::cos(angle / 2.0)), 0.0f, 0.0f,
                                      static_cast<float>(sign * std::sin(angle / 2.0))};
        records[i].torque_Nm = {0.3f, 0.0f, 0.5f};
    }
    EXPECT_NEAR(*measure(records, contextUntil(1000)).at("work_J"), -0.5, 1e-5);
}

TEST(Measures, SaturatedShareCountsTicksAtTheForceLimit) {
    // Truth: closed form. 50 of 200 ticks; the rate limit is another bit.
    auto records = restingTicks(201);
    for (std::size_t i = 0; i < records.size(); ++i) {
        records[i].status = kRateLimited | kEngaged;
        if (i >= 20 && i < 70) records[i].status |= kForceLimited;
    }
    EXPECT_DOUBLE_EQ(*measure(records, contextUntil(200)).at("saturated_share"), 0.25);
}

/// Contact from tick 400, tip 1.5 mm deep from tick 700, 20 mm from tick 900.
std::vector<TickRecord> insertion() {
    auto records = restingTicks(1501);
    for (std::size_t i = 400; i < records.size(); ++i) {
        records[i].contacts = 3;
        putTipAt(records[i], i < 700 ? 0.0005 : i < 900 ? 0.0015 : 0.020);
    }
    return records;
}

TEST(Measures, PhasesOfASuccessPartitionTheTrial) {
    // Truth: closed form
    const auto values = measure(insertion(), contextUntil(1500));
    EXPECT_DOUBLE_EQ(*values.at("approach_time_s"), 0.4);
    EXPECT_DOUBLE_EQ(*values.at("search_time_s"), 0.3);
    EXPECT_DOUBLE_EQ(*values.at("insertion_time_s"), 0.8);
    EXPECT_NEAR(*values.at("insertion_depth_m"), 0.020, 1e-8);
}

TEST(Measures, InsertionTimeIsEmptyWithoutSuccess) {
    // Truth: closed form (definition)
    const auto values = measure(insertion(), contextUntil(1500, Outcome::Timeout));
    EXPECT_TRUE(values.at("search_time_s"));
    EXPECT_FALSE(values.at("insertion_time_s"));
}

TEST(Measures, PartThatGoesInWithoutTouchingDoesNotSearch) {
    // Truth: closed form. Engaged at tick 300, first contact at tick 600.
    auto records = restingTicks(1001);
    for (std::size_t i = 300; i < records.size(); ++i) putTipAt(records[i], 0.005);
    for (std::size_t i = 600; i < records.size(); ++i) records[i].contacts = 1;
    const auto values = measure(records, contextUntil(1000));
    EXPECT_DOUBLE_EQ(*values.at("approach_time_s"), 0.3);
    EXPECT_DOUBLE_EQ(*values.at("search_time_s"), 0.0);
    EXPECT_DOUBLE_EQ(*values.at("insertion_time_s"), 0.7);
}

TEST(Measures, DepthCountsOnTheAxisOfATurnedTargetAndNotBesideIt) {
    // Truth: closed form. The bore's axis is the world's y: its mouth at (0.1, 0.2, 0.3), 5 mm in is y = 0.195; 0.5 mm
    // of clearance and 0.2 mm of give.
    TrialContext context = contextUntil(10);
    context.X_WT.q = Quat(Eigen::AngleAxisd(-pi / 2.0, Vec3::UnitX()));  // z of the target to the world's y
    context.X_WT.p = Vec3(0.1, 0.2, 0.3);
    context.clearance = 5e-4;
    auto records = restingTicks(11);
    for (TickRecord& record : records) record.proxy_position_m = {0.1f, 0.195f, 0.3006f};
    EXPECT_NEAR(*measure(records, context).at("insertion_depth_m"), 0.005, 1e-7);
    for (TickRecord& record : records) record.proxy_position_m = {0.1f, 0.195f, 0.3008f};
    EXPECT_DOUBLE_EQ(*measure(records, context).at("insertion_depth_m"), 0.0);
    EXPECT_FALSE(measure(records, context).at("search_time_s"));
}

TEST(Measures, PegPressedIntoTheWallBesideTheBoreIsNeitherEngagedNorInserted) {
    // Truth: closed form. 15 mm deep in the material, 1.9 mm beside the axis, 0.5 mm of clearance: no engagement, and
    // the approach ends with the contact.
    TrialContext context = contextUntil(1000, Outcome::Timeout);
    context.clearance = 5e-4;
    auto records = restingTicks(1001);
    for (std::size_t i = 300; i < records.size(); ++i) {
        records[i].contacts = 9;
        records[i].proxy_position_m = {0.0019f, 0.0f, -0.015f};
    }
    const auto values = measure(records, context);
    EXPECT_EQ(values.at("approach_time_s"), 0.3);
    EXPECT_FALSE(values.at("search_time_s"));
    EXPECT_EQ(values.at("insertion_depth_m"), 0.0);
}

TEST(Measures, CountTheTicksInWhichEachGuardActed) {
    // Truth: closed form. Each bit in a number of ticks of its own, from tick 10 on, beside bits that are not counted;
    // one tick before the trial and one at its end count for none.
    const std::vector<std::pair<const char*, TickStatus>> counted = {
        {"input_held_ticks", kInputHeld},       {"input_rejected_ticks", kInputRejected},
        {"device_stale_ticks", kDeviceStale},   {"latched_ticks", kNonFiniteLatched},
        {"force_limited_ticks", kForceLimited}, {"rate_limited_ticks", kRateLimited},
        {"passivity_ticks", kPassivityActed},   {"suspended_ticks", kSuspended}};
    auto records = restingTicks(101);
    TrialContext context = contextUntil(100);
    context.start_tick = 10;
    for (std::size_t n = 0; n < counted.size(); ++n) {
        for (std::size_t i = 0; i <= 2 * n; ++i) records[10 + i].status |= counted[n].second;
        records[9].status |= counted[n].second;
        records[100].status |= counted[n].second;
    }
    for (auto& record : records) record.status |= kEngaged | kOverrun | kContactCap;
    const auto values = measure(records, context);
    for (std::size_t n = 0; n < counted.size(); ++n)
        EXPECT_EQ(values.at(counted[n].first), 2.0 * static_cast<double>(n) + 1.0) << counted[n].first;
    EXPECT_EQ(measure(restingTicks(101), context).at("rate_limited_ticks"), 0.0);
}

TEST(Measures, TicksOutsideTheTrialAreIgnored) {
    // Truth: invariant: loud ticks before the start and after the end change nothing.
    auto records = insertion();
    TrialContext context = contextUntil(1200);
    context.start_tick = 200;
    const auto quiet = measure(records, context);
    for (TickRecord& record : records) {
        if (record.tick >= 200 && record.tick <= 1200) continue;
        record.force_N = {100.0f, 0.0f, 0.0f};
        record.hand_position_m = {static_cast<float>(record.tick), 0.0f, 0.0f};
        record.status = kForceLimited;
        record.proxy_depth_m = 1.0f;
        putTipAt(record, 0.010);
    }
    EXPECT_EQ(measure(records, context), quiet);
}

TEST(Measures, MissingTicksCountForNoDurationAndTheirStepIsStraight) {
    // Truth: closed form. Ticks 200…299 of a straight line in constant contact are lost.
    auto records = restingTicks(1001);
    for (std::size_t i = 0; i < records.size(); ++i) {
        records[i].hand_position_m = {static_cast<float>(kStep * static_cast<double>(i)), 0.0f, 0.5f};
        records[i].force_N = {0.0f, 0.0f, 2.0f};
    }
    records.erase(records.begin() + 200, records.begin() + 300);
    const auto values = measure(records, contextUntil(1000));
    EXPECT_NEAR(*values.at("path_length_m"), 1000.0 * kStep, kSettled);
    EXPECT_DOUBLE_EQ(*values.at("contact_time_s"), 0.9);
    EXPECT_DOUBLE_EQ(*values.at("trial_time_s"), 1.0);
}

/// The first hand rests with 1 N at ticks 100 ... 199; the other goes straight on, a step a tick, with 3 N and 0.25 Nm
/// at ticks 150 ... 349.
struct TwoHands {
    std::vector<TickRecord> first = restingTicks(1001), other = restingTicks(1001);

    TwoHands() {
        for (std::size_t i = 0; i <= 1000; ++i) {
            other[i].hand_position_m = {static_cast<float>(kStep * static_cast<double>(i)), 0.0f, 0.5f};
            if (i >= 100 && i < 200) first[i].force_N = {1.0f, 0.0f, 0.0f};
            if (i < 150 || i >= 350) continue;
            other[i].force_N = {-3.0f, 0.0f, 0.0f};
            other[i].torque_Nm = {0.0f, 0.25f, 0.0f};
            other[i].proxy_depth_m = 0x1p-12f;
            other[i].hand_depth_m = 0x1p-10f;
            other[i].status |= kForceLimited;
        }
        other[160].proxy_gap_m = 0x1p-18f;
    }
    std::map<std::string, std::optional<double>> measured() const {
        const std::array<std::span<const TickRecord>, 2> hands{first, other};
        std::map<std::string, std::optional<double>> result;
        for (const Value& value : computeMeasures(first, contextUntil(1000), hands)) result[value.name] = value.value;
        return result;
    }
};

TEST(Measures, WhatTheOtherHandDoesIsMeasuredToo) {
    // Truth: closed form. Largest of any hand, sums over both; ticks 100 ... 349 are in contact; means over 100 contact
    // ticks of one hand and 200 of the other; leaves 20 mm at step ceil(0.02 · 2^13) = 164. The other is pulled back by
    // 3 N along 200 steps.
    const auto values = TwoHands().measured();
    EXPECT_DOUBLE_EQ(*values.at("peak_force_N"), 3.0);
    EXPECT_DOUBLE_EQ(*values.at("peak_torque_Nm"), 0.25);
    EXPECT_DOUBLE_EQ(*values.at("max_proxy_depth_m"), 0x1p-12);
    EXPECT_DOUBLE_EQ(*values.at("max_hand_depth_m"), 0x1p-10);
    EXPECT_DOUBLE_EQ(*values.at("min_proxy_gap_m"), 0x1p-18);
    EXPECT_DOUBLE_EQ(*values.at("mean_force_N"), (100.0 * 1.0 + 200.0 * 3.0) / 300.0);
    EXPECT_DOUBLE_EQ(*values.at("mean_proxy_depth_m"), 0x1p-12 * 200.0 / 300.0);
    EXPECT_NEAR(*values.at("path_length_m"), 1000.0 * kStep, kSettled);
    EXPECT_DOUBLE_EQ(*values.at("contact_time_s"), 0.25);
    EXPECT_DOUBLE_EQ(*values.at("contact_onsets"), 1.0);
    EXPECT_NEAR(*values.at("impulse_Ns"), 0.1 * 1.0 + 0.2 * 3.0, 1e-12);
    EXPECT_NEAR(*values.at("work_J"), 3.0 * 200.0 * kStep, 3.0 * kSettled);
    EXPECT_DOUBLE_EQ(*values.at("saturated_share"), 0.2);
    EXPECT_DOUBLE_EQ(*values.at("force_limited_ticks"), 200.0);
    EXPECT_DOUBLE_EQ(*values.at("completion_time_s"), 1.0 - 0.164);
    EXPECT_DOUBLE_EQ(*values.at("approach_time_s"), 0.1);
}

TEST(Measures, OfTwoHandsTheLargestOfEitherAndEveryTwentiethTickOfEitherIsJudged) {
    // Truth: closed form. Contact in ticks 100 ... 349, of the largest force and depth those of the other hand.
    const TwoHands two;
    const std::array<std::span<const TickRecord>, 2> hands{two.first, two.other};
    const auto judged = ticksToJudge(two.first, contextUntil(1000), hands);
    for (const TickOverlap& tick : judged) {
        EXPECT_EQ(tick.every_20th, tick.tick % 20 == 0) << tick.tick;
        EXPECT_EQ(tick.largest_force, tick.tick >= 150 && tick.tick < 170) << tick.tick;
        EXPECT_EQ(tick.largest_depth, tick.largest_force) << tick.tick;
    }
    EXPECT_EQ(judged.size(), 13u + 20u - 1u) << "160 is among both";
}

TEST(Measures, OneHandAmongTheHandsIsAsOneHandAlone) {
    // Truth: invariant, and the words of the formulas: those of one hand and their numbers stay.
    const auto records = insertion();
    TrialContext context = contextUntil(1200);
    std::map<std::string, std::optional<double>> alone = measure(records, context), among;
    const std::array<std::span<const TickRecord>, 1> hands{records};
    for (const Value& value : computeMeasures(records, context, hands)) among[value.name] = value.value;
    EXPECT_EQ(alone, among);
    for (const MeasureDefinition& definition : definitions()) {
        EXPECT_EQ(formulaOf(definition, 1), definition.formula);
        EXPECT_EQ(versionOf(definition, 1), definition.version);
        EXPECT_EQ(versionOf(definition, 2) > definition.version, formulaOf(definition, 2) != definition.formula);
    }
}

TEST(Measures, TrialThatNeverStartedHasNoMeasureButItsFailure) {
    // Truth: closed form (definition)
    TrialContext context = contextUntil(100, Outcome::Aborted);
    context.start_tick = 101;
    for (const Value& value : computeMeasures({}, context)) {
        if (value.name == "success")
            EXPECT_DOUBLE_EQ(value.value.value(), 0.0);
        else
            EXPECT_FALSE(value.value) << value.name;
    }
}

}  // namespace
}  // namespace passung::measures
