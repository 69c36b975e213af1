#pragma once

#include <array>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/base/types.h"

namespace passung::unit {

/// Which axis of a device points along each axis of its base frame B, and which way: one of the 48 signed permutations.
/// The frame is converted here and nowhere else.
class Axes {
public:
    Axes() = default;  // as they are

    /// "x -z y": B's x is the device's x, B's y against its z, B's z its y. Errors: anything else.
    static Result<Axes> parse(std::string_view text);

    Vec3 toBase(const Vec3& device) const noexcept;
    Vec3 toDevice(const Vec3& base) const noexcept;
    /// The handle's own axes are renamed as the base's are: at rest both frames agree.
    Pose toBase(const Pose& device) const noexcept;
    bool mirrors() const noexcept;  // left-handed to right-handed
    std::string text() const;

private:
    std::array<int, 3> source_{0, 1, 2};
    std::array<double, 3> sign_{1.0, 1.0, 1.0};
};

}  // namespace passung::unit
