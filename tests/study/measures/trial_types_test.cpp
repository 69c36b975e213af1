#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "study/measures/contour_watch.h"
#include "study/measures/measures.h"
#include "study/measures/pair_watch.h"
#include "study/measures/passage_watch.h"
#include "study/protocol/trial_types.h"

namespace passung::measures {
namespace {

using Values = std::map<std::string, std::optional<double>>;

Values measure(const std::vector<TickRecord>& records, const TrialContext& context) {
    Values result;
    for (const Value& value : computeMeasures(records, context)) result[value.name] = value.value;
    return result;
}

TickRecord recordAt(std::int64_t tick, const Vec3& proxy, double force = 0.0) {
    TickRecord record;
    record.tick = tick;
    record.proxy_position_m = {static_cast<float>(proxy.x()), static_cast<float>(proxy.y()),
                               static_cast<float>(proxy.z())};
    record.hand_position_m = record.proxy_position_m;
    record.proxy_quaternion = record.hand_quaternion = {1, 0, 0, 0};
    record.force_N = {0, 0, static_cast<float>(force)};
    return record;
}

TrialContext contextOf(std::int64_t end_tick, Outcome outcome = Outcome::Success) {
    TrialContext context;
    context.end_tick = end_tick;
    context.outcome = outcome;
    return context;
}

TEST(TrialTypes, DeclareTheMeasuresThatOnlyTheirTrialsHave) {
    // Truth: invariant: every declared name is a measure, and no trial of another type has a value for it.
    std::vector<std::string> known;
    for (const MeasureDefinition& definition : definitions()) known.push_back(definition.name);
    const std::vector<TickRecord> records(100, recordAt(0, Vec3::Zero()));
    for (const protocol::TrialType& type : protocol::trialTypes()) {
        const std::array types{&type};
        const auto possible = protocol::measuresOf(types, known);
        for (const std::string_view name : type.measures)
            EXPECT_NE(std::find(possible.begin(), possible.end(), name), possible.end()) << name;
        TrialContext context = contextOf(50);
        if (type.name == "narrow_passage") context.form = PassageFacts{0.01, 0.01};
        if (type.name == "contour_following") context.form = ContourFacts{{Vec3::Zero(), Vec3::UnitX()}, 0.1, 1.0};
        if (type.name == "free_placement") context.form = PlacementFacts{};
        if (type.name == "discrimination_pair") context.form = PairFacts{1};
        if (type.name == "assembly") context.form = AssemblyFacts{{StepResult{}}};
        for (const auto& [name, value] : measure(records, context)) {
            const bool declared = std::find(possible.begin(), possible.end(), name) != possible.end();
            EXPECT_TRUE(declared || !value) << type.name << " has " << name;
        }
    }
}

// ---- discrimination pair ----------------------------------------------------------------------------------------

/// Engaged in ticks 0 … 99 and 150 … 249; the first button goes down at `press` and stays for 20 ticks.
std::vector<TickRecord> pairTicks(std::int64_t press, std::uint32_t button) {
    std::vector<TickRecord> records;
    for (std::int64_t tick = 0; tick < 400; ++tick) {
        TickRecord record = recordAt(tick, Vec3::Zero());
        if (tick < 100 || (tick >= 150 && tick < 250)) record.status |= kEngaged;
        if (tick >= press && tick < press + 20) record.input_flags |= button << 8;
        records.push_back(record);
    }
    return records;
}

TEST(DiscriminationPair, AnswerTimeAndCorrectnessFollowFromButtonsAndIntervals) {
    // Truth: closed form: the second interval ends at tick 250, the button goes down at 310: 60 ms.
    TrialContext context = contextOf(310);
    context.form = PairFacts{2};
    auto values = measure(pairTicks(310, 2), context);
    EXPECT_EQ(values["answer"], 2.0);
    EXPECT_EQ(values["correct"], 1.0);
    EXPECT_EQ(values["comparison_interval"], 2.0);
    EXPECT_DOUBLE_EQ(*values["response_time_s"], 0.060);
    values = measure(pairTicks(310, 1), context);
    EXPECT_EQ(values["answer"], 1.0);
    EXPECT_EQ(values["correct"], 0.0);
    EXPECT_FALSE(values["insertion_depth_m"]);
}

TEST(DiscriminationPair, CountsMissedCyclesIntoTheResponseTime) {
    // Truth: closed form: 60 ticks and 40 periods that were missed at one of them.
    auto records = pairTicks(310, 1);
    records[280].periods = 41;
    TrialContext context = contextOf(310);
    context.form = PairFacts{1};
    EXPECT_DOUBLE_EQ(*measure(records, context)["response_time_s"], 0.100);
}

TEST(DiscriminationPair, HasNoAnswerBeforeTheQuestionNorByTwoButtonsAtOnce) {
    // Truth: invariant: a button that is down when the question comes is not pressed then.
    for (const auto& [press, button] : {std::pair<std::int64_t, std::uint32_t>{200, 1}, {240, 2}, {300, 3}, {300, 4}}) {
        TrialContext context = contextOf(399, Outcome::Timeout);
        context.form = PairFacts{1};
        auto values = measure(pairTicks(press, button), context);
        EXPECT_FALSE(values["answer"]) << press;
        EXPECT_FALSE(values["correct"]);
        EXPECT_FALSE(values["response_time_s"]);
        EXPECT_EQ(values["comparison_interval"], 1.0);
    }
}

// ---- narrow passage ---------------------------------------------------------------------------------------------

constexpr double kStep = 0x1p-13;  // [m] a tick: exact in 32 bits

TEST(NarrowPassage, TimePathContactAndForceAreThoseSinceTheEntry) {
    // Truth: closed form. Down from 10 steps above by a step a tick: the mouth is crossed at tick 10; the passage is 20
    // steps long, so at tick 31 the origin is 21 steps below. Contact at ticks 15 … 19 with 3 N, once 5 N; more force
    // before the entry does not count.
    std::vector<TickRecord> records;
    for (std::int64_t tick = 0; tick <= 31; ++tick)
        records.push_back(recordAt(tick, Vec3(0, 0, static_cast<double>(10 - tick) * kStep),
                                   tick == 17                 ? 5.0
                                   : tick >= 15 && tick <= 19 ? 3.0
                                   : tick == 5                ? 9.0
                                                              : 0.0));
    TrialContext context = contextOf(31);
    context.form = PassageFacts{20 * kStep, 0.01};
    auto values = measure(records, context);
    EXPECT_DOUBLE_EQ(*values["passage_time_s"], 0.021);
    EXPECT_DOUBLE_EQ(*values["passage_path_m"], 21 * kStep);
    EXPECT_DOUBLE_EQ(*values["passage_contact_time_s"], 0.005);
    EXPECT_DOUBLE_EQ(*values["passage_peak_force_N"], 5.0);
    EXPECT_EQ(values["passage_entries"], 1.0);
}

TEST(NarrowPassage, WhoLeavesEntersAnewAndWhoGoesRoundHasNotComeThrough) {
    // Truth: closed form: in, out upwards, in again, through; and down beside the passage.
    const PassageFacts facts{0.010, 0.010};
    PassageWatch watch(facts, Pose{});
    std::int64_t tick = 0;
    const auto go = [&](double x, double z) { watch.follow(recordAt(tick++, Vec3(x, 0, z))); };
    for (const double z : {0.001, -0.001, 0.001, -0.001, -0.005}) go(0.0, z);
    EXPECT_EQ(watch.entries(), 2);
    EXPECT_TRUE(watch.inside());
    go(0.006, -0.006);  // beside: it has left
    EXPECT_FALSE(watch.inside());
    go(0.0, -0.006);
    go(0.0, -0.011);
    EXPECT_FALSE(watch.through());
    for (const double z : {0.001, -0.001, -0.009}) go(0.004, z);
    EXPECT_FALSE(watch.through());
    go(0.004, -0.0101);
    EXPECT_TRUE(watch.through());
    EXPECT_EQ(watch.entries(), 3);
}

TEST(NarrowPassage, WhoRestsOnTheRimBesideItAndSlidesInHasEntered) {
    // Truth: closed form: a tilted tip whose origin is 0.05 mm below the mouth 6 mm beside the axis; not from 0.3 mm.
    for (const double depth : {0.00005, 0.0003}) {
        PassageWatch watch(PassageFacts{0.010, 0.010}, Pose{});
        std::int64_t tick = 0;
        for (const auto& [x, z] : {std::pair{0.006, 0.001}, {0.006, -depth}, {0.004, -depth}, {0.0, -0.011}})
            watch.follow(recordAt(tick++, Vec3(x, 0, z)));
        EXPECT_EQ(watch.through(), depth < 0.0002) << depth;
        EXPECT_EQ(watch.entries(), depth < 0.0002 ? 1 : 0) << depth;
    }
}

// ---- contour following ------------------------------------------------------------------------------------------

TEST(ContourFollowing, DeviationAndForceAreThoseOfTheFollowedTicks) {
    // Truth: closed form. A line of 100 mm along x, 1 mm beside it all the way, a millimetre a tick; the force swings
    // between 1 and 3 N about the asked 2 N: mean 2, root mean square error 1.
    std::vector<TickRecord> records;
    for (std::int64_t tick = 0; tick <= 100; ++tick)
        records.push_back(recordAt(tick, Vec3(1e-3 * static_cast<double>(tick), 1e-3, 0), tick % 2 == 0 ? 1.0 : 3.0));
    TrialContext context = contextOf(100);
    context.form = ContourFacts{{Vec3::Zero(), Vec3(0.1, 0, 0)}, 0.005, 2.0};
    auto values = measure(records, context);
    EXPECT_NEAR(*values["contour_progress"], 1.0, 1e-6);
    EXPECT_NEAR(*values["contour_deviation_m"], 1e-3, 1e-9);
    EXPECT_NEAR(*values["contour_max_deviation_m"], 1e-3, 1e-9);
    EXPECT_DOUBLE_EQ(*values["contour_force_N"], 2.0);
    EXPECT_DOUBLE_EQ(*values["contour_force_error_N"], 1.0);
}

TEST(ContourFollowing, GoesRoundCornersNeverBackAndNotByAShortCut) {
    // Truth: closed form: an L of 2 × 40 mm; half of it at the corner; jumping to its end is not following it.
    const ContourFacts facts{{Vec3::Zero(), Vec3(0.04, 0, 0), Vec3(0.04, 0.04, 0)}, 0.005, 1.0};
    ContourWatch watch(facts, Pose{});
    std::int64_t tick = 0;
    const auto go = [&](double x, double y) { watch.follow(recordAt(tick++, Vec3(x, y, 0))); };
    for (int mm = 0; mm <= 40; ++mm) go(1e-3 * mm, 0);
    EXPECT_NEAR(watch.progress(), 0.5, 1e-6);
    go(0.02, 0);
    EXPECT_NEAR(watch.progress(), 0.5, 1e-6);
    EXPECT_FALSE(watch.following());
    go(0.04, 0.04);
    EXPECT_NEAR(watch.progress(), 0.5, 1e-6);
    for (int mm = 0; mm <= 40; ++mm) go(0.04, 1e-3 * mm);
    EXPECT_NEAR(watch.progress(), 1.0, 1e-6);
}

// ---- free placement ---------------------------------------------------------------------------------------------

TEST(FreePlacement, ErrorsAreThoseAtTheConfirmation) {
    // Truth: closed form: 3-4-5 mm beside the goal, turned by 0.2 rad about z, tilted by none.
    std::vector<TickRecord> records{recordAt(0, Vec3::Zero()), recordAt(1, Vec3(0.003, 0.004, 0))};
    records[1].proxy_quaternion = {static_cast<float>(std::cos(0.1)), 0, 0, static_cast<float>(std::sin(0.1))};
    TrialContext context = contextOf(1, Outcome::Failure);
    context.form = PlacementFacts{false};
    auto values = measure(records, context);
    EXPECT_NEAR(*values["position_error_m"], 0.005, 1e-9);
    EXPECT_NEAR(*values["angle_error_rad"], 0.2, 1e-6);
    context.form = PlacementFacts{true};
    EXPECT_NEAR(*measure(records, context)["angle_error_rad"], 0.0, 1e-6);
    context.outcome = Outcome::Timeout;
    EXPECT_FALSE(measure(records, context)["position_error_m"]) << "nothing was confirmed";
}

TEST(FreePlacement, TheAngleOfARoundPartIsItsTilt) {
    // Truth: closed form: 0.3 rad about x after half a turn about z.
    const Quat q =
        Quat(Eigen::AngleAxisd(0.3, Vec3::UnitX())) * Quat(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitZ()));
    std::vector<TickRecord> records(2, recordAt(0, Vec3::Zero()));
    records[1].tick = 1;
    records[1].proxy_quaternion = {static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()),
                                   static_cast<float>(q.z())};
    TrialContext context = contextOf(1);
    context.form = PlacementFacts{true};
    EXPECT_NEAR(*measure(records, context)["angle_error_rad"], 0.3, 1e-6);
    context.form = PlacementFacts{false};
    EXPECT_GT(*measure(records, context)["angle_error_rad"], 3.0);
}

}  // namespace
}  // namespace passung::measures
