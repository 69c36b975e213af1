#include "ui/presenter/part_poses.h"

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/shape/shape.h"
#include "ui/presenter/participant.h"
#include "ui/presenter/playback.h"
#include "ui/presenter/step_view.h"

// Where parts are drawn that hands pick up, beside a small world of the test's own: hands that go anywhere and take and
// leave parts at random.

namespace passung {
namespace {

using namespace presenter;

constexpr double kRounding = 1e-6;  // of single precision, of poses within a metre
constexpr std::size_t kParts = 5, kHands = 2;

Pose randomPose(Random& random) {
    const auto number = [&] { return random.uniform(-0.5, 0.5); };
    return {rotationFromVector({number(), number(), number()}), {number(), number(), number()}};
}

plan::Condition conditionOf(plan::ShownPose shown) {
    plan::Condition condition;
    condition.shown = shown;
    for (std::size_t i = 0; i < kParts; ++i) {
        scene::PartSpec part;
        part.name = "part " + std::to_string(i);
        part.geometry = shape::Shape(shape::Box{0.01, 0.01, 0.01});
        part.X_WP = {Quat::Identity(), {0.05 * static_cast<double>(i), 0, 0}};
        part.shown_offset = {0, 0, 0.001 * static_cast<double>(i)};
        part.pickable = i > 0;
        condition.scene.parts.push_back(std::move(part));
    }
    condition.scene.effects.pick = {.reach = 0.004, .button = 3};
    condition.scene.other_hands.resize(kHands - 1);
    condition.task.form = plan::AssemblyTask{};
    return condition;
}

std::shared_ptr<const DrawnScene> drawn(const plan::Condition& condition) {
    SceneArtist artist;
    auto scene = artist.draw(condition, {});
    EXPECT_TRUE(scene);
    return *scene;
}

void store(const Pose& X, std::array<float, 3>& p, std::array<float, 4>& q) {
    for (int i = 0; i < 3; ++i) p[static_cast<std::size_t>(i)] = static_cast<float>(X.p[i]);
    q = {static_cast<float>(X.q.w()), static_cast<float>(X.q.x()), static_cast<float>(X.q.y()),
         static_cast<float>(X.q.z())};
}

/// Hands and parts by the rules of core/tick/pick.h, as a person reads them.
struct World {
    explicit World(const plan::Condition& condition, std::uint64_t seed) : random(seed) {
        for (const scene::PartSpec& part : condition.scene.parts) rests.push_back(part.X_WP);
    }

    /// One tick; what a part's pose is afterwards that a picture shows.
    void step() {
        for (std::size_t hand = 0; hand < kHands; ++hand) {
            X_WH[hand] = randomPose(random);
            X_WG[hand] = randomPose(random);
        }
        if (held[0] >= 0 && held[0] == held[1]) X_WG[1] = X_WG[0];  // one part has one pose
        began = held;
        for (std::size_t hand = 0; hand < kHands; ++hand) {
            if (random.uniform(0, 1) > 0.1) continue;
            if (held[hand] < 0) {
                held[hand] = 1 + static_cast<std::int32_t>(random.below(kParts - 1));
                continue;
            }
            rests[static_cast<std::size_t>(held[hand])] = X_WG[hand];
            held[hand] = kNoPart;
        }
        turn = 1 + static_cast<std::int32_t>(static_cast<std::size_t>(tick) % (kParts - 1));
        resting = held[0] == turn || held[1] == turn ? kNoPart : turn;
        ++tick;
    }

    TickRecord record(std::size_t hand) const {
        TickRecord made;
        made.tick = tick - 1;
        made.held = began[hand];
        store(X_WH[hand], made.hand_position_m, made.hand_quaternion);
        store(X_WG[hand], made.proxy_position_m, made.proxy_quaternion);
        return made;
    }
    loop::ScreenTick screenTick() const {
        loop::ScreenTick made{.record = record(0)};
        made.others[0] = {X_WH[1], X_WG[1], began[1]};
        if (resting >= 0) made.at_rest = {resting, rests[static_cast<std::size_t>(resting)]};
        return made;
    }
    /// Where a picture of this tick shows a part, without its offset.
    Pose shown(std::size_t part, plan::ShownPose which, bool told_resting) const {
        if (told_resting && resting == static_cast<std::int32_t>(part)) return rests[part];
        for (std::size_t hand = 0; hand < kHands; ++hand)
            if (began[hand] == static_cast<std::int32_t>(part))
                return which == plan::ShownPose::Proxy ? X_WG[hand] : X_WH[hand];
        return rests[part];
    }

    Random random;
    std::vector<Pose> rests;
    std::array<Pose, kHands> X_WH, X_WG;
    std::array<std::int32_t, kHands> held{kNoPart, kNoPart}, began{kNoPart, kNoPart};
    std::int32_t turn = 1, resting = kNoPart;
    std::int64_t tick = 0;
};

double apart(const Pose& a, const Pose& b) { return (a.p - b.p).norm() + a.q.angularDistance(b.q); }

Pose moved(const Pose& X, const Vec3& offset) { return {X.q, X.p + offset}; }

TEST(PartPoses, EveryPartIsWhereItsHandShowsItOrWhereItWasLeft) {
    // Truth: the small world. Both hands carry, leave, share and take over parts, each drawn at an offset of its own.
    for (const auto shown : {plan::ShownPose::Proxy, plan::ShownPose::Device}) {
        const auto condition = conditionOf(shown);
        const auto scene = drawn(condition);
        World world(condition, 5);
        PartPoses poses(*scene);
        int shared = 0;
        for (int i = 0; i < 3000; ++i) {
            world.step();
            poses.follow(world.screenTick());
            if (world.began[0] >= 0 && world.began[0] == world.began[1]) ++shared;
            for (std::size_t part = 0; part < kParts; ++part) {
                const Vec3 offset = condition.scene.parts[part].shown_offset;
                const Pose truth = moved(world.shown(part, shown, true), offset);
                ASSERT_LT(apart(poses.drawn()[part], truth), kRounding) << "tick " << i << ", part " << part;
            }
            for (std::size_t hand = 0; hand < kHands; ++hand) ASSERT_EQ(poses.hands()[hand].part, world.began[hand]);
        }
        EXPECT_GT(shared, 20);
    }
}

TEST(PartPoses, AScreenThatMissesTicksFindsAllPartsInTheirTurn) {
    // Truth: the small world. Nine of ten ticks are missed, then nothing is handled while every part has its turn.
    const auto condition = conditionOf(plan::ShownPose::Proxy);
    const auto scene = drawn(condition);
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        World world(condition, seed);
        PartPoses poses(*scene);
        for (int i = 0; i < 400; ++i) {
            world.step();
            if (world.random.below(10) == 0) poses.follow(world.screenTick());
        }
        world.held = {kNoPart, kNoPart};
        for (std::size_t i = 1; i < kParts; ++i) {
            ++world.tick;
            world.began = {kNoPart, kNoPart};
            world.resting = static_cast<std::int32_t>(i);
            poses.follow(world.screenTick());
        }
        for (std::size_t part = 0; part < kParts; ++part)
            EXPECT_LT(apart(poses.poses()[part], world.rests[part]), kRounding) << seed << ", part " << part;
    }
}

TEST(PartPoses, AnotherAttemptBeginsWithAllPartsAtTheirStart) {
    // Truth: invariant.
    const auto condition = conditionOf(plan::ShownPose::Proxy);
    PartPoses poses(*drawn(condition));
    World world(condition, 3);
    for (int i = 0; i < 500; ++i) {
        world.step();
        poses.follow(world.screenTick());
    }
    EXPECT_GT(apart(poses.poses()[1], condition.scene.parts[1].X_WP), 0.01);
    loop::ScreenTick first;
    first.record.held = kNoPart;
    first.record.input_flags = 1u << 10;  // the third button
    poses.follow(first);
    for (std::size_t part = 0; part < kParts; ++part)
        EXPECT_LT(apart(poses.poses()[part], condition.scene.parts[part].X_WP), 1e-12);
    EXPECT_TRUE(poses.hands()[0].closed) << "it is drawn closed though it found nothing";
    first.record.tick = 1;
    first.record.input_flags = 1u << 8;
    poses.follow(first);
    EXPECT_FALSE(poses.hands()[0].closed) << "by another button";
}

TEST(Playback, MovesAllPartsWhereverItIsSought) {
    // Truth: the small world, at times in any order.
    for (const auto shown : {plan::ShownPose::Proxy, plan::ShownPose::Device}) {
        const auto condition = conditionOf(shown);
        World world(condition, 9);
        std::vector<TickRecord> first;
        std::vector<std::vector<TickRecord>> others(1);
        std::vector<std::vector<Pose>> truth;
        for (int i = 0; i < 3000; ++i) {
            world.step();
            first.push_back(world.record(0));
            others[0].push_back(world.record(1));
            truth.emplace_back();
            for (std::size_t part = 0; part < kParts; ++part)
                truth.back().push_back(
                    moved(world.shown(part, shown, false), condition.scene.parts[part].shown_offset));
        }
        Playback playback(first, drawn(condition), others);
        for (const int at : {0, 2999, 1, 1023, 1024, 1025, 2048, 700, 2500, 2499}) {
            playback.seek((at + 1.5 - 1.0) * kTickSeconds);
            const auto now = static_cast<std::size_t>(playback.record().tick);
            const auto view = playbackView(*playback.scene(), playback.record(), {}, &playback.poses());
            ASSERT_EQ(view.X_WParts.size(), kParts);
            for (std::size_t part = 0; part < kParts; ++part)
                EXPECT_LT(apart(view.X_WParts[part], truth[now][part]), kRounding) << now << ", part " << part;
        }
    }
}

/// The second is put into the first, which is put on the table; the third comes after both.
plan::Condition threeSteps() {
    auto condition = conditionOf(plan::ShownPose::Proxy);
    auto& steps = condition.scene.effects.pick.steps;
    steps.resize(3);
    steps[0] = {.part = 1, .X_IGoal = {Quat::Identity(), {0, 0.2, 0}}};
    steps[1] = {.part = 2, .into = 1, .X_IGoal = {Quat::Identity(), {0, 0, 0.03}}, .after = scene::stepBit(0)};
    steps[2] = {.part = 3, .X_IGoal = {Quat::Identity(), {0, 0.3, 0}}, .after = 3};
    condition.task.form = plan::AssemblyTask{.steps = {{.name = "base"}, {.name = "pin"}, {}}};
    return condition;
}

TEST(StepView, ShowsWhereWhatMayBeNextBelongs) {
    // Truth: by hand. A goal goes with the part that it is in, and is drawn at the offset of the part that goes there.
    const auto condition = threeSteps();
    const auto scene = drawn(condition);
    std::vector<Pose> X_WP;
    for (const scene::PartSpec& part : condition.scene.parts) X_WP.push_back(part.X_WP);
    const auto images = [&](scene::StepSet done) { return stepImages(*scene, X_WP, done); };
    ASSERT_EQ(images(0).size(), 1u);
    EXPECT_EQ(images(0)[0].part, 1u);
    EXPECT_NEAR((images(0)[0].X_W.p - Vec3(0, 0.2, 0.001)).norm(), 0.0, 1e-12);
    X_WP[1].p = Vec3(0.01, 0.2, 0.0);
    ASSERT_EQ(images(1).size(), 1u);
    EXPECT_NEAR((images(1)[0].X_W.p - Vec3(0.01, 0.2, 0.032)).norm(), 0.0, 1e-12);
    EXPECT_TRUE(images(7).empty());
    EXPECT_EQ(partsDone(*scene, 1), (std::vector{false, true, false, false, false}));
    const auto lines = stepLines(*scene->picking, 1);
    using State = StepLine::State;
    EXPECT_EQ(lines, (std::vector<StepLine>{{"base", State::Done}, {"pin", State::Next}, {"3", State::Later}}));
    auto silent = condition;
    std::get<plan::AssemblyTask>(silent.task.form).hints = false;
    EXPECT_TRUE(stepImages(*drawn(silent), X_WP, 0).empty());
}

TEST(StepView, AHintMarksThePartItsLineAndItsGoal) {
    // Truth: by hand: a trial runs from its first engaged tick, 20 ms in; the hint is due 50 ms later, and 50 ms after
    // the first step is done.
    auto condition = threeSteps();
    auto& assembly = std::get<plan::AssemblyTask>(condition.task.form);
    assembly.hints = false;
    assembly.hint_after = 0.050;
    const auto scene = drawn(condition);
    PartPoses poses(*scene);
    TickRecord record;
    const auto at = [&](std::int64_t tick, scene::StepSet done) {
        loop::ScreenTick one;
        one.record.tick = tick;
        one.record.held = kNoPart;
        one.record.steps_done = done;
        one.record.hand_quaternion = one.record.proxy_quaternion = {1, 0, 0, 0};
        one.engaged = tick >= 20;
        poses.follow(one);
        record = one.record;
        return playbackView(*scene, record, {}, &poses);
    };
    for (const std::int64_t tick : {0, 20, 69}) {
        const ParticipantView view = at(tick, 0);
        EXPECT_FALSE(view.hinted) << tick;
        EXPECT_TRUE(view.images.empty());
        EXPECT_FALSE(view.steps[0].hinted);
    }
    const ParticipantView hinted = at(70, 0);
    EXPECT_EQ(hinted.hinted, 1u);
    ASSERT_EQ(hinted.images.size(), 1u);
    EXPECT_EQ(hinted.images[0].part, 1u);
    EXPECT_TRUE(hinted.steps[0].hinted);
    EXPECT_FALSE(hinted.steps[1].hinted);
    EXPECT_FALSE(at(80, 1).hinted);
    EXPECT_FALSE(at(129, 1).hinted);
    EXPECT_EQ(at(130, 1).hinted, 2u);
    EXPECT_FALSE(at(0, 0).hinted) << "the next trial begins";
    EXPECT_FALSE(at(19, 0).hinted);
    EXPECT_FALSE(at(75, 0).hinted) << "its first engaged tick that is known";
}

TEST(StepView, TellsHowFarEachStepIs) {
    // Truth: by hand, from what the states are said to be. Goal 0.2 m along y, within 1 mm; taken 50 mm along x.
    auto condition = threeSteps();
    condition.scene.effects.pick.steps[0].position_tolerance = 0.001;
    const auto scene = drawn(condition);
    PartPoses poses(*scene);
    using measures::StepState;
    std::int64_t tick = 0;
    const auto after = [&](const Vec3& p, std::int32_t held, scene::StepSet done) {
        loop::ScreenTick one;
        one.record.tick = tick++;
        one.record.held = held;
        one.record.steps_done = done;
        store({Quat::Identity(), p}, one.record.hand_position_m, one.record.hand_quaternion);
        store({Quat::Identity(), p}, one.record.proxy_position_m, one.record.proxy_quaternion);
        poses.follow(one);
        return stepStates(*scene->picking, poses);
    };
    const std::vector<StepState> none(3, StepState::Idle);
    const auto first = [&](StepState state) { return std::vector{state, StepState::Idle, StepState::Idle}; };
    EXPECT_EQ(after({0.05, 0, 0}, kNoPart, 0), none);
    EXPECT_EQ(after({0.05, 0.001, 0}, 1, 0), first(StepState::Picked));
    EXPECT_EQ(after({0.05, 0.1, 0}, 1, 0), first(StepState::Carried));
    EXPECT_EQ(after({0.009, 0.2, 0}, 1, 0), first(StepState::Near));
    EXPECT_EQ(after({0.0009, 0.2, 0}, 1, 0), first(StepState::Inserted));
    EXPECT_EQ(after({0.05, 0.1, 0}, 1, 0), first(StepState::Carried)) << "and is drawn out again";
    EXPECT_EQ(after({0.05, 0.1, 0}, kNoPart, 0), none) << "it lies where it does not belong";
    EXPECT_EQ(after({0.051, 0.1, 0}, 1, 0), first(StepState::Picked)) << "from where it lay";
    EXPECT_EQ(after({0, 0.2, 0}, kNoPart, 1), first(StepState::Locked));
}

TEST(SceneArtist, APictureHasRoomForEveryGoal) {
    // Truth: closed form: the angle from the camera's axis to the part at its goal is less than half the opening.
    const auto scene = drawn(threeSteps());
    for (const Vec3& p : {Vec3(0, 0.2, 0), Vec3(0, 0.2, 0.03), Vec3(0, 0.3, 0)}) {
        const Vec3 seen = scene->camera.X_WC.inverse() * p;
        EXPECT_LT(std::atan2(seen.head<2>().norm(), -seen.z()), 0.5 * scene->camera.opening);
    }
    EXPECT_EQ(scene->held, DrawnScene::kNothing);
}

TEST(PointerPose, StaysWithTheHandWhicheverPartItHolds) {
    // Truth: closed form, the registration. A hand that keeps its part: where that is asked to be.
    auto condition = conditionOf(plan::ShownPose::Proxy);
    condition.scene.registration = {
        .X_WB = {Quat::Identity(), {0, 0, 0.1}}, .scale = 2.0, .X_DH = {Quat::Identity(), {0, 0.01, 0}}};
    TickRecord record;
    record.device_position_m = {0.02, 0.03, 0.04};
    record.device_quaternion = {1, 0, 0, 0};
    record.hand_position_m = {9, 9, 9};
    record.hand_quaternion = {1, 0, 0, 0};
    EXPECT_NEAR((pointerPose(*drawn(condition), record).p - Vec3(0.04, 0.07, 0.18)).norm(), 0.0, 1e-12);
    condition.scene.effects.pick = {};
    EXPECT_NEAR(pointerPose(*drawn(condition), record).p.x(), 9.0, 1e-6);
}

}  // namespace
}  // namespace passung
