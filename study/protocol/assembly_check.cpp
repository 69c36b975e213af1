#include "study/protocol/assembly_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "study/protocol/start_pose.h"

namespace passung::protocol {
namespace {

constexpr double kReachRounding = 1e-9;  // [m]

/// Where the step's part may be held: nobody can put a part where no point of it is within a hand's reach [m] beyond.
double beyondReach(const scene::HandSpec& hand, const DeviceDescription& device, const Pose& X_WP, double longest) {
    if (hand.navigation.any()) return 0.0;
    const scene::Registration& r = hand.registration;
    const double far = (r.X_WB.inverse() * X_WP.p).norm() - longest - r.X_DH.p.norm();
    return far - device.workspace_radius_m * r.scale;
}

}  // namespace

void checkAssembly(const StudyTables& tables, const plan::Condition& condition,
                   std::span<const DeviceDescription> devices, PartGeometries& geometries, Errors& errors) {
    const scene::SceneSpec& scene = condition.scene;
    const auto& steps = scene.effects.pick.steps;
    const auto& items = tables.task.find("step")->items;
    std::vector<Pose> X_WP;
    for (const scene::PartSpec& part : scene.parts) X_WP.push_back(part.X_WP);
    std::vector<bool> rests;
    for (const scene::PartSpec& part : scene.parts) rests.push_back(!part.moves());
    std::vector<scene::StepSet> before(steps.size());
    for (const std::size_t i : scene::orderOf(steps)) {
        const scene::AssemblyStep& step = steps[i];
        const scene::PartSpec& part = scene.parts[step.part];
        const Node& place = *items[i].find("position");
        const auto fail = [&](std::string message) {
            errors.push_back(errorAt(place.place, "task.step.position", valueText(place), std::move(message)));
        };
        X_WP[step.part] = scene::goalOf(step, X_WP);
        for (std::size_t other = 0; other < steps.size(); ++other)
            if ((step.after & scene::stepBit(other)) != 0) before[i] |= scene::stepBit(other) | before[other];
        const PartSurface* surface = geometries.of(part);
        if (surface == nullptr) continue;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t hand = 0; hand < scene.handCount(); ++hand) {
            const std::string& name = hand == 0 ? condition.device : condition.other_devices[hand - 1];
            const auto device =
                std::find_if(devices.begin(), devices.end(), [&](const auto& known) { return known.name == name; });
            if (device == devices.end() || !scene.canPick(hand)) continue;
            for (const Pose& X : {part.X_WP, X_WP[step.part]})
                least = std::min(least, beyondReach(scene.hand(hand), *device, X, surface->longest()));
        }
        if (least < std::numeric_limits<double>::infinity() && least > kReachRounding)
            fail(fmt::format("or its start is out of every hand's reach, by {:.4g} mm", 1e3 * least));
        const double slack = std::max(scene.contact.tolerance, step.position_tolerance);
        for (std::size_t other = 0; other < scene.parts.size(); ++other) {
            const auto places = [&](std::size_t s) {
                return steps[s].part == other && (before[i] & scene::stepBit(s));
            };
            bool is_there = rests[other];
            for (std::size_t s = 0; s < steps.size(); ++s) is_there = is_there || places(s);
            if (!is_there) continue;
            scene::PartSpec obstacle = scene.parts[other];
            obstacle.X_WP = X_WP[other];
            const double depth = depthAt(part, X_WP[step.part], obstacle, geometries);
            if (depth > slack)
                fail(fmt::format("there part {} stands {:.4g} mm deep in part {}, more than the tolerance of {:.4g} mm",
                                 part.name, 1e3 * depth, obstacle.name, 1e3 * slack));
        }
    }
}

}  // namespace passung::protocol
