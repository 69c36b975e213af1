#include "core/tick/step.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/tick/tick_model.h"
#include "core/tick/tick_state.h"

namespace passung::tick {

namespace {

/// Mixes the bits of one value into the hash (multiply and fold, 64 bit).
void mix(std::uint64_t& hash, std::uint64_t bits) noexcept {
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 32;
}

void mix(std::uint64_t& hash, const Vec3& v) noexcept {
    for (int i = 0; i < 3; ++i) mix(hash, std::bit_cast<std::uint64_t>(v[i]));
}

void mix(std::uint64_t& hash, const Pose& pose) noexcept {
    mix(hash, pose.p);
    mix(hash, pose.q.vec());
    mix(hash, std::bit_cast<std::uint64_t>(pose.q.w()));
}

void mixOutputs(std::uint64_t& hash, const TickFrame& frame, const Pose& X_WG) noexcept {
    mix(hash, frame.X_WH);
    mix(hash, X_WG);
    mix(hash, frame.F_H_W.force);
    mix(hash, frame.F_H_W.torque);
    mix(hash, frame.F_D_B.force);
    mix(hash, frame.F_D_B.torque);
    mix(hash, Vec3(frame.proxy_depth, frame.hand_depth, frame.quality));
    mix(hash, std::bit_cast<std::uint64_t>(frame.energy));
    // Only where it is known: hashes of scenes without one are as they were before there was a gap.
    if (!std::isnan(frame.proxy_gap)) mix(hash, std::bit_cast<std::uint64_t>(frame.proxy_gap));
    if (!std::isnan(frame.scale)) {  // likewise
        mix(hash, Vec3(frame.scale, frame.clutched ? 1.0 : 0.0, 0.0));
        mix(hash, Pose{frame.turn, frame.offset});
    }
    mix(hash, std::uint64_t{frame.status} << 32 | frame.contacts);
    mix(hash, std::uint64_t{frame.iterations} << 32 | frame.nodes_visited);
}

/// The nearest float that is not above `value`: what is at least so far away stays so in a record. NaN stays NaN.
float roundedDown(double value) noexcept {
    const auto rounded = static_cast<float>(value);
    return static_cast<double>(rounded) > value ? std::nextafter(rounded, -1.0f) : rounded;
}

template <std::size_t N>
void store(std::array<float, N>& into, const Vec3& v) noexcept {
    for (std::size_t i = 0; i < 3; ++i) into[i] = static_cast<float>(v[static_cast<int>(i)]);
}

void store(std::array<float, 4>& into, const Quat& q) noexcept {
    into = {static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z())};
}

void store(std::array<float, 6>& into, const Wrench& wrench) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
        into[i] = static_cast<float>(wrench.force[static_cast<int>(i)]);
        into[i + 3] = static_cast<float>(wrench.torque[static_cast<int>(i)]);
    }
}

/// The stages of a hand from number `begin` until one that does not sense, or all. Where it ended.
std::size_t runStages(const HandModel& model, HandState& state, TickFrame& frame, std::size_t begin, bool sensing,
                      const StageWatch* watch) noexcept {
    std::size_t i = begin;
    for (; i < model.stages.size(); ++i) {
        const Stage& stage = model.stages[i];
        if (sensing && !stage.senses) break;
        if (!state.engaged && !stage.before_start) continue;
        stage.run(model, state, frame);
        if (watch != nullptr) watch->after(watch->context, stage);
    }
    return i;
}

/// The parts that other hands hold, or have just let go, as the tick begins.
void noteOthers(const HandModel& model, const TickState& whole, std::size_t hand, HandState& state) noexcept {
    state.carried_count = 0;
    if (!model.meetsHands() || model.follows) return;
    state.X_WG_begin = whole.X_WP[model.body];
    const auto isHeld = [&](std::size_t body) {
        return std::any_of(whole.holds.begin(), whole.holds.end(), [=](const Hold& h) { return h.body == body; });
    };
    const auto add = [&](std::size_t body, bool rests) {
        const auto obstacle = static_cast<std::uint32_t>(model.obstacleOf(body));
        std::size_t at = state.carried_count++;
        for (; at > 0 && state.carried[at - 1].obstacle > obstacle; --at) state.carried[at] = state.carried[at - 1];
        state.carried[at] = {obstacle, whole.X_WP[body], rests};
    };
    for (std::size_t other = 0; other < whole.holds.size(); ++other) {
        if (other == hand) continue;
        const Hold& hold = whole.holds[other];
        if (hold.body != kNoBody && hold.body != model.body && !hold.follows) add(hold.body, false);
        if (hold.let_go != kNoBody && !isHeld(hold.let_go)) add(hold.let_go, true);
    }
}

/// Where the hand is.
std::size_t sense(const HandModel& model, TickState& whole, std::size_t hand, const DeviceReading& reading,
                  TickFrame& frame, const StageWatch* watch) noexcept {
    HandState& state = whole.hands[hand];
    frame = TickFrame{};
    frame.reading = reading;
    noteOthers(model, whole, hand, state);
    const bool engaged = state.engaged;
    const std::size_t next = runStages(model, state, frame, 0, true, watch);
    if (!engaged && state.engaged && !whole.waiting.empty() && !model.follows) {
        placeObstacles(model, whole.X_WP, state);  // where others have left them
        noteOthers(model, whole, hand, state);
    }
    // Parts without a proxy are where their hands are, each for the others too.
    if (state.engaged && model.rendersAtHand()) whole.X_WP[model.body] = frame.X_WH;
    return next;
}

/// Where a hand that is at `X_WH` draws a part that goes on moving, its spring at rest at `X_WR`.
Pose drawOn(const HandInTick& hand, const Pose& X_WH, const Pose& X_WR, bool relocated) noexcept {
    const HandModel& model = *hand.model;
    HandState& state = *hand.state;
    if (relocated) {
        static_cast<Moving&>(state) = {};
        static_cast<Stretch&>(state) = {};
    }
    const Pose& X_WG = relocated ? X_WH : state.X_WG;
    state.pull = pullOf(model, std::array{state.p_GC}, momentumOf(model, state, X_WG));
    state.pull.springs[0].X_WT = drawnTo(model, state, state.p_GC, X_WR, X_WG);
    return state.pull.restFrom(state.metric, X_WG);
}

// Of what stretched springs add to the metric's square, and of what is rounded there
constexpr double kPulledRoom = 1.3, kPulledTooMuch = 2.0, kRoundingOfSquare = 1e-9;

/// Two hands' springs on one part, and where it would rest. The first one's state takes them.
void drawTogether(const HandInTick& first, const Pose& X_WH, const HandState& second,
                  const Pose& X_WH_second) noexcept {
    const HandModel& model = *first.model;
    HandState& state = *first.state;
    const scene::ContactSpec& contact = model.contact;
    if (model.hasInertia()) {
        state.pull = pullOf(model, std::array{state.p_GC, second.p_GC}, momentumOf(model, state, state.X_WG));
        state.pull.springs[0].X_WT = drawnTo(model, state, state.p_GC, X_WH, state.X_WG);
        state.pull.springs[1].X_WT = drawnTo(model, second, second.p_GC, X_WH_second, state.X_WG);
        state.pull.load = model.weight / contact.stiffness;
        state.X_WT = state.pull.restFrom(state.metric, state.X_WG);
        return;
    }
    state.pull = {.springs = {{{X_WH, state.p_GC}, {X_WH_second, second.p_GC}}},
                  .turn = contact.rotational_stiffness / contact.stiffness,
                  .load = model.weight / contact.stiffness,
                  .p_GM = model.centre};
    // The metric follows the springs' stretch in leaps: between them it is stiffer than they are, by a factor at most.
    const double rho = model.metric_radius, arm = 0.5 * (state.p_GC - second.p_GC).norm();
    const double slack = rho * rho + arm * arm, pulled = std::max(0.0, state.pull.pulledAt(state.X_WG));
    const double square = state.metric.across * state.metric.across;
    if (square > 0.0 && (square < slack + pulled - kRoundingOfSquare * slack ||
                         square > kPulledTooMuch * (slack + kPulledRoom * pulled)))
        measureBy(model, std::array{state.p_GC, second.p_GC}, state, kPulledRoom * pulled);
    state.X_WT = state.pull.restFrom(state.metric, state.X_WG);
}

/// A device is believed to be elsewhere: it holds the part there from now on, where that is.
void holdThere(const HandModel& model, const Pose& X_WG, HandState& state, TickFrame& frame) noexcept {
    const Pose X_WD = frame.X_WH * state.X_DG.inverse() * model.registration.X_DH, X_DP = X_WD.inverse() * X_WG;
    regrip(model.registration.X_DH * X_DP, X_DP.inverse().p, state);
    frame.X_WH = X_WG;
    frame.relocated = false;
    static_cast<Stretch&>(state) = {};
}

/// What the second of two hands learns of the part after the first one's turn.
void share(const HandState& first, const TickFrame& frame, HandState& second) noexcept {
    FollowedPart& shared = second;
    shared.X_WShared = first.X_WG;
    shared.shared_record = frame;
    shared.shared_pressures.clear();
    for (const std::uint32_t i : first.pushes.held())
        if (first.pushes[i].pressure > 0.0) shared.shared_pressures[i] = first.pushes[i].pressure;
}

/// One hand's turn.
void takeTurn(const HandModel& model, TickState& whole, HandState& state, std::size_t next, TickOutput& output,
              const StageWatch* watch) noexcept {
    if (state.engaged)
        for (const ObstaclePoses::Carried& in_hand : state.inHands())
            state.X_WO[in_hand.obstacle] = whole.X_WP[model.obstacles[in_hand.obstacle].body];
    TickFrame& frame = output.frame;
    runStages(model, state, frame, next, false, watch);
    if (state.engaged) frame.status |= kEngaged;
    if (frame.reading.periods > 1) frame.status |= kOverrun;
    if (model.hasPart() && !model.follows) whole.X_WP[model.body] = state.X_WG;
    output.F_D_B = frame.F_D_B;
    output.X_WG = state.X_WG;
    output.held = model.hasPart() ? static_cast<std::int32_t>(model.body) : kNoPart;
}

}  // namespace

void step(const TickModel& model, TickState& state, std::span<const DeviceReading> readings,
          std::span<TickOutput> outputs, const StageWatch* watch) noexcept {
    const std::size_t count = model.hands.size();
    std::array<std::size_t, scene::kMostHands> next{};
    std::array<HandInTick, scene::kMostHands> all{};
    std::array<Pose, scene::kMostHands> X_WT;  // where each part would be without the others
    for (std::size_t i = 0; i < count; ++i) {
        all[i] = {&model.hand(i, state.holds[i].body, state.holds[i].follows), &state.hands[i]};
        next[i] = sense(*all[i].model, state, i, readings[i], outputs[i].frame, watch);
        const TickFrame& frame = outputs[i].frame;
        X_WT[i] = all[i].model->hasWeight() ? state.hands[i].X_WR : frame.X_WH;
        if (all[i].model->hasInertia() && state.holds[i].partner == Hold::kNoHand)
            X_WT[i] = drawOn(all[i], frame.X_WH, X_WT[i], frame.relocated);
    }
    for (std::size_t i = 0; i < count; ++i) {
        const Hold& hold = state.holds[i];
        if (hold.partner == Hold::kNoHand || hold.follows) continue;
        const std::size_t k = hold.partner;
        bool regripped = false;
        for (const std::size_t hand : {i, k}) {
            if (!outputs[hand].frame.relocated) continue;
            holdThere(*all[hand].model, state.hands[i].X_WG, state.hands[hand], outputs[hand].frame);
            regripped = true;
        }
        if (regripped) measureBy(*all[i].model, std::array{state.hands[i].p_GC, state.hands[k].p_GC}, state.hands[i]);
        drawTogether(all[i], outputs[i].frame.X_WH, state.hands[k], outputs[k].frame.X_WH);
        X_WT[i] = state.hands[i].X_WT;
    }
    const auto hands = std::span(all).first(count);
    const std::size_t first = static_cast<std::size_t>(state.tick) % count;
    const Turns turns = balanceHands(hands, std::span(X_WT).first(count), first, state.balance);
    const auto follow = std::count_if(hands.begin(), hands.end(), [](const HandInTick& h) { return h.model->follows; });
    const auto sharers = static_cast<std::uint32_t>(count) - static_cast<std::uint32_t>(follow);
    std::uint32_t spared = 0;  // by those who had their turn
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t hand = turns[i];
        const HandModel& own = *hands[hand].model;
        if (own.follows) continue;  // after its partner
        const std::uint32_t work = mostWork(own) / sharers + spared;
        state.hands[hand].work = work;
        takeTurn(own, state, state.hands[hand], next[hand], outputs[hand], watch);
        spared = work - std::min(work, workDone(own, outputs[hand].frame));
        const std::size_t partner = state.holds[hand].partner;
        if (partner == Hold::kNoHand) continue;
        share(state.hands[hand], outputs[hand].frame, state.hands[partner]);
        takeTurn(*hands[partner].model, state, state.hands[partner], next[partner], outputs[partner], watch);
    }
    for (TickOutput& output : outputs) {
        output.steps_done = state.assembly.done;
        mixOutputs(state.hash, output.frame, output.X_WG);
        if (model.picks())
            mix(state.hash, static_cast<std::uint64_t>(output.held));
        else
            output.held = kPartNotTold;
    }
    if (!model.pick.steps.empty()) mix(state.hash, state.assembly.done);
    if (model.picks()) pickAndLetGo(model, state, readings, outputs);
    ++state.tick;
}

TickOutput step(const TickModel& model, TickState& state, const DeviceReading& reading,
                const StageWatch* watch) noexcept {
    TickOutput output;
    step(model, state, std::span(&reading, 1), std::span(&output, 1), watch);
    return output;
}

TickRecord makeRecord(std::int64_t tick, const DeviceReading& reading, const TickOutput& output) noexcept {
    const TickFrame& frame = output.frame;
    TickRecord record;
    record.tick = tick;
    for (std::size_t i = 0; i < 3; ++i) record.device_position_m[i] = reading.X_BD.p[static_cast<int>(i)];
    const Quat& q = reading.X_BD.q;
    record.device_quaternion = {q.w(), q.x(), q.y(), q.z()};
    record.input_flags = (reading.fresh ? 1u : 0u) | reading.buttons << 8;
    record.periods = reading.periods;
    store(record.hand_position_m, frame.X_WH.p);
    store(record.hand_quaternion, frame.X_WH.q);
    store(record.proxy_position_m, output.X_WG.p);
    store(record.proxy_quaternion, output.X_WG.q);
    store(record.force_N, frame.F_H_W.force);
    store(record.torque_Nm, frame.F_H_W.torque);
    record.hand_depth_m = static_cast<float>(frame.hand_depth);
    record.proxy_depth_m = static_cast<float>(frame.proxy_depth);
    record.proxy_gap_m = roundedDown(frame.proxy_gap);
    record.energy_J = static_cast<float>(frame.energy);
    record.quality = static_cast<float>(frame.quality);
    record.status = frame.status;
    record.contacts = frame.contacts;
    record.iterations = frame.iterations;
    record.nodes_visited = frame.nodes_visited;
    record.hand_energy_J = static_cast<float>(reading.hand_energy_J);
    record.held = output.held;
    record.steps_done = output.steps_done;
    record.navigation_clutched = frame.clutched ? 1u : 0u;
    record.navigation_scale = static_cast<float>(frame.scale);
    store(record.navigation_offset_m, frame.offset);
    store(record.navigation_quaternion, frame.turn);
    record.effects = frame.effects;
    if (frame.effects != 0) {
        const std::array added{&frame.of_transients, &frame.of_weight,  &frame.of_viscosity, &frame.of_guidance,
                               &frame.of_snap,       &frame.of_inertia, &frame.of_keep_apart};
        static_assert(added.size() == kWrenchEffects);
        for (std::size_t i = 0; i < kWrenchEffects; ++i) store(record.effect_wrench[i], *added[i]);
        record.guided = static_cast<float>(frame.guided);
    }
    return record;
}

DeviceReading readingOf(const TickRecord& record) noexcept {
    DeviceReading reading;
    const auto& p = record.device_position_m;
    const auto& q = record.device_quaternion;
    reading.X_BD = {Quat(q[0], q[1], q[2], q[3]), Vec3(p[0], p[1], p[2])};
    reading.fresh = (record.input_flags & 1u) != 0;
    reading.buttons = record.input_flags >> 8;
    reading.periods = record.periods;
    reading.hand_energy_J = record.hand_energy_J;
    return reading;
}

}  // namespace passung::tick
