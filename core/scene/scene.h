#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/scene/part.h"
#include "core/scene/scene_spec.h"

namespace passung::scene {

/// Parts that several scenes of a study have in common are built once.
class PartCache {
public:
    /// `store`, which must outlive the cache, keeps fields and shells from run to run: see buildPart.
    explicit PartCache(BuildStore* store = nullptr) : store_(store) {}

    /// Errors as buildPart. shared_ptr: scenes that come and go share a part, and the cache may go first.
    Result<std::shared_ptr<const Part>> get(const PartSpec& spec, const PartNeeds& needs);

private:
    BuildStore* store_;
    std::map<std::string, std::shared_ptr<const Part>> parts_;
};

/// A scene with everything built; const from then on.
struct Scene {
    SceneSpec spec;
    std::vector<std::shared_ptr<const Part>> parts;  // in the order of spec.parts
    std::size_t held = 0;                            // index of the first hand's part
};

/// Builds what the scene's geometry (contact_geometry.h) takes: of Geometry::Field the shells of the held parts and the
/// fields of all that they can meet, with contact.two_way all of both; of closed forms nothing beside the parts.
/// Errors: SceneSpec::validate and buildPart.
Result<Scene> buildScene(const SceneSpec& spec, PartCache& cache);

}  // namespace passung::scene
