#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "core/base/types.h"

namespace passung::vrpn {

struct Greeting {
    std::string version;  // such as "07.38"
};
/// Where a sensor is, in the server's frame [m]; the quaternion is as it came, of whatever length.
struct PoseReport {
    std::int32_t sensor = 0;
    Pose X;
};
struct ButtonChange {
    std::int32_t number = 0;  // from 0
    bool pressed = false;
};
struct AnalogReport {
    double first = 0.0;  // of its channels
};
struct ForceReport {
    Vec3 force;  // that the server's device displays [N]
};
struct Nothing {};  // what is of no use here, such as a name
struct Broken {};   // no message of VRPN's: the stream is shifted, or another program's
using Message = std::variant<Greeting, PoseReport, ButtonChange, AnalogReport, ForceReport, Nothing, Broken>;

struct Heard {
    std::string sender;  // a device's name; empty: the server itself
    Message message;
};

/// What each side begins with. Of the server's the version's first half has to be ours; what follows the version says
/// how much is logged, and may end in anything.
inline constexpr std::size_t kCookieLength = 24;
inline constexpr std::string_view kCookie{"vrpn: ver. 07.38  0\0\0\0\0\0", kCookieLength};

enum class ReportKind { Pose, Button, Analog, Force, Other };

/// Cuts a server's bytes into its cookie and messages. A message has a head of 24 bytes, six big-endian words: length
/// of head and body, seconds, microseconds, sender, type, a count; its body is padded to 8 bytes, which the length
/// leaves out. Type -1 gives the sender, -2 the type of the number in the sender's place its name, in a text with its
/// length before and a zero behind; what is less is the system's. A number that was not named yet is none.
class MessageCutter {
public:
    static constexpr std::uint32_t kLongest = 65536;    // VRPN's own buffers hold 64 000
    static constexpr std::size_t kMostNames = 1 << 14;  // of senders, and of types; VRPN's tables hold 2 000

    void add(std::string_view bytes);
    /// The next whole message; none: more bytes have to come. After Broken nothing that follows can be trusted.
    std::optional<Heard> next();

private:
    struct Head {
        std::uint32_t length = 0;
        std::int32_t sender = 0, type = 0;
    };
    std::string_view rest() const { return std::string_view(bytes_).substr(taken_); }
    std::optional<Heard> greeting();
    bool canBe(const Head& head) const;
    Message read(const Head& head, std::string_view body);
    bool learn(const Head& head, std::string_view body);

    std::string bytes_;
    std::size_t taken_ = 0;  // of the bytes
    bool greeted_ = false;
    std::map<std::int32_t, std::string> senders_;
    std::map<std::int32_t, ReportKind> types_;
};

}  // namespace passung::vrpn
