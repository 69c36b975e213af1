#pragma once

#include <string>

#include "tests/bench/contact_scene.h"

namespace passung::bench {

/// Writes the poses of `scene` and their truth, and which meshes they belong to. Errors: the file cannot be written.
Result<Done> writeTruePoses(const ContactScene& scene, const std::string& file);

/// The first `count` poses of each kind (fewer if there are no more). Errors: unreadable, not a file of this kind, made
/// for other meshes.
Result<ContactScene> readTruePoses(geometry::TriangleMesh bunny, const std::string& file, std::size_t count);

}  // namespace passung::bench
