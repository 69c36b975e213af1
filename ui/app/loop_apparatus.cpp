#include "ui/app/loop_apparatus.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "devices/simulated/resting_device.h"
#include "devices/simulated/simulated_device.h"
#include "study/session/secondary.h"
#include "ui/app/frame_clock.h"
#include "ui/app/responding_device.h"
#include "ui/app/simulated_hand.h"
#include "ui/app/visible_task.h"

namespace passung::app {

namespace {

constexpr std::size_t kRingRecords = 8192;  // eight seconds: a writer that stalls for longer shows in the data

/// Of each scene in turn: its obstacles, then what none pushed.
std::vector<session::ContactEnergy> contactEnergy(std::span<const model::Scene> scenes,
                                                  std::span<const tick::PairAccount> pairs) {
    std::vector<session::ContactEnergy> energy;
    for (const model::Scene& scene : scenes) {
        for (std::size_t i = 0; i < scene.spec.parts.size(); ++i)
            if (i != scene.held) energy.push_back({.obstacle = scene.spec.parts[i].name});
        energy.emplace_back();
    }
    for (std::size_t i = 0; i < energy.size(); ++i) {
        energy[i].taken_in_J = pairs[i].taken_in;
        energy[i].least_J = pairs[i].least;
    }
    return energy;
}

}  // namespace

std::vector<session::StageNote> stageNotes(const tick::TickModel& model) {
    std::vector<session::StageNote> notes;
    for (const tick::Stage& stage : model.stages) notes.push_back({stage.name, stage.reason});
    return notes;
}

LoopApparatus::Run::Run(BuiltScenes built, std::unique_ptr<loop::HapticDevice> held, bool show_proxy,
                        std::span<loop::ScreenRing* const> screens)
    : scenes(std::move(built)),
      device(std::move(held)),
      ring(kRingRecords),
      cycle(scenes.turns, *device, ring, show_proxy, screens) {}

LoopApparatus::LoopApparatus(const simulated::DeviceParams& device, const person::SimulatedPerson& person, Clock clock,
                             Performer* performer)
    : description_(performer == nullptr ? simulated::describe(device) : performer->describe(device)),
      person_(person),
      clock_(clock),
      performer_(performer) {}

LoopApparatus::~LoopApparatus() = default;

/// What the person sees; of a pair whose stimulus a staircase chose, also which interval they will name.
simulated::VisibleTask LoopApparatus::taskOf(const protocol::Condition& condition, std::uint64_t seed,
                                             std::int64_t trials_before) const {
    constexpr double kOneOfTwo = 0.5;
    simulated::VisibleTask task = visibleTask(condition);
    auto* pair = std::get_if<simulated::CompareGoal>(&task.goal);
    if (pair == nullptr || !perception_) return task;
    if (const auto noticed = perception_->notices(condition, trials_before, kOneOfTwo)) {
        const int comparison = session::comparisonInterval(seed);
        pair->told_answer = *noticed ? comparison : 3 - comparison;
    }
    return task;
}

Result<std::vector<session::StageNote>> LoopApparatus::prepare(const protocol::Condition& condition, std::uint64_t seed,
                                                               std::int64_t trials_before) {
    const simulated::DeviceParams* preset = simulated::findPreset(condition.device);
    if (preset == nullptr)
        return Error{.message = "no such device preset", .key = "device.preset", .value = condition.device};
    if (performer_ != nullptr) performer_->prepares(condition, trials_before, seed);
    auto scenes = build(session::renderedScenes(condition, seed));
    if (!scenes) return scenes.errors();
    auto device = makeDevice(*preset, condition, seed, trials_before);
    description_ = device->description();
    auto run =
        std::make_unique<Run>(std::move(*scenes), std::move(device), condition.shown == protocol::ShownPose::Proxy,
                              performer_ == nullptr ? std::span<loop::ScreenRing* const>() : performer_->screens());
    {
        const std::lock_guard lock(halt_mutex_);
        run_.swap(run);
    }
    std::vector<session::StageNote> notes;  // of a pair the stages of both intervals, each once
    for (const tick::TickModel& model : run_->scenes.models)
        for (session::StageNote& note : stageNotes(model))
            if (std::none_of(notes.begin(), notes.end(), [&](const auto& known) { return known.name == note.name; }))
                notes.push_back(std::move(note));
    return notes;
}

Result<BuiltScenes> LoopApparatus::build(const std::vector<session::RenderedScene>& scenes) {
    std::size_t pieces = 0;
    for (const session::RenderedScene& scene : scenes)
        pieces += scene.spec.parts.size() * (scene.spec.contact.two_way ? 2 : 1);
    watched_.begin(pieces, [this](double share) { return performer_ == nullptr || performer_->builds(share); });
    try {
        return buildScenes(scenes, parts_);
    } catch (const BuildCancelled& cancelled) {
        return Error{.message = cancelled.what()};
    }
}

std::unique_ptr<loop::HapticDevice> LoopApparatus::makeDevice(const simulated::DeviceParams& preset,
                                                              const protocol::Condition& condition, std::uint64_t seed,
                                                              std::int64_t trials_before) const {
    const model::Registration& r = condition.scene.registration;
    const simulated::HandRegistration registration{r.X_WB, r.scale, r.X_DH};
    const simulated::VisibleTask task = taskOf(condition, seed, trials_before);
    const bool held = condition.timed_by == protocol::TimedBy::Program;
    std::unique_ptr<loop::HapticDevice> device;
    if (performer_ != nullptr) device = performer_->device(preset, condition);
    if (device != nullptr) return device;
    if (held)
        device = std::make_unique<simulated::SimulatedDevice>(preset, simulatedHand(person_, trials_before), task,
                                                              registration, seed);
    else
        device = std::make_unique<simulated::RestingDevice>(preset, registration.handleFromPart(task.X_WHeldStart));
    if (!condition.secondary.any()) return device;
    const bool handles = condition.timed_by != protocol::TimedBy::Clock;
    return std::make_unique<RespondingDevice>(std::move(device), session::detectionSettings(condition.secondary),
                                              person_, handles, seed);
}

void LoopApparatus::wait(std::int64_t ticks) {
    if (clock_ == Clock::RealTime) std::this_thread::sleep_for(std::chrono::nanoseconds(ticks * kTickNanoseconds));
}

void LoopApparatus::start() {
    started_ns_ = steadyNanoseconds();
    const std::lock_guard lock(halt_mutex_);
    if (clock_ == Clock::RealTime && !halted_)
        run_->thread = std::make_unique<loop::RealTimeThread>(run_->cycle, performer_ == nullptr);
}

void LoopApparatus::advance(std::int64_t ticks) {
    if (clock_ == Clock::Virtual) {
        const std::lock_guard lock(halt_mutex_);
        for (std::int64_t i = 0; i < ticks && !halted_; ++i) run_->cycle.run();
        return;
    }
    std::this_thread::sleep_for(std::chrono::nanoseconds(ticks * kTickNanoseconds));
}

std::size_t LoopApparatus::takeRecords(std::span<TickRecord> into) { return run_->ring.take(into); }

void LoopApparatus::halt() {
    const std::lock_guard lock(halt_mutex_);
    halted_ = true;
    if (run_ && run_->thread) run_->thread->askToStop();
}

void LoopApparatus::rearm() {
    const std::lock_guard lock(halt_mutex_);
    halted_ = false;
}

session::LoopHealth LoopApparatus::stop() {
    session::LoopHealth health;
    if (run_->thread) {
        run_->thread->stop();
        health.loop = run_->thread->scheduling().fifo ? "real-time fifo" : "real-time normal";
        health.overruns = run_->thread->overruns();
    } else {
        run_->cycle.release();
        health.loop = clock_ == Clock::Virtual ? "virtual" : "real-time normal";  // halted before it began
    }
    const loop::TimingHistogram& timing = run_->cycle.timing();
    health.ticks = run_->cycle.ticks();
    health.mean_us = timing.meanMicroseconds();
    health.sd_us = timing.deviationMicroseconds();
    health.p99_us = timing.quantileMicroseconds(0.99);
    health.p999_us = timing.quantileMicroseconds(0.999);
    health.max_us = timing.maxMicroseconds();
    health.dropped_records = run_->ring.dropped();
    health.histogram = timing.octaves();
    health.state_hash = run_->cycle.stateHash();
    health.contact_energy = contactEnergy(run_->scenes.scenes, run_->cycle.pairs());
    if (performer_ != nullptr) health.presentation = performer_->presented(started_ns_);
    return health;
}

}  // namespace passung::app
