#include "analysis/export/presentation_table.h"

#include "analysis/export/shared_columns.h"

namespace passung::exporter {
namespace {

using session::Presentation;

struct ShownAttempt {
    const store::AttemptRow* attempt;
};

/// The age of an attempt's pictures; NA of none.
auto ageOf(double Presentation::*age) {
    return [age](const Presentation& shown) { return shown.frames > 0 ? cell(shown.*age) : std::string(kMissing); };
}

ColumnsOf<Presentation> presentationColumns() {
    return {{"drawn_pose",
             "What was drawn of the held part",
             "text",
             &Presentation::drawn_pose,
             {.levels = {"proxy", "device"}}},
            {"n_frames", "Pictures that showed a newer tick than the one before", "integer", &Presentation::frames},
            {"frame_age_median_us",
             "Age of a picture, median",
             "number",
             ageOf(&Presentation::frame_age_median_us),
             {.unit = "µs"}},
            {"frame_age_p99_us",
             "Age of a picture, 99th percentile",
             "number",
             ageOf(&Presentation::frame_age_p99_us),
             {.unit = "µs"}},
            {"frame_age_max_us",
             "Age of what was on the screen, largest: until another picture took its place",
             "number",
             [](const Presentation& shown) {
                 return shown.frame_age_max_us > 0.0 ? cell(shown.frame_age_max_us) : kMissing;
             },
             {.unit = "µs"}},
            {"cue_frames", "Pictures of these that were drawn with the visual cue above 0", "integer",
             &Presentation::cue_frames},
            {"sound",
             "none: the condition has nothing to be heard; silent: it has, but there was no output",
             "text",
             &Presentation::sound,
             {.levels = {"none", "played", "silent"}}},
            {"sound_output", "Name of the sound's output", "text", &Presentation::sound_output},
            {"sound_delay_us",
             "Delay of the sound: the length of the output's buffer; what the output adds is not known",
             "number",
             [](const Presentation& shown) { return shown.sound == "played" ? cell(shown.sound_delay_us) : kMissing; },
             {.unit = "µs"}}};
}

}  // namespace

Table makePresentation(const StudyData& study) {
    ColumnsOf<ShownAttempt> columns;
    append(columns, attemptColumns(), attemptOf<ShownAttempt>);
    append(columns, presentationColumns(),
           [](const ShownAttempt& row) -> const Presentation& { return *row.attempt->presentation; });
    return makeAttemptTable<ShownAttempt>(
        study, "presentation.csv",
        "One row per attempt that a window showed: its pictures and its sound. The age of a picture is the time from "
        "the reading of the device for the newest tick that it shows until the display got it. Pictures are those of "
        "the trial, or of the attempt if its trial did not start.",
        std::move(columns), [](const store::AttemptRow& attempt, const auto& take) {
            if (attempt.presentation) take({&attempt});
        });
}

}  // namespace passung::exporter
