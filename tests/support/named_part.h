#pragma once

#include <string>
#include <utility>

#include "core/scene/scene_spec.h"

namespace passung::test {

/// A part of this name and shape; the rest as a scene file leaves it.
inline model::PartSpec namedPart(std::string name, const model::Shape& shape) {
    model::PartSpec part;
    part.name = std::move(name);
    part.geometry = shape;
    return part;
}

}  // namespace passung::test
