#include "study/plan/view.h"

#include "core/base/json.h"

namespace passung::plan {

const char* themeName(Theme theme) { return theme == Theme::Light ? "light" : "dark"; }

std::string viewJson(const View& view) {
    JsonObject json;
    json.text("theme", themeName(view.theme))
        .number("text_scale", view.text_scale)
        .json("camera_from", jsonVector(view.camera_from))
        .json("camera_target_m", view.camera_target ? jsonVector(*view.camera_target) : "null");
    if (view.camera_distance)
        json.number("camera_distance_m", *view.camera_distance);
    else
        json.json("camera_distance_m", "null");
    return json.number("camera_angle_rad", view.camera_opening)
        .json("light_from", view.light_from ? jsonVector(*view.light_from) : "null")
        .number("light", view.light)
        .number("fill_light", view.fill_light)
        .number("ambient_light", view.ambient_light)
        .number("shadow", view.shadow)
        .boolean("ground", view.ground)
        .number("max_picture_age_s", view.max_picture_age)
        .number("min_pictures_per_s", view.min_pictures_per_s)
        .str();
}

}  // namespace passung::plan
