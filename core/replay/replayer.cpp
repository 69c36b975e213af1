#include "core/replay/replayer.h"

#include <array>
#include <bit>
#include <cmath>

namespace passung::replay {

namespace {

class Comparison {
public:
    explicit Comparison(std::int64_t tick) : tick_(tick) {}

    void field(const char* name, float recorded, float replayed) {
        if (std::bit_cast<std::uint32_t>(recorded) == std::bit_cast<std::uint32_t>(replayed)) return;
        report(name, static_cast<double>(recorded), static_cast<double>(replayed));
    }
    void field(const char* name, std::uint32_t recorded, std::uint32_t replayed) {
        if (recorded != replayed) report(name, recorded, replayed);
    }
    /// One NaN is as another: a recording from before the gap was recorded has its reader's.
    void gap(float recorded, float replayed) {
        if (!(std::isnan(recorded) && std::isnan(replayed))) field("proxy_gap_m", recorded, replayed);
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
    comparison.gap(recorded.proxy_gap_m, replayed.proxy_gap_m);
    comparison.field("energy_J", recorded.energy_J, replayed.energy_J);
    comparison.field("quality", recorded.quality, replayed.quality);
    comparison.field("status", recorded.status, replayed.status);
    comparison.field("contacts", recorded.contacts, replayed.contacts);
    comparison.field("iterations", recorded.iterations, replayed.iterations);
    comparison.field("nodes_visited", recorded.nodes_visited, replayed.nodes_visited);
    return comparison.difference;
}

}  // namespace

ReplayReport replay(const scene::Scene& scene, std::span<const TickRecord> records) {
    const tick::SceneModels models(scene);
    return replay(std::array{tick::SceneTurn{&models[0]}}, records);
}

ReplayReport replay(std::span<const tick::SceneTurn> turns, std::span<const TickRecord> records) {
    tick::SceneSequence scenes(turns);
    ReplayReport report;
    for (const TickRecord& recorded : records) {
        const std::int64_t tick = scenes.tick();
        const DeviceReading reading = tick::readingOf(recorded);
        const TickRecord replayed = tick::makeRecord(tick, reading, scenes.step(reading));
        if (!report.first_difference) report.first_difference = compare(recorded, replayed);
        ++report.ticks;
    }
    report.state_hash = scenes.hash();
    report.pairs = scenes.pairs();
    return report;
}

}  // namespace passung::replay
