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

/// Work that all hands' proxies may do in a tick, and what one has done.
std::uint32_t mostWork(const HandModel& model) noexcept {
    return model.hasSurfaces() ? static_cast<std::uint32_t>(kSurfaceBudget) : kFieldBudget;
}
std::uint32_t workDone(const HandModel& model, const TickFrame& frame) noexcept {
    return model.hasSurfaces() ? frame.nodes_visited : frame.work;
}

/// Where the hand is.
std::size_t sense(const HandModel& model, TickState& whole, HandState& state, const DeviceReading& reading,
                  TickFrame& frame, const StageWatch* watch) noexcept {
    frame = TickFrame{};
    frame.reading = reading;
    for (std::size_t i = 0; i < model.moving.size(); ++i)
        state.X_WO_begin[i] = whole.X_WP[model.obstacles[model.moving[i]].body];
    if (!model.moving.empty()) state.X_WG_begin = whole.X_WP[model.body];
    const std::size_t next = runStages(model, state, frame, 0, true, watch);
    // Parts without a proxy are where their hands are, each for the others too.
    if (state.engaged && model.rendersAtHand()) whole.X_WP[model.body] = frame.X_WH;
    return next;
}

/// One hand's turn.
void takeTurn(const HandModel& model, TickState& whole, HandState& state, std::size_t next, TickOutput& output,
              const StageWatch* watch) noexcept {
    for (const std::uint32_t i : model.moving) state.X_WO[i] = whole.X_WP[model.obstacles[i].body];
    TickFrame& frame = output.frame;
    runStages(model, state, frame, next, false, watch);
    if (state.engaged) frame.status |= kEngaged;
    if (frame.reading.periods > 1) frame.status |= kOverrun;
    whole.X_WP[model.body] = state.X_WG;
    output.F_D_B = frame.F_D_B;
    output.X_WG = state.X_WG;
}

}  // namespace

void step(const TickModel& model, TickState& state, std::span<const DeviceReading> readings,
          std::span<TickOutput> outputs, const StageWatch* watch) noexcept {
    const std::size_t count = model.hands.size();
    std::array<std::size_t, scene::kMostHands> next{};
    std::array<Pose, scene::kMostHands> X_WT;  // where each part would be without the others
    for (std::size_t i = 0; i < count; ++i) {
        next[i] = sense(model.hands[i], state, state.hands[i], readings[i], outputs[i].frame, watch);
        X_WT[i] = model.hands[i].hasWeight() ? state.hands[i].X_WR : outputs[i].frame.X_WH;
    }
    const std::size_t first = static_cast<std::size_t>(state.tick) % count;
    const Turns turns = balanceHands(model.hands, state.hands, std::span(X_WT).first(count), first, state.balance);
    std::uint32_t spared = 0;  // by those who had their turn
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t hand = turns[i];
        const HandModel& own = model.hands[hand];
        const std::uint32_t work = mostWork(own) / static_cast<std::uint32_t>(count) + spared;
        state.hands[hand].work = work;
        takeTurn(own, state, state.hands[hand], next[hand], outputs[hand], watch);
        spared = work - std::min(work, workDone(own, outputs[hand].frame));
    }
    for (const TickOutput& output : outputs) mixOutputs(state.hash, output.frame, output.X_WG);
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
    record.navigation_clutched = frame.clutched ? 1u : 0u;
    record.navigation_scale = static_cast<float>(frame.scale);
    store(record.navigation_offset_m, frame.offset);
    store(record.navigation_quaternion, frame.turn);
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
