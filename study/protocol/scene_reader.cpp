#include "study/protocol/scene_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "core/base/device_unit.h"
#include "core/base/regular_file.h"
#include "core/scene/contact_geometry.h"
#include "core/scene/field_estimate.h"
#include "core/scene/part.h"
#include "study/protocol/felt_features.h"
#include "study/protocol/scene_node.h"
#include "study/protocol/weight_check.h"

namespace passung::protocol {
namespace {

constexpr double kDefaultStiffness = 1000.0;         // [N/m], without a device
constexpr double kDefaultRotationalStiffness = 1.0;  // [N·m/rad], without a device
constexpr double kHardness = 10.0;                   // of a coupled penalty's contacts, per stiffness of the coupling
constexpr double kMostGravity = 100.0;               // [m/s²]
constexpr double kToolShare = 0.1;                   // of a virtual tool's inertia, per the device's

/// Names of the scene's hands but the first; empty where there is none, which is told elsewhere.
std::vector<std::string> readHandNames(const TableReader& read) {
    std::vector<std::string> names;
    for (const Node& table : read.items("hand")) {
        const Node* name = table.find("name");
        names.push_back(name != nullptr && name->kind == Node::Kind::Text && isName(name->text) ? name->text : "");
    }
    if (names.size() >= scene::kMostHands)
        read.fail("hand", fmt::format("must be at most {}: a scene has up to {} hands", scene::kMostHands - 1,
                                      scene::kMostHands));
    return names;
}

std::vector<scene::PartSpec> readParts(const TableReader& read, const Node& scene, const std::string& path,
                                       double units, std::span<const std::string> other_hands, Errors& errors) {
    std::vector<scene::PartSpec> parts;
    std::set<std::string> names;
    std::vector<bool> full(1 + other_hands.size());  // hands that hold a part
    for (const Node& table : read.items("part")) {
        auto part = readPartNode(table, path, units, other_hands, errors);
        const auto report = [&](const char* key, const char* message) {
            const Node& value = *table.find(key);
            errors.push_back(
                errorAt(value.place, fmt::format("{}.{}", read.pathOf("part"), key), valueText(value), message));
        };
        if (!part.name.empty() && !names.insert(part.name).second) report("name", "is used by another part");
        if (part.held && full[part.hand]) report("held", "only one part can be held by each hand");
        if (part.held) full[part.hand] = true;
        parts.push_back(std::move(part));
    }
    if (!read.has("part")) return parts;
    const Node* effects = scene.find("effects");
    if (effects != nullptr && effects->find("pick") != nullptr) return parts;
    const bool pickable = std::any_of(parts.begin(), parts.end(), [](const auto& part) { return part.pickable; });
    if (!full[0])
        errors.push_back(errorAt(scene.place, read.pathOf("part"), "",
                                 pickable ? "parts can be picked up, for which effects.pick is missing"
                                          : "one part must be held: held = true; hands that pick parts up, as in an "
                                            "assembly, need effects.pick instead"));
    for (std::size_t i = 0; i < other_hands.size(); ++i)
        if (!full[i + 1] && !other_hands[i].empty())
            errors.push_back(
                errorAt(read.items("hand")[i].place, read.pathOf("hand"), other_hands[i],
                        fmt::format("holds no part: one needs held = true and hand = \"{}\"", other_hands[i])));
    return parts;
}

/// The key that names the device: `kind`, or as it was called before, `preset`.
std::string_view deviceKey(const TableReader& read) { return read.has("kind") ? "kind" : "preset"; }
std::string deviceName(const TableReader& read) { return read.text(deviceKey(read)); }

/// The device that the scene names; nullptr if none or unknown.
const DeviceDescription* findDevice(const TableReader& read, std::span<const DeviceDescription> devices) {
    if (read.has("kind") && read.has("preset"))
        read.fail("preset", "is an earlier name of kind: leave one of them out");
    if (!read.has(deviceKey(read))) return nullptr;
    const auto name = deviceName(read);
    std::vector<std::string_view> names;
    for (const auto& device : devices) {
        if (device.name == name) return &device;
        names.push_back(device.name);
    }
    read.fail(deviceKey(read), fmt::format("unknown device; known devices: {}", fmt::join(names, ", ")));
    return nullptr;
}

/// What the scene needs of a device that may be any.
std::optional<plan::DeviceNeeds> readNeeds(const TableReader& read) {
    const bool any = deviceName(read) == kAnyKind;
    for (const char* key : {"least_force_N", "least_torque_Nm", "least_degrees"})
        if (read.has(key) && !any) read.fail(key, "only with kind = \"any\": another kind has its own");
    if (!any) return std::nullopt;
    if (!read.has("least_force_N")) read.fail("least_force_N", "required with kind = \"any\"; 0: it need not push");
    return plan::DeviceNeeds{read.number("least_force_N"), read.number("least_torque_Nm"),
                             static_cast<int>(read.integer("least_degrees"))};
}

/// Of any device no more than what is needed is asked, so that all of them render the same.
void tightenTo(const TableReader& read, const plan::DeviceNeeds& needs, scene::OutputLimits& limits) {
    const auto atMost = [&](const char* key, double need, double& limit) {
        if (need > limit) read.fail(key, fmt::format("must not exceed what any device may need: {}", limit));
        if (need > 0.0) limit = need;
    };
    atMost("least_force_N", needs.force, limits.max_force);
    atMost("least_torque_Nm", needs.torque, limits.max_torque);
    limits.actuates_torque = needs.torque > 0.0;
}

scene::OutputLimits readLimits(const TableReader& read, const DeviceDescription* device) {
    scene::OutputLimits limits;
    if (device != nullptr) {
        limits.max_force = device->max_force_N;
        limits.max_torque = device->max_torque_Nm;
        limits.max_force_rate = device->max_force_rate_N_per_s;
        limits.max_speed = device->max_speed_m_per_s;
        limits.max_spin = device->max_spin_rad_per_s;
        limits.actuates_torque = device->actuated_degrees >= 6;
        if (device->mechanism) {
            limits.quantum = device->mechanism->quantum_m;
            limits.rotational_quantum = device->mechanism->rotational_quantum_rad;
        }
    }
    if (const auto needs = readNeeds(read)) tightenTo(read, *needs, limits);
    const auto tighten = [&](const char* key, double& limit) {
        if (!read.has(key)) return;
        if (device != nullptr && read.number(key) > limit)
            read.fail(key, fmt::format("must not exceed the limit of {}: {}", device->name, limit));
        limit = read.number(key);
    };
    tighten("max_force_N", limits.max_force);
    tighten("max_torque_Nm", limits.max_torque);
    tighten("max_force_rate_N_per_s", limits.max_force_rate);
    limits.delay_ticks = static_cast<int>(read.integer("delay_ticks"));
    return limits;
}

/// A stiffness as a number, and as a fraction of the device's stable `maximum` (0: not known).
struct ResolvedStiffness {
    double value = 0.0;
    double fraction = 1.0;
};

/// `otherwise`: the stiffness on a device that is named but not known.
/// `scaled`: said of the maximum, may be empty.
ResolvedStiffness resolveStiffness(const TableReader& read, const char* key, double maximum,
                                   const DeviceDescription* device, bool device_named, double otherwise,
                                   const std::string& scaled) {
    const Node* node = read.node(key);
    if (device_named && device == nullptr) return {otherwise, 1.0};
    const bool limited = maximum > 0.0;
    if (node->kind == Node::Kind::Text) {
        const double fraction = stiffnessFraction(node->text).value_or(1.0);
        if (device == nullptr)
            read.fail(key, "a fraction of the stable maximum needs device.preset");
        else if (!limited)
            read.fail(key, fmt::format("the stable maximum of {} is not known", device->name));
        return {fraction * maximum, fraction};
    }
    if (limited && node->number > maximum && !read.boolean("allow_unstable"))
        read.fail(key, fmt::format("must not exceed the stable maximum of {}{}: {}; allow_unstable = true lifts this",
                                   device->name, scaled, maximum));
    return {node->number, limited ? node->number / maximum : 1.0};
}

/// Of the hand's largest scale s, the registration's or that of position_scale. A handle that moves by d moves the held
/// part by s d, and feels K s d + B s v: so a stiffness K is as stable as K s without a scale, at a damping B that is
/// what the device recommends per s. At a smaller scale both are less in the same ratio, and farther from the border.
void readCoupling(const TableReader& read, const DeviceDescription* device, bool device_named,
                  const scene::HandSpec& hand, scene::ContactSpec& contact) {
    const double scale = hand.largestScale();
    const char* const whose = scale > hand.registration.scale ? "effects.position_scale" : "the registration's scale";
    const double maximum = device != nullptr ? device->stable_stiffness_N_per_m / scale : 0.0;
    const double rotational_maximum = device != nullptr ? device->stable_rotational_stiffness_Nm_per_rad : 0.0;
    const auto resolve = [&](const char* key, double limit, double otherwise) {
        const bool linear = limit == maximum && scale != 1.0;
        return resolveStiffness(read, key, limit, device, device_named, otherwise,
                                linear ? fmt::format(" per {} of {:.6g}", whose, scale) : "");
    };
    double fraction = 1.0;
    contact.stiffness = maximum > 0.0 ? maximum : kDefaultStiffness;
    if (read.has("stiffness_N_per_m")) {
        const auto stiffness = resolve("stiffness_N_per_m", maximum, kDefaultStiffness);
        contact.stiffness = stiffness.value;
        fraction = stiffness.fraction;
    }
    contact.rotational_stiffness = device != nullptr ? fraction * rotational_maximum : kDefaultRotationalStiffness;
    if (read.has("rotational_stiffness_Nm_per_rad"))
        contact.rotational_stiffness =
            resolve("rotational_stiffness_Nm_per_rad", rotational_maximum, kDefaultRotationalStiffness).value;
    contact.damping =
        read.numberOr("damping_Ns_per_m", device != nullptr ? device->recommended_damping_Ns_per_m / scale : 0.0);
    contact.rotational_damping = read.numberOr(
        "rotational_damping_Nms_per_rad", device != nullptr ? device->recommended_rotational_damping_Nms_per_rad : 0.0);
}

/// How the penalty reaches the hand, and the tool between them.
void readPenaltyCoupling(const TableReader& read, const DeviceDescription* device, scene::ContactSpec& contact) {
    const auto coupling = read.text("coupling");
    contact.coupling = coupling == "quasi_static" ? scene::PenaltyCoupling::QuasiStatic
                       : coupling == "virtual"    ? scene::PenaltyCoupling::Virtual
                                                  : scene::PenaltyCoupling::Direct;
    if (contact.coupling != scene::PenaltyCoupling::Direct && contact.method != scene::ContactMethod::Penalty)
        read.fail("coupling", "needs method = \"penalty\": a god object is coupled by a spring of its own");
    contact.penalty_stiffness = read.numberOr("penalty_stiffness_N_per_m", kHardness * contact.stiffness);
    const auto mechanism = device != nullptr ? device->mechanism.value_or(DeviceMechanism{}) : DeviceMechanism{};
    const auto share = [](double of_device, double unknown) {
        return of_device > 0.0 ? kToolShare * of_device : unknown;
    };
    contact.tool_mass = read.numberOr("tool_mass_kg", share(mechanism.mass_kg, contact.tool_mass));
    contact.tool_inertia = read.numberOr("tool_inertia_kg_m2", share(mechanism.inertia_kg_m2, contact.tool_inertia));
}

/// The device's stable maximum was found under these circumstances only: under others nothing is known to be stable.
void checkStability(const TableReader& device_table, const TableReader& contact_table, const DeviceDescription* device,
                    const scene::ContactSpec& contact, const scene::HandSpec& hand) {
    if (device == nullptr || contact_table.boolean("allow_unstable")) return;
    const bool linear = device->stable_stiffness_N_per_m > 0.0;
    const bool rotational = device->stable_rotational_stiffness_Nm_per_rad > 0.0;
    const auto refuse = [&](const TableReader& read, const char* key, const std::string& remedy) {
        read.fail(key, fmt::format("the stable maximum of {} is not known for this; {}, or allow_unstable = true",
                                   device->name, remedy));
    };
    const auto checkDamping = [&](const char* key, double damping, double recommended) {
        if (!(std::abs(damping - recommended) <= 1e-9 * recommended))
            refuse(contact_table, key, fmt::format("leave it out or set the recommended {}", recommended));
    };
    const double scale = hand.largestScale();
    if (linear) checkDamping("damping_Ns_per_m", contact.damping, device->recommended_damping_Ns_per_m / scale);
    if (rotational)
        checkDamping("rotational_damping_Nms_per_rad", contact.rotational_damping,
                     device->recommended_rotational_damping_Nms_per_rad);
    if (!linear && !rotational) return;
    if (hand.limits.delay_ticks != 0) refuse(device_table, "delay_ticks", "leave it out or set 0");
}

/// The coupling is resolved against the first hand's device: another one has to bear it.
void checkOtherStiffness(const TableReader& hand_table, const TableReader& contact_table,
                         const DeviceDescription* device, const scene::ContactSpec& contact,
                         const scene::Effects& effects, const scene::HandSpec& hand) {
    if (device == nullptr || contact_table.boolean("allow_unstable")) return;
    // Springs beside the coupling's: snap turns the part as stiffly as the coupling, for as much as it moves it.
    const double snap = effects.picks() ? effects.snap.stiffness : 0.0, apart = effects.keep_apart.stiffness;
    const auto check = [&](const char* key, double stiffness, bool keeps_apart, double maximum) {
        if (!(maximum > 0.0) || stiffness <= maximum * (1.0 + 1e-9)) return;
        std::string all = fmt::format("contact.{}", key);
        if (snap > 0.0) all += " and effects.snap";
        if (keeps_apart) all += " and effects.keep_apart";
        hand_table.fail(
            "device", fmt::format("{} displays {}{} up to {} stably, the scene's is {}; lower it, or "
                                  "contact.allow_unstable = true",
                                  device->name, all, snap > 0.0 || keeps_apart ? " together" : "", maximum, stiffness));
    };
    check("stiffness_N_per_m", contact.stiffness + snap + apart, apart > 0.0,
          device->stable_stiffness_N_per_m / hand.largestScale());
    check("rotational_stiffness_Nm_per_rad", (1.0 + snap / contact.stiffness) * contact.rotational_stiffness, false,
          device->stable_rotational_stiffness_Nm_per_rad);
}

/// Refuses a spacing that gives a part too many points, and cells that give it a field too large to build. A mesh is
/// judged when it is loaded.
void checkSizes(const TableReader& contact_table, const scene::SceneSpec& scene, PartGeometries& geometries) {
    if (scene::geometryOf(scene).geometry != scene::Geometry::Field) return;
    const scene::ContactSpec& contact = scene.contact;
    const auto refuse = [&](const char* key, const scene::PartSpec& part, const std::optional<std::string>& excess) {
        if (excess) contact_table.fail(key, fmt::format("part {}: {}", part.name, *excess));
    };
    for (const auto& part : scene.parts) {
        const PartSurface* geometry = geometries.of(part);
        if (geometry == nullptr) continue;
        if (part.moves() || contact.two_way)
            refuse("spacing_mm", part, scene::tooManyPoints(geometry->size, geometry->area, contact.spacing));
        if (contact.cell > 0.0 && (!part.held || part.pickable || contact.two_way))
            refuse("cell_mm", part, scene::fieldTooLarge(geometry->size, geometry->area, contact.cell));
    }
}

scene::ContactSpec readContact(const TableReader& read, const DeviceDescription* device, bool device_named,
                               const scene::HandSpec& hand) {
    scene::ContactSpec contact;
    const auto method = read.text("method");
    contact.method = method == "penalty"      ? scene::ContactMethod::Penalty
                     : method == "god_object" ? scene::ContactMethod::GodObject
                                              : scene::ContactMethod::GodObjectHeuristic;
    const auto geometry = read.text("geometry");
    contact.geometry = scene::geometryNamed(geometry).value_or(scene::Geometry::Auto);
    // What accuracy = "auto" picks is of distance fields.
    if (geometry == "auto" && read.text("accuracy") == "auto") contact.geometry = scene::Geometry::Field;
    const auto variant = read.text("variant");
    contact.variant = variant == "raw"             ? scene::PenaltyVariant::Raw
                      : variant == "area_weighted" ? scene::PenaltyVariant::AreaWeighted
                                                   : scene::PenaltyVariant::MaxNormalised;
    readCoupling(read, device, device_named, hand, contact);
    readPenaltyCoupling(read, device, contact);
    contact.area_stiffness = read.number("area_stiffness_N_per_m3");
    contact.tolerance = read.numberOr("tolerance_um", contact.tolerance);
    contact.cell = read.numberOr("cell_mm", 0.0);
    contact.spacing = read.numberOr("spacing_mm", contact.spacing);
    contact.mode = field::modeNamed(read.text("mode")).value_or(contact.mode);
    contact.budget_nodes = static_cast<int>(read.integer("budget_nodes"));
    contact.quality = read.number("quality");
    if (contact.quality > 0.0 && contact.method != scene::ContactMethod::Penalty)
        read.fail("quality", "needs method = \"penalty\": a god object's look goes on until it has seen all");
    else if (contact.quality > 0.0 && contact.budget_nodes == 0)
        read.fail("quality", "needs budget_nodes: without a budget nothing is left out");
    if (read.has("two_way")) contact.two_way = read.boolean("two_way");
    contact.proxy_filter = read.number("proxy_filter_hz");
    return contact;
}

/// What the file leaves to the program: it follows from the parts.
void completeContact(const TableReader& read, scene::SceneSpec& scene, PartGeometries& geometries) {
    const bool spacing = read.has("spacing_mm"), tolerance = read.has("tolerance_um"), two_way = read.has("two_way");
    if (spacing && tolerance && two_way) return;
    const ContactDefaults defaults = defaultsFor(scene, geometries);
    if (!spacing) scene.contact.spacing = defaults.spacing;
    if (!tolerance) scene.contact.tolerance = defaults.tolerance;
    // accuracy = "auto" decides for each spacing that it tries.
    if (!two_way && read.text("accuracy") != "auto") scene.contact.two_way = !oneWayFeelsAll(scene, geometries);
}

/// The budget of accuracy = "auto" [s], else 0.
double readAccuracyBudget(const TableReader& read, const scene::SceneSpec& scene) {
    const bool automatic = read.text("accuracy") == "auto";
    if (!automatic) {
        if (read.has("accuracy_budget_us")) read.fail("accuracy_budget_us", "needs accuracy = \"auto\"");
        return 0.0;
    }
    if (scene.contact.geometry != scene::Geometry::Field)
        read.fail("accuracy", "needs geometry = \"field\" or \"auto\": it picks settings of distance fields");
    for (const char* key : {"tolerance_um", "cell_mm", "spacing_mm", "mode", "budget_nodes"})
        if (read.has(key)) read.fail(key, "is picked by accuracy = \"auto\"");
    if (read.has("two_way") && !read.boolean("two_way"))
        read.fail("two_way", "is picked by accuracy = \"auto\"; true asks for both ways whatever it picks");
    if (scene.handCount() > 1 || scene.effects.picks())
        read.fail("accuracy", "needs one hand and no effects.pick: it picks settings for the pairs of one held part");
    else if (std::all_of(scene.parts.begin(), scene.parts.end(), [](const auto& part) { return part.held; }))
        read.fail("accuracy", "needs a part that the held one can touch");
    if (!read.has("accuracy_budget_us")) read.fail("accuracy_budget_us", "required by accuracy = \"auto\"");
    return read.numberOr("accuracy_budget_us", 0.0);
}

scene::Registration readRegistration(const TableReader& read, double units) {
    scene::Registration registration;
    registration.X_WB = readPose(read, "position", "rotation_deg", units);
    registration.scale = read.number("scale");
    registration.X_DH = readPose(read, "handle_position", "handle_rotation_deg", units);
    return registration;
}

scene::StartGate readStartGate(const TableReader& read, double units, bool begins_empty, Errors& errors) {
    scene::StartGate gate;
    if (const Node* pose = read.node("pose"))
        gate.X_WH =
            readPose(TableReader(*pose, {"pose"}, read.pathOf("pose"), errors), "position", "rotation_deg", units);
    if (read.has("pose") && !begins_empty)
        read.fail("pose", "is that of the part which the hand holds: only a hand that begins with nothing has its own");
    if (!read.has("pose") && begins_empty && read.has("hold_ms"))
        read.fail("hold_ms", "needs `pose`: the hand begins with nothing");
    gate.position_tolerance = read.number("position_tolerance_mm");
    gate.angle_tolerance = read.number("angle_tolerance_deg");
    gate.hold_ticks = static_cast<int>(std::lround(read.number("hold_ms") * 1000.0));
    return gate;
}

/// What nothing is built for where parts in several hands touch.
void checkHands(const TableReader& read, const TableReader& contact_table, const scene::SceneSpec& scene,
                Errors& errors) {
    if (scene.handCount() < 2) return;
    if (scene.contact.budget_nodes > 0)
        contact_table.fail("budget_nodes",
                           "must be 0 with more than one hand: a look may not take several ticks where "
                           "parts move meanwhile");
    int rubbing = 0;
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
        if (!scene.parts[i].moves() || !(scene.parts[i].friction > 0.0) || ++rubbing < 2) continue;
        const Node& friction = *read.items("part")[i].find("friction");
        errors.push_back(
            errorAt(friction.place, fmt::format("{}.{}.friction", read.pathOf("part"), scene.parts[i].name),
                    valueText(friction), "must be 0 on all parts that hands hold but one: nothing rubs between hands"));
    }
}

bool beginsEmpty(const scene::SceneSpec& scene, std::size_t hand) { return scene.heldBy(hand) == scene.parts.size(); }
/// The number of a button that the device has.
int readButton(const TableReader& read, const DeviceDescription* device) {
    const auto button = static_cast<int>(read.integer("button"));
    if (device != nullptr && device->buttons && button > *device->buttons)
        read.fail("button",
                  fmt::format("{} has {} button{}", device->name, *device->buttons, *device->buttons == 1 ? "" : "s"));
    return button;
}

scene::Navigation readNavigation(const TableReader& read, const DeviceDescription* device, Errors& errors) {
    scene::Navigation navigation;
    if (const Node* node = read.node("clutch")) {
        const TableReader clutch(*node, {"effects.clutch"}, read.pathOf("clutch"), errors);
        navigation.clutch = {readButton(clutch, device), clutch.boolean("orientation")};
    }
    if (const Node* node = read.node("position_scale")) {
        const TableReader scale(*node, {"effects.position_scale"}, read.pathOf("position_scale"), errors);
        navigation.second_scale = {readButton(scale, device), scale.numberOr("scale", 1.0)};
        if (scale.has("button") && navigation.second_scale.button == navigation.clutch.button)
            scale.fail("button", "is the clutch's");
    }
    if (const Node* node = read.node("drift")) {
        const TableReader drift(*node, {"effects.drift"}, read.pathOf("drift"), errors);
        const double workspace = device != nullptr ? device->workspace_radius_m : navigation.drift.radius;
        navigation.drift.share = drift.numberOr("share", 0.0);
        navigation.drift.radius = drift.numberOr("radius_mm", workspace);
    }
    return navigation;
}

/// The scene's hands but the first, and their devices.
void readOtherHands(const TableReader& read, std::span<const std::string> names, double units,
                    std::span<const DeviceDescription> devices, const TableReader& first_device,
                    const TableReader& contact_table, SceneContent& content, Errors& errors) {
    std::set<std::string> known;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const Node& table = read.items("hand")[i];
        std::string path = read.pathOf("hand");
        if (!names[i].empty()) path += "." + names[i];
        const TableReader hand_table(table, {"hand"}, path, errors);
        if (hand_table.has("name") && !known.insert(names[i]).second)
            hand_table.fail("name", "is used by another hand");
        const Node absent = emptyTable(table.place);
        const auto open = [&](const char* name) {
            const Node* node = hand_table.node(name);
            return TableReader(node != nullptr ? *node : absent, {name}, hand_table.pathOf(name), errors);
        };
        const TableReader own_device = open("device");
        const TableReader& device_table = hand_table.has("device") ? own_device : first_device;
        const DeviceDescription* device = findDevice(device_table, devices);
        scene::HandSpec hand{readLimits(device_table, device), readRegistration(open("registration"), units),
                             readStartGate(open("start_gate"), units, beginsEmpty(content.scene, i + 1), errors),
                             names[i], content.scene.effects.navigation};
        if (hand_table.has("effects")) {
            const TableReader own(*hand_table.node("effects"), {"hand_effects"}, hand_table.pathOf("effects"), errors);
            hand.navigation = readNavigation(own, device, errors);
        }
        checkStability(device_table, contact_table, device, content.scene.contact, hand);
        checkOtherStiffness(hand_table, contact_table, device, content.scene.contact, content.scene.effects, hand);
        content.other_devices.push_back(deviceName(device_table));
        if (hand_table.has("device") && content.other_devices.back() == kAnyKind)
            device_table.fail(deviceKey(device_table), "leave the table out: what [device] needs holds for all hands");
        content.scene.other_hands.push_back(std::move(hand));
    }
}

/// The poses of a list; what is there has one at least, and few enough.
std::vector<Pose> readPoses(const TableReader& read, const char* key, double units, Errors& errors) {
    std::vector<Pose> poses;
    for (const Node& pose : read.items(key))
        poses.push_back(
            readPose(TableReader(pose, {"pose"}, read.pathOf(key), errors), "position", "rotation_deg", units));
    if (poses.size() > scene::kMostWayPoses)
        read.fail(key, fmt::format("must have at most {} poses", scene::kMostWayPoses));
    else if (read.has(key) && poses.empty())
        read.fail(key, "must have a pose at least");
    return poses;
}

scene::Guidance readGuidance(const TableReader& read, double units, Errors& errors) {
    return {.share = read.numberOr("share", 0.0),
            .X_WG = readPoses(read, "way", units, errors),
            .speed = read.number("speed_mm_per_s"),
            .lead = read.number("lead_mm"),
            .stiffness = read.number("stiffness_N_per_m"),
            .rotational_stiffness = read.number("rotational_stiffness_Nm_per_rad")};
}

scene::Snap readSnap(const TableReader& read, double units, Errors& errors) {
    return {.stiffness = read.numberOr("stiffness_N_per_m", 0.0),
            .range = read.number("range_mm"),
            .X_WG = readPoses(read, "at", units, errors)};
}

/// A guide and what cannot be beside it.
void checkGuidance(const TableReader& effects_table, const scene::Guidance& guidance, Errors& errors) {
    if (!(guidance.share > 0.0)) return;
    const TableReader read(*effects_table.node("guidance"), {"effects.guidance"}, effects_table.pathOf("guidance"),
                           errors);
    if (effects_table.has("pick"))
        read.fail("share", "must be 0 with effects.pick: the guide's way is that of one part");
    if (effects_table.has("passivity_controller"))
        read.fail("share", "must be 0 with effects.passivity_controller, which would take back what the guide gives");
}

/// Snap likewise.
void checkSnap(const TableReader& effects_table, const scene::SceneSpec& scene, Errors& errors) {
    const scene::Snap& snap = scene.effects.snap;
    if (!snap.any()) return;
    const TableReader read(*effects_table.node("snap"), {"effects.snap"}, effects_table.pathOf("snap"), errors);
    if (effects_table.has("passivity_controller"))
        read.fail("stiffness_N_per_m",
                  "must be 0 with effects.passivity_controller, which would take back what the place gives");
    if (effects_table.has("pick") && read.has("at"))
        read.fail("at", "must not be there with effects.pick: the task's steps say where each part belongs");
    else if (!effects_table.has("pick") && !read.has("at"))
        read.fail("stiffness_N_per_m",
                  "needs poses `at` where it draws the part to, as no step of an assembly has one");
    const double turn = std::sqrt(scene.contact.rotational_stiffness / scene.contact.stiffness);
    for (std::size_t i = 0; i < snap.X_WG.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const Pose &a = snap.X_WG[i], &b = snap.X_WG[j];
            if (std::hypot((a.p - b.p).norm(), turn * a.q.angularDistance(b.q)) < 2.0 * snap.range)
                return read.fail("at", "has two places whose ranges meet, so that both draw: lower range_mm");
        }
}

/// Inertia and what cannot be beside it.
void checkInertia(const TableReader& effects_table, const scene::SceneSpec& scene, Errors& errors) {
    if (!scene.effects.inertia.any()) return;
    const TableReader read(*effects_table.node("inertia"), {"effects.inertia"}, effects_table.pathOf("inertia"),
                           errors);
    if (scene.contact.method == scene::ContactMethod::Penalty)
        read.fail("scale",
                  "must be 0 with contact.method = \"penalty\": a mass needs a god object's proxy, the penalty's tool "
                  "has contact.tool_mass_kg");
    if (scene.contact.budget_nodes > 0)
        read.fail("scale", "must be 0 with contact.budget_nodes: a step that takes several ticks has no speed");
}

/// Keeping apart likewise.
void checkKeepApart(const TableReader& effects_table, const scene::SceneSpec& scene, Errors& errors) {
    if (!scene.effects.keep_apart.any()) return;
    const TableReader read(*effects_table.node("keep_apart"), {"effects.keep_apart"},
                           effects_table.pathOf("keep_apart"), errors);
    if (scene.handCount() < 2)
        read.fail("stiffness_N_per_m", "must be 0 with one hand: it keeps apart what two hands hold");
    if (effects_table.has("passivity_controller"))
        read.fail("stiffness_N_per_m",
                  "must be 0 with effects.passivity_controller, which would take back what the other hand puts in");
}

/// The springs that draw the hand add to the coupling's: the device has to display all of them together stably.
void checkDrawing(const TableReader& effects_table, const TableReader& contact_table, const DeviceDescription* device,
                  const scene::SceneSpec& scene, Errors& errors) {
    const scene::Effects& effects = scene.effects;
    checkGuidance(effects_table, effects.guidance, errors);
    checkSnap(effects_table, scene, errors);
    checkInertia(effects_table, scene, errors);
    checkKeepApart(effects_table, scene, errors);
    const double share = effects.guidance.share;
    const bool guides = share > 0.0, snaps = effects.snap.any(), apart = effects.keep_apart.any();
    if (device == nullptr || contact_table.boolean("allow_unstable") || !(guides || snaps || apart)) return;
    const std::string effect = guides ? "guidance" : snaps ? "snap" : "keep_apart";
    const std::string id = "effects." + effect;
    const TableReader read(*effects_table.node(effect), {id}, effects_table.pathOf(effect), errors);
    std::string other;
    if (guides && snaps) other += " and effects.snap";
    if ((guides || snaps) && apart) other += " and effects.keep_apart";
    const auto check = [&](const char* contact_key, bool own_key, double coupling, double guide, double snap,
                           double maximum) {
        if (!(maximum > 0.0) || coupling + share * guide + snap <= maximum * (1.0 + 1e-9)) return;
        read.fail(own_key ? contact_key : "stiffness_N_per_m",
                  fmt::format("with contact.{} = {:.6g}{} it is more than {} displays stably, {:.6g} in all; lower "
                              "either{}, or contact.allow_unstable = true",
                              contact_key, coupling, other, device->name, maximum, guides ? " or the share" : ""));
    };
    const scene::ContactSpec& c = scene.contact;
    check("stiffness_N_per_m", true, c.stiffness, effects.guidance.stiffness,
          effects.snap.stiffness + effects.keep_apart.stiffness,
          device->stable_stiffness_N_per_m / scene.hand(0).largestScale());
    check("rotational_stiffness_Nm_per_rad", guides, c.rotational_stiffness, effects.guidance.rotational_stiffness,
          effects.snap.stiffness * c.rotational_stiffness / c.stiffness,
          device->stable_rotational_stiffness_Nm_per_rad);
}

scene::Effects readEffects(const TableReader& read, const DeviceDescription* device, double units, Errors& errors) {
    scene::Effects effects;
    effects.record = read.boolean("record");
    effects.navigation = readNavigation(read, device, errors);
    if (const Node* node = read.node("passivity_controller")) {
        const TableReader controller(*node, {"effects.passivity_controller"}, read.pathOf("passivity_controller"),
                                     errors);
        effects.passivity_damping = controller.number("max_damping_Ns_per_m");
    }
    if (const Node* node = read.node("transients")) {
        const TableReader transients(*node, {"effects.transients"}, read.pathOf("transients"), errors);
        effects.transients = {.amplitude = transients.number("amplitude_Ns_per_m"),
                              .frequency = transients.number("frequency_hz"),
                              .decay = transients.number("decay_ms")};
    }
    if (const Node* node = read.node("weight")) {
        const TableReader weight(*node, {"effects.weight"}, read.pathOf("weight"), errors);
        effects.weight.gravity = weight.has("gravity_m_per_s2") ? weight.vector("gravity_m_per_s2")
                                                                : Vec3(0.0, 0.0, -scene::kStandardGravity);
        if (!(effects.weight.gravity.norm() <= kMostGravity))
            weight.fail("gravity_m_per_s2", fmt::format("must be no longer than {}", kMostGravity));
    }
    if (const Node* node = read.node("viscosity")) {
        const TableReader viscosity(*node, {"effects.viscosity"}, read.pathOf("viscosity"), errors);
        effects.viscosity = {viscosity.numberOr("damping_Ns_per_m", 0.0),
                             viscosity.number("rotational_damping_Nms_per_rad")};
    }
    if (const Node* node = read.node("guidance"))
        effects.guidance =
            readGuidance(TableReader(*node, {"effects.guidance"}, read.pathOf("guidance"), errors), units, errors);
    if (const Node* node = read.node("snap"))
        effects.snap = readSnap(TableReader(*node, {"effects.snap"}, read.pathOf("snap"), errors), units, errors);
    if (const Node* node = read.node("inertia"))
        effects.inertia.scale = TableReader(*node, {"effects.inertia"}, read.pathOf("inertia"), errors).number("scale");
    if (const Node* node = read.node("keep_apart")) {
        const TableReader apart(*node, {"effects.keep_apart"}, read.pathOf("keep_apart"), errors);
        effects.keep_apart = {apart.numberOr("stiffness_N_per_m", 0.0), apart.number("range_mm")};
    }
    if (const Node* node = read.node("pick")) {
        const TableReader pick(*node, {"effects.pick"}, read.pathOf("pick"), errors);
        effects.pick = {.reach = pick.number("reach_mm"),
                        .button = readButton(pick, device),
                        .on_press = pick.text("closed") == "on_press",
                        .locks = pick.text("let_go") == "lock"};
        for (const int taken : {effects.navigation.clutch.button, effects.navigation.second_scale.button})
            if (taken == effects.pick.button) pick.fail("button", "is another effect's");
    }
    return effects;
}

/// Parts that can be picked up are no good without hands that pick, nor these without them.
void checkPicking(const TableReader& read, const TableReader& effects_table, const scene::SceneSpec& scene,
                  Errors& errors) {
    bool any = false;
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
        if (!scene.parts[i].pickable) continue;
        any = true;
        if (effects_table.has("pick")) continue;
        const Node& pickable = *read.items("part")[i].find("pickable");
        errors.push_back(errorAt(pickable.place,
                                 fmt::format("{}.{}.pickable", read.pathOf("part"), scene.parts[i].name),
                                 valueText(pickable), "needs effects.pick: nothing else picks parts up"));
    }
    if (!any && effects_table.has("pick")) effects_table.fail("pick", "needs a part with pickable = true");
}

}  // namespace

SceneContent readSceneNode(const Node& table, std::vector<std::string_view> ids, const std::string& path,
                           const SceneReading& reading, Errors& errors) {
    PartGeometries& geometries = reading.geometries;
    const std::size_t before = errors.size();
    const TableReader read(table, std::move(ids), path, errors);
    const double units = unitsPerMetre(read, 1e3);
    // A table that is not there has no keys: its reader gives the defaults.
    const Node absent = emptyTable(table.place);
    const auto open = [&](std::string_view name) {
        const Node* node = read.node(name);
        return TableReader(node != nullptr ? *node : absent, {name}, read.pathOf(name), errors);
    };
    SceneContent content;
    const std::size_t before_parts = errors.size();
    const std::vector<std::string> other_hands = readHandNames(read);
    content.scene.parts = readParts(read, table, path, units, other_hands, errors);
    const bool unit_sound = read.has("unit") || table.find("unit") == nullptr;
    content.parts_sound = unit_sound && read.has("part") && errors.size() == before_parts;
    if (content.parts_sound)
        for (const scene::PartSpec& part : content.scene.parts)
            for (Error& problem : geometries.problems(part)) errors.push_back(std::move(problem));
    content.parts_sound = content.parts_sound && errors.size() == before_parts;
    const std::size_t before_device = errors.size();
    const auto device_table = open("device");
    const DeviceDescription* device = findDevice(device_table, reading.devices);
    content.device = deviceName(device_table);
    content.needs = readNeeds(device_table);
    content.scene.limits = readLimits(device_table, device);
    const std::size_t of_device = errors.size() - before_device;
    const auto contact_table = open("contact");
    const auto registration_table = open("registration");
    content.scene.registration = readRegistration(registration_table, units);
    content.scene.effects = readEffects(open("effects"), device, units, errors);
    if (content.parts_sound) checkPicking(read, open("effects"), content.scene, errors);
    content.scene.contact =
        readContact(contact_table, device, device_table.has(deviceKey(device_table)), content.scene.hand(0));
    readOtherHands(read, other_hands, units, reading.devices, device_table, contact_table, content, errors);
    if (content.scene.contact.geometry == scene::Geometry::Auto) content.scene.contact.geometry = reading.automatic;
    if (const auto problem = scene::geometryProblem(content.scene); content.parts_sound && problem)
        contact_table.fail("geometry", *problem);
    if (content.parts_sound) completeContact(contact_table, content.scene, geometries);
    content.accuracy_budget = readAccuracyBudget(contact_table, content.scene);
    if (const Node* budget = contact_table.node("accuracy_budget_us")) content.accuracy_place = budget->place;
    content.allow_unstable = contact_table.boolean("allow_unstable");
    checkHands(read, contact_table, content.scene, errors);
    const auto only_device = [&] { return errors.size() == before + of_device; };
    if (only_device()) checkSizes(contact_table, content.scene, geometries);
    checkStability(device_table, contact_table, device, content.scene.contact, content.scene.hand(0));
    checkDrawing(open("effects"), contact_table, device, content.scene, errors);
    content.scene.start_gate = readStartGate(open("start_gate"), units, beginsEmpty(content.scene, 0), errors);
    // What only the model itself can judge has no line of its own.
    if (only_device())
        for (const Error& error : content.scene.validate())
            errors.push_back(errorAt(table.place, error.key, error.value, error.message));
    content.sound = only_device();
    return content;
}

void warnOfTolerance(const Node& scene, const std::string& path, std::vector<std::string>& warnings) {
    const Node* contact = scene.find("contact");
    if (contact == nullptr || contact->find("cell_mm") == nullptr || contact->find("tolerance_um") == nullptr) return;
    const std::string key = path.empty() ? "contact" : path + ".contact";
    std::string sentence = fmt::format(
        "{}.cell_mm decides the cells of distance fields: tolerance_um beside it has no "
        "say in them",
        key);
    if (std::find(warnings.begin(), warnings.end(), sentence) == warnings.end())
        warnings.push_back(std::move(sentence));
}

Result<scene::SceneSpec> readScene(const std::string& path, std::span<const DeviceDescription> devices,
                                   scene::BuildStore* builds) {
    const auto text = readFile(path);
    if (!text) return text.errors();
    return readSceneText(*text, path, devices, builds);
}

Result<scene::SceneSpec> readSceneText(const std::string& text, const std::string& path,
                                       std::span<const DeviceDescription> devices, scene::BuildStore* builds) {
    auto scene = readSceneOnDevice(text, path, devices, builds);
    if (!scene) return scene.errors();
    return std::move(scene->scene);
}

Result<SceneOnDevice> readSceneOnDevice(const std::string& text, const std::string& path,
                                        std::span<const DeviceDescription> devices, scene::BuildStore* builds) {
    const auto document = parseDocument(text, path);
    if (!document) return document.errors();
    if (const auto other = otherKind(*document, FileKind::Scene)) return errorAt(document->place, "", "", *other);
    Errors errors;
    PartGeometries geometries(builds);
    auto content = readSceneNode(*document, {"scene"}, "", {devices, geometries}, errors);
    std::vector<std::string> warnings;
    if (content.sound) checkFelt(*document, "", content.scene, geometries, errors, warnings);
    if (content.sound) checkWeight(*document, "", content.scene, geometries, errors, warnings);
    warnOfTolerance(*document, "", warnings);
    if (content.accuracy_budget > 0.0)
        errors.push_back(errorAt(document->find("contact")->find("accuracy")->place, "contact.accuracy", "\"auto\"",
                                 "only in a study, whose database keeps what was picked; in a scene file write "
                                 "tolerance_um, spacing_mm, mode and budget_nodes, as passung explain STUDY shows what "
                                 "was picked or passung accuracy FIELD SHELL what there is"));
    tidy(errors);
    if (!errors.empty()) return errors;
    return SceneOnDevice{std::move(content.scene), std::move(content.device), std::move(warnings)};
}

Result<scene::PartSpec> readPart(const std::string& path, double metres_per_unit) {
    const auto text = readFile(path);
    if (!text) return text.errors();
    const auto document = parseDocument(*text, path);
    if (!document) return document.errors();
    if (const auto other = otherKind(*document, FileKind::Part)) return errorAt(document->place, "", "", *other);
    Errors errors;
    const TableReader read(*document, {"part_file"}, "", errors);
    const auto& parts = read.items("part");
    if (read.has("part") && parts.size() != 1)
        errors.push_back(errorAt(parts.empty() ? document->place : parts[1].place, "part", "", "must be exactly one"));
    scene::PartSpec part;
    if (!parts.empty()) part = readPartNode(parts[0], "", unitsPerMetre(read, 1.0 / metres_per_unit), {}, errors);
    tidy(errors);
    if (!errors.empty()) return errors;
    return part;
}

}  // namespace passung::protocol
