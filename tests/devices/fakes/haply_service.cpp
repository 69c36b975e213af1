#include "tests/devices/fakes/haply_service.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <utility>

namespace passung::fake {
namespace {

using Json = nlohmann::ordered_json;
using Vector = std::array<double, 3>;

constexpr double kDocumentedGain = 0.3;
constexpr const char* kLyingNumber = "@lie@";  // stands in the tree until the text is written

Json vectorOf(const Vector& v) { return {{"x", v[0]}, {"y", v[1]}, {"z", v[2]}}; }
Json quaternionOf(const std::array<double, 4>& q) { return {{"w", q[0]}, {"x", q[1]}, {"y", q[2]}, {"z", q[3]}}; }
Json anglesOf(const Vector& v) { return {{"a0", v[0]}, {"a1", v[1]}, {"a2", v[2]}}; }

/// A force command's vector; nothing if a component is missing or no finite number.
std::optional<Vector> readVector(const Json& object) {
    Vector result{};
    const std::array<const char*, 3> names{"x", "y", "z"};
    for (std::size_t i = 0; i < 3; ++i) {
        if (!object.is_object() || !object.contains(names[i]) || !object[names[i]].is_number()) return std::nullopt;
        result[i] = object[names[i]].get<double>();
        if (!std::isfinite(result[i])) return std::nullopt;
    }
    return result;
}

/// The same tree with the keys of every object in another order.
Json shuffled(const Json& tree, std::mt19937& chance) {
    if (tree.is_array()) {
        Json result = Json::array();
        for (const Json& item : tree) result.push_back(shuffled(item, chance));
        return result;
    }
    if (!tree.is_object()) return tree;
    std::vector<std::string> keys;
    for (const auto& item : tree.items()) keys.push_back(item.key());
    for (std::size_t i = keys.size(); i > 1; --i) std::swap(keys[i - 1], keys[chance() % i]);
    Json result = Json::object();
    for (const std::string& key : keys) result[key] = shuffled(tree[key], chance);
    return result;
}

/// The same tree with a key in every object, of a kind that changes from one to the next, that no page names.
Json withUnknownKeys(const Json& tree, int& count) {
    if (tree.is_array()) {
        Json result = Json::array();
        for (const Json& item : tree) result.push_back(withUnknownKeys(item, count));
        return result;
    }
    if (!tree.is_object()) return tree;
    Json result = Json::object();
    const std::array<Json, 5> values{Json("\"}]{\\u0000\u00b5"), Json{{"x", 1e300}}, Json::array({1, "two", nullptr}),
                                     Json(true), Json(nullptr)};
    result["future_" + std::to_string(count)] = values[static_cast<std::size_t>(count) % values.size()];
    ++count;
    for (const auto& item : tree.items()) result[item.key()] = withUnknownKeys(item.value(), count);
    return result;
}

}  // namespace

struct HaplyService::Device {
    bool plugged = true;
    HaplyDeviceState state;
    double gate_gain = kDocumentedGain;
    double damping = 0.0;
    bool idle = true;
    Vector felt{};
    std::vector<HaplyMessage> record;
};

struct HaplyService::Channel final : WebSocketHandler {
    std::function<void(int)> on_open;
    std::function<void(int, const std::string&)> on_text;
    std::function<void(int)> on_close;
    void opened(int client) override { on_open(client); }
    void received(int client, const std::string& text) override { on_text(client, text); }
    void closed(int client) override { on_close(client); }
};

HaplyService::HaplyService(std::vector<std::string> devices)
    : order_(std::move(devices)),
      simulation_channel_(std::make_unique<Channel>()),
      events_channel_(std::make_unique<Channel>()) {
    for (const std::string& id : order_) devices_[id] = std::make_unique<Device>();
    simulation_channel_->on_open = [this](int client) { simulationOpened(client); };
    simulation_channel_->on_text = [this](int client, const std::string& text) { simulationHeard(client, text); };
    simulation_channel_->on_close = [this](int client) { simulationClosed(client); };
    events_channel_->on_open = [this](int client) {
        const std::lock_guard lock(mutex_);
        listeners_[client] = true;
    };
    events_channel_->on_text = [](int, const std::string&) {};
    events_channel_->on_close = [this](int client) {
        const std::lock_guard lock(mutex_);
        listeners_.erase(client);
    };
    // The threads that call begin here, when all that they touch is there.
    simulation_ = std::make_unique<WebSocketServer>(*simulation_channel_);
    events_ = std::make_unique<WebSocketServer>(*events_channel_);
}

HaplyService::~HaplyService() {
    events_.reset();
    simulation_.reset();
}

void HaplyService::simulationOpened(int client) {
    std::string text;
    {
        const std::lock_guard lock(mutex_);
        session_of_[client] = ++sessions_;
        text = stateOf(true, sessions_);
    }
    simulation_->send(client, text, fragment_);
}

void HaplyService::simulationClosed(int client) {
    const std::lock_guard lock(mutex_);
    session_of_.erase(client);
    for (auto& [id, device] : devices_) {
        device->felt = {};
        device->idle = true;
        HaplyMessage end;
        end.number = messages_;
        end.is_end = true;
        device->record.push_back(end);
    }
}

/// Sets what the message asks for and adds its forces to `heard`. False if a part of it means nothing here.
bool HaplyService::obey(const nlohmann::ordered_json& message, std::map<std::string, HaplyMessage>& heard) {
    bool understood = true;
    for (const Json& entry : message.value("inverse3", Json::array())) {
        const std::string id = entry.value("device_id", std::string());
        const auto device = devices_.find(id);
        if (device == devices_.end() || !device->second->plugged) {
            understood = false;
            continue;
        }
        const Json configure = entry.value("configure", Json::object());
        if (configure.contains("force_gate")) {
            device->second->gate_gain = configure["force_gate"].value("gain", kDocumentedGain);
        }
        if (configure.contains("damping")) device->second->damping = configure["damping"].value("scalar", 0.0);
        const Json commands = entry.value("commands", Json::object());
        if (!commands.contains("set_cursor_force")) continue;
        const auto force = readVector(commands["set_cursor_force"].value("vector", Json()));
        if (!force) {
            understood = false;
            continue;
        }
        HaplyMessage& row = heard[id];
        row.commands_force = true;
        for (std::size_t i = 0; i < 3; ++i) row.commanded[i] += (*force)[i];
    }
    return understood;
}

void HaplyService::simulationHeard(int client, const std::string& text) {
    std::string reply;
    {
        const std::lock_guard lock(mutex_);
        ++messages_;
        std::map<std::string, HaplyMessage> heard;
        for (auto& [id, device] : devices_) {
            heard[id].number = messages_;
            heard[id].text = text;
        }
        try {
            if (!obey(Json::parse(text), heard)) ++misunderstood_;
        } catch (const Json::exception&) {
            ++misunderstood_;
        }
        for (auto& [id, device] : devices_) {
            HaplyMessage& row = heard[id];
            for (std::size_t i = 0; i < 3; ++i) row.felt[i] = device->gate_gain * row.commanded[i];
            device->felt = row.felt;
            device->idle = !row.commands_force;
            device->record.push_back(row);
        }
        reply = stateOf(false, session_of_[client]);
    }
    answer(client, reply);
}

void HaplyService::answer(int client, const std::string& text) {
    // The server's lock is taken before ours in its thread, so that ours is given up before anything is sent.
    std::size_t fragment = 0, cut = 0;
    bool is_cut = false, hangs_up = false;
    {
        const std::lock_guard lock(mutex_);
        if (held_) {
            held_answers_.emplace_back(client, text);
            return;
        }
        if (swallowed_ > 0) {
            --swallowed_;
            return;
        }
        ++answers_;
        fragment = fragment_;
        cut = cut_;
        is_cut = std::exchange(cuts_next_, false);
        hangs_up = hang_up_after_cut_;
    }
    if (!is_cut) return simulation_->send(client, text, fragment);
    simulation_->sendRaw(client, WebSocketServer::frame(text).substr(0, cut));
    if (hangs_up) simulation_->drop(client);
}

std::string HaplyService::stateOf(bool with_config, int session) const {
    Json tree;
    tree["session_id"] = session;
    tree["inverse3"] = Json::array();
    Json grips = Json::array();
    for (const std::string& id : order_) {
        const Device& device = *devices_.at(id);
        if (!device.plugged) continue;
        Json entry{{"device_id", id}};
        if (with_config) {
            entry["config"] = {
                {"type", "inverse3"},
                {"port", "/dev/ttyACM" + std::to_string(tree["inverse3"].size())},
                {"device_info", {{"major_version", 7}, {"minor_version", 4}, {"id", id}, {"device_type", 4}}},
                {"extended_firmware_version", "7.4.0"},
                {"gravity_compensation", {{"enabled", true}, {"scaling_factor", 1.0}}},
                {"handedness", "right"},
                {"streaming_mode", "USB"},
                {"torque_scaling", {{"enabled", true}}},
                {"home_return", {{"enabled", false}}},
                {"preset", "defaults"},
                {"basis", {{"permutation", "XYZ"}}},
                {"mount",
                 {{"position", vectorOf({})},
                  {"rotation", quaternionOf({1, 0, 0, 0})},
                  {"scale", vectorOf({1, 1, 1})}}},
                {"filters", {{"force_gate", {{"gain", device.gate_gain}}}, {"damping", {{"scalar", device.damping}}}}}};
        }
        const HaplyDeviceState& state = device.state;
        entry["state"] = {{"cursor_position", vectorOf(state.position)},
                          {"cursor_velocity", vectorOf(state.velocity)},
                          {"angular_position", anglesOf({})},
                          {"angular_velocity", anglesOf({})},
                          {"body_orientation", quaternionOf(state.body)},
                          {"current_cursor_force", vectorOf(device.felt)},
                          {"control_domain", "cartesian"},
                          {"control_mode", device.idle ? "idle" : "force"}};
        if (lie_ == Lie::Missing) {
            entry["state"].erase("cursor_position");
        } else if (lie_ != Lie::None && lie_ != Lie::Truncated) {
            entry["state"]["cursor_position"]["y"] = kLyingNumber;
        }
        entry["status"] = {{"calibrated", true}, {"in_use", true}, {"power_supply", true}, {"ready", true}};
        tree["inverse3"].push_back(entry);
        Json grip{{"device_id", "G" + id}};
        if (with_config) grip["config"] = {{"type", grip_family_}};
        grip["state"] = {{"orientation", quaternionOf(state.grip)},
                         {"buttons", {{"a", state.buttons[0]}, {"b", state.buttons[1]}, {"c", state.buttons[2]}}}};
        grips.push_back(grip);
    }
    if (!grip_family_.empty()) tree[grip_family_] = grips;
    if (unknown_keys_) {
        int count = 0;
        tree = withUnknownKeys(tree, count);
    }
    if (shuffle_ != 0) {
        std::mt19937 chance(shuffle_);
        tree = shuffled(tree, chance);
    }
    std::string text = tree.dump();
    const std::map<Lie, std::string> words{
        {Lie::NotANumber, "NaN"}, {Lie::Null, "null"}, {Lie::Huge, "1e999"}, {Lie::Text, "\"0.1\""}};
    const std::string placeholder = '"' + std::string(kLyingNumber) + '"';
    for (std::size_t at; (at = text.find(placeholder)) != std::string::npos;) {
        text.replace(at, placeholder.size(), words.at(lie_));
    }
    if (lie_ == Lie::Truncated) text.resize(text.size() / 2);
    return text;
}

void HaplyService::setState(const std::string& device, const HaplyDeviceState& state) {
    const std::lock_guard lock(mutex_);
    if (!frozen_) devices_.at(device)->state = state;
}

void HaplyService::plug(const std::string& device) {
    {
        const std::lock_guard lock(mutex_);
        devices_.at(device)->plugged = true;
    }
    sendEvent("device-connected", "device", "info", device);
}

void HaplyService::unplug(const std::string& device) {
    {
        const std::lock_guard lock(mutex_);
        devices_.at(device)->plugged = false;
        devices_.at(device)->felt = {};
    }
    sendEvent("device-disconnected", "device", "warning", device);
}

void HaplyService::sendEvent(const std::string& name, const std::string& category, const std::string& level,
                             const std::string& device, const std::string& safety_type) {
    Json data{{"device_family", "inverse"}, {"device_id", device}};
    if (!safety_type.empty()) data["safety_type"] = safety_type;
    const Json event{{"name", name}, {"category", category}, {"level", level}, {"data", data}, {"message", name}};
    std::vector<int> clients;
    {
        const std::lock_guard lock(mutex_);
        for (const auto& [client, listens] : listeners_) clients.push_back(client);
    }
    for (const int client : clients) events_->send(client, event.dump());
}

void HaplyService::hold(bool held) {
    std::vector<std::pair<int, std::string>> free;
    {
        const std::lock_guard lock(mutex_);
        held_ = held;
        if (!held) free.swap(held_answers_);
    }
    for (const auto& [client, text] : free) answer(client, text);
}

void HaplyService::cutNextAnswer(std::size_t bytes, bool hang_up) {
    const std::lock_guard lock(mutex_);
    cuts_next_ = true;
    cut_ = bytes;
    hang_up_after_cut_ = hang_up;
}

void HaplyService::closeConnections(int code) {
    std::map<int, int> clients;
    {
        const std::lock_guard lock(mutex_);
        clients = session_of_;
    }
    for (const auto& [client, session] : clients) simulation_->close(client, code);
}

void HaplyService::dropConnections() {
    std::map<int, int> clients;
    {
        const std::lock_guard lock(mutex_);
        clients = session_of_;
    }
    for (const auto& [client, session] : clients) simulation_->drop(client);
}

void HaplyService::pingConnections() {
    std::map<int, int> clients;
    {
        const std::lock_guard lock(mutex_);
        clients = session_of_;
    }
    for (const auto& [client, session] : clients) simulation_->ping(client, "still there?");
}

void HaplyService::reverseDevices() {
    const std::lock_guard lock(mutex_);
    std::reverse(order_.begin(), order_.end());
}

void HaplyService::setGripFamily(const std::string& family) {
    const std::lock_guard lock(mutex_);
    grip_family_ = family;
}

void HaplyService::setGateGain(const std::string& device, double gain) {
    const std::lock_guard lock(mutex_);
    devices_.at(device)->gate_gain = gain;
}

double HaplyService::gateGain(const std::string& device) const {
    const std::lock_guard lock(mutex_);
    return devices_.at(device)->gate_gain;
}

void HaplyService::shuffleKeys(unsigned seed) {
    const std::lock_guard lock(mutex_);
    shuffle_ = seed;
}

void HaplyService::addUnknownKeys(bool add) {
    const std::lock_guard lock(mutex_);
    unknown_keys_ = add;
}

void HaplyService::fragment(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    fragment_ = bytes;
}

void HaplyService::lie(Lie what) {
    const std::lock_guard lock(mutex_);
    lie_ = what;
}

void HaplyService::freeze(bool frozen) {
    const std::lock_guard lock(mutex_);
    frozen_ = frozen;
}

void HaplyService::swallow(int count) {
    const std::lock_guard lock(mutex_);
    swallowed_ = count;
}

std::int64_t HaplyService::messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
}

std::int64_t HaplyService::answers() const {
    const std::lock_guard lock(mutex_);
    return answers_;
}

int HaplyService::connections() const {
    const std::lock_guard lock(mutex_);
    return static_cast<int>(session_of_.size());
}

int HaplyService::listeners() const {
    const std::lock_guard lock(mutex_);
    return static_cast<int>(listeners_.size());
}

int HaplyService::sessions() const {
    const std::lock_guard lock(mutex_);
    return sessions_;
}

std::array<double, 3> HaplyService::felt(const std::string& device) const {
    const std::lock_guard lock(mutex_);
    return devices_.at(device)->felt;
}

std::vector<HaplyMessage> HaplyService::record(const std::string& device) const {
    const std::lock_guard lock(mutex_);
    return devices_.at(device)->record;
}

std::int64_t HaplyService::misunderstood() const {
    const std::lock_guard lock(mutex_);
    return misunderstood_;
}

}  // namespace passung::fake
