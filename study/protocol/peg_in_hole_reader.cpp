#include "study/protocol/peg_in_hole_reader.h"

#include <fmt/format.h>

#include "study/plan/scene_parts.h"
#include "study/protocol/table_reader.h"
#include "study/protocol/trial_types.h"

namespace passung::protocol {
namespace {

template <class T>
const T* shapeOf(const scene::PartSpec& part) {
    const auto* shape = std::get_if<shape::Shape>(&part.geometry);
    return shape != nullptr ? std::get_if<T>(shape) : nullptr;
}

/// Where other forms go.
std::string otherTypes() {
    std::vector<std::string_view> names;
    for (const TrialType& type : trialTypes())
        if (type.name != std::string_view("peg_in_hole")) names.push_back(type.name);
    return fmt::format("every shape and mesh serves in the types {}", fmt::join(names, ", "));
}

/// The held peg; nullptr after reporting, where the held part's form is written, that it is none: success is judged by
/// the clearance, which only a peg has.
const shape::Peg* findPeg(const StudyTables& tables, const scene::SceneSpec& scene, Errors& errors) {
    const scene::PartSpec* held = plan::heldPart(scene);
    if (held == nullptr) return nullptr;
    if (const auto* peg = shapeOf<shape::Peg>(*held)) return peg;
    for (const Node& node : tables.scene.find("part")->items) {
        if (node.find("name")->text != held->name) continue;
        const Node* shape = node.find("shape");
        const Node* form = shape != nullptr ? shape->find("kind") : node.find("mesh");
        errors.push_back(errorAt(form->place, fmt::format("part.{}.{}", held->name, shape ? "shape.kind" : "mesh"),
                                 valueText(*form),
                                 "the held part must have the shape peg in a peg_in_hole task; " + otherTypes()));
    }
    return nullptr;
}

/// The target's bore; nullptr after reporting why there is none.
const shape::BorePlate* findBore(const TableReader& read, const scene::PartSpec* target) {
    if (target == nullptr) return nullptr;
    const auto* plate = shapeOf<shape::BorePlate>(*target);
    if (plate == nullptr) read.fail("target", "must be a part with the shape bore_plate; " + otherTypes());
    return plate;
}

/// Reports a bore that is too narrow for the peg where the bore's diameter, or its fit, is written.
void checkFit(const StudyTables& tables, const std::string& target, const shape::Peg& peg,
              const shape::BorePlate& plate, Errors& errors) {
    if (peg.diameter < plate.bore_diameter) return;
    for (const Node& part : tables.scene.find("part")->items) {
        const Node* shape = part.find("shape");
        if (part.find("name")->text != target || shape == nullptr) continue;
        const bool fitted = shape->find("fit") != nullptr;
        const char* key = fitted ? "fit" : "bore_diameter";
        const Node& value = *shape->find(key);
        const auto message = fitted ? fmt::format("gives a bore of {:.7g} mm, not larger than the peg's {:.7g} mm",
                                                  1e3 * plate.bore_diameter, 1e3 * peg.diameter)
                                    : std::string("must be larger than the peg's diameter");
        errors.push_back(errorAt(value.place, fmt::format("part.{}.shape.{}", target, key), valueText(value), message));
    }
}

/// A part that is fully inserted before it leaves the sphere about its start would never start the clock.
void checkWay(const TableReader& read, const scene::SceneSpec& scene, const plan::Task& task,
              const plan::PegInHoleTask& peg) {
    const Vec3 end = plan::partNamed(scene, task.target)->X_WP * Vec3(0, 0, -peg.insertion_depth);
    const double way = (end - plan::heldPart(scene)->X_WP.p).norm();
    if (!(task.leave_radius < way))
        read.fail("leave_radius_mm",
                  fmt::format("must be less than the way from the start to full depth, {:.6g} mm", 1e3 * way));
}

}  // namespace

plan::PegInHoleTask readPegInHole(const TableReader& read, const StudyTables& tables, const scene::SceneSpec& scene,
                                  const scene::PartSpec* target, const plan::Task& task, Errors& errors) {
    plan::PegInHoleTask peg;
    peg.insertion_depth = read.number("insertion_depth_mm");
    peg.success_fraction = read.number("success_fraction");
    peg.max_speed = read.number("max_speed_mm_per_s");
    peg.hold = read.number("hold_s");
    peg.engagement_depth = read.number("engagement_depth_mm");
    const double success_depth = peg.success_fraction * peg.insertion_depth;
    if (!(peg.engagement_depth < success_depth))
        read.fail("engagement_depth_mm",
                  fmt::format("must be less than the depth of success, {:.6g} mm", 1e3 * success_depth));
    if (!(peg.hold < task.timeout)) read.fail("hold_s", "must be less than timeout_s");
    const auto* plate = findBore(read, target);
    if (plate == nullptr) return peg;
    if (peg.insertion_depth > plate->bore_depth)
        read.fail("insertion_depth_mm", fmt::format("the bore is only {:.6g} mm deep", 1e3 * plate->bore_depth));
    const auto* held = findPeg(tables, scene, errors);
    if (held == nullptr) return peg;
    checkWay(read, scene, task, peg);
    peg.clearance = 0.5 * (plate->bore_diameter - held->diameter);
    if (peg.insertion_depth > held->length)
        read.fail("insertion_depth_mm", fmt::format("the peg is only {:.6g} mm long", 1e3 * held->length));
    checkFit(tables, task.target, *held, *plate, errors);
    return peg;
}

}  // namespace passung::protocol
