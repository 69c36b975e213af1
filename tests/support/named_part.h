#pragma once

#include <string>
#include <utility>

#include "core/scene/scene_spec.h"

namespace passung::test {

/// A part of this name and shape; the rest as a scene file leaves it.
inline scene::PartSpec namedPart(std::string name, const shape::Shape& shape) {
    scene::PartSpec part;
    part.name = std::move(name);
    part.geometry = shape;
    return part;
}

}  // namespace passung::test
