#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/random.h"
#include "core/tick/output_stage.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

Pose at(double z) { return {Quat::Identity(), Vec3(0, 0, z)}; }

/// A ball over a table; the ball touches at z = 0.01.
scene::SceneSpec pressing() {
    auto spec = test::scene(shape::Sphere{0.02}, at(0.02), shape::Box{0.08, 0.08, 0.04}, at(-0.02),
                            scene::ContactMethod::GodObjectHeuristic);
    spec.contact.stiffness = 1000;
    return spec;
}

tick::TickOutput pressed(test::Bench& bench, double depth) {
    tick::TickOutput out;
    for (int i = 0; i < 1000; ++i) out = bench.step(at(0.01 - std::min(depth, 2e-5 * i)));
    return out;
}

/// The last stage alone, behind a handle 50 mm beside the held part and turned, on a base that is turned in the world.
/// 12 N, 0.2 N·m, 0.97 N a tick and so 0.97/60 N·m a tick: no whole number of rises makes a limit or a wrench asked for
/// below, so that rounding decides nothing.
class LastStage {
public:
    static constexpr double kMaxForce = 12, kMaxTorque = 0.2, kForceRise = 0.97, kTorqueRise = kForceRise / 60;

    LastStage() {
        model.limits.max_force = kMaxForce;
        model.limits.max_torque = kMaxTorque;
        model.limits.max_force_rate = kForceRise / kTickSeconds;
        model.registration.X_WB = {rotationFromVector(Vec3(0.3, -0.8, 0.5)), Vec3(1, 2, 3)};
        model.registration.X_DH = {rotationFromVector(Vec3(-0.4, 0.2, 0.9)), Vec3(0.05, -0.02, 0.03)};
    }
    /// From the handle's origin to the held part's, world axes, by way of the handle's pose.
    Vec3 lever(const Pose& X_WH) const { return X_WH.p - (X_WH * model.registration.X_DH.inverse()).p; }
    /// A wrench at the handle in base axes, as the held part asks for it.
    Wrench atHeldPart(const Wrench& F_D_B, const Pose& X_WH) const {
        const Vec3 force = model.registration.X_WB.q * F_D_B.force;
        return {force, model.registration.X_WB.q * F_D_B.torque - lever(X_WH).cross(force)};
    }
    Wrench atHandle(const Wrench& F_H_W, const Pose& X_WH) const {
        const Quat R_BW = model.registration.X_WB.q.conjugate();
        return {R_BW * F_H_W.force, R_BW * (F_H_W.torque + lever(X_WH).cross(F_H_W.force))};
    }
    tick::TickFrame limit(const Wrench& F_H_W, const Pose& X_WH, int sample_periods = 1, bool usable = true) {
        tick::TickFrame frame;
        frame.X_WH = X_WH;
        frame.F_H_W = F_H_W;
        frame.sample_periods = sample_periods;
        frame.input_usable = usable;
        state.X_DG = model.registration.X_DH;
        tick::runStage<tick::kOutputLimits>(model, state, frame);
        return frame;
    }
    /// Asks for a wrench at the handle.
    tick::TickFrame limitAtHandle(const Wrench& F_D_B, int sample_periods = 1, bool usable = true) {
        return limit(atHeldPart(F_D_B, Pose{}), Pose{}, sample_periods, usable);
    }

    tick::HandModel model;
    tick::HandState state;
};

TEST(OutputStage, KeepsDirectionAndScalesForceAndTorqueTogether) {
    // Truth: closed form. One factor for both.
    auto spec = pressing();
    spec.registration.X_DH = {Quat::Identity(), Vec3(0.05, 0, 0)};  // a lever: the force makes a torque at the handle
    test::Bench free_bench(spec);
    spec.limits.max_force = 1.5;
    spec.limits.max_torque = 1.0;
    test::Bench limited_bench(spec);
    const auto hand = [](double z) { return Pose{Quat::Identity(), Vec3(-0.05, 0, z)}; };
    tick::TickOutput free_out, limited_out;
    for (int i = 0; i < 1000; ++i) {
        const double z = 0.01 - std::min(0.004, 2e-5 * i);
        free_out = free_bench.step(hand(z));
        limited_out = limited_bench.step(hand(z));
    }
    EXPECT_NEAR(limited_out.F_D_B.force.norm(), 1.5, 1e-12);
    EXPECT_LE(limited_out.F_D_B.force.norm(), 1.5);
    const double factor = limited_out.F_D_B.force.z() / free_out.F_D_B.force.z();
    EXPECT_NEAR(limited_out.F_D_B.torque.y(), factor * free_out.F_D_B.torque.y(), 1e-12);
    // About the handle, the force at the held part's origin adds its lever.
    EXPECT_NEAR(free_out.F_D_B.torque.y(), free_out.frame.F_H_W.torque.y() - 0.05 * free_out.frame.F_H_W.force.z(),
                1e-9);
    EXPECT_TRUE(limited_out.frame.status & kForceLimited);
    EXPECT_FALSE(free_out.frame.status & kForceLimited);
}

TEST(OutputStage, LimitsTheRiseOfForceButNotItsFall) {
    // Truth: closed form. Rising by at most rate · T a tick; zero at once when the hand leaves.
    auto spec = pressing();
    spec.contact.damping = 0;
    spec.limits.max_force_rate = 500;  // 0.5 N a tick
    test::Bench bench(spec);
    bench.step(at(0.0105));
    double last = 0;
    for (int i = 0; i < 5; ++i) {
        const auto out = bench.step(at(0.006));  // 4 N asked for
        EXPECT_NEAR(out.F_D_B.force.norm(), last + 0.5, 1e-9);
        EXPECT_TRUE(out.frame.status & kRateLimited);
        last = out.F_D_B.force.norm();
    }
    for (int i = 0; i < 20; ++i) bench.step(at(0.006));
    const auto out = bench.step(at(0.0105));
    EXPECT_EQ(out.F_D_B.force.norm(), 0.0);
    EXPECT_FALSE(out.frame.status & kRateLimited);
}

TEST(OutputStage, RampsInFromZeroWhereContactIsThereAtTheStart) {
    // Truth: closed form. 4.25 N asked for from the first tick with contact on, at 0.5 N a tick: eight ticks rise and
    // say so, all later ones give it. So at the first tick of all, when the start gate opens, after lost samples, and
    // when the state is made anew.
    auto spec = pressing();
    spec.parts[0].X_WP = at(0.00575);
    spec.contact.damping = 0;
    spec.limits.max_force_rate = 500;
    spec.contact.method = scene::ContactMethod::Penalty;
    auto unlimited = spec;
    unlimited.limits.max_force_rate = 1e12;
    const double asked = test::Bench(unlimited).step(at(0.00575)).F_D_B.force.norm();
    ASSERT_NEAR(asked, 4.25, 0.05);  // the lowest of the ball's sample points is a little higher than the ball
    const auto ramp = [&](test::Bench& bench) {
        for (int i = 1; i <= 12; ++i) {
            const auto out = bench.step(at(0.00575));
            EXPECT_NEAR(out.F_D_B.force.norm(), std::min(0.5 * i, asked), 1e-9) << i;
            EXPECT_EQ(out.frame.status, kEngaged | (i <= 8 ? kRateLimited : kStatusOk)) << i;
        }
    };
    test::Bench bench(spec);
    ramp(bench);
    bench.state() = tick::makeHandState(bench.model());
    ramp(bench);
    DeviceReading lost{at(0.00575)};
    lost.fresh = false;
    for (int i = 0; i < 3; ++i) bench.step(lost);
    ramp(bench);

    spec.start_gate = {0.001, 0.1, 20};
    test::Bench gated(spec);
    for (int i = 0; i < 20; ++i) EXPECT_EQ(gated.step(at(0.00575)).F_D_B.force.norm(), 0.0) << i;
    ramp(gated);
}

TEST(OutputStage, SaysExactlyWhichGuardActed) {
    // Truth: closed form, the whole status of every tick: what acted and nothing else.
    const double nan = std::numeric_limits<double>::quiet_NaN();
    struct Case {
        const char* name;
        DeviceReading reading;
        std::uint32_t first, second;  // of two such samples in a row, after good ones
    };
    DeviceReading stale{at(0.006)}, broken{at(nan)}, far{at(0.5)};
    stale.fresh = false;
    for (const Case& c : {Case{"stale", stale, kDeviceStale | kInputHeld, kDeviceStale | kInputRejected},
                          Case{"no pose", broken, kInputNotAPose | kInputHeld, kInputNotAPose | kInputRejected},
                          Case{"jump", far, kInputJump | kInputHeld, kInputJump | kInputRejected}}) {
        test::Bench bench(pressing());
        EXPECT_EQ(pressed(bench, 0.004).frame.status, kEngaged) << c.name;
        EXPECT_EQ(bench.step(c.reading).frame.status, kEngaged | c.first) << c.name;
        DeviceReading again = c.reading;
        again.X_BD.p.z() *= -1.0;
        const auto out = bench.step(again);
        EXPECT_EQ(out.frame.status, kEngaged | c.second) << c.name;
        EXPECT_EQ(out.F_D_B.force.norm(), 0.0) << c.name;
        EXPECT_EQ(tick::makeRecord(7, again, out).status, out.frame.status) << c.name;
    }
    LastStage last;
    EXPECT_EQ(last.limitAtHandle({Vec3(0, 0, 0.9), Vec3::Zero()}).status, kStatusOk);
    EXPECT_EQ(last.limitAtHandle({Vec3(0, 0, 5), Vec3::Zero()}).status, kRateLimited);
    EXPECT_EQ(last.limitAtHandle({Vec3(0, 0, 20), Vec3::Zero()}).status, kForceLimited | kRateLimited);
    for (int i = 0; i < 20; ++i) last.limitAtHandle({Vec3(0, 0, 12), Vec3::Zero()});
    EXPECT_EQ(last.limitAtHandle({Vec3(0, 0, 20), Vec3::Zero()}).status, kForceLimited);
    EXPECT_EQ(last.limitAtHandle({Vec3(0, 0, 0.1), Vec3::Zero()}).status, kStatusOk);
    EXPECT_EQ(last.limitAtHandle({Vec3::Zero(), Vec3(0, 0.3, 0)}).status, kForceLimited | kRateLimited);
}

TEST(OutputStage, LatchesWhateverPartOfTheWrenchIsNotFinite) {
    // Truth: invariant, of each of the six numbers, NaN and infinite, also in a tick whose input is not usable: zero
    // from then on, said in every tick, and the other guards have nothing to say; a new state is armed again.
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        for (int axis = 0; axis < 6; ++axis) {
            for (const bool usable : {true, false}) {
                LastStage last;
                for (int i = 0; i < 30; ++i) last.limitAtHandle({Vec3(0, 0, 10), Vec3(0.1, 0, 0)});
                Wrench wrench{Vec3(0, 0, 10), Vec3(0.1, 0, 0)};
                (axis < 3 ? wrench.force : wrench.torque)[axis % 3] = bad;
                for (int i = 0; i < 5; ++i) {
                    const auto frame = i == 0 ? last.limit(wrench, Pose{}, usable ? 1 : 0, usable)
                                              : last.limitAtHandle({Vec3(0, 0, 50), Vec3(0.1, 0, 0)});
                    EXPECT_EQ(frame.status, static_cast<std::uint32_t>(kNonFiniteLatched));
                    EXPECT_EQ(frame.F_D_B.force.norm() + frame.F_D_B.torque.norm(), 0.0);
                    EXPECT_EQ(frame.F_H_W.force.norm() + frame.F_H_W.torque.norm(), 0.0);
                }
                last.state = tick::HandState();
                EXPECT_NEAR(last.limitAtHandle({Vec3(0, 0, 10), Vec3::Zero()}).F_D_B.force.z(), LastStage::kForceRise,
                            1e-12);
            }
        }
    }
}

TEST(OutputStage, HoldsThePoseForOneBadSampleThenGivesZero) {
    // Truth: invariant (the output stage's contract), for each kind of bad sample.
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    DeviceReading stale{at(0.006)};
    stale.fresh = false;
    for (DeviceReading bad : {DeviceReading{at(nan)}, DeviceReading{at(inf)}, DeviceReading{at(1.0)}, stale,
                              DeviceReading{Pose{Quat(0, 0, 0, 0), Vec3(0, 0, 0.006)}}}) {
        test::Bench bench(pressing());
        const auto before = pressed(bench, 0.004);
        const auto held = bench.step(bad);
        EXPECT_NEAR(held.F_D_B.force.z(), before.F_D_B.force.z(), 1e-6);
        EXPECT_TRUE(held.frame.status & kInputHeld);
        const auto after = bench.step(at(0.006));
        EXPECT_NEAR(after.F_D_B.force.z(), before.F_D_B.force.z(), 0.05 * before.F_D_B.force.z());
        EXPECT_FALSE(after.frame.status & (kInputHeld | kRateLimited));
        bench.step(bad);
        for (int i = 0; i < 3; ++i) {
            bad.X_BD.p.z() *= -1.0;  // jumps that do not agree: input_guard_test has those that do
            const auto zero = bench.step(bad);
            EXPECT_EQ(zero.F_D_B.force.norm(), 0.0);
            EXPECT_TRUE(zero.frame.status & kInputRejected);
        }
    }
}

TEST(OutputStage, KeepsASteadyForceWhileTheTorqueTurnsRound) {
    // Truth: closed form. The torque may rise by 0.97/60 N·m a tick; the force is asked for and given, 10 N.
    LastStage last;
    const Vec3 force(6, 0, 8), torque(0, 0.15, 0);
    for (int i = 0; i < 50; ++i) last.limitAtHandle({force, torque});
    for (int i = 0; i < 50; ++i) {
        const auto frame = last.limitAtHandle({force, -torque});
        EXPECT_NEAR((frame.F_D_B.force - force).norm(), 0.0, 1e-12) << i;
        const double risen = std::min(0.15, LastStage::kTorqueRise * (i + 1));
        EXPECT_NEAR(frame.F_D_B.torque.y(), -risen, 1e-12) << i;
        EXPECT_EQ((frame.status & kRateLimited) != 0, risen < 0.15) << i;
    }
    for (int i = 0; i < 20; ++i) {  // and the other way round
        const auto frame = last.limitAtHandle({-force, -torque});
        EXPECT_NEAR(frame.F_D_B.torque.y(), -0.15, 1e-12) << i;
        EXPECT_NEAR((frame.F_D_B.force + std::min(0.1 * LastStage::kForceRise * (i + 1), 1.0) * force).norm(), 0.0,
                    1e-12)
            << i;
    }
}

TEST(OutputStage, GivesTheForceBackAtOnceAfterOneBadSampleOnly) {
    // Truth: closed form. 10 N, then 4 N while the pose is held; after that 10 N at once and not more than a rise
    // above. After rejected ticks, or where it fell with a good sample, it rises from where it is.
    const auto full = [] {
        LastStage last;
        for (int i = 0; i < 30; ++i) last.limitAtHandle({Vec3(0, 0, 10), Vec3(0.1, 0, 0)});
        return last;
    };
    const Wrench less{Vec3(0, 0, 4), Vec3(0.02, 0, 0)}, more{Vec3(0, 0, 12), Vec3(0.19, 0, 0)};

    LastStage last = full();
    EXPECT_EQ(last.limitAtHandle(less, 0).status, 0u);
    auto frame = last.limitAtHandle({Vec3(0, 0, 10), Vec3(0.1, 0, 0)}, 2);
    EXPECT_NEAR(frame.F_D_B.force.z(), 10, 1e-12);
    EXPECT_NEAR(frame.F_D_B.torque.x(), 0.1, 1e-12);

    last = full();
    last.limitAtHandle(less, 0);
    frame = last.limitAtHandle(more, 2);
    EXPECT_NEAR(frame.F_D_B.force.z(), 10 + LastStage::kForceRise, 1e-12);
    EXPECT_NEAR(frame.F_D_B.torque.x(), 0.1 + LastStage::kTorqueRise, 1e-12);
    EXPECT_TRUE(frame.status & kRateLimited);

    last = full();
    last.limitAtHandle(less);
    EXPECT_NEAR(last.limitAtHandle(more).F_D_B.force.z(), 4 + LastStage::kForceRise, 1e-12);

    last = full();
    last.limitAtHandle(less, 0);
    EXPECT_EQ(last.limitAtHandle(less, 0, false).F_D_B.force.norm(), 0.0);
    EXPECT_NEAR(last.limitAtHandle(more, 3).F_D_B.force.z(), LastStage::kForceRise, 1e-12);
}

TEST(OutputStage, DoesTheSameWorkAtTheHandleAsAtTheHeldPart) {
    // Truth: closed form (virtual work). Moving and turning hand, torque, lever arm, limits acting or not: what is sent
    // at the handle and what the record says of the held part do the same work in any motion.
    LastStage last;
    Random random(5);
    for (int i = 0; i < 2000; ++i) {
        const auto any = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
        const Pose X_WH{rotationFromVector(any()), any()};
        const auto frame = last.limit({5.0 * any(), 0.1 * any()}, X_WH);
        const Vec3 v = any(), w = any();  // of the handle, world axes
        const Vec3 v_H = v + w.cross(last.lever(X_WH));
        const Quat& R_WB = last.model.registration.X_WB.q;
        const double at_handle = (R_WB * frame.F_D_B.force).dot(v) + (R_WB * frame.F_D_B.torque).dot(w);
        const double at_part = frame.F_H_W.force.dot(v_H) + frame.F_H_W.torque.dot(w);
        ASSERT_NEAR(at_handle, at_part, 1e-12);
    }
}

/// Follows tick by tick what was asked and what was sent, with the contract's own words.
class Watch {
public:
    explicit Watch(const scene::OutputLimits& limits) : limits_(limits) {}

    /// `asked` at the handle, base axes, of the tick's frame.
    void see(const Wrench& asked, const tick::TickFrame& frame) {
        const Wrench& sent = frame.F_D_B;
        const double rise = limits_.max_force_rate * kTickSeconds;
        const double torque_rise = rise * limits_.max_torque / limits_.max_force;
        ASSERT_TRUE(isFinite(sent) && isFinite(frame.F_H_W));
        ASSERT_LE(sent.force.norm(), limits_.max_force);
        ASSERT_LE(sent.torque.norm(), limits_.max_torque);
        // Rising: above the last tick, or, after exactly one held tick, above the one before it.
        const bool exempt = held_last_ && frame.sample_periods == 2;
        ASSERT_LE(sent.force.norm(), share(&Wrench::force, sent.force, exempt) + rise + 1e-12);
        ASSERT_LE(sent.torque.norm(), share(&Wrench::torque, sent.torque, exempt) + torque_rise + 1e-12);
        // A bit is set if and only if something was changed. The scale is the limit's, not that of 1e200 N.
        const bool zeroed = !frame.input_usable || (frame.status & kNonFiniteLatched);
        if (zeroed) {
            ASSERT_EQ(sent.force.norm() + sent.torque.norm(), 0.0);
            ASSERT_FALSE(frame.status & (kForceLimited | kRateLimited));
            ++zeros;
        } else {
            const double over =
                std::max(asked.force.stableNorm() / limits_.max_force, asked.torque.stableNorm() / limits_.max_torque);
            if (std::abs(over - 1.0) > 1e-12) {
                ASSERT_EQ((frame.status & kForceLimited) != 0, over > 1.0);
            }
            const double factor = std::min(1.0, 1.0 / over);
            const double gap = (factor * asked.force - sent.force).norm() / limits_.max_force +
                               (factor * asked.torque - sent.torque).norm() / limits_.max_torque;
            ASSERT_EQ((frame.status & kRateLimited) != 0, gap > 1e-11) << gap;
            limited += over > 1.0 ? 1 : 0;
            rated += gap > 1e-11 ? 1 : 0;
            untouched += over <= 1.0 && gap <= 1e-11 && asked.force.norm() > 0.0 ? 1 : 0;
        }
        before_last_ = last_;
        last_ = sent;
        held_last_ = frame.input_usable && frame.sample_periods == 0;
    }

    int limited = 0, rated = 0, zeros = 0, untouched = 0;

private:
    double share(Vec3 Wrench::*of, const Vec3& v, bool exempt) const {
        if (!(v.norm() > 0.0)) return 0.0;
        const Vec3 direction = v.normalized();
        return std::max({0.0, (last_.*of).dot(direction), exempt ? (before_last_.*of).dot(direction) : 0.0});
    }
    scene::OutputLimits limits_;
    Wrench last_, before_last_;
    bool held_last_ = false;
};

TEST(OutputStage, KeepsItsContractForAnyWrench) {
    // Truth: invariant. 20 000 ticks of steady, falling, reversed, jumping and huge wrenches, of held and rejected
    // ticks, and of wrenches that are not finite (the state is then made anew, as for a new trial).
    LastStage last;
    Watch watch(last.model.limits);
    Random random(21);
    Wrench asked;
    bool held_before = true;  // nothing to hold at first
    for (int i = 0; i < 20000; ++i) {
        const auto any = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
        const Pose X_WH{rotationFromVector(any()), any()};
        switch (random.below(150)) {
            case 0:
                asked = {5.0 * any(), 0.08 * any()};
                break;
            case 1:
                asked.torque *= -1.0;
                break;
            case 2:
                asked.force *= -1.0;
                break;
            case 3:
                asked = {40.0 * any(), 0.08 * any()};
                break;
            case 4:
                asked = {5.0 * any(), 3.0 * any()};
                break;
            case 5:
                asked = random.below(10) == 0 ? Wrench{1e200 * any(), 1e150 * any()} : Wrench{};
                break;
            case 6:
                asked = {0.7 * asked.force, 1.2 * asked.torque};
                break;
            default:
                break;  // as before
        }
        const auto kind = random.below(20);
        const bool usable = kind != 0, held = kind < 3 && usable && !held_before;
        const bool broken = random.below(500) == 0;
        Wrench F_H_W = last.atHeldPart(asked, X_WH);
        if (broken) F_H_W.torque.y() = std::numeric_limits<double>::infinity();
        const auto frame = last.limit(F_H_W, X_WH, !usable || held ? 0 : held_before ? 2 : 1, usable);
        ASSERT_EQ((frame.status & kNonFiniteLatched) != 0, broken) << i;
        ASSERT_NO_FATAL_FAILURE(watch.see(last.atHandle(F_H_W, X_WH), frame)) << i;
        held_before = held || !usable;
        if (broken) last.state = tick::HandState();
    }
    EXPECT_GT(watch.limited, 1000);
    EXPECT_GT(watch.rated, 1000);
    EXPECT_GT(watch.zeros, 500);
    EXPECT_GT(watch.untouched, 1000);
}

tick::TickFrame g_asked;  // what reached the last stage of the scene below

TEST(OutputStage, KeepsItsContractUnderHostileInput) {
    // Truth: invariant. 20 000 ticks of a hand that presses, slides and turns, with a lever arm, and of bad samples of
    // every kind, alone and in rows.
    for (const auto method : {scene::ContactMethod::Penalty, scene::ContactMethod::GodObjectHeuristic}) {
        auto spec = pressing();
        spec.contact.method = method;
        spec.contact.damping = 5;
        spec.contact.rotational_damping = 0.01;
        spec.limits.max_force = 3;
        spec.limits.max_torque = 0.1;
        spec.limits.max_force_rate = 190;
        spec.registration.X_DH = {Quat::Identity(), Vec3(0.03, 0, 0)};
        test::Bench bench(spec);
        tick::TickModel model = tick::makeModel(bench.scene());
        auto& stages = model.hands.front().stages;
        stages.insert(stages.end() - 1,
                      {"probe", "planted", false, true,
                       [](const tick::HandModel&, tick::HandState&, tick::TickFrame& f) noexcept { g_asked = f; }});
        Watch watch(spec.limits);
        Random random(9);
        std::uint64_t bad_left = 0;
        for (int i = 0; i < 20000; ++i) {
            const double t = i * kTickSeconds;
            const Quat R = rotationFromVector(0.3 * Vec3(std::sin(5 * t), std::cos(7 * t), std::sin(3 * t)));
            DeviceReading reading{
                Pose{R, Vec3(0.01 * std::sin(2 * t), 0, 0.009 + 0.004 * std::sin(11 * t)) - R * Vec3(0.03, 0, 0)}};
            if (bad_left == 0 && random.below(20) == 0) bad_left = random.below(3) == 0 ? random.below(30) : 1;
            if (bad_left > 0) {
                --bad_left;
                switch (random.below(5)) {
                    case 0:
                        reading.X_BD.p.x() = std::numeric_limits<double>::quiet_NaN();
                        break;
                    case 1:
                        reading.X_BD.q.w() = std::numeric_limits<double>::infinity();
                        break;
                    case 2:
                        reading.X_BD.p.y() = 1e300;
                        break;
                    case 3:
                        reading.X_BD.p.z() -= random.uniform(0, 0.3);
                        break;
                    default:
                        reading.fresh = false;
                }
            }
            const auto out = tick::step(model, bench.wholeState(), reading);
            ASSERT_TRUE(isFinite(out.X_WG) && isFinite(out.frame.X_WH));
            ASSERT_FALSE(out.frame.status & kNonFiniteLatched);
            const Vec3 lever = g_asked.X_WH.q * Vec3(0.03, 0, 0);
            const Wrench asked{g_asked.F_H_W.force, g_asked.F_H_W.torque + lever.cross(g_asked.F_H_W.force)};
            ASSERT_NO_FATAL_FAILURE(watch.see(asked, out.frame)) << i;
        }
        EXPECT_GT(watch.limited, 1000);
        EXPECT_GT(watch.rated, 300);
        EXPECT_GT(watch.zeros, 300);
        EXPECT_GT(watch.untouched, 300);
    }
}

TEST(OutputStage, SharesOutWhatItSendsAsThePushesShareWhatWasAskedFor) {
    // Truth: closed form. One factor for all forces and one for all torques, about the handle in base axes: what the
    // limits leave of the whole they leave of each push, and what has no push of its own, last, is the rest. A device
    // without torque sends none of anybody. Without usable input nobody has a share. Pushes that cancel are whole.
    for (const bool turns : {true, false}) {
        LastStage last;
        last.model.limits.actuates_torque = turns;
        last.model.obstacles = {{.body = 0}, {.body = 1}};
        last.state.pushes.resize(3);
        last.state.last_shares.resize(3);
        Random random(14);
        int limited = 0;
        for (int i = 0; i < 500; ++i) {
            const auto any = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
            const Pose X_WH{rotationFromVector(any()), any()};
            Wrench whole{any(), 0.01 * any()};
            for (std::size_t k = 0; k < 2; ++k) {
                Wrench& push = last.state.pushes[k].wrench;
                push = {4.0 * any(), 0.05 * any()};
                whole.force += push.force;
                whole.torque += push.torque;
            }
            const bool usable = i % 50 != 49;
            const auto frame = last.limit(whole, X_WH, 1, usable);
            const Wrench asked = last.atHandle(whole, X_WH);
            const double force_left = frame.F_D_B.force.norm() / asked.force.norm();
            const double torque_left = frame.F_D_B.torque.norm() / asked.torque.norm();
            EXPECT_EQ(torque_left > 0.0, turns && usable);
            limited += usable && force_left < 0.999 ? 1 : 0;
            Wrench rest = frame.F_D_B;
            for (std::size_t k = 0; k < 2; ++k) {
                const Wrench push = last.atHandle(last.state.pushes[k].wrench, X_WH);
                const Wrench& share = last.state.last_shares[k];
                EXPECT_NEAR((share.force - force_left * push.force).norm(), 0.0, 1e-12);
                EXPECT_NEAR((share.torque - torque_left * push.torque).norm(), 0.0, 1e-12);
                rest.force -= share.force;
                rest.torque -= share.torque;
            }
            EXPECT_NEAR((last.state.last_shares[2].force - rest.force).norm(), 0.0, 1e-12);
            EXPECT_NEAR((last.state.last_shares[2].torque - rest.torque).norm(), 0.0, 1e-12);
        }
        EXPECT_GT(limited, 100);
        const Wrench push{Vec3(1, 2, 3), Vec3::Zero()};
        last.state.pushes[0].wrench = push;
        last.state.pushes[1].wrench = {-push.force, Vec3::Zero()};
        last.limit(Wrench{}, Pose{});
        const Vec3 force = last.atHandle(push, Pose{}).force;
        EXPECT_NEAR((last.state.last_shares[0].force - force).norm(), 0.0, 1e-12);
        EXPECT_NEAR((last.state.last_shares[1].force + force).norm(), 0.0, 1e-12);
    }
}

TEST(OutputStage, DelaysForceTorqueAndPushesBySoManyTicks) {
    // Truth: closed form, y_k = x_{k-n}, zero before the first; what was asked for without usable input is zero. Up to
    // the longest delay, several times round the line.
    for (const int n : {1, 2, 7, scene::kMaxDelayTicks}) {
        tick::HandModel model;
        model.limits.delay_ticks = n;
        tick::HandState state;
        state.pushes.resize(2);
        state.push_line.assign(scene::kMaxDelayTicks + 1, tick::FewOfMany<Wrench>(2));
        Random random(2);
        std::vector<Wrench> asked, pushed;
        for (int i = 0; i < 3 * n + 20; ++i) {
            const auto any = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
            tick::TickFrame frame;
            frame.input_usable = i % 5 != 3;
            frame.F_H_W = {any(), any()};
            asked.push_back(frame.input_usable ? frame.F_H_W : Wrench{});
            for (std::size_t k = 0; k < 2; ++k) {
                state.pushes[k].wrench = {any(), any()};
                pushed.push_back(state.pushes[k].wrench);
            }
            tick::runStage<tick::kOutputDelay>(model, state, frame);
            const auto then = static_cast<std::size_t>(std::max(0, i - n));
            const Wrench expected = i < n ? Wrench{} : asked[then];
            EXPECT_EQ(frame.F_H_W.force, expected.force) << n << ' ' << i;
            EXPECT_EQ(frame.F_H_W.torque, expected.torque) << n << ' ' << i;
            for (std::size_t k = 0; k < 2; ++k) {
                const Wrench push = i < n ? Wrench{} : pushed[2 * then + k];
                EXPECT_EQ(state.pushes[k].wrench.force, push.force) << n << ' ' << i;
                EXPECT_EQ(state.pushes[k].wrench.torque, push.torque) << n << ' ' << i;
            }
        }
    }
}

TEST(OutputStage, ScalesAHugeWrenchInsteadOfDroppingIt) {
    // Truth: closed form. The square of 1e200 N is not finite; the direction is, and it is kept.
    LastStage last;
    last.model.limits.max_force_rate = 1e9;
    const auto frame = last.limitAtHandle({Vec3(3e200, 0, 4e200), Vec3::Zero()});
    EXPECT_NEAR(frame.F_D_B.force.x(), 0.6 * LastStage::kMaxForce, 1e-12);
    EXPECT_NEAR(frame.F_D_B.force.z(), 0.8 * LastStage::kMaxForce, 1e-12);
    EXPECT_EQ(frame.status, static_cast<std::uint32_t>(kForceLimited));
}

TEST(OutputStage, LatchesZeroAfterANonFiniteWrenchUntilTheStateIsMadeAnew) {
    // Truth: invariant. A stage that computes NaN is planted for one tick.
    test::Bench bench(pressing());
    pressed(bench, 0.004);
    tick::TickModel broken = tick::makeModel(bench.scene());
    auto& stages = broken.hands.front().stages;
    stages.insert(stages.end() - 1, {"broken", "planted", false, true,
                                     [](const tick::HandModel&, tick::HandState&, tick::TickFrame& f) noexcept {
                                         f.F_H_W.force.x() = std::numeric_limits<double>::quiet_NaN();
                                     }});
    const auto bad = tick::step(broken, bench.wholeState(), DeviceReading{at(0.006)});
    EXPECT_EQ(bad.F_D_B.force.norm(), 0.0);
    EXPECT_TRUE(bad.frame.status & kNonFiniteLatched);
    const auto still = bench.step(at(0.006));
    EXPECT_EQ(still.F_D_B.force.norm(), 0.0);
    EXPECT_TRUE(still.frame.status & kNonFiniteLatched);
    bench.state() = tick::makeHandState(bench.model());
    EXPECT_GT(pressed(bench, 0.004).F_D_B.force.norm(), 3.0);
}

TEST(OutputStage, RendersNoTorqueOnADeviceThatHasNone) {
    // Truth: invariant.
    auto spec = pressing();
    spec.registration.X_DH = {Quat::Identity(), Vec3(0.05, 0, 0)};
    spec.limits.actuates_torque = false;
    spec.limits.max_torque = 0;
    test::Bench bench(spec);
    tick::TickOutput out;
    for (int i = 0; i < 1000; ++i)
        out = bench.step(Pose{Quat::Identity(), Vec3(-0.05, 0, 0.01 - std::min(0.004, 2e-5 * i))});
    EXPECT_NEAR(out.F_D_B.force.z(), 4.0, 0.05);
    EXPECT_EQ(out.F_D_B.torque.norm(), 0.0);
}

TEST(OutputStage, DelaysTheWrenchByTheTicksThatTheSceneNames) {
    // Truth: invariant. The same motion with and without delay gives the same wrenches, shifted.
    auto spec = pressing();
    test::Bench prompt(spec);
    spec.limits.delay_ticks = 3;
    test::Bench delayed(spec);
    std::vector<double> asked, given;
    for (int i = 0; i < 300; ++i) {
        const double z = 0.01 - 2e-5 * i;
        asked.push_back(prompt.step(at(z)).F_D_B.force.z());
        given.push_back(delayed.step(at(z)).F_D_B.force.z());
    }
    for (std::size_t i = 3; i < asked.size(); ++i) EXPECT_EQ(given[i], asked[i - 3]);
}

TEST(OutputStage, DelaysNoWrenchOfRejectedTicksIntoTheTimeAfterThem) {
    // Truth: invariant. What was computed for a device that was lost is never sent: only what was computed before it or
    // after it, each by its delay later.
    auto spec = pressing();
    spec.limits.delay_ticks = 3;
    test::Bench bench(spec);
    pressed(bench, 0.004);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (int i = 0; i < 10; ++i) bench.step(at(nan));
    for (int i = 0; i < 3; ++i) EXPECT_EQ(bench.step(at(0.006)).F_D_B.force.norm(), 0.0) << i;
    EXPECT_GT(bench.step(at(0.006)).F_D_B.force.z(), 3.0);
}

}  // namespace
}  // namespace passung
