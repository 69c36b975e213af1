#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/loop/haptic_loop.h"
#include "devices/simulated/hand_params.h"
#include "devices/simulated/presets.h"
#include "study/person/simulated_person.h"
#include "study/run/cue_delivery.h"
#include "study/run/files/builds.h"
#include "study/run/files/built_scenes.h"
#include "study/run/files/watched_store.h"
#include "study/run/person/performer.h"
#include "study/run/shown_overlap.h"
#include "study/run/units/unit_rack.h"
#include "study/session/apparatus.h"

namespace passung::run {

enum class Clock { Virtual, RealTime };

/// The session's apparatus: the haptic loop on a simulated device with a simulated hand, in either clock, or on what a
/// performer holds, or on the station's real devices, which only people hold, in real time. Where the program does not
/// time the trial the hand has left the device: real parts, or nothing.
class LoopApparatus final : public session::Apparatus {
public:
    LoopApparatus(const simulated::DeviceParams& device, const person::SimulatedPerson& person, Clock clock,
                  Performer* performer = nullptr, const ImportLimits& import_limits = {}, BuildWatch told = {},
                  UnitRack* rack = nullptr);
    ~LoopApparatus() override;

    /// The next person takes the device: as newly made, but for what is kept of parts. Between sessions.
    void passTo(const person::SimulatedPerson& person);

    const DeviceDescription& device() const override { return description_; }
    Result<std::vector<session::StageNote>> prepare(const plan::Condition& condition, std::uint64_t seed,
                                                    std::int64_t trials_before) override;
    void wait(std::int64_t ticks) override;
    void start() override;
    void advance(std::int64_t ticks) override;
    std::size_t takeRecords(std::span<TickRecord> into) override;
    std::size_t takeRecordsOf(std::size_t hand, std::span<TickRecord> into) override;
    session::LoopHealth stop() override;
    bool measureOverlaps(std::span<const TickRecord> trial, std::span<const std::vector<TickRecord>> others,
                         std::span<measures::TickOverlap> ticks) override;
    void halt() override;
    void rearm() override;
    std::vector<session::DeviceNews> takeDeviceNews() override;
    std::string deviceNotReady(bool or_there) const override;

private:
    struct HeldDevice {
        std::unique_ptr<loop::HapticDevice> device;
        simulated::SimulatedDevice* person = nullptr;  // who holds it; null: nobody simulated
    };

    /// A hand's device and what it records.
    struct Hand {
        HeldDevice held;
        std::unique_ptr<loop::RecordRing> ring;
    };

    /// Everything of one attempt; members are destroyed in reverse order, the thread first.
    struct Run {
        BuiltScenes scenes;
        std::vector<Hand> hands;
        CueDelivery cues;
        loop::HapticCycle cycle;
        std::unique_ptr<loop::RealTimeThread> thread;

        Run(BuiltScenes built, std::vector<Hand> of_scene, const plan::Condition& condition,
            std::span<loop::ScreenRing* const> screens, bool timed);
    };

    bool isSimulated() const;
    std::optional<session::Presentation> presentation() const;
    Result<BuiltScenes> build(const std::vector<session::RenderedScene>& scenes);
    HeldDevice makeDevice(const simulated::DeviceParams& preset, const plan::Condition& condition, BuiltParts parts,
                          std::uint64_t seed, std::int64_t trials_before) const;
    Result<std::vector<Hand>> makeHands(const plan::Condition& condition, BuiltParts parts, std::uint64_t seed,
                                        std::int64_t trials_before) const;
    HeldDevice makeOtherDevice(const simulated::DeviceParams& preset, const plan::Condition& condition,
                               BuiltParts parts, std::size_t hand, std::uint64_t seed,
                               std::int64_t trials_before) const;
    session::Delivered delivered(const std::optional<session::Presentation>& presentation) const;

    DeviceDescription described_, description_;  // of the device itself; as the newest attempt had it
    person::SimulatedPerson person_;
    Clock clock_;
    Performer* performer_;
    UnitRack* rack_;  // null: none is used
    std::unique_ptr<Builds> store_;
    WatchedStore watched_{store_.get()};
    scene::PartCache parts_{&watched_};
    ShownOverlap overlap_;
    std::mutex halt_mutex_;  // run_ and its thread come and go, halted_ changes
    bool halted_ = false;
    std::int64_t started_ns_ = 0;             // on the steady clock, of the newest attempt's loop; 0: it did not start
    std::int64_t periods_ = 0;                // since then, as the records tell
    std::optional<std::int64_t> engaged_at_;  // [periods], when the hand had reached the start pose
    std::unique_ptr<Run> run_;
};

/// What runs in the ticks of these scenes, and why, each once; then what runs in none of them.
std::vector<session::StageNote> stageNotes(const tick::SceneModels& models);

}  // namespace passung::run
