#include "study/protocol/weight_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "core/scene/part_mass.h"
#include "study/plan/scene_parts.h"

namespace passung::protocol {
namespace {

constexpr double kSeenSag = 1e-3;                             // [m]
constexpr double kSeenTurn = 3.0 * std::numbers::pi / 180.0;  // [rad]

/// The value of `key` in `table`, else of what is nearest to it.
const Node* nearest(const Node& scene, const char* table, const char* key) {
    const Node* found = scene.find(table);
    if (found == nullptr) return &scene;
    const Node* value = found->find(key);
    return value != nullptr ? value : found;
}

class WeightCheck {
public:
    WeightCheck(const Node& table, const std::string& path, const scene::SceneSpec& scene, PartGeometries& geometries,
                Errors& errors, std::vector<std::string>& warnings)
        : table_(table),
          prefix_(path.empty() ? "" : path + "."),
          scene_(scene),
          geometries_(geometries),
          errors_(errors),
          warnings_(warnings) {}

    void run() {
        const Node* parts = table_.find("part");
        if (parts == nullptr || parts->items.size() != scene_.parts.size()) return;
        for (std::size_t i = 0; i < scene_.parts.size(); ++i) checkPart(scene_.parts[i], parts->items[i]);
    }

private:
    void checkPart(const scene::PartSpec& part, const Node& node) {
        const Node* density = node.find("density_kg_per_m3");
        const auto body = part.density > 0.0 ? geometries_.massOf(part) : std::nullopt;
        const std::string key = fmt::format("part.{}.density_kg_per_m3", part.name);
        if (part.density > 0.0 && !body)
            return fail(density != nullptr ? *density : node, key,
                        "needs a part that encloses a volume: " + geometries_.notClosed(part));
        const bool weighs = !scene_.effects.weight.gravity.isZero(0.0);
        if (!part.moves() || !(weighs || scene_.effects.inertia.any())) return;
        if (density == nullptr && !part.held) return;
        const char* effect = weighs ? "weight" : "inertia";
        if (density == nullptr)
            return fail(*nearest(table_, "effects", effect), fmt::format("effects.{}", effect),
                        fmt::format("needs density_kg_per_m3 of the held part, {}", part.name));
        if (const auto weight = body ? scene::weigh(scene_, *body) : std::nullopt)
            checkShown(part, *weight, *density, key);
    }

    void checkShown(const scene::PartSpec& part, const scene::HeldWeight& weight, const Node& density,
                    const std::string& key) {
        const scene::ContactSpec& contact = scene_.contact;
        const scene::OutputLimits limits = scene_.hand(part.hand).limits;
        if (weight.force > limits.max_force)
            fail(density, key,
                 fmt::format("the part weighs {:.3g} N: more than the {:.3g} N that the device may show", weight.force,
                             limits.max_force));
        if (weight.turn > scene::kMostHangingTurn)
            fail(*nearest(table_, "contact", "rotational_stiffness_Nm_per_rad"),
                 "contact.rotational_stiffness_Nm_per_rad",
                 fmt::format("the held part's weight, up to {:.3g} Nm about its origin, would turn it by {:.2g} rad "
                             "against the hand: at least {:.3g}, or an origin nearer to its centre of mass",
                             weight.torque, weight.turn, weight.torque / scene::kMostHangingTurn));
        else if (weight.sag > kSeenSag || weight.turn > kSeenTurn)
            warn(fmt::format("effects.weight: the held part {}; a stiffer coupling holds it nearer",
                             scene::describe(weight)));
        if (!limits.actuates_torque || !(weight.torque > 0.0)) return;
        if (weight.has_proxy && !(contact.rotational_stiffness > 0.0))
            warn(
                "effects.weight: contact.rotational_stiffness_Nm_per_rad = 0 shows no torque: the held part weighs as "
                "if its centre of mass were in its origin");
        else if (weight.torque > limits.max_torque)
            warn(
                fmt::format("effects.weight: up to {:.3g} Nm about the held part's origin is more than the {:.3g} Nm "
                            "that the device may show: force and torque are cut where it is reached",
                            weight.torque, limits.max_torque));
    }

    void fail(const Node& at, const std::string& key, std::string message) {
        const bool value = at.kind != Node::Kind::Table;
        errors_.push_back(errorAt(at.place, prefix_ + key, value ? valueText(at) : "", std::move(message)));
    }
    void warn(std::string sentence) {
        sentence.insert(0, prefix_);
        if (std::find(warnings_.begin(), warnings_.end(), sentence) == warnings_.end())
            warnings_.push_back(std::move(sentence));
    }

    const Node& table_;
    const std::string prefix_;
    const scene::SceneSpec& scene_;
    PartGeometries& geometries_;
    Errors& errors_;
    std::vector<std::string>& warnings_;
};

}  // namespace

void checkWeight(const Node& table, const std::string& path, const scene::SceneSpec& scene, PartGeometries& geometries,
                 Errors& errors, std::vector<std::string>& warnings) {
    WeightCheck(table, path, scene, geometries, errors, warnings).run();
}

}  // namespace passung::protocol
