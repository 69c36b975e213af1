#include "study/protocol/view_reader.h"

namespace passung::protocol {
namespace {

constexpr double kLeastLength = 1e-6;  // of a direction

std::optional<Vec3> readDirection(const TableReader& read, const char* name) {
    if (!read.has(name)) return std::nullopt;
    const Vec3 direction = read.vector(name);
    if (!(direction.norm() > kLeastLength)) {
        read.fail(name, "must point somewhere: not all three numbers may be 0");
        return std::nullopt;
    }
    return direction;
}

}  // namespace

plan::View readView(const TableReader& root, Errors& errors) {
    const Node* table = root.node("view");
    plan::View view;
    if (table == nullptr) return view;
    const TableReader read(*table, {"view"}, "view", errors);
    view.theme = read.text("theme") == "light" ? plan::Theme::Light : plan::Theme::Dark;
    view.text_scale = read.number("text_percent");
    if (const auto from = readDirection(read, "camera_from")) view.camera_from = *from;
    if (read.has("camera_target_mm")) view.camera_target = read.vector("camera_target_mm") / unitsPerSi("_mm");
    if (read.has("camera_distance_mm")) view.camera_distance = read.number("camera_distance_mm");
    view.camera_opening = read.number("camera_angle_deg");
    view.light_from = readDirection(read, "light_from");
    view.light = read.number("light_percent");
    view.fill_light = read.number("fill_light_percent");
    view.ambient_light = read.number("ambient_light_percent");
    view.shadow = read.number("shadow_percent");
    view.ground = read.boolean("ground");
    view.max_picture_age = read.number("max_picture_age_ms");
    view.min_pictures_per_s = read.number("min_pictures_per_s");
    return view;
}

}  // namespace passung::protocol
