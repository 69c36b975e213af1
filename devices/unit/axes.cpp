#include "devices/unit/axes.h"

#include <utility>

namespace passung::unit {

Result<Axes> Axes::parse(std::string_view text) {
    const Error wrong{.message = "must be x, y and z in some order, parted by blanks, each with or without a minus",
                      .key = "axes",
                      .value = std::string(text)};
    Axes axes;
    std::array<bool, 3> used{};
    for (std::size_t i = 0; i < 3; ++i) {
        const bool minus = !text.empty() && text.front() == '-';
        if (minus) text.remove_prefix(1);
        if (text.empty() || text.front() < 'x' || text.front() > 'z') return wrong;
        axes.source_[i] = text.front() - 'x';
        axes.sign_[i] = minus ? -1.0 : 1.0;
        if (std::exchange(used[static_cast<std::size_t>(axes.source_[i])], true)) return wrong;
        text.remove_prefix(1);
        if (i == 2) break;
        if (text.empty() || text.front() != ' ') return wrong;
        text.remove_prefix(1);
    }
    if (!text.empty()) return wrong;
    return axes;
}

Vec3 Axes::toBase(const Vec3& device) const noexcept {
    Vec3 base;
    for (int i = 0; i < 3; ++i)
        base[i] = sign_[static_cast<std::size_t>(i)] * device[source_[static_cast<std::size_t>(i)]];
    return base;
}

Vec3 Axes::toDevice(const Vec3& base) const noexcept {
    Vec3 device;
    for (int i = 0; i < 3; ++i)
        device[source_[static_cast<std::size_t>(i)]] = sign_[static_cast<std::size_t>(i)] * base[i];
    return device;
}

Pose Axes::toBase(const Pose& device) const noexcept {
    // With A the matrix of these axes: A R(n, angle) A^T = R(det(A) A n, angle).
    const Vec3 v = (mirrors() ? -1.0 : 1.0) * toBase(Vec3(device.q.vec()));
    return {Quat(device.q.w(), v.x(), v.y(), v.z()), toBase(device.p)};
}

bool Axes::mirrors() const noexcept {
    return toBase(Vec3::UnitX()).cross(toBase(Vec3::UnitY())).dot(toBase(Vec3::UnitZ())) < 0.0;
}

std::string Axes::text() const {
    std::string text;
    for (std::size_t i = 0; i < 3; ++i) {
        if (i > 0) text += ' ';
        if (sign_[i] < 0.0) text += '-';
        text += static_cast<char>('x' + source_[i]);
    }
    return text;
}

}  // namespace passung::unit
