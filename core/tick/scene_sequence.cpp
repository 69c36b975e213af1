#include "core/tick/scene_sequence.h"

#include <algorithm>

#include "core/base/assert.h"
#include "core/tick/tick_model.h"
#include "core/tick/tick_state.h"

namespace passung::tick {

namespace {

std::size_t bytesOf(const closed_form::SmoothSolid& solid) noexcept {
    std::size_t bytes = sizeof(solid) + (solid.edges.size() + solid.cores.size()) * sizeof(closed_form::Curve);
    for (const closed_form::Lump& lump : solid.lumps)
        bytes += sizeof(lump) + lump.faces.size() * sizeof(closed_form::Face);
    return bytes;
}

}  // namespace

SceneModels::SceneModels() = default;

SceneModels::SceneModels(std::span<const scene::Scene> scenes) {
    models_.reserve(scenes.size());
    for (const scene::Scene& scene : scenes) models_.push_back(makeModel(scene));
}

SceneModels::SceneModels(SceneModels&&) noexcept = default;

SceneModels& SceneModels::operator=(SceneModels&&) noexcept = default;

SceneModels::~SceneModels() = default;

std::size_t SceneModels::size() const noexcept { return models_.size(); }

const TickModel& SceneModels::operator[](std::size_t i) const noexcept { return models_[i]; }

std::vector<Stage> SceneModels::stages(std::size_t i) const {
    const TickModel& model = models_[i];
    std::vector<Stage> all = model.hands.front().stages;
    const auto add = [&all](const HandModel& hand) {
        auto place = all.begin();
        for (const Stage& stage : hand.stages) {
            const auto known = std::find_if(all.begin(), all.end(), [&](const Stage& s) { return s.run == stage.run; });
            place = (known != all.end() ? known : all.insert(place, stage)) + 1;
        }
    };
    for (const HandModel& hand : model.hands) add(hand);
    for (const auto* held : {&model.carrying, &model.following})
        for (const auto& of_hand : *held)
            if (!of_hand.empty()) add(of_hand.front());
    return all;
}

std::vector<SparedStage> SceneModels::spared(std::size_t i) const {
    const std::vector<Stage> run = stages(i);
    const TickModel& model = models_[i];
    const bool begins_empty = !model.hands.front().hasPart() && model.canPick(0);
    std::vector<SparedStage> spared = (begins_empty ? model.carrying.front() : model.hands).front().spared;
    std::erase_if(spared, [&](const SparedStage& stage) {
        return std::any_of(run.begin(), run.end(), [&](const Stage& other) { return other.name == stage.name; });
    });
    if (!model.picks()) spared.push_back({"picking up", "effects.pick is not set: hands keep what they hold"});
    return spared;
}

std::size_t SceneModels::memoryBytes(std::size_t i) const noexcept {
    std::size_t bytes = 0;
    const World& world = models_[i].world;
    for (const HandModel& hand : models_[i].hands)
        if (hand.hasSurfaces()) bytes += hand.held_surface->memoryBytes();
    for (const geometry::ClusterTree& still : world.still_surface) bytes += still.memoryBytes();
    for (const Body& body : world.bodies)
        if (body.solid) bytes += bytesOf(*body.solid);
    return bytes;
}

SceneSequence::SceneSequence(std::span<const SceneTurn> turns) : turns_(turns.begin(), turns.end()) {
    states_.reserve(turns_.size());
    for (const SceneTurn& turn : turns_) states_.push_back(makeState(*turn.model));
}

SceneSequence::~SceneSequence() = default;

std::int64_t SceneSequence::tick() const noexcept { return states_[current_].tick; }

std::uint64_t SceneSequence::hash() const noexcept { return states_[current_].hash; }

PartAtRest SceneSequence::atRest(std::uint64_t turn) const noexcept {
    const TickModel& model = *turns_[current_].model;
    const TickState& state = states_[current_];
    if (!model.picks()) return {};
    const std::size_t body = model.pickable[turn % model.pickable.size()];
    for (const Hold& hold : state.holds)
        if (hold.body == body) return {};
    return {static_cast<std::int32_t>(body), state.X_WP[body]};
}

std::vector<PairAccount> SceneSequence::pairs() const {
    std::vector<PairAccount> all;
    for (std::size_t turn = 0; turn < turns_.size(); ++turn) {
        const TickModel& model = *turns_[turn].model;
        for (std::size_t hand = 0; hand < model.hands.size(); ++hand) {
            const auto& pairs = states_[turn].hands[hand].pairs;
            for (std::size_t i = 0; i < pairs.size(); ++i)
                if (i != model.hands[hand].body || model.canPick(hand)) all.push_back(pairs[i]);
        }
    }
    return all;
}

void SceneSequence::step(std::span<const DeviceReading> readings, std::span<TickOutput> outputs) noexcept {
    PASSUNG_ASSERT(readings.size() == turns_[current_].model->hands.size() && outputs.size() == readings.size());
    if (engaged_) rendered_ += readings.front().periods;
    if (engaged_ && rendered_ >= turns_[current_].periods && current_ + 1 < turns_.size()) {
        const TickState& before = states_[current_];
        TickState& next = states_[++current_];
        next.tick = before.tick;
        next.hash = before.hash;
        engaged_ = false;
        rendered_ = 0;
    }
    tick::step(*turns_[current_].model, states_[current_], readings, outputs);
    engaged_ = engaged_ || std::all_of(outputs.begin(), outputs.end(),
                                       [](const TickOutput& output) { return (output.frame.status & kEngaged) != 0; });
}

TickOutput SceneSequence::step(const DeviceReading& reading) noexcept {
    TickOutput output;
    step(std::span(&reading, 1), std::span(&output, 1));
    return output;
}

}  // namespace passung::tick
