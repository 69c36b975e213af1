#include "devices/vrpn/tracker_wire.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace passung::vrpn {
namespace {

constexpr std::string_view kMagic = "vrpn: ver. ";
constexpr std::size_t kVersionLength = 5;
constexpr std::size_t kHead = 24, kAlign = 8;
constexpr std::int32_t kNamesSender = -1, kNamesType = -2, kLastOfSystem = -5;  // UDP, log, end

std::uint32_t wordAt(std::string_view bytes, std::size_t at) {
    std::uint32_t word = 0;
    for (const char byte : bytes.substr(at, sizeof word)) word = word << 8 | static_cast<unsigned char>(byte);
    return word;
}

std::int32_t intAt(std::string_view bytes, std::size_t at) { return static_cast<std::int32_t>(wordAt(bytes, at)); }

double doubleAt(std::string_view bytes, std::size_t at) {
    return std::bit_cast<double>(std::uint64_t{wordAt(bytes, at)} << 32 | wordAt(bytes, at + 4));
}

Vec3 vectorAt(std::string_view bytes, std::size_t at) {
    return {doubleAt(bytes, at), doubleAt(bytes, at + 8), doubleAt(bytes, at + 16)};
}

bool fits(ReportKind kind, std::size_t body) {
    switch (kind) {
        case ReportKind::Pose:
            return body == 64;
        case ReportKind::Button:
            return body == 8;
        case ReportKind::Analog:
            return body >= 8 && body % 8 == 0;
        case ReportKind::Force:
            return body == 24;
        case ReportKind::Other:
            break;
    }
    return true;
}

/// Sensor, a word that only aligns, position, quaternion x, y, z, w.
Message poseOf(std::string_view body) {
    const Vec3 v = vectorAt(body, 32);
    return PoseReport{intAt(body, 0), {Quat(doubleAt(body, 56), v.x(), v.y(), v.z()), vectorAt(body, 8)}};
}

/// The number of channels, and their values.
Message analogOf(std::string_view body) {
    if (body.size() == 8) return Nothing{};
    return AnalogReport{doubleAt(body, 8)};
}

}  // namespace

void MessageCutter::add(std::string_view bytes) {
    bytes_.erase(0, std::exchange(taken_, 0));
    bytes_.append(bytes);
}

std::optional<Heard> MessageCutter::next() {
    if (!greeted_) return greeting();
    const std::string_view bytes = rest();
    if (bytes.size() < kHead) return std::nullopt;
    const Head head{wordAt(bytes, 0), intAt(bytes, 12), intAt(bytes, 16)};
    // Judged before its body is there, of which too much would be waited for.
    if (!canBe(head)) return Heard{{}, Broken{}};
    const std::size_t whole = (head.length + kAlign - 1) / kAlign * kAlign;
    if (bytes.size() < whole) return std::nullopt;
    taken_ += whole;
    Heard heard{{}, read(head, bytes.substr(kHead, head.length - kHead))};
    if (head.type >= 0) heard.sender = senders_.at(head.sender);
    return heard;
}

std::optional<Heard> MessageCutter::greeting() {
    const std::string_view bytes = rest();
    if (!bytes.starts_with(kMagic.substr(0, bytes.size()))) return Heard{{}, Broken{}};
    if (bytes.size() < kCookieLength) return std::nullopt;
    greeted_ = true;
    taken_ += kCookieLength;
    return Heard{{}, Greeting{std::string(bytes.substr(kMagic.size(), kVersionLength))}};
}

bool MessageCutter::canBe(const Head& head) const {
    if (head.length < kHead || head.length > kLongest) return false;
    if (head.type < 0) return head.type >= kLastOfSystem;
    const auto type = types_.find(head.type);
    return senders_.count(head.sender) > 0 && type != types_.end() && fits(type->second, head.length - kHead);
}

Message MessageCutter::read(const Head& head, std::string_view body) {
    if (head.type == kNamesSender || head.type == kNamesType) return learn(head, body) ? Message(Nothing{}) : Broken{};
    if (head.type < 0) return Nothing{};
    switch (types_.at(head.type)) {
        case ReportKind::Pose:
            return poseOf(body);
        case ReportKind::Button:
            return ButtonChange{intAt(body, 0), wordAt(body, 4) != 0};
        case ReportKind::Analog:
            return analogOf(body);
        case ReportKind::Force:
            return ForceReport{vectorAt(body, 0)};
        case ReportKind::Other:
            break;
    }
    return Nothing{};
}

/// Takes a name; false: it is none.
bool MessageCutter::learn(const Head& head, std::string_view body) {
    if (head.sender < 0 || body.size() < 5) return false;
    const std::uint32_t length = wordAt(body, 0);
    if (length < 1 || length > body.size() - 4) return false;
    const std::string_view text = body.substr(4, length);
    const std::string_view name = text.substr(0, text.find('\0'));
    if (name.size() == text.size()) return false;
    if (head.type == kNamesSender) {
        senders_[head.sender] = name;
        return senders_.size() <= kMostNames;
    }
    static const std::map<std::string_view, ReportKind> known{{"vrpn_Tracker Pos_Quat", ReportKind::Pose},
                                                              {"vrpn_Button Change", ReportKind::Button},
                                                              {"vrpn_Analog Channel", ReportKind::Analog},
                                                              {"vrpn_ForceDevice Force", ReportKind::Force}};
    const auto found = known.find(name);
    types_[head.sender] = found == known.end() ? ReportKind::Other : found->second;
    return types_.size() <= kMostNames;
}

}  // namespace passung::vrpn
