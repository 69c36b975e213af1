#include "tests/devices/fakes/haply_service.h"

#include <gtest/gtest.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/devices/fakes/waiting.h"

/// The fake service as Boost.Beast 1.74, a client of RFC 6455 that is not ours, sees it.
namespace passung {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using fake::HaplyMessage;
using fake::HaplyService;
using nlohmann::json;
using Vector = std::array<double, 3>;

class BeastClient {
public:
    explicit BeastClient(int port) : stream_(context_) {
        const asio::ip::tcp::endpoint end(asio::ip::address_v4::loopback(), static_cast<unsigned short>(port));
        stream_.next_layer().connect(end);
        stream_.handshake("localhost:" + std::to_string(port), "/");
        stream_.control_callback([this](beast::websocket::frame_type kind, beast::string_view) {
            if (kind == beast::websocket::frame_type::ping) ++pings_;
        });
    }

    std::string read() {
        beast::flat_buffer buffer;
        stream_.read(buffer);
        return beast::buffers_to_string(buffer.data());
    }
    void write(const std::string& text) { stream_.write(asio::buffer(text)); }
    json ask(const json& message) {
        write(message.dump());
        return json::parse(read());
    }
    void hangUp() { stream_.next_layer().close(); }
    void close() { stream_.close(beast::websocket::close_code::normal); }
    int pings() const { return pings_; }
    beast::websocket::stream<asio::ip::tcp::socket>& stream() { return stream_; }

private:
    asio::io_context context_;
    beast::websocket::stream<asio::ip::tcp::socket> stream_;
    int pings_ = 0;
};

json force(const std::string& device, const Vector& f) {
    return {{"inverse3",
             {{{"device_id", device},
               {"commands", {{"set_cursor_force", {{"vector", {{"x", f[0]}, {"y", f[1]}, {"z", f[2]}}}}}}}}}}};
}

/// What the fake has done is seen when the service's thread has done it.
template <typename Done>
void until(Done done) {
    fake::waitFor(
        "the fake", [] { return poll(nullptr, 0, 1) != 0; }, done);
}

TEST(HaplyService, SendsTheInventoryFirstAndThenOneStateForEachMessage) {
    // Truth: the service's public pages (3.5, realtime/websocket-protocol): exactly one state for each message.
    HaplyService service({"049D", "04A1"});
    BeastClient client(service.port());
    const json inventory = json::parse(client.read());
    EXPECT_EQ(inventory["session_id"], 1);
    ASSERT_EQ(inventory["inverse3"].size(), 2u);
    EXPECT_EQ(inventory["inverse3"][0]["device_id"], "049D");
    EXPECT_EQ(inventory["inverse3"][0]["config"]["filters"]["force_gate"]["gain"], 0.3);
    EXPECT_EQ(inventory["inverse3"][0]["config"]["basis"]["permutation"], "XYZ");
    EXPECT_EQ(inventory["inverse3"][0]["state"]["cursor_position"], (json{{"x", 0.0}, {"y", -0.12}, {"z", 0.15}}));
    fake::HaplyDeviceState state;
    for (int i = 1; i <= 50; ++i) {
        state.position[0] = 1e-3 * i;
        service.setState("049D", state);
        const json answer = client.ask(force("049D", {}));
        EXPECT_EQ(answer["inverse3"][0]["state"]["cursor_position"]["x"], 1e-3 * i);
        EXPECT_FALSE(answer["inverse3"][0].contains("config"));
        EXPECT_EQ(service.messages(), i);
        EXPECT_EQ(service.answers(), i);
    }
    EXPECT_EQ(client.stream().next_layer().available(), 0u) << "nothing comes unasked";
    EXPECT_EQ(service.violations(), 0);
    BeastClient second(service.port());
    EXPECT_EQ(json::parse(second.read())["session_id"], 2);
}

TEST(HaplyService, LetsTheGateChangeTheForceUntilItIsConfigured) {
    // Truth: the service's public pages (3.5, filters): your force → force-gate → device; here it always acts.
    HaplyService service;
    BeastClient client(service.port());
    client.read();
    json answer = client.ask(force("049D", {1.0, -2.0, 4.0}));
    EXPECT_EQ(service.record("049D").back().commanded, (Vector{1.0, -2.0, 4.0}));
    EXPECT_EQ(service.felt("049D"), (Vector{0.3 * 1.0, 0.3 * -2.0, 0.3 * 4.0}));
    EXPECT_EQ(answer["inverse3"][0]["state"]["current_cursor_force"]["z"], 0.3 * 4.0);
    EXPECT_EQ(answer["inverse3"][0]["state"]["control_mode"], "force");
    json message = force("049D", {1.0, -2.0, 4.0});
    message["inverse3"][0]["configure"] = {{"force_gate", {{"gain", 1.0}}}};
    client.ask(message);
    EXPECT_EQ(service.gateGain("049D"), 1.0);
    EXPECT_EQ(service.felt("049D"), (Vector{1.0, -2.0, 4.0}));
    BeastClient second(service.port());
    EXPECT_EQ(json::parse(second.read())["inverse3"][0]["config"]["filters"]["force_gate"]["gain"], 1.0);
}

TEST(HaplyService, AddsTheForcesOfAMessageAndIdlesWithoutOne) {
    // Truth: the service's public pages (3.5, realtime/control-commands): per tick, additive, forgotten after it.
    HaplyService service;
    service.setGateGain("049D", 1.0);
    BeastClient client(service.port());
    client.read();
    json twice = force("049D", {1.0, 0.0, 0.0});
    twice["inverse3"].push_back(force("049D", {0.5, 0.0, -1.0})["inverse3"][0]);
    client.ask(twice);
    EXPECT_EQ(service.felt("049D"), (Vector{1.5, 0.0, -1.0}));
    const json answer = client.ask(json::object());
    EXPECT_EQ(answer["inverse3"][0]["state"]["control_mode"], "idle");
    EXPECT_EQ(service.felt("049D"), Vector{});
    EXPECT_FALSE(service.record("049D").back().commands_force);
}

TEST(HaplyService, CountsOnItsOwnSideWhenTheForceWasGone) {
    // Truth: invariant: the record has one row a message, and one where the connection ends.
    HaplyService service({"A", "B"});
    service.setGateGain("A", 1.0);
    {
        BeastClient client(service.port());
        client.read();
        for (int i = 0; i < 3; ++i) client.ask(force("A", {2.0, 0.0, 0.0}));
        EXPECT_EQ(service.felt("A"), (Vector{2.0, 0.0, 0.0}));
        EXPECT_EQ(service.felt("B"), Vector{});
        client.hangUp();
        until([&] { return service.connections() == 0; });
    }
    const std::vector<HaplyMessage> record = service.record("A");
    ASSERT_EQ(record.size(), 4u);
    EXPECT_EQ(record[2].number, 3);
    EXPECT_FALSE(record[2].is_end);
    EXPECT_TRUE(record[3].is_end);
    EXPECT_EQ(record[3].number, 3);
    EXPECT_EQ(service.felt("A"), Vector{});
}

TEST(HaplyService, SetsNoForceThatItDoesNotUnderstand) {
    // Truth: invariant: whatever is sent, the fake feels finite forces only, and gives one answer.
    HaplyService service;
    BeastClient client(service.port());
    client.read();
    const std::vector<std::string> messages{
        "",
        "no json",
        "[]",
        "7",
        R"({"inverse3":7})",
        R"({"inverse3":[7]})",
        R"({"inverse3":[{"device_id":7}]})",
        force("other", {1, 1, 1}).dump(),
        R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{"vector":{"x":1,"y":NaN,"z":0}}}}]})",
        R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{"vector":{"x":1,"y":null,"z":0}}}}]})",
        R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{"vector":{"x":1,"y":2}}}}]})",
        R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{"values":{"x":1,"y":2,"z":3}}}}]})"};
    for (const std::string& message : messages) {
        client.write(message);
        EXPECT_TRUE(json::accept(client.read())) << message;
        EXPECT_EQ(service.felt("049D"), Vector{}) << message;
    }
    EXPECT_EQ(service.misunderstood(), static_cast<std::int64_t>(messages.size()));
    EXPECT_EQ(service.answers(), static_cast<std::int64_t>(messages.size()));
}

/// The tree without the keys that no page names.
json known(const json& tree) {
    if (!tree.is_structured()) return tree;
    json result = tree.is_array() ? json::array() : json::object();
    for (const auto& item : tree.items()) {
        if (tree.is_array()) {
            result.push_back(known(item.value()));
        } else if (item.key().rfind("future_", 0) != 0) {
            result[item.key()] = known(item.value());
        }
    }
    return result;
}

TEST(HaplyService, SaysTheSameWithItsKeysShuffledAndOthersAdded) {
    // Truth: invariant: JSON objects have no order; independent program (nlohmann-json 3.11.2) for what is said.
    HaplyService service({"A", "B"});
    BeastClient client(service.port());
    client.read();
    client.write("{}");
    const std::string plain = client.read();
    std::vector<std::string> texts;
    for (unsigned seed = 1; seed <= 20; ++seed) {
        service.shuffleKeys(seed);
        service.addUnknownKeys(seed % 2 == 0);
        client.write("{}");
        texts.push_back(client.read());
        EXPECT_NE(texts.back(), plain);
        EXPECT_EQ(known(json::parse(texts.back())), json::parse(plain));
    }
    EXPECT_NE(texts[0], texts[2]);
    EXPECT_NE(texts[1].find("future_"), std::string::npos);
}

TEST(HaplyService, LiesAsItIsTold) {
    // Truth: independent program (nlohmann-json 3.11.2): which of the texts are JSON at all.
    HaplyService service;
    BeastClient client(service.port());
    client.read();
    const auto told = [&](HaplyService::Lie lie) {
        service.lie(lie);
        client.write("{}");
        return client.read();
    };
    EXPECT_NE(told(HaplyService::Lie::NotANumber).find("\"y\":NaN"), std::string::npos);
    EXPECT_FALSE(json::accept(told(HaplyService::Lie::NotANumber)));
    EXPECT_NE(told(HaplyService::Lie::Huge).find("\"y\":1e999"), std::string::npos);
    EXPECT_FALSE(json::accept(told(HaplyService::Lie::Truncated)));
    const auto y = [&](HaplyService::Lie lie) {
        return json::parse(told(lie))["inverse3"][0]["state"]["cursor_position"]["y"];
    };
    EXPECT_TRUE(y(HaplyService::Lie::Null).is_null());
    EXPECT_TRUE(y(HaplyService::Lie::Text).is_string());
    EXPECT_FALSE(json::parse(told(HaplyService::Lie::Missing))["inverse3"][0]["state"].contains("cursor_position"));
    EXPECT_EQ(y(HaplyService::Lie::None), -0.12);
}

TEST(HaplyService, FreezesItsStates) {
    // Truth: invariant.
    HaplyService service;
    BeastClient client(service.port());
    client.read();
    service.freeze(true);
    fake::HaplyDeviceState state;
    state.position = {9, 9, 9};
    service.setState("049D", state);
    EXPECT_EQ(client.ask(json::object())["inverse3"][0]["state"]["cursor_position"]["x"], 0.0);
}

TEST(HaplyService, KeepsAnswersBackAndGivesThemAtOnce) {
    // Truth: invariant: one answer for each message in the end, in their order, each with the state of its time.
    HaplyService service;
    BeastClient client(service.port());
    client.read();
    service.hold(true);
    fake::HaplyDeviceState state;
    for (int i = 0; i < 5; ++i) {
        state.position[0] = i;
        service.setState("049D", state);
        client.write("{}");
        until([&] { return service.messages() == i + 1; });
    }
    EXPECT_EQ(client.stream().next_layer().available(), 0u);
    service.hold(false);
    for (int i = 0; i < 5; ++i) {
        EXPECT_EQ(json::parse(client.read())["inverse3"][0]["state"]["cursor_position"]["x"], i);
    }
}

TEST(HaplyService, SwallowsCutsAndHangsUp) {
    // Truth: independent program (Boost.Beast 1.74): what a client that keeps the rules makes of it.
    HaplyService service;
    {
        BeastClient client(service.port());
        client.read();
        service.swallow(1);
        client.write("{}");
        client.write("{}");
        client.read();
        EXPECT_EQ(service.messages(), 2);
        EXPECT_EQ(service.answers(), 1);
        service.cutNextAnswer(100, true);
        client.write("{}");
        EXPECT_THROW(client.read(), boost::system::system_error);
    }
    {
        BeastClient client(service.port());
        client.read();
        service.closeConnections(1001);
        EXPECT_THROW(client.read(), boost::system::system_error);
        EXPECT_EQ(client.stream().reason().code, 1001);
    }
    {
        BeastClient client(service.port());
        client.read();
        service.dropConnections();
        EXPECT_THROW(client.read(), boost::system::system_error);
    }
    until([&] { return service.connections() == 0; });
    EXPECT_EQ(service.violations(), 0);
}

TEST(HaplyService, TellsWhoListensOfAPulledDeviceAndOfItsBrake) {
    // Truth: the service's public pages (3.5, events).
    HaplyService service({"A", "B"});
    BeastClient client(service.port());
    client.read();
    BeastClient listener(service.eventPort());
    until([&] { return service.listeners() == 1; });
    service.unplug("A");
    json event = json::parse(listener.read());
    EXPECT_EQ(event["name"], "device-disconnected");
    EXPECT_EQ(event["category"], "device");
    EXPECT_EQ(event["level"], "warning");
    EXPECT_EQ(event["data"]["device_id"], "A");
    json answer = client.ask(force("A", {1, 0, 0}));
    ASSERT_EQ(answer["inverse3"].size(), 1u);
    EXPECT_EQ(answer["inverse3"][0]["device_id"], "B");
    EXPECT_EQ(service.felt("A"), Vector{});
    service.sendEvent("device-safety-triggered", "device", "error", "B", "ebrake_triggered");
    event = json::parse(listener.read());
    EXPECT_EQ(event["data"]["safety_type"], "ebrake_triggered");
    service.plug("A");
    EXPECT_EQ(json::parse(listener.read())["name"], "device-connected");
    service.reverseDevices();
    answer = client.ask(json::object());
    EXPECT_EQ(answer["inverse3"][0]["device_id"], "B");
    EXPECT_EQ(answer["inverse3"][1]["device_id"], "A");
}

TEST(HaplyService, KeepsTheRulesOfWebSockets) {
    // Truth: independent program (Boost.Beast 1.74): messages of all three lengths, in fragments both ways, pings, the
    // close.
    HaplyService service;
    BeastClient client(service.port());
    client.read();
    for (const std::size_t size : {std::size_t{0}, std::size_t{125}, std::size_t{126}, std::size_t{65535},
                                   std::size_t{65536}, std::size_t{200000}}) {
        client.write(std::string(size, ' ') + "{}");
        EXPECT_TRUE(json::accept(client.read()));
        EXPECT_EQ(service.record("049D").back().text.size(), size + 2);
    }
    service.fragment(7);
    client.stream().auto_fragment(true);
    client.stream().write_buffer_bytes(16);
    const json answer = client.ask(force("049D", {1, 2, 3}));
    EXPECT_EQ(answer["inverse3"].size(), 1u);
    EXPECT_EQ(service.record("049D").back().commanded, (Vector{1, 2, 3}));
    service.pingConnections();
    client.ask(json::object());
    EXPECT_EQ(client.pings(), 1);
    client.ask(json::object());  // the pong came before this message
    EXPECT_EQ(service.pongs(), 1);
    client.close();
    until([&] { return service.connections() == 0; });
    EXPECT_EQ(service.violations(), 0);
}

TEST(HaplyService, CountsWhatIsAgainstTheRulesAndHangsUp) {
    // Truth: RFC 6455 5.1 and 5.7: a client's frames are masked; an unmasked "Hello" is 81 05 48 65 6c 6c 6f.
    EXPECT_EQ(fake::WebSocketServer::frame("Hello"), "\x81\x05Hello");
    HaplyService service;
    BeastClient client(service.port());
    client.read();
    asio::write(client.stream().next_layer(), asio::buffer(std::string("\x81\x05Hello")));
    EXPECT_THROW(client.read(), boost::system::system_error);
    EXPECT_EQ(client.stream().reason().code, 1002);
    EXPECT_EQ(service.violations(), 1);
    EXPECT_EQ(service.messages(), 0);
}

}  // namespace
}  // namespace passung
