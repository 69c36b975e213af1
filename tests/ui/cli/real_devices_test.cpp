// Studies on real devices, run by the program itself against fakes of what serves them.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <thread>

#include "study/store/read/store_reader.h"
#include "tests/devices/fakes/dhd_block.h"
#include "tests/devices/fakes/haply_service.h"
#include "tests/devices/fakes/hd_block.h"
#include "tests/devices/fakes/space_mouse_daemon.h"
#include "tests/devices/fakes/vrpn_server.h"
#include "tests/ui/cli/program.h"

namespace passung::test {
namespace {

/// A peg in a hole, four trials of some seconds, on a device of that kind. What a busy machine loses of them is not
/// done again: an attempt that lacks a sample does not count.
std::string pegInHole(const std::string& device, bool kinesthetic) {
    return R"(passung = 1
[study]
name = "peg_in_hole_ci"
version = "1.0"
seed = 7
participants = 1
[scene]
unit = "mm"
[[scene.part]]
name = "plate"
shape = { kind = "bore_plate", width = 40, depth = 40, height = 12, bore_diameter = 22, bore_depth = 10, chamfer = 1 }
[[scene.part]]
name = "peg"
held = true
shape = { kind = "peg", diameter = 20, length = 20, chamfer = 1 }
pose = { position = [0, 0, 8] }
[scene.contact]
method = "god_object"
stiffness_N_per_m = 400
[scene.device]
)" + device +
           R"(
[scene.start_gate]
position_tolerance_mm = 5
angle_tolerance_deg = 10
hold_ms = 20
[feedback]
kinesthetic = )" +
           (kinesthetic ? "true" : "false") + R"(
[task]
type = "peg_in_hole"
target = "plate"
insertion_depth_mm = 6
success_fraction = 0.9
max_speed_mm_per_s = 20
hold_s = 0.05
timeout_s = 4
leave_radius_mm = 2
[[block]]
name = "main"
order = "listed"
repetitions = 4
on_invalid = "never"
)";
}

/// A hand that holds the start pose, goes down into the hole, rests there, and comes back, again and again. Its grip is
/// a spring: it gives way to the force that the fake displays.
class Hand {
public:
    /// `move` puts the device so far [m] above the mouth, its hand trembling by `tremor` [m].
    explicit Hand(std::function<void(double height, double tremor)> move)
        : move_(std::move(move)), thread_([this] { main(); }) {}
    ~Hand() {
        stop_ = true;
        thread_.join();
    }

private:
    void main() {
        for (int ms = 0; !stop_; ++ms) {
            const double t = 1e-3 * (ms % 1500);
            const double way = std::clamp((t - 0.4) / 0.4, 0.0, 1.0) - std::clamp((t - 1.2) / 0.2, 0.0, 1.0);
            move_(0.008 - 0.015 * way, 1e-6 * (ms % 3));
            poll(nullptr, 0, 1);
        }
    }

    std::function<void(double, double)> move_;
    std::atomic<bool> stop_ = false;
    std::thread thread_;
};

constexpr double kGrip = 2000.0;  // [N/m]

/// At the service; the origin of the device's base is the cursor's of the documented example.
std::function<void(double, double)> handAt(fake::HaplyService& service) {
    return [&service](double height, double tremor) {
        const auto felt = service.felt("049D");
        fake::HaplyDeviceState state;
        state.position = {felt[0] / kGrip + tremor, -0.12 + felt[1] / kGrip, 0.15 + height + felt[2] / kGrip};
        service.setState("049D", state);
    };
}

std::string stationOf(const fake::HaplyService& service) {
    return "[station.device.right]\nkind = \"inverse3\"\nbackend = \"haply\"\nserial = \"049D\"\naddress = "
           "\"localhost:" +
           std::to_string(service.port()) + ":" + std::to_string(service.eventPort()) + "\"\n";
}

/// At a sigma.7 behind the shim of its library, whose x points to the operator and y to the right; along the bore's
/// wall.
std::function<void(double, double)> handAt(fake::DhdDevice& device) {
    return [&device](double height, double tremor) {
        const fake::DhdCommand command = device.commands.last();
        const double* felt = command.felt;
        fake::DhdHand hand;
        hand.position[0] = felt[0] / kGrip;
        hand.position[1] = 0.0013 + felt[1] / kGrip + tremor;
        hand.position[2] = height + felt[2] / kGrip;
        device.hand.store(hand);
    };
}

std::string stationOfShim(const std::string& serial = "4711") {
    return "[station.device.right]\nkind = \"sigma7\"\nbackend = \"dhd\"\nserial = \"" + serial +
           "\"\naddress = \"" PASSUNG_DHD_SHIM_FILE "\"\n";
}

/// At a Touch behind the shim of its library, whose y points up and z to the operator; along the bore's wall.
std::function<void(double, double)> handAt(fake::HdDevice& device) {
    return [&device](double height, double tremor) {
        const fake::HdCommand command = device.commands.last();
        const double* felt = command.felt;
        fake::HdHand hand;
        hand.position[0] = 0.0013 + felt[0] / kGrip + tremor;
        hand.position[1] = height + felt[1] / kGrip;
        hand.position[2] = felt[2] / kGrip;
        device.hand.store(hand);
    };
}

std::string stationOfTouch() {
    return "[station.device.right]\nkind = \"touch\"\nbackend = \"hd\"\nserial = \"815\"\naddress = "
           "\"" PASSUNG_HD_SHIM_FILE "\"\n";
}

template <class Device>
bool isNoForce(const Device& device) {
    const auto last = device.commands.last();
    return std::all_of(std::begin(last.felt), std::end(last.felt), [](double component) { return component == 0.0; });
}

/// At a tracker, which pushes nobody; x right, y away, z up as in the scene.
std::function<void(double, double)> handAt(fake::VrpnServer& server) {
    return [&server](double height, double tremor) { server.sendPose(2, {tremor, 0.0, height}, {0.0, 0.0, 0.0, 1.0}); };
}

std::string stationOf(const fake::VrpnServer& server) {
    return "[station.device.right]\nkind = \"tracker\"\nbackend = \"vrpn\"\nserial = \"Phantom0#2\"\naddress = "
           "\"127.0.0.1:" +
           std::to_string(server.port()) + "\"\n";
}

std::vector<store::AttemptRow> attemptsOf(const std::filesystem::path& database) {
    const auto reader = store::StoreReader::open(database.string());
    if (!reader) throw std::runtime_error("no database");
    return *reader->attempts();
}

/// Why an attempt does not count; empty: it does, or the machine was too busy for it.
std::string faultOf(const store::AttemptRow& attempt) {
    const std::string why = attempt.invalid_reason.value_or("");
    return why.starts_with("no usable device input") || why.starts_with("loop: ") ? "" : why;
}

std::vector<std::string> events(const std::filesystem::path& database, const std::string& kind) {
    const auto reader = store::StoreReader::open(database.string());
    std::vector<std::string> found;
    for (const auto& event : *reader->events())
        if (event.event.starts_with(kind)) found.push_back(event.event);
    return found;
}

/// The columns of a table, and how many rows it has.
std::pair<std::string, std::size_t> shapeOf(const std::filesystem::path& csv) {
    const auto lines = linesOf(readText(csv));
    return {lines.front(), lines.size() - 1};
}

std::vector<std::string> filesOf(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
}

void exportTo(const TempFolder& folder, const std::string& database, const std::string& out) {
    const Ended ended = runProgram(folder.path(), {"export", database, "--out", out});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
}

/// The study on the station's device, in real time.
std::vector<std::string> realRun(const std::string& database) {
    return {"run",  "peg.toml", "--real-time",    "--participant", "T001",
            "--db", database,   "--station-file", "station.toml"};
}

/// Runs the study on the station's device, to its end. A machine that keeps the device waiting for so long that it
/// counts as silent pauses the session: once more from its beginning then.
void runOnDevice(const TempFolder& folder, const std::string& database) {
    for (int tries = 0; tries < 20; ++tries) {
        Program program(folder.path(), realRun(database));
        const auto isPaused = [&] {
            return std::filesystem::exists(folder / ".out") && program.out().find("paused; ") != std::string::npos;
        };
        while (!program.hasEnded() && !isPaused()) poll(nullptr, 0, 20);
        if (program.hasEnded()) {
            ASSERT_EQ(program.wait(), 0) << program.out() << program.err();
            return;
        }
        program.killNow();
        program.wait();
        ASSERT_FALSE(events(folder / database, "device_stale").empty()) << program.out();
        for (const std::string& name : filesOf(folder.path()))
            if (name.starts_with(database)) std::filesystem::remove(folder / name);
    }
    FAIL() << "twenty times the machine was too busy";
}

/// Continues the paused session as soon as its device is back, and whenever a busy machine pauses it again, to its end.
void goOnToTheEnd(const TempFolder& folder, Program& program) {
    bool goes = false;
    for (int i = 0; i < 1200 && !program.hasEnded(); ++i) {
        goes = runProgram(folder.path(), {"session", "continue", "s.db"}).exit_code == 0 || goes;
        poll(nullptr, 0, 50);
    }
    ASSERT_TRUE(goes);
    ASSERT_TRUE(program.hasEnded());
    EXPECT_EQ(program.wait(), 0);
}

/// Expects that the session does not go on, for this reason at last.
void expectRefused(const TempFolder& folder, const std::string& reason) {
    Ended early{};
    for (int i = 0; i < 200 && (early.out + early.err).find(reason) == std::string::npos; ++i) {
        poll(nullptr, 0, 50);
        early = runProgram(folder.path(), {"session", "continue", "s.db"});
        ASSERT_NE(early.exit_code, 0);
    }
    EXPECT_NE((early.out + early.err).find(reason), std::string::npos) << early.out << early.err;
}

/// Of four trials, with one attempt more for each whose device was lost.
void expectAllTrials(const std::vector<store::AttemptRow>& attempts, const std::string& device) {
    std::size_t lost = 0;
    for (const auto& attempt : attempts) {
        const std::string why = faultOf(attempt);
        if (why.starts_with("device right (" + device + ")"))
            ++lost;
        else
            EXPECT_EQ(why, "");
    }
    EXPECT_GE(lost, 1u);
    EXPECT_EQ(attempts.size(), 4u + lost);
}

/// Runs the study simulated and expects the same files, columns and rows of real.db; its sessions.csv.
std::string sessionsLikeSimulated(const TempFolder& folder) {
    const Ended simulated = runProgram(folder.path(), {"run", "peg.toml", "--db", "simulated.db"});
    EXPECT_EQ(simulated.exit_code, 0) << simulated.err;
    exportTo(folder, "real.db", "real");
    exportTo(folder, "simulated.db", "simulated");
    EXPECT_EQ(filesOf(folder.path() / "real"), filesOf(folder.path() / "simulated"));
    for (const char* table : {"trials.csv", "sessions.csv"})
        EXPECT_EQ(shapeOf(folder.path() / "real" / table), shapeOf(folder.path() / "simulated" / table)) << table;
    return readText(folder.path() / "real" / "sessions.csv");
}

TEST(RealDevices, AnInverse3RunsTheSameFileAsItsSimulationWithTheSameTables) {
    // Truth: invariant: same files, columns and rows a trial. The fake's own account says that a force was felt.
    const TempFolder folder;
    fake::HaplyService service;
    writeText(folder / "peg.toml", pegInHole("kind = \"inverse3\"", true));
    writeText(folder / "station.toml", stationOf(service));
    {
        const Hand hand(handAt(service));
        ASSERT_NO_FATAL_FAILURE(runOnDevice(folder, "real.db"));
    }
    const auto attempts = attemptsOf(folder / "real.db");
    ASSERT_EQ(attempts.size(), 4u);
    for (const auto& attempt : attempts) {
        EXPECT_EQ(faultOf(attempt), "");
        EXPECT_EQ(attempt.device, "inverse3");
        EXPECT_EQ(attempt.outcome, "success");
    }
    EXPECT_EQ(service.felt("049D"), (std::array<double, 3>{}));
    EXPECT_EQ(service.violations(), 0);
    EXPECT_EQ(service.misunderstood(), 0);
    EXPECT_EQ(events(folder / "real.db", "device_"), (std::vector<std::string>{"device_present", "device_ready"}));

    const std::string sessions = sessionsLikeSimulated(folder);
    EXPECT_NE(sessions.find("haply"), std::string::npos);
    EXPECT_NE(sessions.find("049D"), std::string::npos);
}

TEST(RealDevices, ADevicePulledInContactPausesTheSessionWhichGoesOnWhenItIsBack) {
    // Truth: invariant; the fake's own account of the force.
    const TempFolder folder;
    fake::HaplyService service;
    writeText(folder / "peg.toml", pegInHole("kind = \"any\"\nleast_force_N = 3\nleast_degrees = 6", true));
    writeText(folder / "station.toml", stationOf(service));
    const Hand hand(handAt(service));
    Program program(folder.path(), realRun("s.db"), true);
    ASSERT_NE(program.nextAcknowledgement(), "");
    service.unplug("049D");
    ASSERT_NE(program.nextAcknowledgement(), "");
    EXPECT_EQ(service.felt("049D"), (std::array<double, 3>{}));
    // The reason is the newest: that it was unplugged, or what the service says of it since.
    expectRefused(folder, "right (haply 049D) is lost: ");
    service.plug("049D");
    goOnToTheEnd(folder, program);
    expectAllTrials(attemptsOf(folder / "s.db"), "haply 049D");
    EXPECT_GE(events(folder / "s.db", "device_lost").size(), 1u);
}

TEST(RealDevices, ASigma7RunsTheSameFileAsItsSimulationWithTheSameTables) {
    // Truth: invariant: same files, columns and rows a trial. The shim's own account says that a force was felt.
    const TempFolder folder;
    fake::SharedBlock<fake::DhdBlock> block(fake::kDhdVariable);
    fake::DhdDevice& device = block->devices[0];
    writeText(folder / "peg.toml", pegInHole("kind = \"sigma7\"", true));
    writeText(folder / "station.toml", stationOfShim());
    {
        const Hand hand(handAt(device));
        ASSERT_NO_FATAL_FAILURE(runOnDevice(folder, "real.db"));
    }
    const auto attempts = attemptsOf(folder / "real.db");
    ASSERT_EQ(attempts.size(), 4u);
    for (const auto& attempt : attempts) {
        EXPECT_EQ(faultOf(attempt), "");
        EXPECT_EQ(attempt.device, "sigma7");
        EXPECT_EQ(attempt.outcome, "success");
    }
    EXPECT_TRUE(isNoForce(device));
    EXPECT_FALSE(device.opened);
    EXPECT_EQ(device.non_finite, 0);
    bool pushed = false;
    const auto count = device.commands.count();
    for (auto row = std::max<std::int64_t>(0, count - 4000); row < count; ++row)
        pushed = pushed || device.commands.row(row).felt[1] < -0.05;
    EXPECT_TRUE(pushed) << "in the last trials";

    const std::string sessions = sessionsLikeSimulated(folder);
    EXPECT_NE(sessions.find("dhd,4711"), std::string::npos) << sessions;
}

TEST(RealDevices, ATouchRunsTheSameFileAsItsSimulationWithTheSameTables) {
    // Truth: invariant: same files, columns and rows a trial. The shim's own account says that a force was felt.
    const TempFolder folder;
    fake::SharedBlock<fake::HdBlock> block(fake::kHdVariable);
    block->stepped = false;
    fake::HdDevice& device = block->devices[0];
    writeText(folder / "peg.toml", pegInHole("kind = \"touch\"", true));
    writeText(folder / "station.toml", stationOfTouch());
    {
        const Hand hand(handAt(device));
        ASSERT_NO_FATAL_FAILURE(runOnDevice(folder, "real.db"));
    }
    const auto attempts = attemptsOf(folder / "real.db");
    ASSERT_EQ(attempts.size(), 4u);
    for (const auto& attempt : attempts) {
        EXPECT_EQ(faultOf(attempt), "");
        EXPECT_EQ(attempt.device, "touch");
        EXPECT_EQ(attempt.outcome, "success");
    }
    EXPECT_TRUE(isNoForce(device));
    EXPECT_FALSE(device.opened);
    EXPECT_EQ(device.non_finite, 0);
    bool pushed = false;
    const auto count = device.commands.count();
    for (auto row = std::max<std::int64_t>(0, count - 4000); row < count; ++row)
        pushed = pushed || device.commands.row(row).felt[0] < -0.05;
    EXPECT_TRUE(pushed) << "in the last trials";
    const std::string sessions = sessionsLikeSimulated(folder);
    EXPECT_NE(sessions.find("hd,815"), std::string::npos) << sessions;
}

TEST(RealDevices, ALibraryThatCrashesInContactPausesTheSessionWhichGoesOn) {
    // Truth: invariant; the shim's own account: the device's watchdog is on, which ends the force of a dead host.
    const TempFolder folder;
    fake::SharedBlock<fake::DhdBlock> block(fake::kDhdVariable);
    fake::DhdDevice& device = block->devices[0];
    writeText(folder / "peg.toml", pegInHole("kind = \"any\"\nleast_force_N = 3\nleast_degrees = 6", true));
    writeText(folder / "station.toml", stationOfShim());
    const Hand hand(handAt(device));
    Program program(folder.path(), realRun("s.db"), true);
    ASSERT_NE(program.nextAcknowledgement(), "");
    device.fault = fake::DhdFault::Crash;
    ASSERT_NE(program.nextAcknowledgement(), "");
    for (const double felt : fake::feltAfterSilence(device, 20)) EXPECT_EQ(felt, 0.0);
    EXPECT_FALSE(program.hasEnded());
    expectRefused(folder, "ended by signal 11");
    device.fault = fake::DhdFault::None;
    goOnToTheEnd(folder, program);
    expectAllTrials(attemptsOf(folder / "s.db"), "dhd 4711");
    EXPECT_GE(events(folder / "s.db", "device_lost").size(), 1u);
    EXPECT_TRUE(isNoForce(device));
}

TEST(RealDevices, ASpaceMouseRunsTheSameFileAsItsSimulation) {
    // Truth: invariant; independent program (spacenavd 1.1-1 of Debian).
    if (!fake::SpaceMouseDaemon::installed()) GTEST_SKIP() << "no spacenavd is installed";
    const TempFolder folder;
    fake::SpaceMouseDaemon daemon(fake::SerialMouse::Model::Spaceball);
    writeText(folder / "peg.toml", pegInHole("kind = \"spacemouse\"", false));
    writeText(folder / "station.toml",
              "[station.device.right]\nkind = \"spacemouse\"\nbackend = \"spacenavd\"\naddress = \"" +
                  daemon.socket().string() + "\"\n");
    std::atomic<bool> over = false;
    std::thread hand([&] {  // pushes the cap down for a moment, again and again
        for (int ms = 0; !over; ms += 10) {
            if (ms % 800 == 0) daemon.mouse().move({0, -350, 0, 0, 0, 0});
            if (ms % 800 == 160) daemon.mouse().move({0, 0, 0, 0, 0, 0});
            poll(nullptr, 0, 10);
        }
    });
    const Ended real = runProgram(folder.path(), {"run", "peg.toml", "--real-time", "--participant", "T001", "--db",
                                                  "real.db", "--station-file", "station.toml"});
    over = true;
    hand.join();
    ASSERT_EQ(real.exit_code, 0) << real.out << real.err;
    const auto attempts = attemptsOf(folder / "real.db");
    ASSERT_EQ(attempts.size(), 4u);
    for (const auto& attempt : attempts) {
        EXPECT_EQ(faultOf(attempt), "");
        EXPECT_EQ(attempt.outcome, "success");
    }
    const Ended simulated = runProgram(folder.path(), {"run", "peg.toml", "--db", "simulated.db"});
    ASSERT_EQ(simulated.exit_code, 0) << simulated.err;
    exportTo(folder, "real.db", "real");
    exportTo(folder, "simulated.db", "simulated");
    EXPECT_EQ(shapeOf(folder.path() / "real" / "trials.csv"), shapeOf(folder.path() / "simulated" / "trials.csv"));
}

TEST(RealDevices, ATrackerOfVrpnRunsTheSameFileAsItsSimulationWithTheSameTables) {
    // Truth: invariant: same files, columns and rows a trial. The fake's own account says that no force was asked.
    const TempFolder folder;
    fake::VrpnServer server;
    writeText(folder / "peg.toml", pegInHole("kind = \"tracker\"", false));
    writeText(folder / "station.toml", stationOf(server));
    {
        const Hand hand(handAt(server));
        ASSERT_NO_FATAL_FAILURE(runOnDevice(folder, "real.db"));
    }
    const auto attempts = attemptsOf(folder / "real.db");
    ASSERT_EQ(attempts.size(), 4u);
    for (const auto& attempt : attempts) {
        EXPECT_EQ(faultOf(attempt), "");
        EXPECT_EQ(attempt.device, "tracker");
        EXPECT_EQ(attempt.outcome, "success");
    }
    EXPECT_EQ(server.received(), 0);
    EXPECT_EQ(server.malformed(), 0);
    const std::string sessions = sessionsLikeSimulated(folder);
    EXPECT_NE(sessions.find("vrpn,Phantom0#2"), std::string::npos) << sessions;
}

/// A tracker's server ends in a trial, and is back. False: the machine kept the tracker waiting for so long that it
/// counted as silent before.
bool serverEndsAndComesBack() {
    const TempFolder folder;
    fake::VrpnServer server;
    writeText(folder / "peg.toml", pegInHole("kind = \"any\"\nleast_force_N = 0", false));
    writeText(folder / "station.toml", stationOf(server));
    const Hand hand(handAt(server));
    Program program(folder.path(), realRun("s.db"), true);
    const auto wasSilent = [&] { return !events(folder / "s.db", "device_stale").empty(); };
    EXPECT_NE(program.nextAcknowledgement(), "");
    server.stayMute(true);  // connects, and then nothing: not there yet
    server.dropConnections();
    const bool told = !program.nextAcknowledgement(std::chrono::seconds(20)).empty();
    if (wasSilent()) return false;
    EXPECT_TRUE(told);
    const Ended early = runProgram(folder.path(), {"session", "continue", "s.db"});
    EXPECT_NE(early.exit_code, 0);
    EXPECT_NE((early.out + early.err).find("right (vrpn Phantom0#2) is lost: "), std::string::npos)
        << early.out << early.err;
    server.stayMute(false);
    goOnToTheEnd(folder, program);
    if (wasSilent()) return false;
    const auto attempts = attemptsOf(folder / "s.db");
    EXPECT_EQ(attempts.size(), 5u);
    const auto lost = std::count_if(attempts.begin(), attempts.end(), [](const store::AttemptRow& attempt) {
        return faultOf(attempt).starts_with("device right (vrpn Phantom0#2)");
    });
    EXPECT_EQ(lost, 1);
    EXPECT_EQ(server.received(), 0);
    return true;
}

TEST(RealDevices, ATrackerWhoseServerEndsPausesTheSessionWhichGoesOnWhenItIsBack) {
    // Truth: invariant.
    int tries = 0;
    while (!serverEndsAndComesBack()) ASSERT_LT(++tries, 20) << "the machine is too busy";
}

TEST(RealDevices, AUnitThatIsWeakerThanItsKindIsRefusedWithTheReason) {
    // Truth: invariant; the sentences name both numbers.
    const TempFolder folder;
    fake::HaplyService service;
    std::string station = stationOf(service);
    const auto run = [&](const std::string& device) {
        writeText(folder / "peg.toml", pegInHole(device, true));
        writeText(folder / "station.toml", station);
        return runProgram(folder.path(), {"run", "peg.toml", "--real-time", "--participant", "T001", "--db", "x.db",
                                          "--station-file", "station.toml"});
    };
    Ended ended = run("kind = \"sigma7\"");
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_NE(ended.err.find("the station's unit serves inverse3"), std::string::npos) << ended.err;
    station.replace(station.find("inverse3"), 8, "sigma7");
    ended = run("kind = \"sigma7\"");
    EXPECT_NE(ended.err.find("it drives 3 degrees of 6 degrees"), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("it pushes with 8 N of 12 N"), std::string::npos) << ended.err;
    ended = run("kind = \"any\"\nleast_force_N = 9");
    EXPECT_NE(ended.err.find("it pushes with 8 N of 9 N"), std::string::npos) << ended.err;
    ended = run("kind = \"any\"\nleast_force_N = 2\nleast_torque_Nm = 0.1");
    EXPECT_NE(ended.err.find("it drives 3 degrees of 6 degrees"), std::string::npos) << ended.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "x.db")) << "nothing is stored";
    service.unplug("049D");
    ended = run("kind = \"any\"\nleast_force_N = 2");
    EXPECT_NE(ended.err.find("the Inverse Service has no Inverse3"), std::string::npos) << ended.err;
    EXPECT_EQ(service.felt("049D"), (std::array<double, 3>{}));
}

TEST(RealDevices, DoctorSaysWhatItFoundAndWritesTheStationFileThatRunTakes) {
    // Truth: invariant.
    const TempFolder folder;
    fake::HaplyService service({"049D", "04A1"});
    writeText(folder / "look.toml", stationOf(service) +
                                        "[station.device.left]\nkind = \"spacemouse\"\nbackend = "
                                        "\"spacenavd\"\naddress = \"/nonexistent/spnav.sock\"\n"
                                        "[station.device.third]\nkind = \"tracker\"\nbackend = \"vrpn\"\naddress = "
                                        "\"Wand@127.0.0.1:9\"\n");
    const Ended ended =
        runProgram(folder.path(), {"doctor", "--station-file", "look.toml", "--write-station", "station.toml"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_NE(ended.out.find("found: inverse3, serial 049D, firmware 7.4.0"), std::string::npos) << ended.out;
    EXPECT_NE(ended.out.find("not found: spacenavd does not run: nobody listens at /nonexistent/spnav.sock"),
              std::string::npos)
        << ended.out;
    EXPECT_NE(ended.out.find("not found: no VRPN server runs: nobody listens at 127.0.0.1:9"), std::string::npos)
        << ended.out;
    const std::string written = readText(folder / "station.toml");
    EXPECT_NE(written.find("[station.device.right]\nkind = \"inverse3\"\nbackend = \"haply\"\nserial = \"049D\""),
              std::string::npos)
        << written;
    EXPECT_NE(written.find("[station.device.left]\nkind = \"inverse3\"\nbackend = \"haply\"\nserial = \"04A1\""),
              std::string::npos);
    const Ended again =
        runProgram(folder.path(), {"doctor", "--station-file", "look.toml", "--write-station", "station.toml"});
    EXPECT_EQ(again.exit_code, 1);
    EXPECT_EQ(readText(folder / "station.toml"), written) << "what is there is left as it is";
}

TEST(RealDevices, DoctorFindsTrackersAndWritesWhichIsWhich) {
    // Truth: invariant; the number of the sensor is the fake's.
    const TempFolder folder;
    fake::VrpnServer server;
    writeText(folder / "look.toml", stationOf(server));
    const Hand hand(handAt(server));
    const Ended ended =
        runProgram(folder.path(), {"doctor", "--station-file", "look.toml", "--write-station", "station.toml"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_NE(ended.out.find("found: tracker, serial Phantom0#2, VRPN 07.38"), std::string::npos) << ended.out;
    const std::string written = readText(folder / "station.toml");
    EXPECT_NE(written.find(stationOf(server)), std::string::npos) << written;
}

TEST(RealDevices, DoctorFindsTouchesOrSaysWhichFileIsMissing) {
    // Truth: invariant; model and serial number are the shim's.
    const TempFolder folder;
    fake::SharedBlock<fake::HdBlock> block(fake::kHdVariable);
    writeText(folder / "look.toml", stationOfTouch());
    Ended ended =
        runProgram(folder.path(), {"doctor", "--station-file", "look.toml", "--write-station", "station.toml"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_NE(ended.out.find("found: Premium 6DOF, serial 815, HD 3.4.0, driver 1.0"), std::string::npos) << ended.out;
    EXPECT_NE(readText(folder / "station.toml").find(stationOfTouch()), std::string::npos);
    std::string missing = stationOfTouch();
    missing.replace(missing.find("libhd-shim"), 10, "libnone");
    writeText(folder / "look.toml", missing);
    ended = runProgram(folder.path(), {"doctor", "--station-file", "look.toml", "--write-station", "none.toml"});
    EXPECT_NE(ended.out.find("not found: OpenHaptics' library does not load from "), std::string::npos) << ended.out;
}

TEST(RealDevices, DoctorFindsSigma7sOrSaysWhichFileIsMissing) {
    // Truth: invariant; the serial numbers are the shim's.
    const TempFolder folder;
    fake::SharedBlock<fake::DhdBlock> block(fake::kDhdVariable);
    block->present = 2;
    writeText(folder / "look.toml", stationOfShim());
    Ended ended =
        runProgram(folder.path(), {"doctor", "--station-file", "look.toml", "--write-station", "station.toml"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_NE(ended.out.find("found: sigma.7, serial 4711, SDK 3.17.6.0"), std::string::npos) << ended.out;
    EXPECT_EQ(readText(folder / "station.toml").substr(readText(folder / "station.toml").find("\n\n") + 2),
              stationOfShim() + "\n[station.device.left]" + stationOfShim("4712").substr(22));
    std::string missing = stationOfShim();
    missing.replace(missing.find("libdhd-shim"), 11, "libnone");
    writeText(folder / "look.toml", missing);
    ended = runProgram(folder.path(), {"doctor", "--station-file", "look.toml", "--write-station", "none.toml"});
    EXPECT_NE(ended.out.find("not found: Force Dimension's library does not load from "), std::string::npos)
        << ended.out;
    EXPECT_NE(ended.out.find("libnone.so"), std::string::npos);
}

}  // namespace
}  // namespace passung::test
