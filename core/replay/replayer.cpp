#include "core/replay/replayer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>

namespace passung::replay {

namespace {

class Comparison {
public:
    explicit Comparison(std::int64_t tick) : tick_(tick) {}

    void field(const char* name, float recorded, float replayed) {
        if (std::bit_cast<std::uint32_t>(recorded) == std::bit_cast<std::uint32_t>(replayed)) return;
        report(name, static_cast<double>(recorded), static_cast<double>(replayed));
    }
    template <std::integral Number>
    void field(const char* name, Number recorded, Number replayed) {
        if (recorded != replayed) report(name, static_cast<double>(recorded), static_cast<double>(replayed));
    }
    /// One NaN is as another: a recording from before the value was recorded has its reader's.
    void known(const char* name, float recorded, float replayed) {
        if (!(std::isnan(recorded) && std::isnan(replayed))) field(name, recorded, replayed);
    }
    template <std::size_t N>
    void field(const char* name, const std::array<float, N>& recorded, const std::array<float, N>& replayed) {
        for (std::size_t i = 0; i < N && !difference; ++i) {
            field(name, recorded[i], replayed[i]);
            if (difference) difference->column += "[" + std::to_string(i) + "]";
        }
    }

    std::optional<Difference> difference;

private:
    void report(const char* name, double recorded, double replayed) {
        if (!difference) difference = Difference{tick_, name, recorded, replayed};
    }
    std::int64_t tick_;
};

std::optional<Difference> compare(const TickRecord& recorded, const TickRecord& replayed) {
    if (recorded.tick != replayed.tick) {
        return Difference{replayed.tick, "tick", static_cast<double>(recorded.tick),
                          static_cast<double>(replayed.tick)};
    }
    Comparison comparison(recorded.tick);
    comparison.field("hand_position_m", recorded.hand_position_m, replayed.hand_position_m);
    comparison.field("hand_quaternion", recorded.hand_quaternion, replayed.hand_quaternion);
    comparison.field("proxy_position_m", recorded.proxy_position_m, replayed.proxy_position_m);
    comparison.field("proxy_quaternion", recorded.proxy_quaternion, replayed.proxy_quaternion);
    comparison.field("force_N", recorded.force_N, replayed.force_N);
    comparison.field("torque_Nm", recorded.torque_Nm, replayed.torque_Nm);
    comparison.field("hand_depth_m", recorded.hand_depth_m, replayed.hand_depth_m);
    comparison.field("proxy_depth_m", recorded.proxy_depth_m, replayed.proxy_depth_m);
    if (recorded.held != kPartNotTold) {
        comparison.field("held", recorded.held, replayed.held);
        comparison.field("steps_done", recorded.steps_done, replayed.steps_done);
    }
    comparison.known("proxy_gap_m", recorded.proxy_gap_m, replayed.proxy_gap_m);
    comparison.known("navigation_scale", recorded.navigation_scale, replayed.navigation_scale);
    comparison.field("navigation_clutched", recorded.navigation_clutched, replayed.navigation_clutched);
    comparison.field("navigation_offset_m", recorded.navigation_offset_m, replayed.navigation_offset_m);
    comparison.field("navigation_quaternion", recorded.navigation_quaternion, replayed.navigation_quaternion);
    if (recorded.effects != 0) {
        comparison.field("effects", recorded.effects, replayed.effects);
        comparison.known("guided", recorded.guided, replayed.guided);
        for (std::size_t i = 0; i < kWrenchEffects; ++i)
            comparison.field("effect_wrench", recorded.effect_wrench[i], replayed.effect_wrench[i]);
    }
    comparison.field("energy_J", recorded.energy_J, replayed.energy_J);
    comparison.field("quality", recorded.quality, replayed.quality);
    comparison.field("status", recorded.status, replayed.status);
    comparison.field("contacts", recorded.contacts, replayed.contacts);
    comparison.field("iterations", recorded.iterations, replayed.iterations);
    comparison.field("nodes_visited", recorded.nodes_visited, replayed.nodes_visited);
    return comparison.difference;
}

/// Tells in which hand it is; of the first one nothing needs to be told.
std::optional<Difference> ofHand(std::size_t hand, std::optional<Difference> difference) {
    if (difference && hand > 0) difference->column = "hand " + std::to_string(hand + 1) + ": " + difference->column;
    return difference;
}

/// The first hand that has no record number `i`, of `tick`: nobody knows what the tick computed from.
std::optional<Difference> missingTick(std::span<const std::vector<TickRecord>> hands, std::size_t i,
                                      std::int64_t tick) {
    for (std::size_t hand = 0; hand < hands.size(); ++hand)
        if (i >= hands[hand].size())
            return ofHand(hand, Difference{tick, "tick", std::nan(""), static_cast<double>(tick)});
    return std::nullopt;
}

}  // namespace

ReplayReport replay(const scene::Scene& scene, std::span<const TickRecord> records) {
    const tick::SceneModels models(scene);
    return replay(std::array{tick::SceneTurn{&models[0]}}, records);
}

ReplayReport replay(std::span<const tick::SceneTurn> turns, std::span<const TickRecord> records) {
    return replayHands(turns, std::array{std::vector<TickRecord>(records.begin(), records.end())});
}

ReplayReport replayHands(std::span<const tick::SceneTurn> turns, std::span<const std::vector<TickRecord>> hands) {
    tick::SceneSequence scenes(turns);
    ReplayReport report;
    std::vector<DeviceReading> readings(hands.size());
    std::vector<tick::TickOutput> outputs(hands.size());
    std::size_t ticks = 0;
    for (const auto& records : hands) ticks = std::max(ticks, records.size());
    for (std::size_t i = 0; i < ticks; ++i) {
        const std::int64_t tick = scenes.tick();
        for (std::size_t hand = 0; hand < hands.size(); ++hand)
            if (i < hands[hand].size()) readings[hand] = tick::readingOf(hands[hand][i]);
        scenes.step(readings, outputs);
        if (!report.first_difference) report.first_difference = missingTick(hands, i, tick);
        for (std::size_t hand = 0; hand < hands.size() && !report.first_difference; ++hand)
            report.first_difference =
                ofHand(hand, compare(hands[hand][i], tick::makeRecord(tick, readings[hand], outputs[hand])));
        ++report.ticks;
    }
    report.state_hash = scenes.hash();
    report.pairs = scenes.pairs();
    return report;
}

}  // namespace passung::replay
