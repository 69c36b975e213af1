#include "study/protocol/peg_in_hole_reader.h"

#include <fmt/format.h>

#include "study/plan/scene_parts.h"
#include "study/protocol/scene_node.h"
#include "study/protocol/table_reader.h"

namespace passung::protocol {
namespace {

template <class T>
const T* shapeOf(const scene::PartSpec& part) {
    const auto* shape = std::get_if<shape::Shape>(&part.geometry);
    return shape != nullptr ? std::get_if<T>(shape) : nullptr;
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
void checkWay(const TableReader& read, const scene::PartSpec& held, const scene::PartSpec& target,
              const plan::Task& task, const plan::PegInHoleTask& peg) {
    const Vec3 end = target.X_WP * (peg.X_TMouth * Vec3(0, 0, -peg.insertion_depth));
    const double way = (end - held.X_WP.p).norm();
    if (!(task.leave_radius < way))
        read.fail("leave_radius_mm",
                  fmt::format("must be less than the way from the start to full depth, {:.6g} mm", 1e3 * way));
}

/// Of a peg in the bore of a plate, whose shapes say all.
void readRound(const TableReader& read, const StudyTables& tables, const std::string& target, const shape::Peg& held,
               const shape::BorePlate& plate, plan::PegInHoleTask& peg, Errors& errors) {
    if (read.has("clearance_mm"))
        read.fail("clearance_mm", "must not be there: the diameters of the peg and the bore_plate say it");
    peg.clearance = 0.5 * (plate.bore_diameter - held.diameter);
    if (peg.insertion_depth > held.length)
        read.fail("insertion_depth_mm", fmt::format("the peg is only {:.6g} mm long", 1e3 * held.length));
    checkFit(tables, target, held, plate, errors);
}

}  // namespace

plan::PegInHoleTask readPegInHole(const TableReader& read, const StudyTables& tables, const scene::SceneSpec& scene,
                                  const scene::PartSpec* target, const plan::Task& task, double units, Errors& errors) {
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
    const scene::PartSpec* held = plan::heldPart(scene);
    if (target == nullptr || held == nullptr) return peg;
    const auto* plate = shapeOf<shape::BorePlate>(*target);
    const auto* round = shapeOf<shape::Peg>(*held);
    if (plate != nullptr && peg.insertion_depth > plate->bore_depth)
        read.fail("insertion_depth_mm", fmt::format("the bore is only {:.6g} mm deep", 1e3 * plate->bore_depth));
    if (const Node* mouth = read.node("mouth")) {
        if (plate != nullptr) read.fail("mouth", "must not be there: a bore_plate's frame is in its mouth");
        peg.X_TMouth =
            readPose(TableReader(*mouth, {"pose"}, read.pathOf("mouth"), errors), "position", "rotation_deg", units);
    }
    checkWay(read, *held, *target, task, peg);
    if (plate != nullptr && round != nullptr)
        readRound(read, tables, task.target, *round, *plate, peg, errors);
    else if (read.has("clearance_mm"))
        peg.clearance = read.numberOr("clearance_mm", 0.0);
    else
        read.fail("clearance_mm", "required: only of a `peg` in a `bore_plate` their diameters say it");
    return peg;
}

}  // namespace passung::protocol
