// The kernel's own random runs: input guard, output stage, passivity and the solver of motions on random input, alone
// and together in scenes. Prints a hash of all bits that come out of each, so that two builds can be compared. What a
// fault leaves alone here changes no output; steps taken and other costs do not count as one.

#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <vector>

#include "core/base/random.h"
#include "core/motion/friction.h"
#include "core/scene/scene.h"
#include "core/tick/step.h"
#include "core/tick/tick_state.h"

namespace passung {
namespace {

class Bits {
public:
    explicit Bits(const char* name) : name_(name) {}
    ~Bits() { std::printf("%-16s %016llx\n", name_, static_cast<unsigned long long>(hash_)); }
    Bits(const Bits&) = delete;
    Bits& operator=(const Bits&) = delete;

    void add(std::uint64_t bits) {
        hash_ = (hash_ ^ bits) * 0x9e3779b97f4a7c15u;
        hash_ ^= hash_ >> 29;
    }
    /// -0 and 0 are one number.
    void add(double x) { add(std::bit_cast<std::uint64_t>(x + 0.0)); }
    template <class Matrix>
    void addAll(const Matrix& m) {
        for (Eigen::Index i = 0; i < m.size(); ++i) add(double{m[i]});
    }
    void add(const Wrench& wrench) {
        addAll(wrench.force);
        addAll(wrench.torque);
    }
    void add(const Pose& pose) {
        addAll(pose.p);
        addAll(pose.q.coeffs());
    }
    void add(const tick::TickFrame& frame) {
        add(frame.X_WH);
        add(frame.F_D_B);
        add(frame.F_H_W);
        add(frame.energy);
        add(std::uint64_t{frame.status} << 1 | (frame.input_usable ? 1u : 0u));
        add(static_cast<std::uint64_t>(frame.sample_periods) << 1 | (frame.relocated ? 1u : 0u));
    }

private:
    const char* name_;
    std::uint64_t hash_ = 1;
};

Vec3 anyVector(Random& random, double size) { return size * Vec3(random.normal(), random.normal(), random.normal()); }

Quat anyRotation(Random& random, double size) { return rotationFromVector(anyVector(random, size)); }

Wrench anyWrench(Random& random, double force, double torque) {
    return {anyVector(random, force), anyVector(random, torque)};
}

/// A device that is now quiet, now wild: how its readings go wrong, and for how long.
class Hand {
public:
    explicit Hand(Random& random, const Pose& X) : random_(random), X_(X) {}

    /// Wanders by up to `speed` [m/s]; of `faults` readings in 1000 a bad time begins.
    DeviceReading next(double speed, unsigned faults) {
        X_.p += anyVector(random_, speed * kTickSeconds);
        X_.q = (anyRotation(random_, 10.0 * speed * kTickSeconds) * X_.q).normalized();
        if (left_ == 0 && random_.below(1000) < faults) {
            kind_ = random_.below(9);
            left_ = random_.below(4) == 0 ? 1 + random_.below(250) : 1 + random_.below(5);
            wrong_ = {anyRotation(random_, 1.0), X_.p + anyVector(random_, random_.below(2) == 0 ? 0.05 : 2.0)};
        }
        DeviceReading reading{X_};
        if (random_.below(50) == 0) reading.periods = 1 + static_cast<std::uint32_t>(random_.below(5));
        if (left_ == 0) return reading;
        if (--left_ == 0 && random_.below(3) == 0) {  // one good sample, then the next bad time
            kind_ = random_.below(9);
            left_ = 1 + random_.below(30);
            return reading;
        }
        switch (kind_) {
            case 0:
                reading.fresh = false;
                break;
            case 1:
                reading.fresh = left_ % 2 == 0;
                break;
            case 2:
                reading.X_BD.p[static_cast<Eigen::Index>(random_.below(3))] = std::numeric_limits<double>::quiet_NaN();
                break;
            case 3:
                reading.X_BD.q.coeffs() *= random_.uniform(0.998, 1.002);
                break;
            case 4:
                reading.X_BD.p.x() = random_.uniform(900.0, 1100.0);
                break;
            case 5:
                reading.X_BD = wrong_;
                break;
            case 6:
                reading.X_BD = wrong_;
                reading.fresh = left_ % (1 + wrongGap()) == 0;
                break;
            case 7:
                X_ = wrong_;  // carried away
                reading.X_BD = X_;
                left_ = 0;
                break;
            default:
                if (left_ % (1 + wrongGap()) == 0) reading.X_BD = wrong_;
        }
        return reading;
    }

private:
    std::uint64_t wrongGap() const { return static_cast<std::uint64_t>(std::abs(wrong_.p.x()) * 1e4) % 7; }

    Random& random_;
    Pose X_, wrong_;
    std::uint64_t kind_ = 0, left_ = 0;
};

tick::HandModel anyModel(Random& random) {
    tick::HandModel model;
    model.registration.X_WB = {anyRotation(random, 1.0), anyVector(random, 0.3)};
    model.registration.X_DH = {anyRotation(random, 1.0), anyVector(random, 0.05)};
    model.registration.scale = random.uniform(0.5, 2.0);
    model.limits.max_speed = random.uniform(2.0, 20.0);
    model.limits.max_spin = random.uniform(20.0, 200.0);
    model.limits.max_force = random.uniform(2.0, 12.0);
    model.limits.max_torque = random.below(4) == 0 ? 0.0 : random.uniform(0.02, 0.3);
    model.limits.max_force_rate = random.uniform(300.0, 5000.0);
    model.limits.actuates_torque = random.below(4) != 0;
    model.limits.quantum = random.below(2) == 0 ? 0.0 : random.uniform(1e-5, 1e-3);
    model.limits.rotational_quantum = random.below(2) == 0 ? 0.0 : random.uniform(1e-4, 1e-2);
    model.limits.delay_ticks = static_cast<int>(random.below(4));
    model.metric_radius = random.uniform(0.005, 0.05);
    model.effects.passivity_damping = random.uniform(0.5, 50.0);
    model.start_gate = {random.uniform(0.005, 0.05), random.uniform(0.05, 0.5), static_cast<int>(random.below(10))};
    return model;
}

/// Guard, start gate, energy account, delay, damper and limits, one after the other as in a tick, around a wrench that
/// anybody may have computed.
void runStages(Random& random) {
    Bits guard_bits("guard"), gate_bits("start gate"), energy_bits("energy"), delay_bits("delay"),
        damper_bits("passivity"), limit_bits("output limits");
    for (int run = 0; run < 120; ++run) {
        tick::HandModel model = anyModel(random);
        tick::HandState state;
        state.X_DG = model.registration.X_DH;
        const std::size_t pairs = 1 + random.below(3);
        for (std::size_t k = 0; k + 1 < pairs; ++k) model.obstacles.push_back({.body = k});
        state.pairs.resize(pairs);
        state.pushes.resize(pairs);
        state.last_shares.resize(pairs);
        state.push_line.assign(scene::kMaxDelayTicks + 1, tick::FewOfMany<Wrench>(pairs));
        const Pose X{anyRotation(random, 1.0), anyVector(random, 0.3)};
        model.X_WG_start = tick::registeredPose(model.registration, X, model.registration.X_DH);
        model.X_WG_start.p += anyVector(random, 0.01);
        state.X_WG = model.X_WG_start;
        Hand hand(random, X);
        const double speed = random.uniform(0.01, 1.5);
        const auto faults = static_cast<unsigned>(random.below(100));
        const bool withheld = run % 20 == 0;
        Wrench asked;
        for (int i = 0; i < 600; ++i) {
            tick::TickFrame frame;
            frame.reading = hand.next(speed, faults);
            tick::runStage<tick::kInputGuard>(model, state, frame);
            guard_bits.add(frame);
            tick::runStage<tick::kEnergyAccount>(model, state, frame);
            energy_bits.add(frame.energy);
            for (const tick::PairAccount& pair : state.pairs) energy_bits.add(pair.taken_in);
            tick::runStage<tick::kStartGate>(model, state, frame);
            gate_bits.add(std::uint64_t{state.engaged ? 1u : 0u});
            if (random.below(20) == 0)
                asked = random.below(10) == 0 ? Wrench{}
                                              : anyWrench(random, random.uniform(0.1, 8.0), random.uniform(0.001, 0.2));
            if (random.below(2000) == 0) asked.force *= 1e200;
            frame.F_H_W = asked;
            if (random.below(3000) == 0) frame.F_H_W.torque.y() = std::numeric_limits<double>::infinity();
            for (std::size_t k = 0; k < pairs; ++k) state.pushes[k].wrench = anyWrench(random, 1.0, 0.01);
            if (model.limits.delay_ticks > 0) tick::runStage<tick::kOutputDelay>(model, state, frame);
            delay_bits.add(frame.F_H_W);
            for (const tick::ObstaclePush& push : state.pushes) delay_bits.add(push.wrench);
            if (run % 2 == 0) tick::runStage<tick::kPassivityController>(model, state, frame);
            damper_bits.add(frame.F_H_W);
            damper_bits.add(std::uint64_t{frame.status});
            if (withheld) tick::runStage<tick::kNoWrench>(model, state, frame);
            tick::runStage<tick::kOutputLimits>(model, state, frame);
            limit_bits.add(frame);
            for (const Wrench& share : state.last_shares) limit_bits.add(share);
            if (state.latched && random.below(10) == 0) {
                state.latched = false;
                asked = Wrench{};
            }
        }
    }
}

contact::ContactPoint anyContact(Random& random, double askew) {
    contact::ContactPoint contact;
    contact.position = anyVector(random, 0.01);
    contact.gradient = (Vec3::UnitZ() + askew * anyVector(random, 1.0)).normalized() * random.uniform(0.8, 1.2);
    if (random.below(40) == 0) contact.gradient *= random.uniform(0.05, 0.2);
    contact.normal = -contact.gradient.normalized();
    contact.phi = random.below(3) == 0 ? -1e-6 : random.uniform(-1e-5, 2e-4);
    contact.area = random.uniform(1e-7, 1e-5);
    contact.obstacle = static_cast<std::uint32_t>(random.below(2));
    if (random.below(30) == 0) contact.radius = random.uniform(1e-4, 5e-3);
    return contact;
}

/// The wall of a bore, a groove, a flat face, a wedge, or contacts anywhere.
contact::ContactManifold anyManifold(Random& random) {
    const std::uint64_t kind = random.below(6);
    const std::size_t count = kind == 5 ? 200 + random.below(600) : 1 + random.below(kind == 0 ? 12 : 60);
    contact::ContactManifold manifold(count);
    for (std::size_t i = 0; i < count; ++i) {
        contact::ContactPoint contact = anyContact(random, kind == 0 ? 2.0 : kind == 5 ? 0.3 : 0.02);
        const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
        if (kind == 1 || kind == 5) {  // bore
            const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
            contact.gradient = (-out + anyVector(random, 1e-3)).normalized();
            contact.position = 0.01 * out + 0.02 * random.uniform() * Vec3::UnitZ();
        } else if (kind == 2) {  // groove or wedge
            const double side = random.below(2) == 0 ? 1.0 : -1.0;
            contact.gradient = Vec3(0.3, side, 0.1).normalized();
            contact.position.y() = -0.005 * side;
        } else if (kind == 3) {  // flat face, dry
            contact.gradient = Vec3::UnitZ();
            contact.position.z() = 0.0;
            contact.phi = -1e-6;
            contact.obstacle = 0;
        } else if (kind == 4) {  // corner
            contact.gradient = Vec3::Unit(static_cast<Eigen::Index>(random.below(3)));
        }
        contact.normal = -contact.gradient.normalized();
        (void)manifold.tryPush(contact);
    }
    return manifold;
}

void add(Bits& bits, const motion::ConstrainedMotion& motion) {
    bits.addAll(motion.u);
    bits.add(std::uint64_t{(motion.relaxed ? 1u : 0u) | (motion.converged ? 2u : 0u)});
    for (int i = 0; i < motion.active; ++i) {
        const motion::ActiveContact& held = motion.active_contacts[static_cast<std::size_t>(i)];
        bits.add(std::uint64_t{held.contact});
        bits.add(held.push);
    }
}

void runSolver(Random& random) {
    Bits smooth_bits("smooth motion"), rubbed_bits("friction");
    for (int run = 0; run < 1500; ++run) {
        const contact::ContactManifold manifold = anyManifold(random);
        const double keep_out = random.below(2) == 0 ? -1e-6 : -5e-6;
        const Vec3 origin = anyVector(random, 0.01);
        const motion::Surroundings around{manifold,
                                          {random.uniform(0.005, 0.05), origin},
                                          keep_out,
                                          keep_out - (random.below(2) == 0 ? 0.0 : random.uniform(0.0, 5e-6))};
        motion::Motion wanted;
        const double size = std::pow(10.0, random.uniform(-6.0, -2.0));
        for (int i = 0; i < 6; ++i) wanted[i] = size * random.normal();
        std::vector<std::uint32_t> likely;
        const double at_rest = random.uniform(0.05, 1.0), other = random.uniform(0.05, 1.0);
        const motion::Friction friction[] = {{at_rest, at_rest * random.uniform(0.5, 1.0)}, {other, 0.8 * other}};
        motion::FrictionPatches before;
        motion::MotionSolver solver(around);
        for (int tick = 0; tick < 3; ++tick) {
            add(smooth_bits, motion::constrainMotion(wanted, around, likely));
            add(smooth_bits, solver.solve(wanted));
            const motion::FrictionMotion rubbed =
                motion::constrainWithFriction(wanted, around, friction, before, likely);
            add(rubbed_bits, rubbed.motion);
            rubbed_bits.add(std::uint64_t{rubbed.converged ? 1u : 0u});
            for (int p = 0; p < rubbed.patches.count; ++p) {
                const motion::FrictionPatch& patch = rubbed.patches.patch[static_cast<std::size_t>(p)];
                rubbed_bits.addAll(patch.centre);
                rubbed_bits.addAll(patch.impulse);
                rubbed_bits.add(patch.radius);
                rubbed_bits.add(patch.pressure);
                rubbed_bits.add(std::uint64_t{patch.slides ? 1u : 0u});
            }
            before = rubbed.patches;
            likely.clear();
            for (int i = 0; i < rubbed.motion.active; ++i)
                likely.push_back(rubbed.motion.active_contacts[static_cast<std::size_t>(i)].contact);
            if (random.below(4) == 0)
                for (std::uint32_t& place : likely) place = static_cast<std::uint32_t>(random.below(manifold.size()));
            wanted += 0.1 * size * motion::Motion::Constant(random.normal());
        }
    }
}

/// A block over a plate and a post, pressed, drawn and turned by a hand whose device now and then goes wrong.
void runScenes(Random& random) {
    Bits bits("scenes");
    scene::PartCache cache;
    for (int run = 0; run < 12; ++run) {
        scene::SceneSpec spec;
        const Vec3 place = anyVector(random, 0.2);
        spec.parts.push_back({.name = "held",
                              .geometry = shape::Box{0.02, 0.02, 0.01},
                              .X_WP = {Quat::Identity(), place + Vec3(0, 0, 0.0155)},
                              .held = true,
                              .friction = run % 2 == 0 ? 0.5 : 0.0,
                              .sliding_friction = run % 2 == 0 ? 0.4 : 0.0});
        spec.parts.push_back({.name = "plate",
                              .geometry = shape::Box{0.06, 0.06, 0.02},
                              .X_WP = {Quat::Identity(), place},
                              .friction = 0.5,
                              .sliding_friction = 0.4});
        spec.parts.push_back({.name = "post",
                              .geometry = shape::Cylinder{0.01, 0.03},
                              .X_WP = {Quat::Identity(), place + Vec3(0.016, 0, 0.02)},
                              .friction = 0.5,
                              .sliding_friction = 0.4});
        const scene::ContactMethod methods[] = {scene::ContactMethod::Penalty, scene::ContactMethod::GodObjectHeuristic,
                                                scene::ContactMethod::GodObject};
        spec.contact.method = methods[run % 3];
        spec.contact.geometry = scene::Geometry::Field;
        spec.contact.cell = 1e-3;
        spec.contact.spacing = 2e-3;
        spec.limits.delay_ticks = run % 4;
        spec.effects.passivity_damping = run % 3 == 0 ? 0.0 : 20.0;
        if (run == 11) spec.start_gate = {0.002, 0.1, 20};
        if (run == 10) spec.display_wrench = false;
        const auto scene = scene::buildScene(spec, cache);
        if (!scene) std::abort();
        const tick::TickModel model = tick::makeModel(*scene);
        tick::TickState state = tick::makeState(model);
        Hand hand(random, spec.parts[0].X_WP);
        const Vec3 start = spec.parts[0].X_WP.p, way = anyVector(random, 0.003);
        for (int i = 0; i < 400; ++i) {
            DeviceReading reading = hand.next(0.01, 20);
            const double t = i * kTickSeconds;
            if (isFinite(reading.X_BD))
                reading.X_BD.p +=
                    way * std::sin(9.0 * t) + Vec3(0.003 * std::sin(23.0 * t), 0, -0.003 * std::sin(17.0 * t));
            const tick::TickOutput output = tick::step(model, state, reading);
            bits.add(output.frame);
            bits.add(Pose{output.X_WG.q, output.X_WG.p - start});
            bits.add(output.frame.proxy_depth);
        }
    }
}

}  // namespace
}  // namespace passung

int main() {
    passung::Random random(20);
    passung::runStages(random);
    passung::runSolver(random);
    passung::runScenes(random);
    return 0;
}
