#include "study/store/rows/presentation_rows.h"

#include "study/store/schema/named_columns.h"

namespace passung::store {

void insertPresentation(const Database& database, std::int64_t attempt_id, const session::Presentation& given) {
    const auto known = [](bool is, double us) { return is ? std::optional(us) : std::nullopt; };
    const bool drawn = given.frames > 0;
    insertRow(database, "presentation", Named{"attempt_id", attempt_id}, Named{"drawn_pose", given.drawn_pose},
              Named{"frames", given.frames}, Named{"frame_age_median_us", known(drawn, given.frame_age_median_us)},
              Named{"frame_age_p99_us", known(drawn, given.frame_age_p99_us)},
              Named{"frame_age_max_us", known(given.frame_age_max_us > 0.0, given.frame_age_max_us)},
              Named{"sound", given.sound}, Named{"sound_output", nullIfEmpty(given.sound_output)},
              Named{"sound_delay_us", known(given.sound == "played", given.sound_delay_us)},
              Named{"cue_frames", given.cue_frames});
}

std::optional<session::Presentation> readPresentation(const Database& database, std::int64_t attempt_id) {
    using session::Presentation;
    static const Selection<Presentation> columns = {
        {"drawn_pose", &Presentation::drawn_pose},
        {"frames", &Presentation::frames},
        {"coalesce(frame_age_median_us, 0)", &Presentation::frame_age_median_us},
        {"coalesce(frame_age_p99_us, 0)", &Presentation::frame_age_p99_us},
        {"coalesce(frame_age_max_us, 0)", &Presentation::frame_age_max_us},
        {"sound", &Presentation::sound},
        {"coalesce(sound_output, '')", &Presentation::sound_output},
        {"coalesce(sound_delay_us, 0)", &Presentation::sound_delay_us},
        {"cue_frames", &Presentation::cue_frames}};
    Statement row = database.prepare("SELECT " + columns.text() + " FROM presentation WHERE attempt_id=?");
    if (!row.bind(attempt_id).step()) return std::nullopt;
    return columns.read(row);
}

}  // namespace passung::store
