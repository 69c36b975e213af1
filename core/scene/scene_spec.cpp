#include "core/scene/scene_spec.h"

#include <cmath>
#include <set>

#include "core/scene/contact_geometry.h"

namespace passung::scene {

namespace {

class Checks {
public:
    void positive(const char* key, double value) {
        require(std::isfinite(value) && value > 0.0, key, value, "must be > 0");
    }
    void notNegative(const char* key, double value) {
        require(std::isfinite(value) && value >= 0.0, key, value, "must be ≥ 0");
    }
    void require(bool holds, const std::string& key, double value, const char* requirement) {
        if (!holds) errors.push_back({.message = requirement, .key = key, .value = std::to_string(value)});
    }
    void finite(const std::string& key, const Pose& pose) {
        if (!isFinite(pose) || !(std::abs(pose.q.norm() - 1.0) < 1e-9)) {
            errors.push_back({.message = "must be finite with a unit rotation", .key = key});
        }
    }
    std::vector<Error> errors;
};

}  // namespace

std::vector<Error> SceneSpec::validate() const {
    Checks check;
    int held = 0;
    std::set<std::string> names;
    for (const auto& part : parts) {
        held += part.held ? 1 : 0;
        check.finite("part " + part.name + ": pose", part.X_WP);
        if (!names.insert(part.name).second) {
            check.errors.push_back({.message = "part names must differ", .key = "part", .value = part.name});
        }
        if (const auto* shape = std::get_if<shape::Shape>(&part.geometry)) {
            for (auto error : shape::validate(*shape)) {
                error.key = "part " + part.name + ": " + error.key;
                check.errors.push_back(std::move(error));
            }
        }
    }
    for (const PartSpec& part : parts) {
        check.notNegative("part: friction", part.friction);
        check.notNegative("part: sliding friction", part.sliding_friction);
        check.require(!(part.sliding_friction > part.friction), "part: sliding friction", part.sliding_friction,
                      "must not exceed the friction at rest");
    }
    check.require(held == 1, "part: held", held, "exactly one part must be held");
    check.positive("contact: stiffness", contact.stiffness);
    check.notNegative("contact: rotational stiffness", contact.rotational_stiffness);
    check.notNegative("contact: damping", contact.damping);
    check.notNegative("contact: rotational damping", contact.rotational_damping);
    check.positive("contact: area stiffness", contact.area_stiffness);
    check.positive("contact: penalty stiffness", contact.penalty_stiffness);
    check.positive("contact: tool mass", contact.tool_mass);
    check.positive("contact: tool inertia", contact.tool_inertia);
    if (contact.coupling != PenaltyCoupling::Direct && contact.method != ContactMethod::Penalty)
        check.errors.push_back(
            {.message = "needs the penalty method: a god object has its own", .key = "contact: coupling"});
    if (const auto problem = geometryProblem(*this))
        check.errors.push_back({.message = *problem, .key = "contact: geometry"});
    check.positive("contact: tolerance", contact.tolerance);
    check.notNegative("contact: cell", contact.cell);
    check.positive("contact: spacing", contact.spacing);
    check.require(contact.budget_nodes >= 0, "contact: budget_nodes", contact.budget_nodes, "must be ≥ 0");
    check.positive("limits: max force", limits.max_force);
    check.notNegative("limits: max torque", limits.max_torque);
    check.positive("limits: max force rate", limits.max_force_rate);
    check.positive("limits: max speed", limits.max_speed);
    check.positive("limits: max spin", limits.max_spin);
    check.require(limits.delay_ticks >= 0 && limits.delay_ticks <= kMaxDelayTicks, "limits: delay_ticks",
                  limits.delay_ticks, "must be 0 … 100");
    check.notNegative("effects: passivity damping", effects.passivity_damping);
    const Transients& transients = effects.transients;
    check.notNegative("effects: transients: amplitude", transients.amplitude);
    check.positive("effects: transients: frequency", transients.frequency);
    check.require(!(transients.frequency >= 500.0), "effects: transients: frequency", transients.frequency,
                  "must be below half the tick's rate, 500 Hz");
    check.positive("effects: transients: decay", transients.decay);
    check.notNegative("contact: proxy filter", contact.proxy_filter);
    check.finite("registration: device base", registration.X_WB);
    check.finite("registration: handle", registration.X_DH);
    check.positive("registration: scale", registration.scale);
    check.notNegative("start gate: position tolerance", start_gate.position_tolerance);
    check.notNegative("start gate: angle tolerance", start_gate.angle_tolerance);
    check.require(start_gate.hold_ticks >= 0, "start gate: hold", start_gate.hold_ticks, "must be ≥ 0");
    return check.errors;
}

}  // namespace passung::scene
