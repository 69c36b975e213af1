#include "analysis/export/presentation_table.h"

#include "study/plan/participant.h"

namespace passung::exporter {

Table makePresentation(const StudyData& study) {
    Table table{
        "presentation.csv",
        "One row per attempt that a window showed: its pictures and its sound. The age of a picture is the time from "
        "the reading of the device for the newest tick that it shows until the display got it. Pictures are those of "
        "the trial, or of the attempt if its trial did not start.",
        {{"participant_id", "Code of the participant", "", "text", "", 1, {}},
         {"kind", "Real person, pilot or simulated participant", "", "text", "", 1, protocol::participantKindNames()},
         {"session", "Number of the participant's session, from 1", "", "integer", "", 1, {}},
         {"trial_index", "Number of the trial in the session, from 0", "", "integer", "", 1, {}},
         {"attempt_no", "Number of the attempt at this trial, from 1", "", "integer", "", 1, {}},
         {"drawn_pose", "What was drawn of the held part", "", "text", "", 1, {"proxy", "device"}},
         {"n_frames", "Pictures that showed a newer tick than the one before", "", "integer", "", 1, {}},
         {"frame_age_median_us", "Age of a picture, median", "µs", "number", "", 1, {}},
         {"frame_age_p99_us", "Age of a picture, 99th percentile", "µs", "number", "", 1, {}},
         {"frame_age_max_us",
          "Age of what was on the screen, largest: until another picture took its place",
          "µs",
          "number",
          "",
          1,
          {}},
         {"cue_frames", "Pictures of these that were drawn with the visual cue above 0", "", "integer", "", 1, {}},
         {"sound",
          "none: the condition has nothing to be heard; silent: it has, but there was no output",
          "",
          "text",
          "",
          1,
          {"none", "played", "silent"}},
         {"sound_output", "Name of the sound's output", "", "text", "", 1, {}},
         {"sound_delay_us",
          "Delay of the sound: the length of the output's buffer; what the output adds is not known",
          "µs",
          "number",
          "",
          1,
          {}}},
        {}};
    for (const store::AttemptRow& attempt : study.attempts) {
        if (!attempt.presentation) continue;
        const session::Presentation& given = *attempt.presentation;
        const auto age = [&](double us) { return given.frames > 0 ? cell(us) : std::string(kMissing); };
        table.rows.push_back(
            {attempt.participant_id, attempt.kind, cell(attempt.session_ordinal), cell(attempt.trial_index),
             cell(attempt.attempt_no), given.drawn_pose, cell(given.frames), age(given.frame_age_median_us),
             age(given.frame_age_p99_us), given.frame_age_max_us > 0.0 ? cell(given.frame_age_max_us) : kMissing,
             cell(given.cue_frames), given.sound, given.sound_output.empty() ? kMissing : given.sound_output,
             given.sound == "played" ? cell(given.sound_delay_us) : kMissing});
    }
    return table;
}

}  // namespace passung::exporter
