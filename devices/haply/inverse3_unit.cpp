#include "devices/haply/inverse3_unit.h"

#include <fmt/format.h>

#include <algorithm>

#include "devices/haply/service_channels.h"
#include "devices/unit/linked_unit.h"

namespace passung::haply {
namespace {

using std::chrono::milliseconds;
using unit::Exchange;

constexpr milliseconds kInventoryTime{1000};

Result<std::vector<SaidOfDevice>> firstMessage(ServiceChannels& channels, const ServiceAddress& at) {
    if (const auto done = channels.connect(at.host, at.port, at.event_port); !done) return done.errors();
    const auto text = channels.message(kInventoryTime);
    auto devices = text ? readMessage(*text) : std::nullopt;
    if (devices) return *std::move(devices);
    return Error{.message = "what listens at " + at.host + ":" + at.port +
                            " does not begin with a list of devices, as Haply's Inverse Service 3.5 does"};
}

std::string idsOf(const std::vector<SaidOfDevice>& devices) {
    std::string ids;
    for (const SaidOfDevice& device : devices) ids += (ids.empty() ? "" : ", ") + device.id;
    return ids;
}

std::string filtersText(const Filters& found) {
    const auto text = [](std::optional<double> value) { return value ? fmt::format("{}", *value) : "not said"; };
    return fmt::format("force_gate gain {}, set to 1; damping {}, set to 0", text(found.gate_gain),
                       text(found.damping));
}

}  // namespace

Result<ServiceAddress> serviceAddress(const std::string& address) {
    ServiceAddress at;
    if (address.empty()) return at;
    const auto first = address.find(':');
    const auto second = address.find(':', first == std::string::npos ? first : first + 1);
    at.host = address.substr(0, first);
    if (first != std::string::npos)
        at.port = address.substr(first + 1, second == std::string::npos ? second : second - first - 1);
    if (second != std::string::npos) at.event_port = address.substr(second + 1);
    const auto isPort = [](const std::string& text) {
        return !text.empty() && text.size() <= 5 &&
               std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
    };
    if (at.host.empty() || !isPort(at.port) || !isPort(at.event_port))
        return Error{.message = "must be HOST:PORT or HOST:PORT:EVENTPORT", .key = "address", .value = address};
    return at;
}

Inverse3Link::Inverse3Link(DeviceChoice choice, ServiceAddress address)
    : choice_(std::move(choice)), address_(std::move(address)) {}
Inverse3Link::~Inverse3Link() = default;

void Inverse3Link::close() noexcept { channels_.reset(); }

Result<DeviceUnit> Inverse3Link::open() {
    channels_ = std::make_unique<ServiceChannels>();
    const auto devices = firstMessage(*channels_, address_);
    if (!devices) return devices.errors();
    if (devices->empty())
        return Error{.message = "the Inverse Service has no Inverse3: switch it on and plug it in; `lsusb` lists it"};
    const auto found = choice_.serial.empty()
                           ? devices->begin()
                           : std::find_if(devices->begin(), devices->end(),
                                          [&](const SaidOfDevice& device) { return device.id == choice_.serial; });
    if (found == devices->end())
        return Error{.message = "the Inverse Service has no device " + choice_.serial + ", but " + idsOf(*devices)};
    if (choice_.serial.empty() && devices->size() > 1)
        return Error{.message = "the Inverse Service has several devices, " + idsOf(*devices) +
                                ": name one as `serial` in the station file"};
    if (!found->basis.empty() && found->basis != "XYZ")
        return Error{.message = "the Inverse Service gives axes in the order " + found->basis +
                                ": set its basis to XYZ, x right, y forward, z up"};
    id_ = found->id;
    opens_gate_ = true;
    unanswered_ = false;
    return DeviceUnit{.hand = choice_.hand,
                      .kind = choice_.kind,
                      .backend = "haply",
                      .serial = id_,
                      .model = "inverse3",
                      .versions = "firmware " + found->firmware,
                      .calibration = filtersText(found->filters)};
}

Exchange Inverse3Link::exchange(const Wrench& F_D_B, milliseconds longest) {
    bool late = false;
    while (channels_->message(milliseconds(0))) late = true;  // answers to earlier messages
    if (late) unanswered_ = false;
    const Vec3 force = unanswered_ ? Vec3(Vec3::Zero()) : F_D_B.force;
    if (!channels_->send(forceMessage(id_, force, opens_gate_), longest))
        return {Exchange::Kind::Gone, {}, "the Inverse Service has gone: its connection has ended"};
    opens_gate_ = false;
    const auto text = channels_->message(longest);
    unanswered_ = !text;
    while (const auto event = channels_->event())
        if (std::string harm = harmOf(*event, id_); !harm.empty()) return {Exchange::Kind::Gone, {}, std::move(harm)};
    if (text) return taken(*text);
    if (!channels_->isOpen())
        return {Exchange::Kind::Gone, {}, "the Inverse Service has gone: its connection has ended"};
    return {};
}

Exchange Inverse3Link::taken(const std::string& text) const {
    const auto devices = readMessage(text);
    if (!devices) return {Exchange::Kind::Wrong, {}, "a state of the Inverse Service is no JSON, or none of 3.5"};
    const auto found =
        std::find_if(devices->begin(), devices->end(), [&](const SaidOfDevice& device) { return device.id == id_; });
    if (found == devices->end())
        return {Exchange::Kind::Gone, {}, "the Inverse3 " + id_ + " is not in the service's list any more: unplugged?"};
    const auto& orientation = found->grip ? found->grip : found->body;
    if (!found->position || !orientation)
        return {Exchange::Kind::Wrong, {}, "position or orientation of the Inverse3 " + id_ + " is no finite number"};
    Exchange exchange{Exchange::Kind::News, {}, {}};
    exchange.said.X_BD = {*orientation, toBase(*found->position)};
    exchange.said.V_D_B.v = found->velocity.value_or(Vec3::Zero());
    exchange.said.buttons = found->buttons;
    return exchange;
}

Result<std::unique_ptr<unit::Unit>> openInverse3(const DeviceChoice& choice, const DeviceDescription& description) {
    auto address = serviceAddress(choice.address);
    if (!address) return address.errors();
    if (!choice.axes.empty())
        return Error{.message = "the axes of an Inverse3 are its service's basis: leave them out",
                     .key = "axes",
                     .value = choice.axes};
    unit::LinkedParams params;
    params.description = description;
    return std::unique_ptr<unit::Unit>(std::make_unique<unit::LinkedUnit>(
        std::make_unique<Inverse3Link>(choice, *std::move(address)), std::move(params)));
}

Result<std::vector<SaidOfDevice>> inventory(const std::string& address) {
    const auto at = serviceAddress(address);
    if (!at) return at.errors();
    ServiceChannels channels;
    return firstMessage(channels, *at);
}

}  // namespace passung::haply
