#include "study/session/picture_quality.h"

#include <array>
#include <cinttypes>
#include <cstdio>
#include <string_view>

#include "core/base/json.h"

namespace passung::session {

std::string qualityJson(const QualityFound& found) {
    return JsonObject()
        .integer("window_width_px", found.width_px)
        .integer("window_height_px", found.height_px)
        .number("scale", found.quality.scale)
        .integer("samples", found.quality.samples)
        .boolean("shadows", found.quality.shadows)
        .number("pictures_per_s", found.pictures_per_s)
        .integer("triangles", found.triangles)
        .str();
}

std::optional<QualityFound> qualityOfNote(const std::string& note) {
    QualityFound found;
    PictureQuality& drawn = found.quality;
    std::array<char, 4> shadows{};
    const int read = std::sscanf(note.c_str(),
                                 "picture quality: window %d x %d pixels, drawn at %lf of its sides, %d samples a "
                                 "pixel, shadows %3[a-z]; %lf pictures a second with %" SCNd64 " triangles",
                                 &found.width_px, &found.height_px, &drawn.scale, &drawn.samples, shadows.data(),
                                 &found.pictures_per_s, &found.triangles);
    if (read != 7) return std::nullopt;
    drawn.shadows = std::string_view(shadows.data()) == "on";
    return found;
}

}  // namespace passung::session
