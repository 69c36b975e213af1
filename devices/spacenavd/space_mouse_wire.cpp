#include "devices/spacenavd/space_mouse_wire.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace passung::spacenavd {
namespace {

using Words = std::array<std::int32_t, 8>;

constexpr std::int32_t kMotion = 0, kPress = 1, kRelease = 2, kDevice = 3, kRawButton = 6;
constexpr std::int32_t kFirstReply = 0x7faa1000, kLastReply = 0x7faa7fff;  // to whatever a client may ask
constexpr std::int32_t kMostCounts = 32768, kMostButtons = 256;

const std::string kReply(reinterpret_cast<const char*>(&kProtocol1), sizeof kProtocol1);

bool isCount(std::int32_t value) { return value >= -kMostCounts && value <= kMostCounts; }

Frame buttonOf(const Words& words) {
    if (words[1] < 0 || words[1] >= kMostButtons) return Broken{};
    return Button{words[1], words[0] == kPress};
}

Frame nameOf(const Words& words) {
    std::array<char, 24> letters{};
    std::memcpy(letters.data(), &words[1], letters.size());
    const auto end = std::find(letters.begin(), letters.end(), '\0');
    return Name{{letters.begin(), end}, end != letters.end(), words[7] >= 0};
}

Frame frameOf(const Words& words) {
    const std::int32_t type = words[0];
    if (type == kMotion) {
        Deflection deflection;
        std::copy_n(words.begin() + 1, 6, deflection.counts.begin());
        if (!std::all_of(deflection.counts.begin(), deflection.counts.end(), isCount) || words[7] < 0) return Broken{};
        return deflection;
    }
    if (type == kPress || type == kRelease) return buttonOf(words);
    if (type == kDevice && words[1] == 1) return MouseRemoved{};
    if (type == kAskName) return nameOf(words);
    if ((type > kRelease && type <= kRawButton) || (type >= kFirstReply && type <= kLastReply)) return Nothing{};
    return Broken{};
}

Vec3 scaled(const std::int32_t* counts, double full) {
    Vec3 v;
    for (int i = 0; i < 3; ++i) v[i] = full * std::clamp(counts[i] / kFullCounts, -1.0, 1.0);
    return v;
}

}  // namespace

std::optional<Frame> FrameCutter::next() {
    while (bytes_.starts_with(kReply)) bytes_.erase(0, kReply.size());
    Words words{};
    if (bytes_.size() < sizeof words) return std::nullopt;
    std::memcpy(words.data(), bytes_.data(), sizeof words);
    bytes_.erase(0, sizeof words);
    return frameOf(words);
}

Twist twistOf(const Deflection& deflection, const unit::Axes& axes) {
    return {axes.toBase(scaled(deflection.counts.data(), kFullSpeed)),
            axes.toBase(scaled(deflection.counts.data() + 3, kFullSpin))};
}

Deflection deflectionFor(const Twist& V_D_B, const unit::Axes& axes) {
    Deflection deflection;
    const Vec3 v = axes.toDevice(V_D_B.v) * (kFullCounts / kFullSpeed);
    const Vec3 w = axes.toDevice(V_D_B.w) * (kFullCounts / kFullSpin);
    for (int i = 0; i < 3; ++i) {
        deflection.counts[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(std::lround(v[i]));
        deflection.counts[static_cast<std::size_t>(i) + 3] = static_cast<std::int32_t>(std::lround(w[i]));
    }
    return deflection;
}

}  // namespace passung::spacenavd
