#pragma once

#include <array>

#include "study/protocol/key_table.h"

namespace passung::protocol {

// Rows of the key table for what stands beside a study's scene and task: secondary task, texts, instructions.
// clang-format off
inline constexpr std::array kConditionKeys{
    Key{"protocol", "secondary", KeyType::Table, {}, "", "(its defaults)", "A detection-response task beside the trial's own."},
    Key{"protocol", "text", KeyType::Table, {}, "", "(none)", "The study's texts: a table for each language."},
    Key{"protocol", "instruction", KeyType::Tables, {}, "", "(none)", "Pages for the participant, in this order."},

    Key{"task.peg_in_hole", "timed_by", KeyType::Choice, {}, "program|experimenter|clock", "program", "Source of a trial's begin and end. program: the rule of the task. experimenter: real parts in the hand, and `passung session DB start`, then `done` or `failed`, or the time-out. clock: nothing is handled, the trial begins at once and is a success after `timeout_s`. Both need `feedback.kinesthetic = false`; the device rests, only outcome, trial time and the secondary task's measures are known."},

    Key{"feedback", "masking_noise", KeyType::Boolean, {}, "", "false", "Noise over the headphones, so that contact is not heard: a state that is stored with every trial and a column of the exported samples."},

    Key{"feedback", "result", KeyType::Choice, {}, "none|outcome|time", "none", "Feedback to the participant after a trial, until the next one begins: nothing, how the trial ended, or also how long the trial took."},

    Key{"secondary", "stimulus", KeyType::Choice, {}, "none|visual|vibrotactile|audio", "none", "Stimulus that a button answers; its command, 0 or 1, is a column of the exported samples. Windows play audio; visual and vibrotactile have no output yet: check warns, and only simulated participants can run them. A block's or a level's `set` turns it on where it is wanted."},
    Key{"secondary", "interval_min_s", KeyType::Number, {0.1, 600}, "", "3", "Least time between two onsets. Times are drawn uniformly; the first counts from the attempt's first tick."},
    Key{"secondary", "interval_max_s", KeyType::Number, {0.1, 600}, "", "5", "Longest time between two stimuli."},
    Key{"secondary", "stimulus_ms", KeyType::Number, {1, 10000}, "", "1000", "Duration of a stimulus that is not answered."},
    Key{"secondary", "response_min_ms", KeyType::Number, {0, 10000}, "", "100", "Shortest response; an earlier press after an onset is a false alarm."},
    Key{"secondary", "response_max_ms", KeyType::Number, {1, 10000}, "", "2500", "Longest response; a stimulus without response by then is a miss."},
    Key{"secondary", "button", KeyType::Integer, {1, 24}, "", "1", "Number of the device's button, from 1."},

    Key{"instruction", "moment", KeyType::Choice, {}, "session_start|before_block|session_end", "!", "Moment at which the page is shown: before the session's first trial, before the first trial of `block`, after the last trial. Logged with who read it and, in real time, for how long."},
    Key{"instruction", "block", KeyType::Name, {}, "", "(only before_block)", "Block before which the page is shown."},
    Key{"instruction", "text", KeyType::Name, {}, "", "!", "Name of a text."},
    Key{"instruction", "picture", KeyType::Text, {}, "", "(none)", "PNG or JPEG file, relative to the study's. Its SHA-256 is stored with the study, which refuses another content later."},
};
// clang-format on

}  // namespace passung::protocol
