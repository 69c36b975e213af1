#include "study/run/shown_overlap.h"

#include <algorithm>
#include <map>
#include <vector>

#include "study/measures/overlap.h"
#include "study/measures/parts_watch.h"
#include "study/session/hands_view.h"

namespace passung::run {
namespace {

constexpr double kTolerance = 2e-6;                   // of a depth [m]
constexpr double kShare = 0.03;                       // of a depth besides
constexpr double kIgnored = measures::kLeastOverlap;  // of a depth [m]
constexpr std::size_t kMostPieces = 800'000;          // of a trial: a fifth of a second
constexpr std::size_t kMostOfAssembly = 16'000'000;   // of one that takes minutes, among many parts
constexpr std::size_t kMostPiecesOfTick = 20'000;     // of surfaces

bool areEngaged(const TickRecord& record, std::span<const TickRecord* const> others) {
    return (record.status & kEngaged) != 0 && std::all_of(others.begin(), others.end(), [](const TickRecord* other) {
               return other != nullptr && (other->status & kEngaged) != 0;
           });
}

/// The parts in hands, each once.
std::vector<std::size_t> heldIn(const measures::PartsWatch& parts, std::size_t hands) {
    std::vector<std::size_t> held;
    for (std::size_t hand = 0; hand < hands; ++hand)
        if (const auto part = parts.heldBy(hand); part && std::find(held.begin(), held.end(), *part) == held.end())
            held.push_back(*part);
    return held;
}

/// Which scene rendered each record: the turns as in tick::SceneSequence, from records alone.
class TurnOf {
public:
    explicit TurnOf(std::span<const tick::SceneTurn> turns) : turns_(turns) {}

    /// `engaged`: all hands in this record's tick.
    std::size_t next(const TickRecord& record, bool engaged) {
        if (engaged_) rendered_ += record.periods;
        if (engaged_ && current_ + 1 < turns_.size() && rendered_ >= turns_[current_].periods) {
            ++current_;
            engaged_ = false;
            rendered_ = 0;
        }
        engaged_ = engaged_ || engaged;
        return current_;
    }

private:
    std::span<const tick::SceneTurn> turns_;
    std::size_t current_ = 0;
    bool engaged_ = false;
    std::int64_t rendered_ = 0;
};

}  // namespace

bool ShownOverlap::measure(const BuiltScenes& scenes, std::span<const TickRecord> trial,
                           std::span<const std::vector<TickRecord>> others, std::span<measures::TickOverlap> ticks) {
    std::vector<truth::SceneOverlap> of_scenes;
    for (const scene::Scene& scene : scenes.scenes) of_scenes.emplace_back(scene, bodies_);
    if (std::none_of(of_scenes.begin(), of_scenes.end(), [](const auto& scene) { return scene.hasObstacles(); }))
        return false;
    struct Shown {
        std::size_t scene = 0;
        std::vector<std::size_t> held;  // parts in hands, each once
        std::vector<Pose> X_WP;         // of every part of that scene
    };
    std::vector<measures::PartsWatch> parts;
    for (const scene::Scene& scene : scenes.scenes) parts.emplace_back(scene.spec);
    std::map<std::int64_t, Shown> shown;
    for (const measures::TickOverlap& tick : ticks) shown[tick.tick] = {};
    TurnOf turn(scenes.turns);
    auto judged = shown.begin();
    for (const TickRecord& record : trial) {
        std::vector<const TickRecord*> beside;
        for (const auto& records : others) beside.push_back(session::recordAt(records, record.tick));
        const std::size_t scene = turn.next(record, areEngaged(record, beside));
        std::vector<const TickRecord*> hands{&record};
        hands.insert(hands.end(), beside.begin(), beside.end());
        parts[scene].follow(hands);
        while (judged != shown.end() && judged->first < record.tick) ++judged;
        if (judged == shown.end() || judged->first != record.tick) continue;
        judged->second = {scene, heldIn(parts[scene], hands.size()), parts[scene].poses()};
    }
    // Those that are likely the deepest first, should the work not suffice for all.
    std::vector<measures::TickOverlap*> order;
    for (measures::TickOverlap& tick : ticks) order.push_back(&tick);
    std::stable_sort(order.begin(), order.end(), [](const auto* a, const auto* b) {
        return 2 * a->largest_depth + a->largest_force > 2 * b->largest_depth + b->largest_force;
    });
    const bool picks = scenes.scenes.front().spec.effects.picks();
    std::size_t left = picks ? kMostOfAssembly : kMostPieces;
    for (measures::TickOverlap* tick : order) {
        const Shown& there = shown.at(tick->tick);
        truth::SceneOverlap& scene = of_scenes[there.scene];
        for (std::size_t part = 0; part < there.X_WP.size(); ++part) scene.place(part, there.X_WP[part]);
        const truth::Overlap found = scene.of(there.held, {.tolerance = kTolerance,
                                                           .share = kShare,
                                                           .ignore = kIgnored,
                                                           .most_pieces = std::min(left, kMostPiecesOfTick)});
        tick->depth = found.depth;
        tick->bound = found.bound;
        left -= std::min(left, found.pieces);
    }
    return true;
}

}  // namespace passung::run
