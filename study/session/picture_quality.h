#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace passung::session {

/// How the participant's window draws, frozen for a session once it was found on the session's own scene.
struct PictureQuality {
    bool shadows = true;
    int samples = 4;     // per pixel, 1: edges are not smoothed
    double scale = 1.0;  // of the drawn picture's sides to the window's, 0.5 … 1
    friend bool operator==(const PictureQuality&, const PictureQuality&) = default;
};

/// What finding it has shown.
struct QualityFound {
    PictureQuality quality;
    int width_px = 0, height_px = 0;  // of the window
    std::int64_t triangles = 0;       // of the scene that was drawn meanwhile
    double pictures_per_s = 0.0;      // that were reached with it
    friend bool operator==(const QualityFound&, const QualityFound&) = default;
};

/// The event that keeps it in the data.
inline constexpr const char* kQualityEvent = "picture_quality";

/// Its fields as JSON; unfinished.cpp in study/store reads them.
std::string qualityJson(const QualityFound& found);

/// Quality in a note of the windows, from before it was an event of its own; nothing if the note is about something
/// else.
std::optional<QualityFound> qualityOfNote(const std::string& note);

}  // namespace passung::session
