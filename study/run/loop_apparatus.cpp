#include "study/run/loop_apparatus.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "core/base/random.h"
#include "core/scene/contact_geometry.h"
#include "devices/simulated/resting_device.h"
#include "devices/simulated/simulated_device.h"
#include "study/run/machine/frame_clock.h"
#include "study/run/person/responding_device.h"
#include "study/run/person/simulated_hand.h"
#include "study/run/visible_task.h"
#include "study/session/cue_settings.h"
#include "study/session/secondary.h"

namespace passung::run {

namespace {

constexpr std::size_t kRingRecords = 8192;  // eight seconds: a writer that stalls for longer shows in the data

/// Of each scene in turn and each of its hands: its obstacles, then what none pushed.
std::vector<session::ContactEnergy> contactEnergy(std::span<const scene::Scene> scenes,
                                                  std::span<const tick::PairAccount> pairs) {
    std::vector<session::ContactEnergy> energy;
    for (const scene::Scene& scene : scenes) {
        const scene::SceneSpec& spec = scene.spec;
        for (std::size_t hand = 0; hand < spec.handCount(); ++hand) {
            const std::string name = spec.hand(hand).name;
            for (const std::size_t i : spec.obstaclesOf(hand))
                energy.push_back({.obstacle = spec.parts[i].name, .hand = name});
            energy.push_back({.obstacle = "", .hand = name});
        }
    }
    for (std::size_t i = 0; i < energy.size(); ++i) {
        energy[i].taken_in_J = pairs[i].taken_in;
        energy[i].least_J = pairs[i].least;
    }
    return energy;
}

/// What the loop asks of the hands.
template <class Hands>
std::vector<loop::HandPort> portsOf(const Hands& hands) {
    std::vector<loop::HandPort> ports;
    ports.reserve(hands.size());
    for (const auto& hand : hands) ports.push_back({hand.held.device.get(), hand.ring.get()});
    return ports;
}

}  // namespace

std::vector<session::StageNote> stageNotes(const tick::SceneModels& models) {
    std::vector<session::StageNote> notes;
    const auto add = [&notes](const char* name, const char* reason, bool runs) {
        if (std::none_of(notes.begin(), notes.end(), [&](const auto& known) { return known.name == name; }))
            notes.push_back({name, reason, runs});
    };
    for (std::size_t i = 0; i < models.size(); ++i)
        for (const tick::Stage& stage : models.stages(i)) add(stage.name, stage.reason, true);
    for (std::size_t i = 0; i < models.size(); ++i)
        for (const tick::SparedStage& stage : models.spared(i)) add(stage.name, stage.reason, false);
    return notes;
}

LoopApparatus::Run::Run(BuiltScenes built, std::vector<Hand> of_scene, const plan::Condition& condition,
                        std::span<loop::ScreenRing* const> screens, bool timed)
    : scenes(std::move(built)),
      hands(std::move(of_scene)),
      cues(session::cueSettings(condition.cues), hands.front().held.person, hands.front().held.device->pushesHand()),
      cycle(scenes.turns, portsOf(hands), condition.shown == plan::ShownPose::Proxy, screens, &cues, timed) {}

LoopApparatus::LoopApparatus(const simulated::DeviceParams& device, const person::SimulatedPerson& person, Clock clock,
                             Performer* performer, const ImportLimits& import_limits, BuildWatch told, UnitRack* rack)
    : described_(rack != nullptr && !rack->empty() ? rack->description()
                 : performer == nullptr            ? simulated::describe(device)
                                                   : performer->describe(device)),
      description_(described_),
      person_(person),
      clock_(clock),
      performer_(performer),
      rack_(rack),
      store_(openBuilds(import_limits, std::move(told))) {}

LoopApparatus::~LoopApparatus() = default;

void LoopApparatus::passTo(const person::SimulatedPerson& person) {
    {
        const std::lock_guard lock(halt_mutex_);
        run_.reset();
        halted_ = false;
    }
    description_ = described_;
    person_ = person;
    started_ns_ = periods_ = 0;
    engaged_at_.reset();
}

Result<std::vector<session::StageNote>> LoopApparatus::prepare(const plan::Condition& condition, std::uint64_t seed,
                                                               std::int64_t trials_before) {
    started_ns_ = periods_ = 0;
    engaged_at_.reset();
    if (performer_ != nullptr) performer_->prepares(condition, trials_before, seed);
    auto scenes = build(session::renderedScenes(condition, seed));
    if (!scenes) return scenes.errors();
    auto hands = makeHands(condition, scenes->scenes.front().parts, seed, trials_before);
    if (!hands) return hands.errors();
    description_ = hands->front().held.device->description();
    auto run =
        std::make_unique<Run>(std::move(*scenes), std::move(*hands), condition,
                              performer_ == nullptr ? std::span<loop::ScreenRing* const>() : performer_->screens(),
                              clock_ == Clock::RealTime || performer_ != nullptr);
    {
        const std::lock_guard lock(halt_mutex_);
        run_.swap(run);
    }
    if (performer_ != nullptr) performer_->awaitPicture();  // no clock runs before
    return stageNotes(run_->scenes.models);
}

Result<BuiltScenes> LoopApparatus::build(const std::vector<session::RenderedScene>& scenes) {
    std::size_t pieces = 0;
    for (const session::RenderedScene& scene : scenes)
        if (scene::geometryOf(scene.spec).geometry == scene::Geometry::Field)
            pieces += scene.spec.parts.size() * (scene.spec.contact.two_way ? 2 : 1);
    watched_.begin(pieces, [this](double share) { return performer_ == nullptr || performer_->builds(share); });
    try {
        return buildScenes(scenes, parts_);
    } catch (const BuildCancelled& cancelled) {
        return Error{.message = cancelled.what()};
    }
}

Result<std::vector<LoopApparatus::Hand>> LoopApparatus::makeHands(const plan::Condition& condition, BuiltParts parts,
                                                                  std::uint64_t seed,
                                                                  std::int64_t trials_before) const {
    std::vector<Hand> hands;
    for (std::size_t i = 0; i < condition.scene.handCount(); ++i) {
        const std::string& name = i == 0 ? condition.device : condition.other_devices.at(i - 1);
        const simulated::DeviceParams* preset = simulated::findPreset(name);
        if (preset == nullptr) return Error{.message = "no such device preset", .key = "device.preset", .value = name};
        hands.push_back({i == 0 ? makeDevice(*preset, condition, parts, seed, trials_before)
                                : makeOtherDevice(*preset, condition, parts, i, seed, trials_before),
                         std::make_unique<loop::RecordRing>(kRingRecords)});
    }
    return hands;
}

/// Held by the simulated person's other hand; by nobody where a person takes part, who has one device.
LoopApparatus::HeldDevice LoopApparatus::makeOtherDevice(const simulated::DeviceParams& preset,
                                                         const plan::Condition& condition, BuiltParts parts,
                                                         std::size_t hand, std::uint64_t seed,
                                                         std::int64_t trials_before) const {
    const scene::Registration r = condition.scene.hand(hand).registration;
    const simulated::HandRegistration registration{r.X_WB, r.scale, r.X_DH};
    const simulated::VisibleTask task = otherTask(condition, hand, parts);
    HeldDevice held;
    if (rack_ != nullptr) held.device = rack_->lend(condition, hand, registration.handleFromPart(task.X_WHeldStart));
    if (held.device != nullptr) return held;
    if (!isSimulated() || condition.timed_by != plan::TimedBy::Program) {
        held.device =
            std::make_unique<simulated::RestingDevice>(preset, registration.handleFromPart(task.X_WHeldStart));
        return held;
    }
    auto device =
        std::make_unique<simulated::SimulatedDevice>(preset, simulatedHand(person_, trials_before), task, registration,
                                                     fnv1a64(fmt::format("hand {} {}", hand, seed)));
    held.person = device.get();
    held.device = std::move(device);
    return held;
}

LoopApparatus::HeldDevice LoopApparatus::makeDevice(const simulated::DeviceParams& preset,
                                                    const plan::Condition& condition, BuiltParts parts,
                                                    std::uint64_t seed, std::int64_t trials_before) const {
    const scene::Registration& r = condition.scene.registration;
    const simulated::HandRegistration registration{r.X_WB, r.scale, r.X_DH};
    const simulated::VisibleTask task = visibleTask(condition, parts);
    HeldDevice held;
    if (rack_ != nullptr) held.device = rack_->lend(condition, 0, registration.handleFromPart(task.X_WHeldStart));
    if (held.device == nullptr && performer_ != nullptr) held.device = performer_->device(preset, condition);
    if (held.device != nullptr) return held;
    if (condition.timed_by == plan::TimedBy::Program) {
        auto device = std::make_unique<simulated::SimulatedDevice>(preset, simulatedHand(person_, trials_before), task,
                                                                   registration, seed);
        held.person = device.get();
        held.device = std::move(device);
    } else {
        held.device =
            std::make_unique<simulated::RestingDevice>(preset, registration.handleFromPart(task.X_WHeldStart));
    }
    if (!condition.secondary.any()) return held;
    const bool handles = condition.timed_by != plan::TimedBy::Clock;
    held.device = std::make_unique<RespondingDevice>(
        std::move(held.device), session::detectionSettings(condition.secondary), person_, handles, seed);
    return held;
}

/// Nobody but a simulated person holds a device.
bool LoopApparatus::isSimulated() const {
    return performer_ == nullptr || performer_->kind() == plan::ParticipantKind::Simulated;
}

/// What windows drew and played, or what a simulated person's senses took. No device has an actuator for vibration yet.
session::Delivered LoopApparatus::delivered(const std::optional<session::Presentation>& presentation) const {
    const session::Delivered& asked = run_->cues.asked();
    if (isSimulated()) {
        session::Delivered delivered = asked;
        if (asked.masking > 0) delivered.sound = 0;  // noise covers it
        return delivered;
    }
    session::Delivered delivered{.force = asked.force};
    if (presentation) delivered.visual = presentation->cue_frames.value_or(0);
    if (presentation && presentation->sound == "played") {
        delivered.sound = asked.sound;
        delivered.masking = asked.masking;
    }
    return delivered;
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

std::size_t LoopApparatus::takeRecords(std::span<TickRecord> into) {
    const std::size_t count = run_->hands.front().ring->take(into);
    for (const TickRecord& record : into.first(count)) {
        periods_ += record.periods;
        if (!engaged_at_ && (record.status & kEngaged) != 0) engaged_at_ = periods_;
    }
    return count;
}

std::size_t LoopApparatus::takeRecordsOf(std::size_t hand, std::span<TickRecord> into) {
    return run_->hands.at(hand).ring->take(into);
}

void LoopApparatus::halt() {
    const std::lock_guard lock(halt_mutex_);
    halted_ = true;
    if (run_ && run_->thread) run_->thread->askToStop();
}

void LoopApparatus::rearm() {
    {
        const std::lock_guard lock(halt_mutex_);
        halted_ = false;
    }
    if (rack_ != nullptr) rack_->arm();
}

std::vector<session::DeviceNews> LoopApparatus::takeDeviceNews() {
    return rack_ == nullptr ? std::vector<session::DeviceNews>{} : rack_->takeNews();
}

std::string LoopApparatus::deviceNotReady(bool or_there) const {
    return rack_ == nullptr ? std::string() : rack_->notReady(or_there);
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
    const loop::TimingHistogram& processor = run_->cycle.processorTiming();
    health.processor_mean_us = processor.meanMicroseconds();
    health.processor_p99_us = processor.quantileMicroseconds(0.99);
    health.processor_p999_us = processor.quantileMicroseconds(0.999);
    health.processor_max_us = processor.maxMicroseconds();
    for (const Hand& hand : run_->hands) health.dropped_records += hand.ring->dropped();
    health.histogram = timing.octaves();
    health.state_hash = run_->cycle.stateHash();
    health.contact_energy = contactEnergy(run_->scenes.scenes, run_->cycle.pairs());
    if (performer_ != nullptr) health.presentation = presentation();
    health.delivered = delivered(health.presentation);
    return health;
}

bool LoopApparatus::measureOverlaps(std::span<const TickRecord> trial, std::span<const std::vector<TickRecord>> others,
                                    std::span<measures::TickOverlap> ticks) {
    return overlap_.measure(run_->scenes, trial, others, ticks);
}

/// Of the trial's time; of the attempt's where it did not start or the program does not see it start.
std::optional<session::Presentation> LoopApparatus::presentation() const {
    const std::int64_t zero_ns = started_ns_ == 0 ? steadyNanoseconds() : started_ns_;
    return performer_->presented(zero_ns, zero_ns + engaged_at_.value_or(0) * kTickNanoseconds,
                                 zero_ns + periods_ * kTickNanoseconds);
}

}  // namespace passung::run
