#include "study/run/loop_apparatus.h"
#include "study/run/files/known_names.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "devices/simulated/simulated_device.h"
#include "study/protocol/protocol_reader.h"
#include "study/run/person/performer.h"
#include "study/run/person/simulated_hand.h"
#include "study/run/visible_task.h"
#include "tests/ui/cli/small_study.h"

namespace passung::run {
namespace {

using Names = std::vector<std::string>;

/// The small study's conditions: "none" is rendered by penalty, "fair" by the god object heuristic.
const plan::Condition& condition(const std::string& name) {
    static const auto plan =
        protocol::readProtocolText(test::smallStudy(), "small.toml", knownDevices(), knownMeasures());
    for (const plan::Condition& c : plan->conditions) {
        if (c.name == name) return c;
    }
    throw std::runtime_error("no condition " + name);
}

LoopApparatus makeApparatus() { return {*simulated::findPreset("sigma7"), {}, Clock::Virtual}; }

Names stagesOf(const plan::Condition& c) {
    LoopApparatus apparatus = makeApparatus();
    const auto stages = apparatus.prepare(c, 1, 0);
    Names names;
    for (const session::StageNote& stage : *stages) {
        EXPECT_FALSE(stage.reason.empty()) << stage.name;
        if (stage.runs) names.push_back(stage.name);
    }
    return names;
}

/// Runs some ticks; all records and what stop() says.
std::pair<std::vector<TickRecord>, session::LoopHealth> runTicks(const plan::Condition& c, std::uint64_t seed,
                                                                 std::int64_t ticks) {
    LoopApparatus apparatus = makeApparatus();
    EXPECT_TRUE(apparatus.prepare(c, seed, 0));
    apparatus.start();
    std::vector<TickRecord> records;
    std::array<TickRecord, 64> buffer;
    for (std::int64_t done = 0; done < ticks; done += 20) {
        apparatus.advance(20);
        while (const std::size_t count = apparatus.takeRecords(buffer)) {
            records.insert(records.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(count));
        }
    }
    return {records, apparatus.stop()};
}

TEST(LoopApparatus, NamesTheStagesThatTheConditionCallsForAndNoOthers) {
    // Truth: invariant (what a scene does not name does not run)
    EXPECT_EQ(stagesOf(condition("none")), (Names{"input guard", "energy account", "start gate", "contacts at the hand",
                                                  "penalty wrench", "contact shares", "output limits"}));
    EXPECT_EQ(stagesOf(condition("fair")),
              (Names{"input guard", "energy account", "start gate", "closed-form proxy", "closed-form record",
                     "closed-form hand depth", "virtual coupling", "contact shares", "output limits"}));
    plan::Condition bare = condition("fair");
    bare.scene.start_gate = {};
    bare.scene.record_hand_depth = false;
    bare.scene.contact.proxy_filter = 100.0;
    bare.scene.limits.delay_ticks = 3;
    EXPECT_EQ(stagesOf(bare),
              (Names{"input guard", "energy account", "closed-form proxy", "closed-form filter", "closed-form record",
                     "virtual coupling", "contact shares", "output delay", "output limits"}));
}

/// Somebody of this kind takes part in windows; the device is held by a simulated hand all the same.
class Somebody final : public run::Performer {
public:
    Somebody(plan::ParticipantKind kind, std::string sound, std::optional<std::int64_t> coloured)
        : kind_(kind), sound_(std::move(sound)), coloured_(coloured) {}
    plan::ParticipantKind kind() const override { return kind_; }
    std::optional<session::Presentation> presented(std::int64_t, std::int64_t, std::int64_t) override {
        session::Presentation given;
        given.sound = sound_;
        given.cue_frames = coloured_;
        return given;
    }

private:
    plan::ParticipantKind kind_;
    std::string sound_;
    std::optional<std::int64_t> coloured_;  // pictures with the cue's colour
};

session::Delivered deliveredTo(plan::ParticipantKind kind, const std::string& sound, bool masking,
                               std::optional<std::int64_t> coloured = {}) {
    plan::Condition everything = condition("none");
    everything.cues.visual = everything.cues.vibrotactile = everything.cues.audio = true;
    everything.cues.masking_noise = masking;
    Somebody somebody(kind, sound, coloured);
    LoopApparatus apparatus(*simulated::findPreset("sigma7"), {}, Clock::Virtual, &somebody);
    EXPECT_TRUE(apparatus.prepare(everything, 7, 0));
    apparatus.start();
    std::array<TickRecord, 64> buffer;
    for (int i = 0; i < 400; ++i) {
        apparatus.advance(20);
        while (apparatus.takeRecords(buffer) > 0) {
        }
    }
    return apparatus.stop().delivered;
}

TEST(LoopApparatus, TellsWhatOfTheFeedbackReachedWhom) {
    // Truth: invariant: a simulated person's senses take everything, those of a person what was drawn, played and
    // acknowledged: no vibration as there is no actuator, no sound without output, no colour without a picture.
    using enum plan::ParticipantKind;
    const session::Delivered simulated = deliveredTo(Simulated, "silent", true);
    EXPECT_GT(simulated.force, 0);
    EXPECT_GT(simulated.visual, 0);
    EXPECT_GT(simulated.vibration, 10 * simulated.visual) << "colour comes with pictures";
    EXPECT_EQ(simulated.sound, 0) << "noise covers it";
    EXPECT_EQ(simulated.masking, 8000);
    EXPECT_GT(deliveredTo(Simulated, "silent", false).sound, 0);
    for (const auto kind : {Real, Pilot})
        for (const char* sound : {"silent", "played"}) {
            const session::Delivered person = deliveredTo(kind, sound, true);
            const bool played = std::string(sound) == "played";
            EXPECT_EQ(person.force, simulated.force);
            EXPECT_EQ(person.visual, 0);
            EXPECT_EQ(person.vibration, 0);
            EXPECT_EQ(person.sound > 0, played);
            EXPECT_EQ(person.masking, played ? 8000 : 0);
        }
    EXPECT_EQ(deliveredTo(Pilot, "silent", false, 12).visual, 12) << "as many as a window drew";
    EXPECT_EQ(deliveredTo(Simulated, "silent", false).masking, 0);
}

TEST(LoopApparatus, RefusesADeviceThatItDoesNotKnow) {
    // Truth: invariant (an error that names key and value)
    plan::Condition other = condition("fair");
    other.device = "sigma8";
    LoopApparatus apparatus = makeApparatus();
    const auto stages = apparatus.prepare(other, 1, 0);
    ASSERT_FALSE(stages);
    EXPECT_EQ(stages.errors().front().key, "device.preset");
    EXPECT_EQ(stages.errors().front().value, "sigma8");
}

TEST(LoopApparatus, GivesARecordForEveryTickAndTheSameHashForTheSameSeed) {
    // Truth: invariant (in virtual time nothing but condition and seed decides)
    const auto [records, health] = runTicks(condition("fair"), 5, 800);
    ASSERT_EQ(records.size(), 800u);
    for (std::size_t i = 0; i < records.size(); ++i) EXPECT_EQ(records[i].tick, static_cast<std::int64_t>(i));
    EXPECT_EQ(health.ticks, 800);
    EXPECT_EQ(health.loop, "virtual");
    EXPECT_EQ(health.dropped_records, 0);
    EXPECT_EQ(health.overruns, 0);
    EXPECT_EQ(runTicks(condition("fair"), 5, 800).second.state_hash, health.state_hash);
    EXPECT_NE(runTicks(condition("fair"), 6, 800).second.state_hash, health.state_hash);
}

TEST(LoopApparatus, TellsTheEnergyOfEachObstacleByName) {
    // Truth: invariant: the pairs add up to the account of the last tick, but for that one's 32 bits.
    const auto [records, health] = runTicks(condition("fair"), 5, 8000);
    ASSERT_EQ(health.contact_energy.size(), 2u);
    EXPECT_EQ(health.contact_energy[0].obstacle, "plate");
    EXPECT_EQ(health.contact_energy[1].obstacle, "");
    const double sum = health.contact_energy[0].taken_in_J + health.contact_energy[1].taken_in_J;
    EXPECT_NE(health.contact_energy[0].taken_in_J, 0.0);
    EXPECT_NEAR(sum, records.back().energy_J, 1e-6 * std::abs(sum));
}

TEST(LoopApparatus, APersonMovesOtherwiseInALaterTrial) {
    // Truth: invariant; reaching for the start is alike, the way to the bore is practised.
    LoopApparatus apparatus = makeApparatus();
    std::vector<std::uint64_t> hashes;
    for (const std::int64_t trials_before : {0, 40, 0}) {
        ASSERT_TRUE(apparatus.prepare(condition("fair"), 9, trials_before));
        apparatus.start();
        apparatus.advance(3000);
        hashes.push_back(apparatus.stop().state_hash);
    }
    EXPECT_EQ(hashes[0], hashes[2]);
    EXPECT_NE(hashes[0], hashes[1]);
}

TEST(LoopApparatus, BeginsEveryTrialAnew) {
    // Truth: invariant (a trial does not depend on what the same apparatus did before)
    LoopApparatus apparatus = makeApparatus();
    std::vector<std::uint64_t> hashes;
    for (const char* name : {"fair", "none", "fair"}) {
        ASSERT_TRUE(apparatus.prepare(condition(name), 9, 0));
        apparatus.start();
        apparatus.advance(500);
        hashes.push_back(apparatus.stop().state_hash);
    }
    EXPECT_EQ(hashes[0], hashes[2]);
    EXPECT_NE(hashes[0], hashes[1]);
}

TEST(LoopApparatus, AHaltEndsTheTicksUntilItIsRearmed) {
    // Truth: invariant: motors stay off however often an attempt is started; the attempt after rearm() is a whole one.
    const std::uint64_t undisturbed = runTicks(condition("fair"), 5, 100).second.state_hash;
    LoopApparatus apparatus = makeApparatus();
    ASSERT_TRUE(apparatus.prepare(condition("fair"), 5, 0));
    apparatus.start();
    apparatus.advance(20);
    apparatus.halt();
    apparatus.advance(20);
    EXPECT_EQ(apparatus.stop().ticks, 20);
    ASSERT_TRUE(apparatus.prepare(condition("fair"), 5, 0));
    apparatus.start();
    apparatus.advance(20);
    EXPECT_EQ(apparatus.stop().ticks, 0);
    apparatus.rearm();
    ASSERT_TRUE(apparatus.prepare(condition("fair"), 5, 0));
    apparatus.start();
    apparatus.advance(100);
    EXPECT_EQ(apparatus.stop().state_hash, undisturbed);
}

TEST(LoopApparatus, AHaltInRealTimeEndsTheLoopAfterItsRunningTick) {
    // Truth: invariant. A halt before the start lets no tick happen; one from another thread ends what runs. Waits for
    // the first record, however long a busy machine takes to begin.
    LoopApparatus apparatus(*simulated::findPreset("sigma7"), {}, Clock::RealTime);
    ASSERT_TRUE(apparatus.prepare(condition("none"), 5, 0));
    apparatus.start();
    std::array<TickRecord, 256> buffer;
    std::size_t records = 0;
    while (records == 0) records = apparatus.takeRecords(buffer);
    std::thread([&] { apparatus.halt(); }).join();
    const session::LoopHealth health = apparatus.stop();
    while (const std::size_t more = apparatus.takeRecords(buffer)) records += more;
    EXPECT_EQ(static_cast<std::int64_t>(records), health.ticks);
    EXPECT_EQ(health.dropped_records, 0);
    ASSERT_TRUE(apparatus.prepare(condition("none"), 5, 0));
    apparatus.start();
    apparatus.advance(20);
    EXPECT_EQ(apparatus.stop().ticks, 0);
}

/// Keeps what the motors were told; else it is the simulated device with its hand.
class WatchedDevice : public loop::HapticDevice {
public:
    explicit WatchedDevice(std::unique_ptr<loop::HapticDevice> watched, std::vector<double>& forces, bool motors)
        : watched_(std::move(watched)), forces_(forces), motors_(motors) {
        forces_.reserve(100'000);
    }
    const DeviceDescription& description() const override { return watched_->description(); }
    DeviceReading read() noexcept override { return watched_->read(); }
    void command(const Wrench& F_D_B) noexcept override {
        forces_.push_back(F_D_B.force.norm());
        told_.fetch_add(1);
        if (!F_D_B.force.isZero(0.0) || !F_D_B.torque.isZero(0.0)) felt_.fetch_add(1);
        if (forces_.back() > 0.5) pushed_.store(true);
        watched_->command(F_D_B);
    }
    void show(const loop::DisplayedImage& image) noexcept override { watched_->show(image); }
    bool pushesHand() const override { return motors_; }

    std::size_t told() const { return told_.load(); }
    std::int64_t felt() const { return felt_.load(); }  // how often it was told a wrench other than zero
    bool pushed() const { return pushed_.load(); }

private:
    std::unique_ptr<loop::HapticDevice> watched_;
    std::vector<double>& forces_;  // of the loop's thread; [N]
    const bool motors_;
    std::atomic<std::size_t> told_{0};
    std::atomic<std::int64_t> felt_{0};
    std::atomic<bool> pushed_{false};
};

class DeviceOfHis : public run::Performer {
public:
    plan::ParticipantKind kind() const override { return plan::ParticipantKind::Pilot; }
    std::unique_ptr<loop::HapticDevice> device(const simulated::DeviceParams& preset,
                                               const plan::Condition& c) override {
        const scene::Registration& r = c.scene.registration;
        auto hand = std::make_unique<simulated::SimulatedDevice>(
            preset, simulatedHand({}, 0), visibleTask(c), simulated::HandRegistration{r.X_WB, r.scale, r.X_DH}, 5);
        auto watched = std::make_unique<WatchedDevice>(std::move(hand), forces, motors);
        device_ = watched.get();
        return watched;
    }
    bool motors = true;
    std::vector<double> forces;
    WatchedDevice* device_ = nullptr;
};

TEST(LoopApparatus, GivesForceToWhoeverBringsADeviceWithMotors) {
    // Truth: invariant, as the device sees it: it was told to push in as many ticks as force is said to have been
    // given; without motors in none, whatever it was told.
    for (const bool motors : {true, false}) {
        DeviceOfHis performer;
        performer.motors = motors;
        LoopApparatus apparatus(*simulated::findPreset("sigma7"), {}, Clock::Virtual, &performer);
        ASSERT_TRUE(apparatus.prepare(condition("none"), 5, 0));
        apparatus.start();
        for (int i = 0; i < 400; ++i) apparatus.advance(20);
        const session::Delivered delivered = apparatus.stop().delivered;
        const std::int64_t pushed = performer.device_->felt();
        EXPECT_GT(pushed, 100);
        EXPECT_EQ(delivered.force, motors ? pushed : 0);
    }
}

TEST(LoopApparatus, AHaltInContactTurnsTheMotorsOffWithinTwoTicks) {
    // Truth: invariant, as the device sees it: after the halt at most the running tick's wrench, then zero, then
    // nothing.
    DeviceOfHis performer;
    LoopApparatus apparatus(*simulated::findPreset("sigma7"), {}, Clock::RealTime, &performer);
    ASSERT_TRUE(apparatus.prepare(condition("none"), 5, 0));
    apparatus.start();
    while (!performer.device_->pushed()) apparatus.advance(1);
    std::size_t told = 0;
    std::thread([&] {
        apparatus.halt();
        told = performer.device_->told();
    }).join();
    apparatus.advance(50);
    EXPECT_LE(performer.device_->told(), told + 2);
    apparatus.stop();
    EXPECT_EQ(performer.forces.back(), 0.0);
    EXPECT_LE(performer.forces.size(), told + 2);
}

}  // namespace
}  // namespace passung::run
