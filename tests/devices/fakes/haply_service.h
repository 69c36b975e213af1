#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tests/devices/fakes/web_socket_server.h"

namespace passung::fake {

/// What an Inverse3 says of itself: metres, m/s, degrees of its joints; right-handed, x right, y forward, z up; unit
/// quaternions w, x, y, z of body and grip.
struct HaplyDeviceState {
    std::array<double, 3> position{0.0, -0.12, 0.15};
    std::array<double, 3> velocity{};
    std::array<double, 4> body{1.0, 0.0, 0.0, 0.0};
    std::array<double, 4> grip{1.0, 0.0, 0.0, 0.0};
    std::array<bool, 3> buttons{};  // a, b, c of the grip
};

/// One message that the service has received, or the end of a connection.
struct HaplyMessage {
    std::int64_t number = 0;            // from 1; the end of a connection has the number of the last message
    bool is_end = false;                // the connection has gone, and the device idles
    bool commands_force = false;        // without a command the device idles
    std::array<double, 3> commanded{};  // [N]
    std::array<double, 3> felt{};       // [N], after the filters
    std::string text;
};

/// The Inverse Service 3.5 as its public pages describe it, at two ports of the loop-back.
///
/// Simulation channel: on connection one message with session, configuration, state and status of every device; then
/// exactly one state for each message received, none otherwise. A force is a command of one message, in newtons; forces
/// of one message add up; a message without one leaves the device idle. `configure` sets the filters of a session.
/// Event channel: read only, one message an event.
///
/// Our readings, where the pages leave it open, all of them the worst for a client: the force gate always acts and
/// multiplies by its gain (the pages: during detected oscillation); a force stands until the next message or the end of
/// the connection; a command that is not understood (no number, or an unknown device) sets no force and is answered by
/// a state all the same.
///
/// The answer to a message is given while that message is heard: who sends and waits for the answer drives the service
/// in steps.
class HaplyService final {
public:
    /// What the service says that is not so.
    enum class Lie { None, NotANumber, Null, Huge, Text, Missing, Truncated };

    explicit HaplyService(std::vector<std::string> devices = {"049D"});
    ~HaplyService();
    HaplyService(const HaplyService&) = delete;
    HaplyService& operator=(const HaplyService&) = delete;

    int port() const noexcept { return simulation_->port(); }
    int eventPort() const noexcept { return events_->port(); }

    // The hand and the plugs.
    void setState(const std::string& device, const HaplyDeviceState& state);
    void plug(const std::string& device);
    void unplug(const std::string& device);
    /// The list in another order, as after a restart of the machine.
    void reverseDevices();
    /// The grip's family: "wireless_verse_grip", "verse_grip" or "custom_verse_grip"; empty: none is there.
    void setGripFamily(const std::string& family);
    void setGateGain(const std::string& device, double gain);
    double gateGain(const std::string& device) const;

    // How it speaks.
    void shuffleKeys(unsigned seed);  // 0: as documented
    void addUnknownKeys(bool add);
    void fragment(std::size_t bytes);  // 0: one frame a message
    void lie(Lie what);
    void freeze(bool frozen);  // states stay as they were, whatever the hand does
    /// Answers are kept back, and given all at once when they are let go.
    void hold(bool held);
    /// The next answer ends after so many bytes of its frame; with `hang_up` the connection does too.
    void cutNextAnswer(std::size_t bytes, bool hang_up);
    /// The next `count` messages get no answer.
    void swallow(int count);
    void closeConnections(int code);
    void dropConnections();
    void pingConnections();
    void sendEvent(const std::string& name, const std::string& category, const std::string& level,
                   const std::string& device, const std::string& safety_type = {});

    // What it has seen.
    std::int64_t messages() const;
    std::int64_t answers() const;
    int connections() const;
    int listeners() const;  // of the event channel
    int sessions() const;   // since the beginning
    /// The force at the device now, after the filters.
    std::array<double, 3> felt(const std::string& device) const;
    /// All messages for that device since the beginning.
    std::vector<HaplyMessage> record(const std::string& device) const;
    std::int64_t violations() const noexcept { return simulation_->violations() + events_->violations(); }
    std::int64_t pongs() const noexcept { return simulation_->pongs(); }
    /// Messages that were no JSON or had commands of no known form.
    std::int64_t misunderstood() const;

private:
    struct Device;
    struct Channel;

    std::string stateOf(bool with_config, int session) const;
    void simulationOpened(int client);
    void simulationHeard(int client, const std::string& text);
    void simulationClosed(int client);
    bool obey(const nlohmann::ordered_json& message, std::map<std::string, HaplyMessage>& heard);
    void answer(int client, const std::string& text);

    mutable std::mutex mutex_;
    std::vector<std::string> order_;
    std::map<std::string, std::unique_ptr<Device>> devices_;
    std::map<int, int> session_of_;  // by client
    std::map<int, bool> listeners_;
    std::vector<std::pair<int, std::string>> held_answers_;
    std::string grip_family_ = "wireless_verse_grip";
    unsigned shuffle_ = 0;
    bool unknown_keys_ = false;
    bool frozen_ = false;
    bool held_ = false;
    std::size_t fragment_ = 0;
    std::size_t cut_ = 0;
    bool hang_up_after_cut_ = false;
    bool cuts_next_ = false;
    int swallowed_ = 0;
    Lie lie_ = Lie::None;
    int sessions_ = 0;
    std::int64_t messages_ = 0;
    std::int64_t answers_ = 0;
    std::int64_t misunderstood_ = 0;
    std::unique_ptr<Channel> simulation_channel_;
    std::unique_ptr<Channel> events_channel_;
    std::unique_ptr<WebSocketServer> simulation_;
    std::unique_ptr<WebSocketServer> events_;
};

}  // namespace passung::fake
