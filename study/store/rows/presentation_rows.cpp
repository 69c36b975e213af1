#include "study/store/rows/presentation_rows.h"

namespace passung::store {

void insertPresentation(const Database& database, std::int64_t attempt_id, const session::Presentation& given) {
    const auto known = [](bool is, double us) { return is ? std::optional(us) : std::nullopt; };
    const bool drawn = given.frames > 0;
    database.prepare("INSERT INTO presentation VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
        .bind(attempt_id, given.drawn_pose, given.frames, known(drawn, given.frame_age_median_us),
              known(drawn, given.frame_age_p99_us), known(given.frame_age_max_us > 0.0, given.frame_age_max_us),
              given.sound, nullIfEmpty(given.sound_output), known(given.sound == "played", given.sound_delay_us),
              given.cue_frames)
        .run();
}

std::optional<session::Presentation> readPresentation(const Database& database, std::int64_t attempt_id) {
    Statement row = database.prepare(
        "SELECT drawn_pose, frames, coalesce(frame_age_median_us, 0), coalesce(frame_age_p99_us, 0), "
        "coalesce(frame_age_max_us, 0), sound, coalesce(sound_output, ''), coalesce(sound_delay_us, 0), cue_frames "
        "FROM presentation WHERE attempt_id=?");
    if (!row.bind(attempt_id).step()) return std::nullopt;
    return session::Presentation{row.text(0), row.integer(1), row.real(2), row.real(3),           row.real(4),
                                 row.text(5), row.text(6),    row.real(7), row.optionalInteger(8)};
}

}  // namespace passung::store
