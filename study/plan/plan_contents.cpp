#include "study/plan/plan_contents.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

namespace passung::plan {

std::vector<NamedMesh> meshesOf(const StudyPlan& plan, const std::string& study) {
    const auto folder = std::filesystem::path(study).parent_path();
    std::map<std::string, std::string> names;  // by path
    const auto list = [&](const scene::SceneSpec& scene) {
        for (const scene::PartSpec& part : scene.parts)
            if (const auto* mesh = std::get_if<scene::MeshFile>(&part.geometry)) {
                const std::filesystem::path path(mesh->path);
                const bool below = path.is_relative() == folder.is_relative() && !folder.empty();
                names[mesh->path] = below ? path.lexically_relative(folder).generic_string() : path.generic_string();
            }
    };
    for (const Condition& condition : plan.conditions) {
        list(condition.scene);
        if (condition.comparison) list(*condition.comparison);
    }
    std::vector<NamedMesh> meshes;
    for (const auto& [path, name] : names) meshes.push_back({name, path});
    return meshes;
}

std::vector<StableStiffness> stableStiffnessOf(const StudyPlan& plan, std::span<const DeviceDescription> devices) {
    std::set<std::string> named;
    for (const Condition& condition : plan.conditions) named.insert(condition.device);
    std::vector<StableStiffness> stable;
    for (const DeviceDescription& device : devices)
        if (named.erase(device.name) > 0)
            stable.push_back({device.name, device.stable_stiffness_N_per_m,
                              device.stable_rotational_stiffness_Nm_per_rad, device.stability_source});
    std::sort(stable.begin(), stable.end(),
              [](const StableStiffness& a, const StableStiffness& b) { return a.device < b.device; });
    return stable;
}

std::size_t mostHands(const StudyPlan& plan) {
    std::size_t most = 1;
    for (const Condition& condition : plan.conditions) most = std::max(most, condition.scene.handCount());
    return most;
}

}  // namespace passung::plan
