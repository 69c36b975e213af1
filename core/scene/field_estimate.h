#pragma once

#include <optional>
#include <string>

#include "core/base/types.h"

namespace passung::scene {

/// Says that a distance field with cells of `cell` everywhere, on a surface of this size and area, would need more than
/// the 2 GiB that DistanceField::build() takes, how much, and what to change; nothing if it would not. An estimate from
/// below: what it passes may still be refused by a factor of about two. SI units.
std::optional<std::string> fieldTooLarge(const Vec3& size, double area, double cell);

}  // namespace passung::scene
